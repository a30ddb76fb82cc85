#include <algorithm>
#include <cassert>

#include <base/disjoint_sets.hpp>
#include <improve/neighbourhoods.hpp>

namespace hexhex::improvement {

namespace {

/// Lists with at least this part of all indices are long: sorting them takes longer than looking at
/// all marks.
constexpr std::size_t kMany = 16;

/// Sorts the indices that are marked, each of which is listed once, and clears the marks.
void sortMarked(std::vector<Index>& list, std::vector<bool>& marks) {
  if (kMany * list.size() < marks.size()) {
    std::sort(list.begin(), list.end());
    for (const Index i : list) marks[i] = false;
    return;
  }
  list.clear();
  for (Index i = 0; i < marks.size(); ++i) {
    if (marks[i]) list.push_back(i);
  }
  marks.assign(marks.size(), false);
}

bool isBefore(const Positions::OnSurface& at, Index vertex) { return at.vertex < vertex; }

}  // namespace

std::vector<Index> Neighbourhoods::pointsOf(int rings, std::vector<Index>& cells) {
  for (const Index cell : cells) isCell_[cell] = true;
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
        if (!isPoint_[v]) points.push_back(v);
        isPoint_[v] = true;
      }
    }
    for (; pointsDone < points.size(); ++pointsDone) {
      for (const Index cell : mesh_.around(points[pointsDone])) {
        if (!isCell_[cell]) cells.push_back(cell);
        isCell_[cell] = true;
      }
    }
  }
  sortMarked(cells, isCell_);
  sortMarked(points, isPoint_);
  return points;
}

Positions::Positions(const Array<Vec3>& points_, const VertexPlaces& places) : points(points_) {
  for (Index v = 0; v < points.size(); ++v) {
    if (places.simplex[v] != kNone) onSurface.push_back({v, places.simplex[v]});
  }
}

bool Positions::arePresent(const Array<Vec3>& now, const VertexPlaces& places) const {
  return now == points && std::all_of(onSurface.begin(), onSurface.end(), [&](const OnSurface& at) {
           return places.simplex[at.vertex] == at.simplex;
         });
}

SurfacePlace Positions::placeOf(Index vertex) const {
  const auto at = std::lower_bound(onSurface.begin(), onSurface.end(), vertex, isBefore);
  const bool isFound = at != onSurface.end() && at->vertex == vertex;
  return {points[vertex], isFound ? at->simplex : kNone};
}

void Positions::setSimplex(Index vertex, Index simplex) {
  const auto at = std::lower_bound(onSurface.begin(), onSurface.end(), vertex, isBefore);
  assert(at != onSurface.end() && at->vertex == vertex);
  at->simplex = simplex;
}

void Positions::restore(Index vertex, Array<Vec3>& now, VertexPlaces& places) const {
  const SurfacePlace place = placeOf(vertex);
  now[vertex] = place.point;
  places.simplex[vertex] = place.simplex;
}

void Positions::restoreAll(Array<Vec3>& now, VertexPlaces& places) const {
  std::copy(points.begin(), points.end(), now.begin());
  for (const OnSurface& at : onSurface) places.simplex[at.vertex] = at.simplex;
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
    before.restore(v, points, places);
  }
}

}  // namespace hexhex::improvement
