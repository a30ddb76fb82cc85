// The cells that are improved, straight or curved: their points, their qualities, and their energy.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <curved/lagrange_columns.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

/// Cells as lists of points: corners of straight cells, all nodes of curved ones.
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

/// The quality of a cell is its scaled Jacobian or, if it is not certified, this.
inline constexpr double kNotCertified = -2;
[[nodiscard]] inline bool isCertified(double quality) noexcept { return quality >= -1; }

class ImprovedCells {
 public:
  /// One per thread.
  struct Scratch {
    curved::LagrangeScratch columns;
    std::vector<Vec3> nodes;
    std::vector<MovingCell> straight;
  };

  explicit ImprovedCells(std::size_t atOnce) : atOnce_(atOnce) {}
  virtual ~ImprovedCells() = default;
  ImprovedCells(const ImprovedCells&) = delete;
  ImprovedCells& operator=(const ImprovedCells&) = delete;

  [[nodiscard]] virtual CellPoints points() const = 0;
  [[nodiscard]] virtual Hex cornersOf(std::size_t cell) const = 0;

  /// Adds the terms of cells as functions of one of their points.
  /// @param kind  for curved cells, Corners and OwnCorners mean the same values on a grid
  virtual void addTerms(const Array<Vec3>& points, std::span<const Index> cells, Index moving,
                        const Array<IdealBox>& boxes, TermKind kind, Scratch& scratch,
                        EnergyTerms& terms) const = 0;

  /// Cells that take hardly longer to measure together than one.
  static constexpr std::size_t kTogether = 4;
  /// Measures any number of cells.
  void measure(const Array<Vec3>& points, std::span<const Index> cells, Scratch& scratch,
               std::span<double> qualities) const {
    for (std::size_t begin = 0; begin < cells.size(); begin += atOnce_) {
      const std::size_t count = std::min(atOnce_, cells.size() - begin);
      measureSome(points, cells.subspan(begin, count), scratch, qualities.subspan(begin, count));
    }
  }

 protected:
  /// Measures up to `atOnce` cells.
  virtual void measureSome(const Array<Vec3>& points, std::span<const Index> cells,
                           Scratch& scratch, std::span<double> qualities) const = 0;

 private:
  std::size_t atOnce_;
};

}  // namespace hexhex::improvement
