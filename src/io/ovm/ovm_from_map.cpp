// From a map to a polyhedral mesh (see ovm_output.hpp).
#include <algorithm>
#include <atomic>
#include <cmath>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <io/core/writable.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_features.hpp>
#include <io/ovm/ovm_output.hpp>
#include <io/ovm/ovm_topology.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 4096;

/// How corners are exchanged where most tets are inside out.
constexpr std::array<std::uint8_t, 4> kAsListed = {0, 1, 2, 3};
constexpr std::array<std::uint8_t, 4> kTurned = {0, 2, 1, 3};

bool isMostlyNegative(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage) {
  std::atomic<std::int64_t> balance{0};
  parallelBlocks(stage, tets.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::int64_t local = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     const Tet& tet = tets[t];
                     const Vec3& origin = points[tet[0]];
                     const double volume =
                         tripleProduct(minus(points[tet[3]], origin), minus(points[tet[1]], origin),
                                       minus(points[tet[2]], origin));
                     local += volume > 0 ? 1 : (volume < 0 ? -1 : 0);
                   }
                   balance.fetch_add(local, std::memory_order_relaxed);
                 });
  return balance.load() < 0;
}

using Exchange = std::array<std::uint8_t, 4>;

const Exchange& exchangeFor(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage) {
  return isMostlyNegative(points, tets, stage) ? kTurned : kAsListed;
}

OvmTopology topologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                       const Exchange& exchanged, Stage& stage) {
  Array<Tet> turned(tets.size());
  parallelFor(stage, tets.size(), kGrain, [&](std::size_t t) {
    for (std::size_t i = 0; i < 4; ++i) turned[t][i] = tets[t][exchanged[i]];
  });
  return buildOvmTopology(points.size(), turned, stage);
}

/// How the corners of a tet were listed, which a reader finds in the order of `assembled`.
std::int32_t orderOf(const Tet& listed, const Tet& assembled) {
  const auto* const found = std::find_if(kTetOrders.begin(), kTetOrders.end(),
                                         [&](const std::array<std::uint8_t, 4>& order) {
                                           for (std::size_t i = 0; i < 4; ++i) {
                                             if (listed[i] != assembled[order[i]]) return false;
                                           }
                                           return true;
                                         });
  return static_cast<std::int32_t>(found - kTetOrders.begin());
}

void setCornerOrder(OvmOutput& output, const TetMap& map, const Exchange& exchanged, Stage& stage) {
  // Tets begin with their first half-face, and nearly all of those begin where the tet does.
  const auto usual = static_cast<std::int32_t>(
      std::find(kTetOrders.begin(), kTetOrders.end(), exchanged) - kTetOrders.begin());
  const auto orderAt = [&](std::size_t t) {
    const Index first = output.topology.cells.handles[4 * t];
    if (first % 2 == 0) return usual;
    const std::array<Index, 3> loop =
        loopOfHalfFace(loopOfFace<3>(output.topology, first / 2), first);
    return orderOf(map.tets[t], {loop[0], loop[1], loop[2], map.tets[t][exchanged[3]]});
  };
  Array<std::int32_t> orders(map.tets.size());
  std::atomic<bool> any{false};
  parallelFor(stage, map.tets.size(), kGrain, [&](std::size_t t) {
    orders[t] = orderAt(t);
    if (orders[t] != 0) any.store(true, std::memory_order_relaxed);
  });
  if (any) output.properties[OvmInteger::CornerOrder] = std::move(orders);
}

/// Parameters and rotations, which half-faces carry for the corners opposite them.
void setHalfFaceValues(OvmOutput& output, const TetMap& map, const Exchange& exchanged,
                       Stage& stage) {
  Array<Vec3>& parameters = output.properties.parametrization;
  parameters.resize(2 * output.topology.faces.size());
  Array<std::int32_t>& rotations = output.properties[OvmInteger::Transition];
  if (!map.rotations.empty()) rotations.resize(parameters.size());
  // The half-faces at the boundary have no cell; all others are overwritten.
  parallelFor(stage, parameters.size(), kGrain, [&](std::size_t h) { parameters[h] = {}; });
  std::fill(rotations.begin(), rotations.end(), -1);
  parallelFor(stage, map.tets.size(), kGrain, [&](std::size_t t) {
    for (std::size_t s = 0; s < 4; ++s) {
      const Index halfFace = output.topology.cells.handles[4 * t + s];
      const std::size_t corner = exchanged[kOvmTetOpposite[s]];
      parameters[halfFace] = map.parameters[t][corner];
      if (rotations.empty()) continue;
      const std::int8_t rotation = map.rotations[t][corner];
      rotations[halfFace] = rotation >= 0 && rotation < 24 ? rotation : -1;
    }
  });
}

void setEdgeValences(OvmOutput& output, const TetMap& map) {
  if (map.edgeValences.empty()) return;
  Array<std::int32_t>& offsets = output.properties[OvmInteger::EdgeValence];
  offsets.assign(output.topology.edges.size(), 0);
  const OvmEdgeFinder finder(output.topology.vertexCount, output.topology.edges);
  for (const EdgeValence& edge : map.edgeValences) {
    const Place place{PlaceKind::Edge, edge.vertex0, edge.vertex1};
    setOvmValue(offsets, finder.find(edge.vertex0, edge.vertex1), edge.offset,
                toString(place) + " with a known valence", place);
  }
}

}  // namespace

OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage) {
  return topologyOf(points, tets, exchangeFor(points, tets, stage), stage);
}

OvmOutput toOvm(const TetMap& map, Stage& stage) {
  requireWritable(map, stage);
  const Exchange& exchanged = exchangeFor(map.points, map.tets, stage);
  OvmOutput output{map.points, topologyOf(map.points, map.tets, exchanged, stage), {}};
  setCornerOrder(output, map, exchanged, stage);
  setHalfFaceValues(output, map, exchanged, stage);
  setEdgeValences(output, map);
  setOvmVertexTags(output, map.features.vertices);
  setOvmEdgeTags(output, map.features.edges);
  if (!map.features.faces.empty()) {
    setOvmFaceTags(output, map.features.faces, OvmLoops<3>(output.topology, stage));
  }
  setOvmRegions(output, map.regions);
  return output;
}

}  // namespace hexhex
