// From a hex mesh to a polyhedral mesh (see ovm_output.hpp).
#include <algorithm>
#include <atomic>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_features.hpp>
#include <io/ovm_first_fault.hpp>
#include <io/ovm_output.hpp>
#include <io/ovm_topology.hpp>
#include <io/simplex_indices.hpp>
#include <io/writable_map.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::size_t kReversed =
    4;  // the order of a cell that begins alike but turns the other way

std::int32_t orderOf(const Hex& listed, const Hex& assembled) {
  std::size_t order = 0;
  while (order < kHexOrders && inHexOrder(assembled, order) != listed) ++order;
  return static_cast<std::int32_t>(order);
}

/// @param cells  those of the mesh as the topology was built from them
void setCornerOrder(OvmOutput& output, const HexMesh& mesh, std::span<const Hex> cells,
                    Stage& stage) {
  Array<std::int32_t> orders(mesh.cells.size());
  std::atomic<bool> any{false};
  const Array<Index>& halfFaces = output.topology.cells.handles;
  parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
    Hex hex = cells[c];
    // Half-face 2f + 1 begins where another cell does.
    if (halfFaces[6 * c] % 2 != 0) {
      std::array<std::array<Index, 4>, 6> loops;
      for (std::size_t s = 0; s < 6; ++s) {
        const Index halfFace = halfFaces[6 * c + s];
        loops[s] = loopOfHalfFace(loopOfFace<4>(output.topology, halfFace / 2), halfFace);
      }
      static_cast<void>(assembleHex(loops, hex));  // built so that it succeeds
    }
    orders[c] = orderOf(mesh.cells[c], hex);
    if (orders[c] != 0) any.store(true, std::memory_order_relaxed);
  });
  if (any) output.properties[OvmInteger::CornerOrder] = std::move(orders);
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
    parallelFor(stage, turned.size(), kGrain,
                [&](std::size_t c) { turned[c] = inHexOrder(mesh.cells[c], kReversed); });
  }
  const std::span<const Hex> cells = turned.empty() ? std::span<const Hex>(mesh.cells) : turned;
  OvmOutput output{mesh.points, buildOvmTopology(mesh.points.size(), cells, stage), {}};
  setCornerOrder(output, mesh, cells, stage);
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
