#include <algorithm>
#include <bit>
#include <cmath>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <map/flat_stars.hpp>
#include <map/turned_direction.hpp>

namespace hexhex {

namespace {

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
    return 1U ^ (signBit(sides[0]) | signBit(sides[1]) | signBit(sides[2]));
  }

  std::array<Vec3, 3> normals_{};  ///< inward, of the faces at the corner
  Vec3 sides_{};                   ///< scalar products of normals and direction
  double uncertainty_ = 0;
};

std::size_t rotationOf(const VertexStar::Member& member) {
  return static_cast<std::size_t>(member.rotation.index());
}

/// Per rotation: the signs of the components of the direction that is to be covered.
constexpr std::array<Vec3, Rotation::kCount> kSigns = [] {
  std::array<Vec3, Rotation::kCount> signs{};
  for (std::size_t r = 0; r < signs.size(); ++r) {
    for (std::size_t k = 0; k < 3; ++k) signs[r][k] = kTurnedDirections[r][k] > 0 ? 1 : -1;
  }
  return signs;
}();

/// Whether the edges from a corner of a tet go far enough into an octant that a direction in it can
/// lead into the tet; exact, and soon said.
bool reachesOctant(const TetParameters& u, std::size_t corner, const Vec3& signs) {
  const std::array<std::uint8_t, 3>& others = kPositiveOthers[corner];
  unsigned reaches = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double farthest =
        std::max(std::max(signs[k] * u[others[0]][k], signs[k] * u[others[1]][k]),
                 signs[k] * u[others[2]][k]);
    reaches &= farthest > signs[k] * u[corner][k] ? 1U : 0U;
  }
  return reaches != 0;
}

}  // namespace

/// Notes during the walk through a star how charts turn.
class FlatStarTest::Unfolding {
 public:
  explicit Unfolding(const Passage* passages) : passages_(passages) {}

  void operator()(HalfFace halfFace, const VertexStar::Member& here, VertexStar::Member& spare,
                  const VertexStar::Member& behind) {
    const Passage passage = passages_[halfFace];
    spare.rotation = passage.after(here.rotation);
    turns_ |= spare.rotation != behind.rotation ? 1U : 0U;
    turns_ |= passage.isRough() ? 1U : 0U;
    planes_ |= passage.planeBefore(here.rotation);
  }

  /// Whether charts fit, and boundary faces have planes.
  [[nodiscard]] bool fits() const noexcept { return turns_ == 0; }
  [[nodiscard]] unsigned planes() const noexcept { return planes_; }

 private:
  const Passage* passages_;
  unsigned planes_ = 0;
  unsigned turns_ = 0;
};

bool FlatStarTest::run(Index vertex, VertexStar& star) {
  const Unfolding unfolding = star.walk(topology_, vertex, Unfolding(plain_.passages.data()));
  planes_ = unfolding.planes();
  if (!unfolding.fits()) return false;
  const std::span<const VertexStar::Member> members = star.members();
  if (planes_ != 0 && (!std::has_single_bit(planes_) || isBetweenPlanes(members[0].corner))) {
    return false;
  }
  return coversDirectionOnce(members);
}

std::size_t FlatStarTest::axis(const VertexStar::Member& member) const noexcept {
  const auto& images = kImagesOfAxes[static_cast<std::size_t>(member.rotation.index())];
  return images[static_cast<std::size_t>(std::countr_zero(planes_))];
}

bool FlatStarTest::isBetweenPlanes(CornerIndex corner) const {
  const auto axis = static_cast<std::size_t>(std::countr_zero(planes_));
  return hexhex::isBetweenPlanes(parameters_(tetOf(corner), localOf(corner))[axis]);
}

bool FlatStarTest::coversDirectionOnce(std::span<const VertexStar::Member> star) {
  return (planes_ == 0 ? countCones(star) : countConesAndImages(star)) == 1;
}

/// Cones that contain the direction, of a vertex inside.
std::size_t FlatStarTest::countCones(std::span<const VertexStar::Member> star) {
  if (turned_.size() < star.size()) turned_.resize(2 * star.size());
  std::size_t count = 0;
  std::size_t turned = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    // In charts that are not turned, all is known.
    const bool isTurned = !star[i].rotation.isIdentity();
    const bool isConeCorner = coneCorner(plain_.sides[star[i].tet()]) == star[i].corner % 4;
    count += allOf(!isTurned, isConeCorner) ? 1 : 0;
    turned_[turned] = static_cast<Index>(i);
    turned += isTurned ? 1 : 0;
  }
  std::size_t open = 0;
  for (const Index i : std::span(turned_).first(turned)) {
    TetParameters scratch;
    const TetParameters& u = parameters_.see(star[i].tet(), scratch);
    turned_[open] = i;
    open += reachesOctant(u, star[i].corner % 4, kSigns[rotationOf(star[i])]) ? 1 : 0;
  }
  for (const Index i : std::span(turned_).first(open)) {
    TetParameters scratch;
    const TetParameters& u = parameters_.see(star[i].tet(), scratch);
    count += Cone(u, star[i].corner % 4, kTurnedDirections[rotationOf(star[i])]).count();
  }
  return count;
}

/// Cones and their mirror images, of a vertex on the boundary.
std::size_t FlatStarTest::countConesAndImages(std::span<const VertexStar::Member> star) const {
  std::size_t count = 0;
  for (const VertexStar::Member& member : star) {
    const Vec3& direction = kTurnedDirections[rotationOf(member)];
    TetParameters scratch;
    const TetParameters& u = parameters_.see(member.tet(), scratch);
    const Cone cone(u, member.corner % 4, direction);
    count += cone.count() + cone.countMirrored(direction, axis(member));
  }
  return count;
}

}  // namespace hexhex
