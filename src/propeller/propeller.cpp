// Global connectivity (Section 5.4, Algorithm 8), cells, and the engine's stages in sequence.
#include <algorithm>
#include <atomic>
#include <cassert>
#include <utility>

#include <propeller/hex_vertices.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/propeller.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex::propeller {

namespace {

constexpr std::size_t kGlobalConnectivityGrain = 64;

/// A hex edge being traced: in the chart of a tet, from grid point z in direction `along`, with the
/// blade in direction `beside` next to it.
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
    assert(rank < vertices_.generators[generator].vertexCount && propeller < count);
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

  /// Goes from tet to tet until it reaches the next grid point along the edge, in a tet that holds
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

  /// Whether the whole tet lies beyond the edge's end, which must then have been missed.
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
  assert(std::find(global.opposites.begin(), global.opposites.end(),
                   GlobalConnectivity::kUntraced) == global.opposites.end());
  return global;
}

namespace {

class CellWalker {
 public:
  CellWalker(const HexVertices& vertices, const LocalConnectivity& local,
             const GlobalConnectivity& global)
      : vertices_(vertices), local_(local), global_(global) {}

  /// The cell with a hex corner at a vertex, whose propellers x, y, z become the cell's axes: seen
  /// from x, it lies between blades y and z.
  ///
  /// Moving along one of the propellers swaps the order of the other two, so after a move along x
  /// the corner is seen from x with z before y.
  [[nodiscard]] Hex walk(Index vertex, const SlotName& slot) const {
    const At v0{vertex, slot};
    const At v1 = across(v0);                // (x; z, y)
    const At alongY = rotate(v0);            // (y; z, x)
    const At v3 = across(alongY);            // (y; x, z)
    const At v4 = across(rotate(alongY));    // (z; y, x)
    const At v1AlongZ = rotate(v1);          // (z; y, x)
    const At v2 = across(rotate(v1AlongZ));  // along y: (y; z, x)
    const At v5 = across(v1AlongZ);
    const At v6 = across(rotate(v2));          // along z
    const At v7 = across(rotate(rotate(v3)));  // along z
    return {v0.vertex, v1.vertex, v2.vertex, v3.vertex, v4.vertex, v5.vertex, v6.vertex, v7.vertex};
  }

 private:
  /// A hex corner at a vertex, seen from one of its three propellers.
  struct At {
    Index vertex;
    SlotName slot;
  };

  [[nodiscard]] const Configuration& configurationAt(Index vertex) const {
    return local_.configuration(vertices_.generatorOf[vertex]);
  }

  /// The same hex corner seen from the next of its propellers.
  [[nodiscard]] At rotate(const At& at) const {
    const Propeller* propellers =
        local_.propellers.data() + configurationAt(at.vertex).propellerBegin;
    return {at.vertex, rotateCorner(propellers, local_.slots.data(), at.slot)};
  }

  /// Along the propeller to the corner of the same cell at its other end: the corner between blades
  /// i and i + 1 becomes the one between offset - i - 1 and offset - i.
  [[nodiscard]] At across(const At& at) const {
    const Index generator = vertices_.generatorOf[at.vertex];
    const Configuration& configuration = local_.configuration(generator);
    const std::uint64_t rank = at.vertex - vertices_.generators[generator].firstVertex;
    const Opposite opposite = GlobalConnectivity::unpack(
        global_.opposites[global_.begin[generator] + rank * configuration.propellerCount +
                          at.slot.propeller]);
    const std::size_t count = local_.propeller(configuration, at.slot.propeller).slotCount;
    assert(at.slot.slot < count && opposite.offset < count);
    return {opposite.vertex,
            {opposite.propeller, (opposite.offset + 2 * count - at.slot.slot - 1) % count}};
  }

  const HexVertices& vertices_;
  const LocalConnectivity& local_;
  const GlobalConnectivity& global_;
};

}  // namespace

std::uint64_t countCells(const HexVertices& vertices, const LocalConnectivity& local) {
  std::uint64_t corners = 0;
  for (std::size_t g = 0; g < vertices.generators.size(); ++g) {
    corners += std::uint64_t{vertices.generators[g].vertexCount} *
               local.configuration(static_cast<Index>(g)).cornerCount;
  }
  return corners / 8;
}

Array<Hex> collectCells(const igm::PreparedMap& map, const Array<lattice::NormalSigns>& signs,
                        const HexVertices& vertices, const LocalConnectivity& local,
                        const GlobalConnectivity& global, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  const sweep::CellCenters centers = sweep::findCells(map, stage);
  Array<Hex> cells(centers.count());
  const CellWalker walker(vertices, local, global);
  const SlotFinder finder(map, signs, vertices, local);
  const auto enter = [&](sweep::CellTracer& tracer, Index tet, const lattice::GridPoint& z,
                         lattice::CornerMask generator) {
    tracer.enter(tet, z, generator);
    const sweep::CornerPlace place = tracer.trace({0, 0, 0});
    const Index vertex = vertices.tables.find(place.tet, place.z).vertex;
    if (vertex == kNone) failForMissingVertex(place.tet);
    return walker.walk(vertex, finder.find(place.tet, vertices.generatorOf[vertex],
                                           place.rotation(lattice::direction(0, 1)),
                                           place.rotation(lattice::direction(1, 1))));
  };
  parallelBlocks(
      stage, tets, sweep::kSweepBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
        sweep::CellTracer tracer(map);
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          std::uint64_t next = centers.begin[t];
          if (next == centers.begin[t + 1]) continue;
          sweep::forEachOwnedCenter(map.topology, tet, centers.lines->of(tet),
                                    [&](const lattice::SweptLine& line, std::uint32_t i) {
                                      cells[next++] =
                                          enter(tracer, tet, line.point(i), line.simplex(i));
                                    });
          assert(next == centers.begin[t + 1]);
        }
      });
  return cells;
}

namespace {

constexpr std::size_t kPipelineGrain = 4096;

Array<lattice::NormalSigns> computeNormalSigns(const igm::ExactMap& map, Stage& stage) {
  Array<lattice::NormalSigns> signs(map.corners.size());
  parallelFor(stage, map.corners.size(), kPipelineGrain,
              [&](std::size_t t) { signs[t] = lattice::NormalSigns(map.corners[t]); });
  return signs;
}

void count(const HexVertices& vertices, const LocalConnectivity& local,
           const GlobalConnectivity& global, ExtractStatistics& statistics) {
  statistics.generators = vertices.tables.numbers().generatorCounts;
  statistics.vertices = vertices.tables.numbers().vertexCounts;
  statistics.localPropellers = 0;
  for (std::size_t i = kConstantConfigurations; i < local.configurations.size(); ++i) {
    statistics.localPropellers += local.configurations[i].propellerCount;
  }
  statistics.globalPropellers = global.opposites.size();
}

}  // namespace

HexMesh runPipeline(const igm::PreparedMap& map, std::uint64_t expectedCells, double epsilon,
                    Context& context, ExtractStatistics& statistics) {
  HexMesh mesh;
  HexVertices vertices = [&] {
    Stage stage(context, "vertices");
    HexVertices swept(map, epsilon, stage);
    mesh.points.resize(swept.tables.count());
    mesh.generatorTet.resize(swept.tables.count());
    mesh.generatorCorners.resize(swept.tables.count());
    swept.tables.describe({mesh.points, mesh.generatorTet, mesh.generatorCorners}, stage);
    return swept;
  }();
  Array<lattice::NormalSigns> signs;
  LocalConnectivity local;
  {
    Stage stage(context, "local connectivity");
    signs = computeNormalSigns(map.exact, stage);
    local = extractLocalConnectivity(map, signs, vertices, stage);
    // A missed vertex leaves corners behind that do not make up a whole number of cells.
    if (countCells(vertices, local) != expectedCells) failForMissingVertex({});
  }
  GlobalConnectivity global;
  {
    Stage stage(context, "global connectivity");
    global = traceOpposites(map, signs, vertices, local, stage);
  }
  {
    Stage stage(context, "cells");
    mesh.cells = collectCells(map, signs, vertices, local, global, stage);
    if (mesh.cells.size() != expectedCells) failForMissingVertex({});
  }
  count(vertices, local, global, statistics);
  return mesh;
}

}  // namespace hexhex::propeller
