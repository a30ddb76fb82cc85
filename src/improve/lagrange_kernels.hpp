// Energy terms and Bezier coefficients of determinants, of up to four curved cells at once.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <curved/lagrange_columns.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

/// Places in a cell, and the conversion from values there to Bezier coefficients.
struct LagrangeGrid {
  curved::LagrangeColumns columns;
  mesh::Matrix<double> toBezier = {};  ///< along an axis; empty: no conversion
};

/// Cells around a moving node.
struct MovingNode {
  curved::LagrangeCells cells;
  std::size_t count;                                 ///< of cells
  std::array<std::size_t, curved::kCellLanes> node;  ///< its index among the nodes of each
  std::array<Vec3, curved::kCellLanes> scale;        ///< inverse lengths of the ideal boxes
};

struct LagrangeKernels {
  /// A term per place, with the determinant there or, with a conversion, a Bezier coefficient.
  void (*terms)(const LagrangeGrid& grid, const MovingNode& moving,
                curved::LagrangeScratch& scratch, TermLanes* terms);
  /// Per cell: the least Bezier coefficient of the determinant divided by the largest, or 0 if the
  /// largest is not positive.
  std::array<double, curved::kCellLanes> (*leastShares)(const LagrangeGrid& grid,
                                                        const curved::LagrangeCells& cells,
                                                        curved::LagrangeScratch& scratch);
};

/// Like energyKernels().
[[nodiscard]] std::span<const LagrangeKernels> lagrangeKernels() noexcept;

}  // namespace hexhex::improvement
