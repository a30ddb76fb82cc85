// E. W. Dijkstra, "A note on two problems in connexion with graphs", Numerische Mathematik 1
// (1959).
#include <functional>
#include <queue>
#include <utility>

#include <shape/triangle_paths.hpp>

namespace hexhex::shape {

TrianglePaths shortestPaths(const Surface& surface, std::span<const Index> starts, double reach,
                            const std::vector<bool>& isBlocked) {
  TrianglePaths paths{std::vector<double>(surface.triangleCount(), reach),
                      std::vector<Side>(surface.triangleCount(), kNone)};
  using Front = std::pair<double, Index>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  for (const Index start : starts) {
    paths.distances[start] = 0;
    fronts.emplace(0, start);
  }
  while (!fronts.empty()) {
    const auto [reached, t] = fronts.top();
    fronts.pop();
    if (reached > paths.distances[t]) continue;
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      const Index beyond = surface.beyond(side);
      if (!isBlocked.empty() && isBlocked[beyond]) continue;
      const double farther = reached + distanceBetween(surface, t, beyond);
      if (farther >= paths.distances[beyond]) continue;
      paths.distances[beyond] = farther;
      paths.entries[beyond] = surface.twins[side];
      fronts.emplace(farther, beyond);
    }
  }
  return paths;
}

}  // namespace hexhex::shape
