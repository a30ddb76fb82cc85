#include <algorithm>
#include <bit>
#include <cmath>

#include <base/vector3.hpp>
#include <map/flat_stars.hpp>

namespace hexhex {

namespace {

/// kTurned[r]: the direction that is to be covered once, rotated.
constexpr std::array<Vec3, Rotation::kCount> kTurned = [] {
  std::array<Vec3, Rotation::kCount> turned{};
  for (int r = 0; r < Rotation::kCount; ++r) {
    turned[static_cast<std::size_t>(r)] = Rotation(r)(kGeneralDirection);
  }
  return turned;
}();

/// Where rotations send axes.
struct AxisTables {
  std::array<std::array<std::uint8_t, 3>, Rotation::kCount> image{};
  std::array<std::array<std::uint8_t, 3>, Rotation::kCount> preimage{};
};

constexpr AxisTables kAxes = [] {
  AxisTables axes;
  for (int r = 0; r < Rotation::kCount; ++r) {
    const auto index = static_cast<std::size_t>(r);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const auto to = static_cast<std::uint8_t>(axisOf(Rotation(r)(direction(axis, 1))));
      axes.image[index][axis] = to;
      axes.preimage[index][to] = axis;
    }
  }
  return axes;
}();

/// The other corners of a tet, such that they are in positive order as seen from inside a positive
/// tet.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kPositiveOthers = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The cone of directions that lead from a corner of a positive tet into it.
class Cone {
 public:
  Cone(const TetParameters& u, std::size_t corner, const Vec3& direction) {
    std::array<Vec3, 3> edges{};
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      edges[k] = minus(u[kPositiveOthers[corner][k]], u[corner]);
      for (const double x : edges[k]) size = std::max(size, std::abs(x));
    }
    normals_ = {cross(edges[1], edges[2]), cross(edges[2], edges[0]), cross(edges[0], edges[1])};
    for (std::size_t k = 0; k < 3; ++k) sides_[k] = dot(direction, normals_[k]);
    // As in computeSides(). The mirrored direction adds 10 u size^2 to an error of 33 u size^2.
    uncertainty_ = 0x1p-45 * size * size;
  }

  /// 1 if the direction leads into the tet, 0 if it does not, kUncertain if it may be in a face.
  [[nodiscard]] std::size_t count() const noexcept { return count(sides_); }

  /// The same for the direction mirrored along an axis.
  [[nodiscard]] std::size_t countMirrored(const Vec3& direction, std::size_t axis) const noexcept {
    Vec3 sides = sides_;
    for (std::size_t k = 0; k < 3; ++k) sides[k] -= 2 * direction[axis] * normals_[k][axis];
    return count(sides);
  }

  /// Spoils any sum.
  static constexpr std::size_t kUncertain = std::size_t{1} << 48;

 private:
  [[nodiscard]] std::size_t count(const Vec3& sides) const noexcept {
    const double nearest = std::min({std::abs(sides[0]), std::abs(sides[1]), std::abs(sides[2])});
    if (!(nearest > uncertainty_)) return kUncertain;
    return std::min({sides[0], sides[1], sides[2]}) > 0 ? 1 : 0;
  }

  std::array<Vec3, 3> normals_{};  ///< inward, of the faces at the corner
  Vec3 sides_{};                   ///< scalar products of normals and direction
  double uncertainty_ = 0;
};

}  // namespace

bool FlatStarTest::run(std::span<const VertexStar::Member> star) {
  plane_ = 0;
  if (!unfold(star)) return false;
  if (plane_ != 0 && (!std::has_single_bit(plane_) || isBetweenPlanes(star[0].corner))) {
    return false;
  }
  return coversDirectionOnce(star);
}

std::size_t FlatStarTest::axis(std::size_t member) const noexcept {
  const auto& axes = kAxes.image[static_cast<std::size_t>(rotations_[member].index())];
  return axes[static_cast<std::size_t>(std::countr_zero(plane_))];
}

/// Follows the walk through the star; false if charts do not fit, or boundary faces have no plane.
bool FlatStarTest::unfold(std::span<const VertexStar::Member> star) {
  if (rotations_.size() <= star.size()) rotations_.resize(2 * star.size());
  rotations_[0] = {};
  std::size_t reached = 1;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const TetSides sides = plain_.sides[star[i].tet()];
    if (sides == kUncertainSides) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t neighbour = star[i].neighbour[k];
      if (neighbour == kNone && !addBoundary(star[i].halfFace(k), i)) return false;
      if (neighbour == kNone || neighbour < i) continue;  // or done from the other side
      Rotation rotation = rotations_[i];
      if (disagrees(sides, localOf(star[i].halfFace(k))) != 0) {
        const Index jump = transitions_.jump[star[i].halfFace(k)];
        if (transitions_.isExact[jump] == 0) return false;
        rotation = transitions_.table[jump].rotation * rotation;
      }
      // The one behind the last is free to be written.
      rotations_[reached] = rotation;
      reached += neighbour == reached ? 1 : 0;
      if (rotations_[neighbour] != rotation) return false;
    }
  }
  return true;
}

bool FlatStarTest::addBoundary(HalfFace halfFace, std::size_t i) {
  const unsigned plane = constantAxes(parameters_, halfFace);
  if (!std::has_single_bit(plane)) return false;
  const auto& axisBack = kAxes.preimage[static_cast<std::size_t>(rotations_[i].index())];
  plane_ |= 1U << axisBack[static_cast<std::size_t>(std::countr_zero(plane))];
  return true;
}

/// Halfway between two integers, the one to snap to depends on the chart.
bool FlatStarTest::isBetweenPlanes(CornerIndex corner) const {
  const auto axis = static_cast<std::size_t>(std::countr_zero(plane_));
  const double x = parameters_(tetOf(corner), localOf(corner))[axis];
  return std::abs(x - std::nearbyint(x)) == 0.5;
}

bool FlatStarTest::coversDirectionOnce(std::span<const VertexStar::Member> star) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const Vec3& direction = kTurned[static_cast<std::size_t>(rotations_[i].index())];
    const Cone cone(parameters_(star[i].tet()), star[i].corner % 4, direction);
    count += cone.count();
    if (plane_ == 0) continue;
    count += cone.countMirrored(direction, axis(i));
  }
  return count == 1;
}

}  // namespace hexhex
