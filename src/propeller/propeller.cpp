#include <utility>

#include <propeller/global_connectivity.hpp>
#include <propeller/hex_vertices.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/propeller.hpp>
#include <sweep/cell_centers.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex::propeller {

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
  statistics.epsilon = epsilon;
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
    // A vertex that was overlooked leaves corners behind that make up no whole number of cells.
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
