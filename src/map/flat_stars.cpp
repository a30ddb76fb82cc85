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

Vec3 mirrored(Vec3 direction, unsigned planes) {
  for (std::size_t k = 0; k < 3; ++k) {
    if ((planes >> k) & 1U) direction[k] = -direction[k];
  }
  return direction;
}

/// The image of an axis, both as bits.
unsigned rotatedAxis(unsigned axis, Rotation rotation) {
  const auto direction = static_cast<Direction>(2 * std::countr_zero(axis));
  return 1U << axisOf(rotation(direction));
}

/// The cone of directions that lead from a corner of a positive tet into it.
class Cone {
 public:
  Cone(const TetParameters& u, std::size_t corner) {
    std::array<Vec3, 3> edges{};
    for (std::size_t k = 0; k < 3; ++k) {
      edges[k] = minus(u[kOthers[corner][k]], u[corner]);
      for (const double x : edges[k]) size_ = std::max(size_, std::abs(x));
    }
    // Corners 1 and 3 see the others, as listed, in negative order.
    const bool negative = corner % 2 == 1;
    normals_[0] = negative ? cross(edges[2], edges[1]) : cross(edges[1], edges[2]);
    normals_[1] = negative ? cross(edges[0], edges[2]) : cross(edges[2], edges[0]);
    normals_[2] = negative ? cross(edges[1], edges[0]) : cross(edges[0], edges[1]);
  }

  /// 1 if a direction leads into the tet, 0 if it does not, kUncertain if it may be in a face.
  [[nodiscard]] std::size_t count(const Vec3& direction) const noexcept {
    const double a = dot(direction, normals_[0]);
    const double b = dot(direction, normals_[1]);
    const double c = dot(direction, normals_[2]);
    // As in computeSides(), with much to spare.
    const double uncertainty = 0x1p-45 * size_ * size_;
    if (!(std::min({std::abs(a), std::abs(b), std::abs(c)}) > uncertainty)) return kUncertain;
    return std::min({a, b, c}) > 0 ? 1 : 0;
  }

  /// Spoils any sum.
  static constexpr std::size_t kUncertain = std::size_t{1} << 48;

 private:
  std::array<Vec3, 3> normals_{};  ///< inward, of the faces at the corner
  double size_ = 0;
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

unsigned FlatStarTest::plane(std::size_t member) const noexcept {
  return rotatedAxis(plane_, rotations_[member]);
}

/// Follows the walk through the star; false if charts do not fit, or boundary faces have no plane.
bool FlatStarTest::unfold(std::span<const VertexStar::Member> star) {
  if (rotations_.size() < star.size()) rotations_.resize(2 * star.size());
  rotations_[0] = {};
  std::size_t reached = 1;
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (plain_.sides[star[i].tet()] == kUncertainSides) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!cross(star[i], i, k, reached)) return false;
    }
  }
  return true;
}

/// Goes through one face of member i.
bool FlatStarTest::cross(const VertexStar::Member& member, std::size_t i, std::size_t k,
                         std::size_t& reached) {
  const HalfFace halfFace = member.halfFace(k);
  const std::size_t neighbour = member.neighbour[k];
  if (neighbour == kNone) return addBoundary(halfFace, i);
  if (neighbour < i) return true;  // done from the other side
  Rotation rotation = rotations_[i];
  if (disagrees(plain_.sides[member.tet()], localOf(halfFace)) != 0) {
    const Index jump = transitions_.jump[halfFace];
    if (transitions_.isExact[jump] == 0) return false;
    rotation = transitions_.table[jump].rotation * rotation;
  }
  if (neighbour < reached) return rotations_[neighbour] == rotation;
  rotations_[neighbour] = rotation;
  ++reached;
  return true;
}

bool FlatStarTest::addBoundary(HalfFace halfFace, std::size_t i) {
  const unsigned plane = constantAxes(parameters_, halfFace);
  if (!std::has_single_bit(plane)) return false;
  plane_ |= rotatedAxis(plane, rotations_[i].inverse());
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
    const Cone cone(parameters_(star[i].tet()), star[i].corner % 4);
    const Vec3& direction = kTurned[static_cast<std::size_t>(rotations_[i].index())];
    count += cone.count(direction);
    if (plane_ != 0) count += cone.count(mirrored(direction, plane(i)));
  }
  return count == 1;
}

}  // namespace hexhex
