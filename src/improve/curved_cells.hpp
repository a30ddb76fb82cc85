// Cells as lists of points: of straight cells corners, of others all nodes.
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

// Cells of order 2 or 3, whose nodes move one by one as vertices of straight cells do: moving a
// node changes the Jacobian matrix at any place by a matrix of rank one, too.

/// What a cell, or the worst of some, is like.
struct CellState {
  double scaled = 1;  ///< scaled Jacobian
  bool certified = true;
};

class CurvedCells {
 public:
  static constexpr int kMaxOrder = 3;

  /// One per thread.
  struct Scratch {
    std::vector<Vec3> nodes;
    curved::LagrangeColumns::Values values;
    mesh::Bezier<double> determinants;
    mesh::Bezier<Vec3> normals;
    std::vector<double> numbers;
    std::vector<EnergyTerm> terms;
    std::vector<EnergyTerm> found;  ///< of all cells around a node
  };

  /// @param mesh  of an order up to kMaxOrder; outlives this
  explicit CurvedCells(const LagrangeMesh& mesh);

  [[nodiscard]] CellPoints points(const adjacency::VertexCells& around) const;
  [[nodiscard]] adjacency::VertexCells cellsAroundNodes(Stage& stage) const;
  [[nodiscard]] Hex cornersOf(std::size_t cell) const;

  /// @param points  of nodes; those of the mesh itself are not looked at
  /// @param least   a cell with a smaller scaled Jacobian need not be certified
  [[nodiscard]] CellState stateOf(const Array<Vec3>& points, std::size_t cell, double least,
                                  Scratch& scratch) const;

  /// The terms of a cell as a function of one of its nodes: at (3 p)^3 places, or with the Bezier
  /// coefficients of the determinant instead of its values there.
  void addTerms(const Array<Vec3>& points, std::size_t cell, Index moving, const IdealBox& box,
                bool bezier, Scratch& scratch, std::vector<EnergyTerm>& terms) const;

 private:
  [[nodiscard]] std::span<const Index> nodesOf(std::size_t cell) const;
  void take(const Array<Vec3>& points, std::size_t cell, Scratch& scratch) const;
  void toBezier(Scratch& scratch) const;
  /// Whether all Bezier coefficients of the determinant are, up to rounding: a proof follows in the
  /// end, and takes five times as long.
  [[nodiscard]] bool hasPositiveCoefficients(Scratch& scratch) const;

  const LagrangeMesh& mesh_;
  curved::LagrangeColumns columns_;
  mesh::Matrix<double> toBezier_;  ///< of the determinant, along an axis
  curved::LagrangeQuality quality_;
  mesh::CellValidity validity_;
};

/// Straight cells between neighbouring nodes, p^3 per cell, with the generators and tags of all
/// nodes: their boundary is what has to be near the surface.
[[nodiscard]] HexMesh refinedMesh(const LagrangeMesh& mesh, Stage& stage);

}  // namespace hexhex::improvement
