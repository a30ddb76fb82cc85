// From a hex mesh to a polyhedral mesh (see ovm_output.hpp).
#include <algorithm>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/writable.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_features.hpp>
#include <io/ovm/ovm_output.hpp>
#include <io/ovm/ovm_topology.hpp>
#include <io/ovm/simplex_indices.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::int32_t kReversed = 4;  // the order of a cell that begins alike but turns round

/// How a cell was listed, which a reader finds from where its first half-face begins.
/// @param cells  those of the mesh as the topology was built from them
/// @param turned  whether they begin alike but turn the other way
void setCornerOrder(OvmOutput& output, std::span<const Hex> cells, bool turned, Stage& stage) {
  const OvmTopology& topology = output.topology;
  const auto firstOf = [&](std::size_t c) { return topology.cells.handles[6 * c]; };
  // A half-face of an even number begins where its cell does.
  const auto orderOf = [&](std::size_t c) {
    const std::int32_t direction = turned ? kReversed : 0;
    if (firstOf(c) % 2 == 0) return direction;
    const Index begin = topology.from(topology.faces.handles[4 * std::size_t{firstOf(c) / 2}]);
    const Hex& cell = cells[c];
    const std::int32_t place =
        (cell[1] == begin ? 1 : 0) + (cell[2] == begin ? 2 : 0) + (cell[3] == begin ? 3 : 0);
    return (4 - place) % 4 + direction;
  };
  if (firstFault(stage, cells.size(), [&](std::size_t c) { return orderOf(c) == 0; }) ==
      cells.size()) {
    return;
  }
  Array<std::int32_t>& orders = output.properties[OvmInteger::CornerOrder];
  orders.resize(cells.size());
  parallelFor(stage, cells.size(), kGrain, [&](std::size_t c) { orders[c] = orderOf(c); });
}

void setGenerators(OvmOutput& output, const HexMesh& mesh, Stage& stage) {
  if (mesh.generatorCorners.empty()) return;
  const std::size_t vertices = mesh.points.size();
  Array<std::int32_t>& types = output.properties[OvmInteger::GeneratorType];
  Array<std::int32_t>& tets = output.properties[OvmInteger::GeneratorTet];
  Array<std::int32_t>& corners = output.properties[OvmInteger::GeneratorCorners];
  types.resize(vertices);
  corners.resize(vertices);
  const bool haveTets = mesh.generatorTet.size() == vertices;
  if (haveTets) tets.resize(vertices);
  const std::size_t fault = firstFault(stage, vertices, [&](std::size_t v) {
    types[v] = static_cast<std::int32_t>(generatorKind(mesh.generatorCorners[v]));
    corners[v] = mesh.generatorCorners[v];
    if (haveTets) tets[v] = static_cast<std::int32_t>(mesh.generatorTet[v]);
    return corners[v] >= 1 && corners[v] <= 15;
  });
  if (fault == vertices) return;
  throw Error(ErrorCode::InvalidArgument,
              "The generator of vertex " + std::to_string(fault) + " has the corner set " +
                  std::to_string(corners[fault]) + ", which must be from 1 to 15.",
              Place{PlaceKind::Vertex, fault});
}

void setGeneratorIndices(OvmOutput& output, const HexMesh& mesh, const TetMap& map, Stage& stage) {
  if (mesh.generatorCorners.empty() || mesh.generatorTet.size() != mesh.points.size()) return;
  requireWritable(map, stage);
  const SimplexIndices indices(map.points, map.tets, stage);
  Array<std::int32_t>& values = output.properties[OvmInteger::GeneratorIndex];
  values.resize(mesh.points.size());
  parallelFor(stage, values.size(), kGrain, [&](std::size_t v) {
    const Index tet = mesh.generatorTet[v];
    const Index index = tet < map.tets.size() ? indices.of(tet, mesh.generatorCorners[v]) : kNone;
    values[v] = static_cast<std::int32_t>(index);  // kNone is -1
  });
}

}  // namespace

OvmOutput toOvm(const HexMesh& mesh, const TetMap* map, Stage& stage) {
  Array<Hex> turned;
  if (isMostlyNegative(mesh.points, mesh.cells, stage)) {
    turned.resize(mesh.cells.size());
    parallelFor(stage, turned.size(), kGrain, [&](std::size_t c) {
      turned[c] = inHexOrder(mesh.cells[c], std::size_t{kReversed});
    });
  }
  const std::span<const Hex> cells = turned.empty() ? std::span<const Hex>(mesh.cells) : turned;
  OvmOutput output{mesh.points, buildOvmTopology(mesh.points.size(), cells, stage), {}};
  setCornerOrder(output, cells, !turned.empty(), stage);
  setGenerators(output, mesh, stage);
  if (map != nullptr) setGeneratorIndices(output, mesh, *map, stage);
  setOvmVertexTags(output, mesh.features.vertices);
  setOvmEdgeTags(output, mesh.features.edges);
  if (!mesh.features.quads.empty()) {
    setOvmFaceTags(output, mesh.features.quads, OvmLoops<4>(output.topology, stage));
  }
  setOvmRegions(output, mesh.regions);
  return output;
}

}  // namespace hexhex
