#include <algorithm>

#include <base/disjoint_sets.hpp>
#include <improve/neighbourhoods.hpp>

namespace hexhex::improvement {

std::vector<Index> Neighbourhoods::pointsOf(int rings, std::vector<Index>& cells) {
  for (const Index cell : cells) isCell_[cell] = 1;
  std::vector<Index> points;
  std::size_t cellsDone = 0;
  std::size_t pointsDone = 0;
  for (int ring = 0; ring <= rings; ++ring) {
    for (; cellsDone < cells.size(); ++cellsDone) {
      for (const Index v : mesh_.of(cells[cellsDone])) {
        if (isPoint_[v] == 0) points.push_back(v);
        isPoint_[v] = 1;
      }
    }
    for (; pointsDone < points.size(); ++pointsDone) {
      for (const Index cell : mesh_.around(points[pointsDone])) {
        if (isCell_[cell] == 0) cells.push_back(cell);
        isCell_[cell] = 1;
      }
    }
  }
  for (const Index cell : cells) isCell_[cell] = 0;
  for (const Index v : points) isPoint_[v] = 0;
  return points;
}

void putBack(const CellPoints& mesh, std::span<const Index> cells, const Positions& before,
             Array<Vec3>& points, VertexPlaces& places) {
  DisjointSets sets(points.size());
  const auto isMoved = [&](Index v) { return points[v] != before.points[v]; };
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    Index first = kNone;
    for (const Index v : mesh.of(c)) {
      if (!isMoved(v)) continue;
      if (first != kNone) sets.unite(first, v);
      first = v;
    }
  }
  std::vector<Index> back;
  for (const Index cell : cells) {
    for (const Index v : mesh.of(cell)) {
      if (isMoved(v)) back.push_back(sets.find(v));
    }
  }
  std::sort(back.begin(), back.end());
  for (Index v = 0; v < points.size(); ++v) {
    if (!isMoved(v) || !std::binary_search(back.begin(), back.end(), sets.find(v))) continue;
    points[v] = before.points[v];
    places.simplex[v] = before.simplices[v];
  }
}

}  // namespace hexhex::improvement
