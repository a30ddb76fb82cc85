#include <algorithm>
#include <cmath>
#include <numbers>

#include <quantize/bend/edge_turns.hpp>

#include <base/sorted.hpp>

namespace hexhex::quantization {

namespace {

constexpr std::size_t kEdgeTurnsGrain = 256;

double angleSum(std::span<const TetParameters> map, std::span<const adjacency::EdgeCorner> fan) {
  double sum = 0;
  for (const adjacency::EdgeCorner& at : fan)
    sum += dihedralAngle(map[at.tet], at.corner0, at.corner1);
  return sum;
}

int expectedQuarters(const adjacency::TetTopology& topology, const IrregularEdges& expected,
                     Index vertex, std::span<const adjacency::EdgeCorner> fan) {
  const auto found = expected.find({vertex, fan.front().other});
  if (found != expected.end()) return found->second;
  return adjacency::boundaryFacesAt(topology, fan) != 0 ? 2 : 4;
}

}  // namespace

void splitIrregular(const tetmap::VertexPair& edge, Index middle, IrregularEdges& irregular) {
  const auto found = irregular.find({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
  if (found == irregular.end()) return;
  for (const Index end : edge) irregular[{end, middle}] = found->second;
  irregular.erase(found);
}

std::vector<Index> tetsAtOtherTurns(const adjacency::TetTopology& topology,
                                    const IrregularEdges& expected,
                                    std::span<const TetParameters> map, Stage& stage) {
  auto tets = collectFromBlocks<Index>(
      stage, topology.pointCount, kEdgeTurnsGrain,
      [&](std::size_t begin, std::size_t end, auto& list) {
        std::vector<adjacency::EdgeCorner> scratch;
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          adjacency::forEachEdge(
              topology, v, scratch, [&](Index /*w*/, std::span<const adjacency::EdgeCorner> fan) {
                const double quarters = angleSum(map, fan) / (std::numbers::pi / 2);
                if (std::abs(quarters - expectedQuarters(topology, expected, v, fan)) < 0.5) return;
                for (const adjacency::EdgeCorner& at : fan) list.push_back(at.tet);
              });
        }
      });
  sortUnique(tets);
  return tets;
}

}  // namespace hexhex::quantization
