#include <algorithm>

#include <adjacency/cell_faces.hpp>

#include <io/medit/vertex_tags.hpp>

namespace hexhex::io {
namespace {

/// References of which a vertex has two neighbours along edges of cells, ascending.
std::vector<std::int32_t> crowdedReferences(const Array<std::int32_t>& references,
                                            const Array<Hex>& cells) {
  Array<Index> neighbours(references.size(), kNone);  // with the same reference; itself: several
  const auto note = [&](Index vertex, Index other) {
    Index& known = neighbours[vertex];
    known = known == kNone || known == other ? other : vertex;
  };
  for (const Hex& cell : cells) {
    for (const auto& edge : adjacency::kHexEdges) {
      const Index a = cell[edge[0]];
      const Index b = cell[edge[1]];
      if (references[a] == 0 || references[a] != references[b]) continue;
      note(a, b);
      note(b, a);
    }
  }
  std::vector<std::int32_t> crowded;
  for (std::size_t v = 0; v < neighbours.size(); ++v) {
    if (neighbours[v] == v) crowded.push_back(references[v]);
  }
  std::sort(crowded.begin(), crowded.end());
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  return crowded;
}

bool allShareOne(const Array<std::int32_t>& references) {
  return std::all_of(references.begin(), references.end(),
                     [&](std::int32_t reference) { return reference == references[0]; });
}

}  // namespace

std::vector<FeatureVertex> vertexTags(std::vector<Index> corners,
                                      const Array<std::int32_t>& references,
                                      const Array<Hex>& cells) {
  std::vector<FeatureVertex> tags;
  if (!corners.empty()) {
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (const Index v : corners) {
      const bool hasReference = !references.empty() && references[v] != 0;
      tags.push_back({v, hasReference ? references[v] : 1});
    }
    return tags;
  }
  if (allShareOne(references)) return tags;
  const std::vector<std::int32_t> crowded = crowdedReferences(references, cells);
  for (std::size_t v = 0; v < references.size(); ++v) {
    const std::int32_t reference = references[v];
    if (reference == 0 || std::binary_search(crowded.begin(), crowded.end(), reference)) continue;
    tags.push_back({static_cast<Index>(v), reference});
  }
  return tags;
}

}  // namespace hexhex::io
