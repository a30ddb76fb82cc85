// Tells flat vertices from irregular ones, by their stars (for Section 5.1.2).
#include <algorithm>
#include <bit>
#include <cmath>

#include <base/low_level.hpp>
#include <base/workspaces.hpp>
#include <igm/irregular_vertices.hpp>

namespace hexhex::igm {

namespace {

/// Most vertices are regular, and the star of any other takes long.
constexpr std::size_t kIrregularVerticesGrain = 128;

/// Whether a coordinate is halfway between two integers. The plane to which it snaps then depends
/// on the chart.
bool isBetweenIntegers(double x) { return std::abs(x - std::nearbyint(x)) == 0.5; }

/// Whether the edges from a corner of a tet reach far enough into an octant for a ray in it to lead
/// into the tet.
bool reachesOctant(const TetParameters& u, std::size_t corner, const Ray& ray) {
  PairMask reaches = {-1, -1};
  // Two overlapping pairs cover all three coordinates.
  for (std::size_t k = 0; k < 2; ++k) {
    const Pair signs = loadPair(&ray.signs[k]);
    const auto at = [&](std::size_t i) { return signs * loadPair(&u[i][k]); };
    reaches &= larger(larger(at(0), at(1)), larger(at(2), at(3))) > at(corner);
  }
  return (reaches[0] & reaches[1]) != 0;
}

/// Classifies one star after the other.
class StarClassifier {
 public:
  StarClassifier(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                 const RegularVertices& regular,
                 std::span<const HalfFaceTransition> faceTransitions, bool flatAllowed,
                 VertexKinds& result)
      : topology_(topology),
        parameters_(parameters),
        regular_(regular),
        faceTransitions_(faceTransitions),
        flatAllowed_(flatAllowed),
        result_(result) {}

  /// @param block  receives the star
  void run(Index vertex, StarBlock& block) {
    star_.collect(topology_, vertex, faceTransitions_);
    const std::span<const VertexStar::Member> star = star_.members();
    block.cornersSeen += star.size();
    planes_ = star_.planes();
    if (!flatAllowed_ || !star_.chartsFit() || !isInOnePlane(star) || !coversDirectionOnce(star)) {
      result_.kind[vertex] = VertexKind::Irregular;
      result_.rounding[vertex] = Rounding::ByStar;
      block.add(vertex, star, planes_);
      return;
    }
    result_.kind[vertex] = VertexKind::Flat;
    result_.rounding[vertex] = planes_ == 0 ? Rounding::Free : Rounding::ByStar;
    if (planes_ == 0) return;
    for (const VertexStar::Member& member : star) {
      block.planeCorners.push_back(
          {member.corner, static_cast<Rounding>(lattice::imageOf(planes_, member.rotation))});
    }
  }

 private:
  /// The axis across the boundary plane, in the chart to which a rotation leads.
  [[nodiscard]] std::size_t planeAxis(lattice::Rotation rotation) const {
    return static_cast<std::size_t>(std::countr_zero(lattice::imageOf(planes_, rotation)));
  }

  /// Whether all boundary faces are in one plane, and it is certain to which plane the vertex
  /// snaps.
  [[nodiscard]] bool isInOnePlane(std::span<const VertexStar::Member> star) const {
    if (planes_ == 0) return true;
    const adjacency::CornerIndex first = star.front().corner;
    return hasOneBit(planes_) &&
           !isBetweenIntegers(
               parameters_(adjacency::tetOf(first), adjacency::localOf(first))[planeAxis({})]);
  }

  [[nodiscard]] bool coversDirectionOnce(std::span<const VertexStar::Member> star) {
    std::size_t cones = listRays(star);
    for (std::size_t i = 0; i < rayCount_; i += 2) {
      const bool isLast = i + 1 == rayCount_;
      const auto& [first, rayOfFirst] = rays_[i];
      const auto& [second, rayOfSecond] = rays_[isLast ? i : i + 1];
      std::array<TetParameters, 2> scratch;  // NOLINT: written before it is read
      const auto sides =
          sidesOf(parameters_.see(adjacency::tetOf(first), scratch[0]), rayOfFirst->direction,
                  parameters_.see(adjacency::tetOf(second), scratch[1]), rayOfSecond->direction,
                  rayOfFirst->axis, rayOfSecond->axis);
      if (sides[0] == kUncertainSides || sides[1] == kUncertainSides) return false;
      cones += coneCorner(sides[0]) == first % 4 ? 1 : 0;
      cones += !isLast && coneCorner(sides[1]) == second % 4 ? 1 : 0;
    }
    return cones == 1;
  }

  /// Lists the rays that may lead into tets: in rotated charts the direction, and on the boundary
  /// its mirror image. In unrotated charts, the cones are known.
  /// @return how many of the known cones contain the direction
  std::size_t listRays(std::span<const VertexStar::Member> star) {
    if (rays_.size() <= 2 * star.size()) rays_.resize(4 * star.size());
    std::size_t count = 0;
    // Neither which charts are rotated nor which octants are reached can be predicted.
    const auto add = [&](adjacency::CornerIndex corner, const Ray& ray, bool isWanted) {
      rays_[count] = {corner, &ray};
      count += isWanted ? 1 : 0;
    };
    std::size_t cones = 0;
    for (const VertexStar::Member& member : star) {
      const auto& rays = kRays[static_cast<std::size_t>(member.rotation.index())];
      const bool isRotated = !member.rotation.isIdentity();
      const std::size_t cone = coneCorner(regular_.sides[member.tet()]);
      cones += allOf(!isRotated, cone == member.corner % 4) ? 1 : 0;
      add(member.corner, rays[kNoReflection], isRotated);
      if (planes_ != 0) add(member.corner, rays[planeAxis(member.rotation)], true);
    }
    const std::span listed = std::span(rays_).first(count);
    count = 0;
    for (const auto& [corner, ray] : listed) {
      TetParameters scratch;
      const TetParameters& u = parameters_.see(adjacency::tetOf(corner), scratch);
      add(corner, *ray, reachesOctant(u, corner % 4, *ray));
    }
    rayCount_ = count;
    return cones;
  }

  const adjacency::TetTopology& topology_;
  const LocalParameters& parameters_;
  const RegularVertices& regular_;
  std::span<const HalfFaceTransition> faceTransitions_;
  bool flatAllowed_;
  VertexKinds& result_;
  VertexStar star_;
  lattice::AxisSet planes_ = 0;  ///< of boundary faces, in the chart of the first member
  std::vector<std::pair<adjacency::CornerIndex, const Ray*>> rays_;  ///< more than are in use
  std::size_t rayCount_ = 0;
};

}  // namespace

VertexKinds classifyVertices(const adjacency::TetTopology& topology,
                             const LocalParameters& parameters, const RegularVertices& regular,
                             std::span<const HalfFaceTransition> faceTransitions,
                             std::span<const EdgeValence> known, bool findFlat, Stage& stage) {
  Array<std::uint8_t> isIrregular = regular.isIrregular;
  for (const EdgeValence& edge : known) {
    for (const Index v : {edge.vertex0, edge.vertex1}) {
      if (!topology.isIsolated(v)) isIrregular[v] = 1;
    }
  }
  VertexKinds result;
  result.kind.resize(topology.pointCount);
  result.rounding.resize(topology.pointCount);
  result.blocks.resize(blockCount(topology.pointCount, kIrregularVerticesGrain));
  // The caller's claims about edges, if any, have to be looked up for each edge.
  const bool flatAllowed = findFlat && known.empty();
  const auto makeClassifier = [&] {
    return StarClassifier(topology, parameters, regular, faceTransitions, flatAllowed, result);
  };
  parallelBlocksWith(
      stage, topology.pointCount, kIrregularVerticesGrain, makeClassifier,
      [&](std::size_t begin, std::size_t end, std::size_t block, StarClassifier& classifier) {
        result.blocks[block].reserve(static_cast<std::size_t>(
            std::count(&isIrregular[begin], &isIrregular[begin] + (end - begin), 1)));
        for (std::size_t v = begin; v < end; ++v) {
          if (isIrregular[v] != 0) {
            classifier.run(static_cast<Index>(v), result.blocks[block]);
          } else {
            result.kind[v] = VertexKind::Regular;
            result.rounding[v] = static_cast<Rounding>(regular.plane[v]);
          }
        }
      });
  return result;
}

}  // namespace hexhex::igm
