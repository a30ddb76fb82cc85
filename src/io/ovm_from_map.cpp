// From a map to a polyhedral mesh (see ovm_output.hpp).
#include <algorithm>
#include <atomic>
#include <cmath>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_features.hpp>
#include <io/ovm_first_fault.hpp>
#include <io/ovm_output.hpp>
#include <io/ovm_topology.hpp>
#include <io/writable_map.hpp>

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

/// How the corners of a tet were listed, which a reader finds in order of `assembled`.
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

void setCornerOrder(OvmOutput& output, const TetMap& map, const OvmLoops<3>& loops, Stage& stage) {
  Array<std::int32_t> orders(map.tets.size());
  std::atomic<bool> any{false};
  parallelFor(stage, map.tets.size(), kGrain, [&](std::size_t t) {
    std::array<std::array<Index, 3>, 4> cell;
    for (std::size_t s = 0; s < 4; ++s) {
      cell[s] = loops.ofHalfFace(output.topology.cells.handles[4 * t + s]);
    }
    OvmTet tet;
    static_cast<void>(assembleTet(cell, tet));  // built so that it succeeds
    orders[t] = orderOf(map.tets[t], tet.corners);
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
  const OvmEdgeFinder finder(output.topology);
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
  const OvmLoops<3> loops(output.topology, stage);
  setCornerOrder(output, map, loops, stage);
  setHalfFaceValues(output, map, exchanged, stage);
  setEdgeValences(output, map);
  setOvmVertexTags(output, map.features.vertices);
  setOvmEdgeTags(output, map.features.edges);
  setOvmFaceTags(output, map.features.faces, loops);
  setOvmRegions(output, map.regions);
  return output;
}

}  // namespace hexhex
