// Cells of order 2 or 3, whose nodes move one by one as vertices of straight cells do: moving a
// node changes the Jacobian matrix at any place by a matrix of rank one, too.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>
#include <curved/lagrange_quality.hpp>
#include <improve/cell_points.hpp>
#include <improve/vertex_energy.hpp>
#include <mesh/cell_validity.hpp>

namespace hexhex::improvement {

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
  [[nodiscard]] CellState stateOf(const Array<Vec3>& points, std::size_t cell,
                                  Scratch& scratch) const;

  /// The terms of a cell as a function of one of its nodes: at (3 p)^3 places, or with the Bezier
  /// coefficients of the determinant instead of its values there.
  void addTerms(const Array<Vec3>& points, std::size_t cell, Index moving, const IdealBox& box,
                bool bezier, Scratch& scratch, std::vector<EnergyTerm>& terms) const;

 private:
  [[nodiscard]] std::span<const Index> nodesOf(std::size_t cell) const;
  void take(const Array<Vec3>& points, std::size_t cell, Scratch& scratch) const;
  void toBezier(Scratch& scratch) const;

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
