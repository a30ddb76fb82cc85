// The energy of the cells around a vertex as a function of that vertex alone.
//
// At a place of a cell let J be the Jacobian matrix, relative to the cell's ideal box. Moving one
// vertex changes J by a matrix of rank one, hence det J linearly and |J|^2 quadratically. So
// |J|^3 / det J, the shape measure of V. Garanzha et al., "Foldover-free maps in 50 lines of code",
// ACM Transactions on Graphics 40 (2021) to the power 3/2, is convex where determinants are
// positive, and so is any power of it. In its place for determinants that are not, they take a
// positive number chi(det).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/lanes.hpp>

namespace hexhex::improvement {

/// Lengths of the three edges of the ideal box of a cell.
using IdealBox = std::array<float, 3>;

/// With these lengths, but no edge less than a ten-thousandth of the longest.
[[nodiscard]] IdealBox idealBox(const Vec3& lengths) noexcept;

/// A cell of which one corner moves, mirrored such that this is the one at (0, 0, 0).
struct MovingCell {
  std::array<const Vec3*, 8> corners;  ///< by place: bits 0, 1, 2 are u, v, w
  Vec3 scale;                          ///< inverse lengths of the ideal box
};

/// @param corners  by place
/// @param moving   place of the corner that moves
[[nodiscard]] MovingCell movingCell(const std::array<const Vec3*, 8>& corners, std::size_t moving,
                                    const IdealBox& box) noexcept;

/// What places of cells contribute for a step d of the vertex: four places at once, one in each
/// lane.
struct alignas(4 * sizeof(double)) TermLanes {
  static constexpr std::size_t kCount = 4;
  using Number = Lanes<double, kCount>;
  Number square;  ///< |J|^2 = square + 2 slope d + growth d^2
  std::array<Number, 3> slope;
  Number growth;
  Number determinant;  ///< det J = determinant + normal d
  std::array<Number, 3> normal;
  Number weight;  ///< 1, or 0 where there is no term
};

/// What all places of the cells around a vertex contribute.
class EnergyTerms {
 public:
  void clear() noexcept { size_ = 0; }
  /// Adds blocks that are to be filled.
  /// @return the first of them
  [[nodiscard]] TermLanes* add(std::size_t blocks);
  /// The terms of the four corners of each cell whose determinants depend on one of them.
  void addCorners(std::span<const MovingCell> cells);
  /// The terms of all Bezier coefficients of the determinant that depend on a corner, in place of
  /// determinants at their places: where all of them are positive, so is the cell.
  void addBezier(std::span<const MovingCell> cells);

  [[nodiscard]] std::span<const TermLanes> blocks() const noexcept {
    return std::span(blocks_).first(size_);
  }
  [[nodiscard]] double leastDeterminantAt(const Vec3& step) const noexcept;

 private:
  void addCells(std::span<const MovingCell> cells, std::size_t perCell,
                void (*termsOf)(std::span<const MovingCell>, TermLanes*) noexcept);

  std::vector<TermLanes> blocks_;  ///< those beyond the size are kept for later
  std::size_t size_ = 0;
};

/// The energy: the sum of (|J|^3 / (3 sqrt(3) chi))^power, each at least 1.
struct EnergyKind {
  int power = 1;  ///< 1, 2, 4 or 8: the larger, the more the worst term counts
  /// Of chi. With 0 it is the determinant, and the energy infinite unless that is positive.
  double epsilon = 0;
  double volume = 0;  ///< weight of (det^2 + 1) / chi, which keeps cells from shrinking
};

[[nodiscard]] double energyAt(const EnergyTerms& terms, const EnergyKind& kind,
                              const Vec3& step) noexcept;

/// Derivatives where the vertex is.
struct EnergySlope {
  double energy = 0;
  Vec3 gradient{};
  /// xx, xy, xz, yy, yz, zz; of the convex part.
  std::array<double, 6> hessian{};
};
[[nodiscard]] EnergySlope slopeOf(const EnergyTerms& terms, const EnergyKind& kind) noexcept;

/// Newton's step within the span of one, two or three orthonormal directions.
/// @return zero if there is none downhill
[[nodiscard]] Vec3 newtonStep(const EnergySlope& slope, std::span<const Vec3> directions) noexcept;

}  // namespace hexhex::improvement
