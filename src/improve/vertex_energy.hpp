// The energy of the cells around a vertex as a function of that vertex alone.
//
// At a place of a cell, let J be the Jacobian matrix relative to the cell's ideal box. Moving one
// vertex changes J by a matrix of rank one, hence det J linearly and |J|^2 quadratically. So
// |J|^3 / det J, the shape measure of V. Garanzha et al., "Foldover-free maps in 50 lines of code",
// ACM Transactions on Graphics 40 (2021) to the power 3/2, is convex where determinants are
// positive, and so is any power of it. Like them, we replace det J by a positive number chi(det J)
// where determinants may be negative.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/lanes.hpp>

namespace hexhex::improvement {

/// Lengths of the three edges of the ideal box of a cell.
using IdealBox = std::array<float, 3>;

/// The box with these edge lengths, but at least a ten-thousandth of the longest.
[[nodiscard]] IdealBox idealBox(const Vec3& lengths) noexcept;

/// A cell with one moving corner, mirrored such that this corner is at (0, 0, 0).
struct MovingCell {
  std::array<const Vec3*, 8> corners;  ///< by place: bits 0, 1, 2 are u, v, w
  Vec3 scale;                          ///< inverse lengths of the ideal box
};

/// @param corners  by place
/// @param moving   place of the corner that moves
[[nodiscard]] MovingCell movingCell(const std::array<const Vec3*, 8>& corners, std::size_t moving,
                                    const IdealBox& box) noexcept;

/// The contributions of four places, one per lane, to the energy after a step d of the vertex.
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

/// What contributes to the energy of the cells around a vertex.
enum class TermKind : std::uint8_t {
  Corners,  ///< those four corners whose determinants depend on the moving one
  /// The same, with ideal edges halfway between those of the box and their own, as they are when
  /// the terms are made: their lengths do not follow the vertex.
  OwnCorners,
  /// Those Bezier coefficients of the determinant that depend on the moving corner, instead of
  /// determinants at their places: if all coefficients are positive, so is the cell.
  Bezier
};
/// Terms of a straight cell, and how many there are per kind.
inline constexpr std::size_t kCornerTerms = 4;
inline constexpr std::size_t kBezierTerms = 20;
inline constexpr std::array kTermCounts = {kCornerTerms, kCornerTerms, kBezierTerms};

/// The contributions of all places of the cells around a vertex.
class EnergyTerms {
 public:
  void clear() noexcept { size_ = 0; }
  /// Appends blocks for the caller to fill.
  /// @return the first one
  [[nodiscard]] TermLanes* add(std::size_t blocks);
  void addCells(std::span<const MovingCell> cells, TermKind kind);

  [[nodiscard]] std::span<const TermLanes> blocks() const noexcept {
    return std::span(blocks_).first(size_);
  }
  [[nodiscard]] double leastDeterminantAt(const Vec3& step) const noexcept;

 private:
  std::vector<TermLanes> blocks_;  ///< those beyond size_ are kept for reuse
  std::size_t size_ = 0;
};

/// The energy: the sum of (|J|^3 / (3 sqrt(3) chi))^power. Terms are at least 1 if chi = det J.
struct EnergyKind {
  int power = 1;  ///< 1, 2, 4 or 8: the larger, the more the worst term counts
  /// The regularization of chi. With 0, chi is the determinant, and the energy is infinite unless
  /// all determinants are positive.
  double epsilon = 0;
  double volume = 0;  ///< weight of (det^2 + 1) / chi, which keeps cells from shrinking
};

[[nodiscard]] double energyAt(const EnergyTerms& terms, const EnergyKind& kind,
                              const Vec3& step) noexcept;

/// The energy and its derivatives at the current position of the vertex.
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
