// Cells as lists of points: corners of straight cells, all nodes of curved ones.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <curved/lagrange_quality.hpp>
#include <improve/lagrange_kernels.hpp>
#include <improve/vertex_energy.hpp>
#include <mesh/cell_validity.hpp>

namespace hexhex::improvement {

struct CellPoints {
  std::span<const Index> all;  ///< those of cell 0, of cell 1, and so on
  std::size_t perCell = 8;
  const adjacency::VertexCells& around;  ///< the cells at each point
  std::size_t pointCount = 0;

  [[nodiscard]] std::size_t cellCount() const noexcept { return all.size() / perCell; }
  [[nodiscard]] std::span<const Index> of(std::size_t cell) const noexcept {
    return all.subspan(perCell * cell, perCell);
  }
};

// Cells of orders 1 to 3. Their nodes move one by one, like vertices of straight cells: moving a
// node changes the Jacobian matrix at any place by a matrix of rank one.

/// The quality of a cell.
struct CellState {
  double scaled = 1;  ///< scaled Jacobian
  bool certified = true;
};

class CurvedCells {
 public:
  static constexpr int kMaxOrder = 3;

  /// One per thread.
  struct Scratch {
    curved::LagrangeScratch columns;
    std::vector<Vec3> nodes;
  };

  /// @param mesh  of an order up to kMaxOrder; must outlive this
  explicit CurvedCells(const LagrangeMesh& mesh);

  [[nodiscard]] CellPoints points(const adjacency::VertexCells& around) const;
  [[nodiscard]] adjacency::VertexCells cellsAroundNodes(Stage& stage) const;
  [[nodiscard]] Hex cornersOf(std::size_t cell) const;

  /// The states of one to four cells. If the scaled Jacobian of any is less than required, none is
  /// certified.
  /// @param points   of nodes, instead of those of the mesh
  /// @param leastOf  called with a cell: the scaled Jacobian required
  template <class LeastOf>
  [[nodiscard]] std::array<CellState, curved::kCellLanes> statesOf(const Array<Vec3>& points,
                                                                   std::span<const Index> cells,
                                                                   const LeastOf& leastOf,
                                                                   Scratch& scratch) const {
    std::array<CellState, curved::kCellLanes> states = qualitiesOf(points, cells, scratch);
    bool areGood = true;
    for (std::size_t i = 0; i < cells.size(); ++i) areGood &= states[i].scaled >= leastOf(cells[i]);
    if (areGood) certify(points, cells, states, scratch);
    return states;
  }

  /// Adds the terms of cells as functions of one of their nodes: at (2 p)^3 places or, with Bezier
  /// coefficients of the determinant instead of its values, at (3 p)^3.
  void addTerms(const Array<Vec3>& points, std::span<const Index> cells, Index moving,
                const Array<IdealBox>& boxes, bool bezier, Scratch& scratch,
                EnergyTerms& terms) const;

 private:
  using States = std::array<CellState, curved::kCellLanes>;
  [[nodiscard]] std::span<const Index> nodesOf(std::size_t cell) const;
  [[nodiscard]] curved::LagrangeCells lanesOf(const Array<Vec3>& points,
                                              std::span<const Index> cells) const;
  [[nodiscard]] States qualitiesOf(const Array<Vec3>& points, std::span<const Index> cells,
                                   Scratch& scratch) const;
  void certify(const Array<Vec3>& points, std::span<const Index> cells, States& states,
               Scratch& scratch) const;

  const LagrangeMesh& mesh_;
  LagrangeGrid grid_;
  LagrangeGrid bezierGrid_;
  curved::LagrangeQuality quality_;
  mesh::CellValidity validity_;
};

/// Straight cells between adjacent nodes, p^3 per cell, with the generators and tags of all nodes.
/// Distances from the surface are those of their boundary.
[[nodiscard]] HexMesh refinedMesh(const LagrangeMesh& mesh, Stage& stage);

}  // namespace hexhex::improvement
