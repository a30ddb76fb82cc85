#include <algorithm>
#include <utility>

#include <base/disjoint_sets.hpp>
#include <improve/neighbourhoods.hpp>

namespace hexhex::improvement {

namespace {

/// Lists with at least this part of all indices are long: sorting them takes longer than looking at
/// all marks.
constexpr std::size_t kMany = 16;

/// Sorts the indices that are marked, each of which is listed once, and clears the marks.
void sortMarked(std::vector<Index>& list, std::vector<std::uint8_t>& marks) {
  if (kMany * list.size() < marks.size()) {
    std::sort(list.begin(), list.end());
    for (const Index i : list) marks[i] = 0;
    return;
  }
  list.clear();
  for (Index i = 0; i < marks.size(); ++i) {
    if (std::exchange(marks[i], 0) != 0) list.push_back(i);
  }
}

}  // namespace

std::vector<Index> Neighbourhoods::pointsOf(int rings, std::vector<Index>& cells) {
  for (const Index cell : cells) isCell_[cell] = 1;
  std::vector<Index> points;
  if (kMany * cells.size() >= isCell_.size()) {  // lists that grow would be there twice
    points.reserve(isPoint_.size());
    cells.reserve(isCell_.size());
  }
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
  sortMarked(cells, isCell_);
  sortMarked(points, isPoint_);
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
