// Curved cells that are improved.
#pragma once

#include <cstddef>
#include <span>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <curved/lagrange_quality.hpp>
#include <improve/improved_cells.hpp>
#include <improve/lagrange_kernels.hpp>
#include <mesh/cell_validity.hpp>

namespace hexhex::improvement {

// Cells of orders 1 to 3. Their nodes move one by one, like vertices of straight cells: moving a
// node changes the Jacobian matrix at any place by a matrix of rank one.

class CurvedCells final : public ImprovedCells {
 public:
  static constexpr int kMaxOrder = 3;

  /// @param mesh  of an order up to kMaxOrder; must outlive this
  CurvedCells(const LagrangeMesh& mesh, Stage& stage);

  [[nodiscard]] CellPoints points() const override;
  [[nodiscard]] Hex cornersOf(std::size_t cell) const override;

  /// At (2 p)^3 places, or with (3 p)^3 Bezier coefficients.
  void addTerms(const Array<Vec3>& points, std::span<const Index> cells, Index moving,
                const Array<IdealBox>& boxes, TermKind kind, Scratch& scratch,
                EnergyTerms& terms) const override;

 private:
  [[nodiscard]] std::span<const Index> nodesOf(std::size_t cell) const;
  [[nodiscard]] curved::LagrangeCells lanesOf(const Array<Vec3>& points,
                                              std::span<const Index> cells) const;
  void measureSome(const Array<Vec3>& points, std::span<const Index> cells, Scratch& scratch,
                   std::span<double> qualities) const override;

  const LagrangeMesh& mesh_;
  adjacency::VertexCells around_;
  LagrangeGrid grid_;
  LagrangeGrid bezierGrid_;
  curved::LagrangeQuality quality_;
  mesh::CellValidity validity_;
};

/// Straight cells between adjacent nodes, p^3 per cell, with the generators and tags of all nodes.
/// Distances from the surface are those of their boundary.
[[nodiscard]] HexMesh refinedMesh(const LagrangeMesh& mesh, Stage& stage);

}  // namespace hexhex::improvement
