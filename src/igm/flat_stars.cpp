#include <algorithm>
#include <bit>
#include <cmath>

#include <base/bits.hpp>
#include <base/branchless.hpp>
#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <igm/flat_stars.hpp>
#include <igm/tet_projection.hpp>
#include <igm/turned_direction.hpp>

namespace hexhex {

namespace {

/// Spoils any sum of cones.
constexpr std::size_t kUncertainCone = std::size_t{1} << 48;

/// 1 if the direction leads from a corner into the tet, 0 if it does not.
std::size_t countCone(TetSides sides, std::size_t corner) {
  return sides == kUncertainSides ? kUncertainCone : (coneCorner(sides) == corner ? 1 : 0);
}

std::size_t rotationOf(const VertexStar::Member& member) {
  return static_cast<std::size_t>(member.rotation.index());
}

/// In place of an axis to mirror at.
constexpr std::size_t kNotMirrored = 3;

/// The direction to be covered as a chart sees it, or its mirror image.
struct TurnedRay {
  Vec3 direction{};
  Vec3 signs{};  ///< of its components
};

/// By rotation, and by the axis along which the direction is mirrored then, or kNotMirrored.
constexpr auto kRays = [] {
  std::array<std::array<TurnedRay, 4>, Rotation::kCount> rays{};
  for (std::size_t r = 0; r < rays.size(); ++r) {
    for (std::size_t mirror = 0; mirror < 4; ++mirror) {
      Vec3& direction = rays[r][mirror].direction;
      direction = kTurnedDirections[r];
      if (mirror != kNotMirrored) direction = mirrored(direction, mirror);
      for (std::size_t k = 0; k < 3; ++k) rays[r][mirror].signs[k] = direction[k] > 0 ? 1 : -1;
    }
  }
  return rays;
}();

/// Per pair of numbers in a row of a tet's corners: whether another one goes farther than a corner.
PairMask goFarther(const TetParameters& u, std::size_t corner, std::size_t first, Pair signs) {
  const auto at = [&](std::size_t i) { return signs * loadPair(&u[i][first]); };
  return larger(larger(at(0), at(1)), larger(at(2), at(3))) > at(corner);
}

/// Whether the edges from a corner of a tet go far enough into an octant that a direction in it can
/// lead into the tet; exact, and soon said.
bool reachesOctant(const TetParameters& u, std::size_t corner, const Vec3& signs) {
  // Two overlapping pairs have all three coordinates.
  const PairMask farther =
      goFarther(u, corner, 0, loadPair(&signs[0])) & goFarther(u, corner, 1, loadPair(&signs[1]));
  return (farther[0] & farther[1]) != 0;
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
  if (planes_ != 0 && (!hasOneBit(planes_) || isBetweenPlanes(members[0].corner))) {
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
  std::size_t count = listRays(star);
  const std::span<const Ray> rays = keepOpenRays(star);
  for (std::size_t i = 0; i < rays.size(); i += 2) {
    const bool areTwo = i + 1 < rays.size();
    count += countCones(star, rays[i], rays[areTwo ? i + 1 : i], areTwo);
  }
  return count == 1;
}

/// Of two rays, or of the first one only.
std::size_t FlatStarTest::countCones(std::span<const VertexStar::Member> star, const Ray& first,
                                     const Ray& second, bool areTwo) const {
  const VertexStar::Member& a = star[first.member];
  const VertexStar::Member& b = star[second.member];
  const TurnedRay& rayA = kRays[rotationOf(a)][first.mirror];
  const TurnedRay& rayB = kRays[rotationOf(b)][second.mirror];
  std::array<TetParameters, 2> scratch;  // NOLINT: written before it is read
  const TetProjections projections(
      parameters_.see(a.tet(), scratch[0]), parameters_.see(b.tet(), scratch[1]),
      kImagesOfAxes[rotationOf(a)][0], kImagesOfAxes[rotationOf(b)][0]);
  const std::array<TetSides, 2> sides = projections.sides(rayA.direction, rayB.direction);
  return countCone(sides[0], a.corner % 4) + (areTwo ? countCone(sides[1], b.corner % 4) : 0);
}

/// What is to be looked at: where charts are turned the direction, and on the boundary its mirror
/// image, too. In other charts, cones are known.
/// @return how many of these contain the direction
std::size_t FlatStarTest::listRays(std::span<const VertexStar::Member> star) {
  if (rays_.size() <= 2 * star.size()) rays_.resize(4 * star.size());
  const std::size_t images = onBoundary() ? 1 : 0;
  std::size_t count = 0;
  rayCount_ = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const bool isTurned = !star[i].rotation.isIdentity();
    const bool isConeCorner = coneCorner(plain_.sides[star[i].tet()]) == star[i].corner % 4;
    count += allOf(!isTurned, isConeCorner) ? 1 : 0;
    rays_[rayCount_] = {static_cast<Index>(i), kNotMirrored};
    rayCount_ += isTurned ? 1 : 0;
    rays_[rayCount_] = {static_cast<Index>(i),
                        static_cast<Index>(onBoundary() ? axis(star[i]) : 0)};
    rayCount_ += images;
  }
  return count;
}

/// Keeps the rays that may lead into their members.
std::span<const FlatStarTest::Ray> FlatStarTest::keepOpenRays(
    std::span<const VertexStar::Member> star) {
  std::size_t open = 0;
  for (std::size_t i = 0; i < rayCount_; ++i) {
    const Ray ray = rays_[i];
    const VertexStar::Member& member = star[ray.member];
    TetParameters scratch;
    const TetParameters& u = parameters_.see(member.tet(), scratch);
    rays_[open] = ray;
    open +=
        reachesOctant(u, member.corner % 4, kRays[rotationOf(member)][ray.mirror].signs) ? 1 : 0;
  }
  return std::span(rays_).first(open);
}

}  // namespace hexhex
