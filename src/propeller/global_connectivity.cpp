#include <algorithm>
#include <atomic>
#include <vector>

#include <base/output_batches.hpp>
#include <propeller/global_connectivity.hpp>
#include <propeller/slot_finder.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 64;

/// A hex edge on its way: in the chart of a tet, from grid point z in direction `along`, beside it
/// the blade in direction `beside`.
struct Trace {
  Index tet;
  GridPoint z;
  Direction along;
  Direction beside;
};

/// Keeps no records.
struct NoRecorder {
  static constexpr bool kRecords = false;
  void begin(const Trace& /*at*/, CornerMask /*simplex*/) const noexcept {}
  void cross(HalfFace /*halfFace*/, const Trace& /*at*/, bool /*jumps*/) const noexcept {}
};

/// Keeps records of edges, one at a time.
class EdgeRecorder {
 public:
  static constexpr bool kRecords = true;

  explicit EdgeRecorder(FollowedEdges& records) : records_(records) {}

  /// @param simplex  of the tet, that holds the beginning
  void begin(const Trace& at, CornerMask simplex) {
    FollowedEdge& edge = records_.edges.emplace_back();
    edge.tet = at.tet;
    edge.z = at.z;
    edge.along = at.along;
    edge.begin = simplex;
    edge.faceBegin = faceCount_;
    jumps_ = false;
  }
  /// @param jumps  whether the charts on the two sides differ
  void cross(HalfFace halfFace, const Trace& at, bool jumps) {
    records_.faces.push_back({halfFace, edgeCount_, at.z, at.along});
    ++faceCount_;
    jumps_ |= jumps;
  }
  /// @param simplex  of the last tet, that holds the end
  void keep(Index vertex, Index end, CornerMask simplex) {
    FollowedEdge& edge = records_.edges.back();
    edge.ends = {vertex, end};
    edge.end = simplex;
    edge.jumps = jumps_;
    edge.faceEnd = faceCount_;
    ++edgeCount_;
  }
  void drop() {
    faceCount_ = records_.edges.back().faceBegin;
    records_.faces.resize(faceCount_);
    records_.edges.pop_back();
  }

 private:
  FollowedEdges& records_;
  // Counted, as sizes of arrays of such elements take a division.
  Index edgeCount_ = 0;  ///< that were kept
  Index faceCount_ = 0;
  bool jumps_ = false;  ///< the edge at hand, so far
};

class Tracer {
 public:
  Tracer(const PreparedMap& map, const Array<NormalSigns>& signs, const HexVertices& vertices,
         const LocalConnectivity& local, GlobalConnectivity& global)
      : topology_(map.topology),
        exact_(map.exact),
        signs_(signs),
        vertices_(vertices),
        local_(local),
        finder_(map, signs, vertices, local),
        global_(global) {}

  /// Traces every propeller whose first blade's casing lies in this tet.
  template <class Recorder>
  void run(Index tet, Recorder& recorder) const {
    if (vertices_.lines.empty(tet)) return;
    vertices_.lines.forEachPoint(tet, [&](const GridPoint& z, CornerMask simplex, Index point) {
      const Index vertex = vertices_.lines.vertices[point];
      if (vertex == kNone) throw MissingVertex{tet};
      const Index generator = vertices_.generatorOf[vertex];
      const Configuration& configuration = local_.configuration(generator);
      const bool constant = local_.configurationOf[generator] < kConstantConfigurations;
      for (std::size_t p = 0; p < configuration.propellerCount; ++p) {
        const Propeller& propeller = local_.propeller(configuration, p);
        const Slot& slot = local_.slot(propeller, 0);
        if (!constant && slot.tet != tet) continue;
        trace(vertex, generator, p, {tet, z, propeller.direction, slot.direction}, simplex,
              recorder);
      }
    });
  }

 private:
  [[nodiscard]] std::uint64_t placeOf(Index vertex, Index generator, std::size_t propeller) const {
    const std::uint64_t count = local_.configuration(generator).propellerCount;
    const std::uint64_t rank = vertex - vertices_.generators[generator].firstVertex;
    return global_.begin[generator] + rank * count + propeller;
  }
  [[nodiscard]] std::atomic_ref<std::uint64_t> entry(std::uint64_t place) const {
    return std::atomic_ref(global_.opposites[place]);
  }

  /// The tet in whose turn a propeller is traced.
  [[nodiscard]] Index turnOf(Index generator, std::size_t propeller) const {
    if (local_.configurationOf[generator] < kConstantConfigurations) {
      return vertices_.generators[generator].tet;
    }
    const Configuration& configuration = local_.configuration(generator);
    return local_.slot(local_.propeller(configuration, propeller), 0).tet;
  }
  /// Whether the other end of an edge, as its propeller says, comes after a tet. Then it was
  /// another thread that traced the edge.
  [[nodiscard]] bool isAhead(std::uint64_t opposite, Index tet) const {
    const Opposite o = GlobalConnectivity::unpack(opposite);
    return turnOf(vertices_.generatorOf[o.vertex], o.propeller) > tet;
  }

  template <class Recorder>
  void trace(Index vertex, Index generator, std::size_t propeller, Trace at, CornerMask simplex,
             Recorder& recorder) const {
    // Two threads may trace an edge from both ends at once. They write the same values, so relaxed
    // accesses suffice, and the result is the same in any order. It is recorded from the end whose
    // turn comes first, if need be by tracing it once more.
    const std::uint64_t here = placeOf(vertex, generator, propeller);
    const std::uint64_t known = entry(here).load(std::memory_order_relaxed);
    if (known != GlobalConnectivity::kUntraced) {
      if constexpr (!Recorder::kRecords) return;
      if (alone_ || !isAhead(known, at.tet)) return;
    }
    [[maybe_unused]] const Index turn = at.tet;
    recorder.begin(at, simplex);
    const auto [end, endSimplex] = follow(at, recorder);
    const Index endGenerator = vertices_.generatorOf[end];
    const SlotName arrived =
        finder_.find(at.tet, endGenerator, hexhex::opposite(at.along), at.beside);
    const auto offset = static_cast<std::uint16_t>(arrived.slot);
    const std::uint64_t there = placeOf(end, endGenerator, arrived.propeller);
    entry(here).store(
        GlobalConnectivity::pack({end, static_cast<std::uint16_t>(arrived.propeller), offset}),
        std::memory_order_relaxed);
    entry(there).store(
        GlobalConnectivity::pack({vertex, static_cast<std::uint16_t>(propeller), offset}),
        std::memory_order_relaxed);
    if constexpr (Recorder::kRecords) {
      if (!alone_ && turnOf(endGenerator, arrived.propeller) < turn) {
        recorder.drop();
        return;
      }
      recorder.keep(vertex, end, endSimplex);
    }
  }

  /// The end of an edge in the last tet on its way.
  struct Arrival {
    Index vertex;
    CornerMask simplex;
  };

  /// Goes from tet to tet until the next grid point along the edge is reached, and the tet holds
  /// the blade's quarter plane there.
  template <class Recorder>
  Arrival follow(Trace& at, Recorder& recorder) const {
    int entered = -1;
    for (;;) {
      const Index found = vertices_.lines.find(at.tet, step(at.z, at.along));
      if (found != kNone) {
        const CornerMask simplex = arrived(at, found);
        if (simplex != kNoSimplex) return {found, simplex};
      }
      if (passed(at)) throw MissingVertex{at.tet};
      const int exit = exitOfLine(exact_.corners[at.tet], signs_[at.tet], at.z, exact_.unit,
                                  at.along, at.beside, entered);
      if (exit == kNoExit) throw MissingVertex{at.tet};
      const HalfFace halfFace = halfFaceOf(at.tet, exit);
      const HalfFace mate = topology_.mate[halfFace];
      if (mate == kNone) throw MissingVertex{at.tet};
      entered = localOf(mate);
      recorder.cross(halfFace, at, exact_.transitions.isJump(halfFace));
      const Transition& transition = exact_.transitions.across(halfFace);
      at = {tetOf(mate), transition(at.z), transition(at.along), transition(at.beside)};
    }
  }

  /// The simplex of the tet that holds the edge's end, if the tet holds the blade's quarter plane
  /// there; or none. The edge may run inside a face of this tet while the blade lies on the other
  /// side of it.
  [[nodiscard]] CornerMask arrived(const Trace& at, Index vertex) const {
    const Index g = vertices_.generatorOf[vertex];
    const Generator& generator = vertices_.generators[g];
    if (generator.simplex == kWholeTet) return kWholeTet;
    const CornerMask simplex = vertices_.incidenceOf(at.tet, g).simplex;
    const NormalSigns& signs = signs_[at.tet];
    for (int face = 0; face < 4; ++face) {
      if (!contains(simplex, face) && signs.dot(face, at.along) == 0 &&
          signs.dot(face, at.beside) < 0) {
        return kNoSimplex;
      }
    }
    return simplex;
  }

  /// Whether the whole tet lies beyond the edge's end, which then must have been overlooked.
  [[nodiscard]] bool passed(const Trace& at) const {
    const auto axis = static_cast<std::size_t>(axisOf(at.along));
    const std::int64_t end = (at.z[axis] + signOf(at.along)) * exact_.unit;
    const LatticeTet& corners = exact_.corners[at.tet];
    return std::all_of(corners.begin(), corners.end(), [&](const LatticePoint& corner) {
      return signOf(at.along) > 0 ? corner[axis] > end : corner[axis] < end;
    });
  }

  const TetTopology& topology_;
  const ExactMap& exact_;
  const Array<NormalSigns>& signs_;
  const HexVertices& vertices_;
  const LocalConnectivity& local_;
  SlotFinder finder_;
  GlobalConnectivity& global_;
  bool alone_ = currentThreads() == 1;
};

}  // namespace

GlobalConnectivity traceOpposites(const PreparedMap& map, const Array<NormalSigns>& signs,
                                  const HexVertices& vertices, const LocalConnectivity& local,
                                  Stage& stage, TraceGuest* guest) {
  GlobalConnectivity global;
  global.begin.resize(vertices.generators.size());
  std::uint64_t total = 0;
  for (std::size_t g = 0; g < vertices.generators.size(); ++g) {
    global.begin[g] = total;
    total += std::uint64_t{vertices.generators[g].vertexCount} *
             local.configuration(static_cast<Index>(g)).propellerCount;
  }
  global.opposites.resize(total);
  parallelBlocks(stage, total, 1 << 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::fill(global.opposites.begin() + static_cast<std::ptrdiff_t>(begin),
              global.opposites.begin() + static_cast<std::ptrdiff_t>(end),
              GlobalConnectivity::kUntraced);
  });
  const Tracer tracer(map, signs, vertices, local, global);
  const std::size_t tets = map.topology.tetCount();
  if (guest == nullptr) {
    NoRecorder none;
    parallelFor(stage, tets, kGrain,
                [&](std::size_t t) { tracer.run(static_cast<Index>(t), none); });
    return global;
  }
  const std::uint64_t edges = total / 2;
  const std::size_t grain = tetsPerBlock(edges, tets);
  std::vector<FollowedEdges> followed(blocksPerBatch(blockCount(tets, grain)));
  guest->begin(vertices.lines, {vertices.positions.size(), edges, followed.size()}, stage);
  parallelBatches(
      stage, tets, grain, followed.size(),
      [&](std::size_t first, std::size_t end, std::size_t block) {
        FollowedEdges& own = followed[block % followed.size()];
        own.clear();
        EdgeRecorder recorder(own);
        for (std::size_t t = first; t < end; ++t) tracer.run(static_cast<Index>(t), recorder);
        guest->add(block, own);
      },
      [&](std::size_t firstBlock, std::size_t endBlock) { guest->measure(firstBlock, endBlock); },
      [&](std::size_t block) { guest->place(block); });
  return global;
}

}  // namespace hexhex
