// Grid points in a tet whose bounding box has few of them: each is compared with the tet's faces,
// by a floating-point filter with a proven bound, and by exact predicates where the filter cannot
// decide.
//
// A special case of TetRasterizer. With lines alone, whole extractions of maps with 0.1 cells per
// tet take 7 % (sphere_blocks_low) to 12 % (s17c_sphere_r0.1) longer (docs/results/ablation.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <base/lanes.hpp>
#include <lattice/swept_line.hpp>

namespace hexhex::lattice {

/// A tet in half grid units, and its bounding box in the grid of that width. Everything is exact if
/// doubles hold the corners.
struct HalvedTet {
  std::array<Pair, 3> of01;  ///< corners, per axis
  std::array<Pair, 3> of23;
  IntPair firstXy;  ///< first point of the box
  std::int32_t firstZ;
  IntPair stepsXy;  ///< from the first to the last point; -1 if there are none
  std::int32_t stepsZ;
  double mostSteps;  ///< the most along any axis
  double largest;    ///< coordinate of a corner

  HalvedTet(const LatticeTet& corners, double perHalf) noexcept;
};

/// One number per corner of a tet.
struct CornerWeights {
  Pair of01;
  Pair of23;

  [[nodiscard]] double least() const noexcept;
  [[nodiscard]] std::array<double, 4> byCorner() const noexcept {
    return {of01[0], of01[1], of23[0], of23[1]};
  }
};

/// The weights of points, as volumes, in half grid units: positive on the inner side of the face
/// opposite a corner.
struct WeightField {
  std::array<CornerWeights, 3> gradient;  ///< per axis
  std::array<CornerWeights, 3> zero;      ///< per axis, a point where the weight vanishes

  WeightField() = default;
  explicit WeightField(const HalvedTet& tet) noexcept;
  [[nodiscard]] CornerWeights at(const std::array<double, 3>& point) const noexcept;
};

/// The grid points of one tet.
class FewPoints {
 public:
  /// @param corners  must outlive this
  /// @param unit     a power of two, at least 2 unless only vertices are swept
  FewPoints(const LatticeTet& corners, std::int64_t unit) noexcept;

  /// Whether the bounding box has few points of every grid, and doubles hold the corners. If not,
  /// nothing else may be called.
  [[nodiscard]] bool areFew() const noexcept { return areFew_; }

  /// As TetRasterizer::sweep().
  template <class Visit>
  void sweep(HalfGrid grid, const Visit& visit) {
    Lines lines;  // NOLINT: written before it is read
    const std::size_t count = find(grid, lines);
    for (std::size_t i = 0; i < count; ++i) visit(lines[i]);
  }

 private:
  /// More points take longer one by one than by lines.
  static constexpr std::int32_t kFewPoints = 16;
  using Lines = std::array<SweptLine, kFewPoints>;
  using Halves = std::array<std::int32_t, 3>;
  /// Weights of the points, the last coordinate changing fastest, and one spare entry.
  using WeightsOf = std::array<CornerWeights, kFewPoints + 1>;

  /// The points of one grid in the bounding box.
  struct Points {
    IntPair firstXy;  ///< in half units
    std::int32_t firstZ;
    IntPair countXy;  ///< along each axis
    std::int32_t countZ;

    [[nodiscard]] std::int32_t all() const noexcept { return countXy[0] * countXy[1] * countZ; }
    /// The point at some steps from the first, in half units.
    [[nodiscard]] Halves at(const std::array<std::int32_t, 3>& steps) const noexcept {
      return {firstXy[0] + 2 * steps[0], firstXy[1] + 2 * steps[1], firstZ + 2 * steps[2]};
    }
  };

  [[nodiscard]] Points pointsOf(HalfGrid grid) const noexcept;
  /// @return the number of lines
  [[nodiscard]] std::size_t find(HalfGrid grid, Lines& lines) noexcept;
  [[nodiscard]] std::size_t findOne(const Points& points, const std::array<std::int32_t, 3>& at,
                                    const CornerWeights& weights, SweepAxes order,
                                    SweptLine& line) const noexcept;
  [[nodiscard]] std::size_t findCandidates(const Points& points, const WeightsOf& weights,
                                           std::uint32_t candidates, Lines& lines) const noexcept;
  void weigh(const Points& points, WeightsOf& weights) const noexcept;
  [[nodiscard]] std::uint32_t candidates(const WeightsOf& weights,
                                         std::int32_t points) const noexcept;
  [[nodiscard]] CornerMask simplexOf(const Halves& halves,
                                     const CornerWeights& weights) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  HalvedTet halved_;
  bool areFew_;
  bool measured_ = false;
  WeightField field_;
  double error_;  ///< error bound of weights in the box
};

}  // namespace hexhex::lattice
