#include <algorithm>
#include <cmath>
#include <numbers>

#include <quantize/edge_turns.hpp>

#include <base/vector3.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 256;

double dihedralAngle(const TetParameters& u, const EdgeCorner& at) {
  const Vec3 axis = minus(u[at.corner1], u[at.corner0]);
  const std::size_t third = at.corner0 != 0 && at.corner1 != 0   ? 0
                            : at.corner0 != 1 && at.corner1 != 1 ? 1
                                                                 : 2;
  const std::size_t fourth = 6 - third - at.corner0 - at.corner1;
  const Vec3 first = cross(axis, minus(u[third], u[at.corner0]));
  const Vec3 second = cross(axis, minus(u[fourth], u[at.corner0]));
  return std::atan2(length(cross(first, second)), dot(first, second));
}

double angleSum(std::span<const TetParameters> parameters, std::span<const EdgeCorner> fan) {
  double sum = 0;
  for (const EdgeCorner& at : fan) sum += dihedralAngle(parameters[at.tet], at);
  return sum;
}

}  // namespace

std::vector<Index> tetsAtOtherTurns(const TetTopology& topology,
                                    std::span<const TetParameters> reference,
                                    std::span<const TetParameters> bent, Stage& stage) {
  auto tets = collectFromBlocks<Index>(
      stage, topology.pointCount, kGrain, [&](std::size_t begin, std::size_t end, auto& list) {
        std::vector<EdgeCorner> scratch;
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          forEachEdge(topology, v, scratch, [&](Index /*w*/, std::span<const EdgeCorner> fan) {
            const double difference = angleSum(bent, fan) - angleSum(reference, fan);
            if (std::abs(difference) < std::numbers::pi / 4) return;
            for (const EdgeCorner& at : fan) list.push_back(at.tet);
          });
        }
      });
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

}  // namespace hexhex
