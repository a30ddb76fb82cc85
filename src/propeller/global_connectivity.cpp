#include <algorithm>
#include <atomic>

#include <propeller/global_connectivity.hpp>

namespace hexhex::propeller {

namespace {

constexpr std::size_t kGlobalConnectivityGrain = 64;

/// A hex edge that is traced: in the chart of a tet, from grid point z in direction `along`, beside
/// it the blade in direction `beside`.
struct Trace {
  Index tet;
  lattice::GridPoint z;
  lattice::Direction along;
  lattice::Direction beside;
};

class Tracer {
 public:
  Tracer(const igm::PreparedMap& map, const Array<lattice::NormalSigns>& signs,
         const HexVertices& vertices, const LocalConnectivity& local, GlobalConnectivity& global)
      : topology_(map.topology),
        exact_(map.exact),
        signs_(signs),
        vertices_(vertices),
        local_(local),
        finder_(map, signs, vertices, local),
        global_(global) {}

  /// Traces every propeller whose first blade's casing lies in this tet.
  void run(Index tet) const {
    vertices_.tables.forEach(
        tet, [&](const lattice::GridPoint& z, const sweep::VertexTables::Found& found) {
          const Index vertex = found.vertex;
          const Index generator = vertices_.generatorOf[vertex];
          const Configuration& configuration = local_.configuration(generator);
          const bool constant = local_.configurationOf[generator] < kConstantConfigurations;
          for (std::size_t p = 0; p < configuration.propellerCount; ++p) {
            const Propeller& propeller = local_.propeller(configuration, p);
            const Slot& slot = local_.slot(propeller, 0);
            if (!constant && slot.tet != tet) continue;
            trace(vertex, generator, p, {tet, z, propeller.direction, slot.direction});
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

  void trace(Index vertex, Index generator, std::size_t propeller, Trace at) const {
    // Two threads may trace an edge from both ends at once. They write the same values, so relaxed
    // accesses suffice, and the result is the same in any order.
    const std::uint64_t here = placeOf(vertex, generator, propeller);
    if (entry(here).load(std::memory_order_relaxed) != GlobalConnectivity::kUntraced) return;
    const Index end = follow(at);
    const Index endGenerator = vertices_.generatorOf[end];
    const SlotName arrived =
        finder_.find(at.tet, endGenerator, hexhex::lattice::opposite(at.along), at.beside);
    const auto offset = static_cast<std::uint16_t>(arrived.slot);
    const std::uint64_t there = placeOf(end, endGenerator, arrived.propeller);
    entry(here).store(
        GlobalConnectivity::pack({end, static_cast<std::uint16_t>(arrived.propeller), offset}),
        std::memory_order_relaxed);
    entry(there).store(
        GlobalConnectivity::pack({vertex, static_cast<std::uint16_t>(propeller), offset}),
        std::memory_order_relaxed);
  }

  /// Goes from tet to tet until the next grid point along the edge is reached, and the tet holds
  /// the blade's quarter plane there.
  Index follow(Trace& at) const {
    int entered = -1;
    for (;;) {
      const sweep::VertexTables::Found found =
          vertices_.tables.find(at.tet, lattice::step(at.z, at.along));
      if (found.vertex != kNone && holdsBlade(at, found.simplex)) return found.vertex;
      const int exit = lattice::exitOfLine(exact_.corners[at.tet], signs_[at.tet], at.z,
                                           exact_.unit, at.along, at.beside, entered);
      if (exit == lattice::kNoExit || passed(at)) failForMissingVertex(at.tet);
      const adjacency::HalfFace halfFace = adjacency::halfFaceOf(at.tet, exit);
      const adjacency::HalfFace mate = topology_.mate[halfFace];
      if (mate == kNone) failForMissingVertex(at.tet);
      entered = adjacency::localOf(mate);
      const lattice::Transition& transition = exact_.transitions.across(halfFace);
      at = {adjacency::tetOf(mate), transition(at.z), transition(at.along), transition(at.beside)};
    }
  }

  /// Whether the tet holds the blade's quarter plane at the edge's end, in the interior of a
  /// simplex. The edge may run inside a face of this tet while the blade lies on the other side of
  /// it.
  [[nodiscard]] bool holdsBlade(const Trace& at, lattice::CornerMask simplex) const {
    const lattice::NormalSigns& signs = signs_[at.tet];
    for (int face = 0; face < 4; ++face) {
      if (!lattice::contains(simplex, face) && signs.dot(face, at.along) == 0 &&
          signs.dot(face, at.beside) < 0) {
        return false;
      }
    }
    return true;
  }

  /// Whether the whole tet lies beyond the edge's end, which then must have been overlooked.
  [[nodiscard]] bool passed(const Trace& at) const {
    const auto axis = static_cast<std::size_t>(lattice::axisOf(at.along));
    const std::int64_t end = (at.z[axis] + lattice::signOf(at.along)) * exact_.unit;
    const lattice::LatticeTet& corners = exact_.corners[at.tet];
    return std::all_of(corners.begin(), corners.end(), [&](const lattice::LatticePoint& corner) {
      return lattice::signOf(at.along) > 0 ? corner[axis] > end : corner[axis] < end;
    });
  }

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  const Array<lattice::NormalSigns>& signs_;
  const HexVertices& vertices_;
  const LocalConnectivity& local_;
  SlotFinder finder_;
  GlobalConnectivity& global_;
};

}  // namespace

GlobalConnectivity traceOpposites(const igm::PreparedMap& map,
                                  const Array<lattice::NormalSigns>& signs,
                                  const HexVertices& vertices, const LocalConnectivity& local,
                                  Stage& stage) {
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
  parallelFor(stage, map.topology.tetCount(), kGlobalConnectivityGrain,
              [&](std::size_t t) { tracer.run(static_cast<Index>(t)); });
  return global;
}

}  // namespace hexhex::propeller
