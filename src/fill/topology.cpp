#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <fill/topology.hpp>

#include <base/disjoint_sets.hpp>
#include <base/sorted.hpp>

namespace hexhex::fill {

Topology topologyOf(const TriangleMesh& surface) {
  DisjointSets sets(surface.points.size());
  std::vector<bool> isUsed(surface.points.size(), false);
  std::vector<std::pair<Index, Index>> edges;
  for (const std::array<Index, 3>& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      isUsed[triangle[i]] = true;
      edges.emplace_back(std::minmax(triangle[i], triangle[(i + 1) % 3]));
      sets.unite(triangle[i], triangle[(i + 1) % 3]);
    }
  }
  sortUnique(edges);
  const auto count = [](auto number) { return static_cast<std::int64_t>(number); };
  const auto used = count(std::count(isUsed.begin(), isUsed.end(), true));
  return {sets.count() - static_cast<std::uint64_t>(count(isUsed.size()) - used),
          used - count(edges.size()) + count(surface.triangles.size())};
}

}  // namespace hexhex::fill
