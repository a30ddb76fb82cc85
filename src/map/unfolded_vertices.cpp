#include <array>
#include <atomic>
#include <bit>

#include <base/bits.hpp>
#include <base/branchless.hpp>
#include <base/shared_bits.hpp>
#include <base/shared_counts.hpp>
#include <map/flat_stars.hpp>
#include <map/tet_projection.hpp>
#include <map/turn.hpp>
#include <map/turned_direction.hpp>
#include <map/unfolded_vertices.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

class VertexUnfolder {
 public:
  VertexUnfolder(const TetTopology& topology, const LocalParameters& parameters,
                 const Gauges& gauges, PlainVertices& plain, Stage& stage)
      : topology_(topology),
        parameters_(parameters),
        plain_(plain),
        stage_(stage),
        inward_(topology.tetCount()),
        state_(topology.pointCount),
        cones_(topology.pointCount, 0) {
    forEachTet([&](Index t) { inward_[t] = inverseOf(gauges.of[t].rotation); });
    parallelFor(stage, topology.pointCount, kGrain,
                [&](std::size_t v) { state_[v] = plain.special[v] == 1 ? 0 : kBlocked; });
  }

  std::vector<StarBlock> run() {
    forEachTet([&](Index t) { lookAtFaces(t); });
    forEachTet([&](Index t) { countCones(t); });
    std::atomic<bool> anyPlane = false;
    parallelFor(stage_, topology_.pointCount, kGrain, [&](std::size_t v) {
      if (!isFlat(static_cast<Index>(v))) return;
      plain_.special[v] = 0;
      plain_.plane[v] = state_[v] == 0 ? 0 : PlainVertices::kPlaneOfStar;
      if (state_[v] != 0) anyPlane.store(true, std::memory_order_relaxed);
    });
    return anyPlane ? planeCorners() : std::vector<StarBlock>{};
  }

 private:
  /// In `state_`, beside bits for the boundary's planes across the axes of the picture: the vertex
  /// is not special, or there is a face that is not passed exactly or where gauges do not agree.
  static constexpr std::uint8_t kBlocked = 8;

  /// Spoils any count of cones.
  static constexpr std::uint32_t kUncertain = std::uint32_t{1} << 20;

  template <class F>
  void forEachTet(const F& f) const {
    parallelFor(stage_, topology_.tetCount(), kGrain,
                [&f](std::size_t t) { f(static_cast<Index>(t)); });
  }

  void lookAtFaces(Index t) {
    std::array<std::uint8_t, 4> found{};
    unsigned all = 0;
    for (std::size_t f = 0; f < 4; ++f) {
      const std::size_t halfFace = 4 * std::size_t{t} + f;
      const Passage passage = plain_.passages[halfFace];
      // At the boundary, a tet stands for its neighbour.
      const HalfFace mate = topology_.mate[halfFace];
      const Index behind = mate == kNone ? t : tetOf(mate);
      const bool isCut = passage.after(inward_[t]) != inward_[behind];
      found[f] = static_cast<std::uint8_t>(passage.planeBefore(inward_[t]) |
                                           (anyOf(isCut, passage.isRough()) ? kBlocked : 0U));
      all |= found[f];
    }
    if (all == 0) return;
    for (std::size_t f = 0; f < 4; ++f) {
      for (const int corner : kFaceCorners[f]) {
        addBits(state_[topology_.tets[t][static_cast<std::size_t>(corner)]], found[f]);
      }
    }
  }

  [[nodiscard]] bool isBlocked(Index vertex) const { return state_[vertex] >= kBlocked; }

  void countCones(Index t) {
    const Tet& tet = topology_.tets[t];
    const unsigned states = state_[tet[0]] | state_[tet[1]] | state_[tet[2]] | state_[tet[3]];
    if (allOf(isBlocked(tet[0]), isBlocked(tet[1]), isBlocked(tet[2]), isBlocked(tet[3]))) return;
    const auto rotation = static_cast<std::size_t>(inward_[t].index());
    TetParameters scratch;
    const TetParameters& u = parameters_.see(t, scratch);
    const std::size_t along = kImagesOfAxes[rotation][0];
    const TetProjections projections(u, u, along, along);
    const Vec3& direction = kTurnedDirections[rotation];
    add(tet, projections.sides(direction, direction)[0], 0);
    for (unsigned rest = states % kBlocked; rest != 0; rest &= rest - 1) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(rest));
      const Vec3 image = mirrored(direction, kImagesOfAxes[rotation][axis]);
      add(tet, projections.sides(image, image)[0], 1U << axis);
    }
  }

  /// Adds the cone that contains a direction to the number of its vertex.
  /// @param plane  across which the direction is mirrored, or 0; counts only at vertices in it
  void add(const Tet& tet, TetSides sides, unsigned plane) {
    if (sides == kUncertainSides) {
      for (const Index v : tet) count(v, kUncertain);
      return;
    }
    const std::size_t corner = coneCorner(sides);
    if (corner == 4) return;
    const Index vertex = tet[corner];
    if (plane == 0 || state_[vertex] == plane) count(vertex, 1);
  }

  void count(Index vertex, Index cones) { sharedCones_.increase(vertex, cones); }

  [[nodiscard]] bool isFlat(Index vertex) const {
    const unsigned planes = state_[vertex];
    if (planes >= kBlocked || cones_[vertex] != 1) return false;
    return planes == 0 || (hasOneBit(planes) && !isBetweenPlanes(vertex));
  }

  [[nodiscard]] bool isBetweenPlanes(Index vertex) const {
    const Index tet = topology_.vertexTet[vertex];
    return hexhex::isBetweenPlanes(
        parameters_(tet, topology_.localCorner(tet, vertex))[planeAxis(vertex, tet)]);
  }

  /// The axis across which the plane of a vertex is in the chart of a tet.
  [[nodiscard]] std::size_t planeAxis(Index vertex, Index tet) const {
    const auto rotation = static_cast<std::size_t>(inward_[tet].index());
    return kImagesOfAxes[rotation]
                        [static_cast<std::size_t>(std::countr_zero(unsigned{state_[vertex]}))];
  }

  [[nodiscard]] std::vector<StarBlock> planeCorners() const {
    constexpr std::size_t kTets = 8 * kGrain;
    std::vector<StarBlock> blocks(blockCount(topology_.tetCount(), kTets));
    parallelBlocks(stage_, topology_.tetCount(), kTets,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     for (std::size_t t = begin; t < end; ++t) {
                       listPlaneCorners(static_cast<Index>(t), blocks[block]);
                     }
                   });
    return blocks;
  }

  void listPlaneCorners(Index t, StarBlock& block) const {
    for (Index i = 0; i < 4; ++i) {
      const Index vertex = topology_.tets[t][i];
      if (plain_.plane[vertex] != PlainVertices::kPlaneOfStar) continue;
      block.planeCorners.push_back({4 * t + i, 1U << planeAxis(vertex, t)});
    }
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  PlainVertices& plain_;
  Stage& stage_;
  Array<Rotation> inward_;     ///< per tet: from the picture into its chart
  Array<std::uint8_t> state_;  ///< per vertex
  Array<Index> cones_;         ///< per vertex: tets and images in one direction from it
  SharedCounts sharedCones_{cones_};
};

}  // namespace

std::vector<StarBlock> unfoldVertices(const TetTopology& topology,
                                      const LocalParameters& parameters, const Gauges& gauges,
                                      PlainVertices& plain, Stage& stage) {
  return VertexUnfolder(topology, parameters, gauges, plain, stage).run();
}

}  // namespace hexhex
