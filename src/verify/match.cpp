#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>
#include <verify/match.hpp>

#include <base/parallel.hpp>
#include <lattice/cell_corners.hpp>

namespace hexhex::verification {

namespace {

constexpr std::size_t kMatchGrain = 4096;

/// Points in the cells of a grid so fine that cells hardly ever hold two, as lists behind a hash
/// table.
class PointFinder {
 public:
  PointFinder(const Array<Vec3>& points, double tolerance, Stage& stage)
      : points_(points), tolerance_(tolerance), spacing_(tolerance > 0 ? 16 * tolerance : 1) {
    buckets_ = adjacency::VertexLists<Index>(
        std::max<std::size_t>(points.size(), 1), stage, [&](const auto& add) {
          parallelFor(stage, points.size(), kMatchGrain, [&](std::size_t v) {
            add(bucketOf(gridCell(points[v], {})), static_cast<Index>(v));
          });
        });
  }

  /// The first of the nearest points within the tolerance along each axis, or kNone.
  [[nodiscard]] Index nearest(const Vec3& p) const {
    Index best = kNone;
    double least = tolerance_;
    std::array<std::size_t, 8> seen{};
    for (unsigned i = 0; i < 8; ++i) {
      Vec3 shift;
      for (std::size_t k = 0; k < 3; ++k) shift[k] = (i >> k & 1U) != 0 ? tolerance_ : -tolerance_;
      seen[i] = bucketOf(gridCell(p, shift));
      if (std::find(seen.begin(), seen.begin() + i, seen[i]) != seen.begin() + i) continue;
      for (const Index v : buckets_(seen[i])) {
        const Vec3& q = points_[v];
        const double dx = std::abs(q[0] - p[0]);
        const double dy = std::abs(q[1] - p[1]);
        const double dz = std::abs(q[2] - p[2]);
        if (!(dx <= least && dy <= least && dz <= least)) continue;  // nor if not a number
        const double distance = std::max({dx, dy, dz});
        if (distance == least && v > best) continue;
        best = v;
        least = distance;
        if (distance == 0) break;  // lists are ascending
      }
    }
    return best;
  }

 private:
  [[nodiscard]] std::array<std::int64_t, 3> gridCell(const Vec3& p, const Vec3& shift) const {
    std::array<std::int64_t, 3> cell;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = std::floor((p[k] + shift[k]) / spacing_);
      cell[k] = std::abs(x) < 0x1p62 ? static_cast<std::int64_t>(x) : 0;
    }
    return cell;
  }
  [[nodiscard]] Index bucketOf(const std::array<std::int64_t, 3>& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t x : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 29U;
    }
    return static_cast<Index>(hash % std::max<std::size_t>(points_.size(), 1));
  }

  const Array<Vec3>& points_;
  double tolerance_;
  double spacing_;
  adjacency::VertexLists<Index> buckets_;
};

/// The three rotations of a cell that start at each corner, as orders of corners.
constexpr auto kOrders = [] {
  std::array<std::array<std::array<std::uint8_t, 8>, 3>, 8> orders{};
  std::array<std::size_t, 8> count{};
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    std::array<std::uint8_t, 8> order{};
    for (std::uint8_t c = 0; c < 8; ++c) order[lattice::turnedCorner(lattice::Rotation(r), c)] = c;
    orders[order[0]][count[order[0]]++] = order;
  }
  return orders;
}();

/// A cell rotated so that the place numbers of its corners are lexicographically smallest.
struct TurnedCell {
  Hex vertices;
  Hex places;
};

TurnedCell turnedFirst(const Hex& cell, const Array<Index>& placeOf) {
  Hex places;
  for (std::size_t c = 0; c < 8; ++c) places[c] = placeOf[cell[c]];
  const Index least = *std::min_element(places.begin(), places.end());
  TurnedCell best{};
  bool any = false;
  for (std::size_t first = 0; first < 8; ++first) {
    if (places[first] != least) continue;
    for (const std::array<std::uint8_t, 8>& order : kOrders[first]) {
      TurnedCell turned;
      for (std::size_t c = 0; c < 8; ++c) {
        turned.vertices[c] = cell[order[c]];
        turned.places[c] = places[order[c]];
      }
      if (!any || turned.places < best.places) best = turned;
      any = true;
    }
  }
  return best;
}

void lowerTo(Index value, Index& least) {
  const std::atomic_ref atomic(least);
  Index known = atomic.load(std::memory_order_relaxed);
  while (value < known && !atomic.compare_exchange_weak(known, value)) {
  }
}

template <class T>
void fill(Array<T>& array, std::size_t size, T value) {
  array.resize(size);
  std::fill(array.begin(), array.end(), value);
}

template <class IsOdd>
Odd countOdd(std::size_t n, const IsOdd& isOdd) {
  Odd odd;
  for (std::size_t i = 0; i < n; ++i) {
    if (isOdd(i) && odd.count++ == 0) odd.first = i;
  }
  return odd;
}

class Matching {
 public:
  Matching(const HexMesh& right, const HexMesh& found, double tolerance, Stage& stage)
      : right_(right), found_(found), stage_(stage) {
    const PointFinder finder(right.points, tolerance, stage);
    rightPlaces_ = placesOf(right.points, finder);
    foundPlaces_ = placesOf(found.points, finder);
    matchCells();
    matchVertices();
  }

  [[nodiscard]] Mismatch result() const {
    Mismatch result;
    result.strangeVertices =
        countOdd(found_.points.size(), [&](std::size_t v) { return foundPlaces_[v] == kNone; });
    result.gluedVertices =
        countOdd(found_.points.size(), [&](std::size_t v) { return isGlued_[v] != 0; });
    result.splitVertices =
        countOdd(found_.points.size(), [&](std::size_t v) { return isSplit_[v] != 0; });
    std::vector<bool> used(found_.points.size());
    for (const Hex& cell : found_.cells) {
      for (const Index v : cell) used[v] = true;
    }
    result.unusedVertices = countOdd(found_.points.size(), [&](std::size_t v) { return !used[v]; });
    result.strangeCells = countOdd(found_.cells.size(), [&](std::size_t c) {
      return cells_[c] == kNone || finders_[cells_[c]] != c;
    });
    result.missingCells =
        countOdd(right_.cells.size(), [&](std::size_t c) { return finders_[c] == kNone; });
    return result;
  }

 private:
  /// For each point, the first vertex of the right mesh at its place, or kNone.
  [[nodiscard]] Array<Index> placesOf(const Array<Vec3>& points, const PointFinder& finder) const {
    Array<Index> places(points.size());
    parallelFor(stage_, points.size(), kMatchGrain,
                [&](std::size_t v) { places[v] = finder.nearest(points[v]); });
    return places;
  }

  /// Calls accept(cell) for the cells of the right mesh whose corners are at the same places, until
  /// one is accepted.
  template <class Accept>
  void forEachCandidate(std::size_t cell, const Accept& accept) const {
    for (const Index v : found_.cells[cell]) {
      if (foundPlaces_[v] == kNone) return;
    }
    const TurnedCell turned = turnedFirst(found_.cells[cell], foundPlaces_);
    for (const Index right : byFirstPlace_(turned.places[0])) {
      if (turnedFirst(right_.cells[right], rightPlaces_).places == turned.places && accept(right)) {
        return;
      }
    }
  }

  /// Calls visit(found, right) for the vertices of a matched cell.
  template <class Visit>
  void forEachCorner(std::size_t cell, const Visit& visit) const {
    if (cells_[cell] == kNone) return;
    const Hex found = turnedFirst(found_.cells[cell], foundPlaces_).vertices;
    const Hex right = turnedFirst(right_.cells[cells_[cell]], rightPlaces_).vertices;
    for (std::size_t i = 0; i < 8; ++i) visit(found[i], right[i]);
  }

  void matchCells() {
    byFirstPlace_ = adjacency::VertexLists<Index>(
        std::max<std::size_t>(right_.points.size(), 1), stage_, [&](const auto& add) {
          parallelFor(stage_, right_.cells.size(), kMatchGrain, [&](std::size_t c) {
            add(turnedFirst(right_.cells[c], rightPlaces_).places[0], static_cast<Index>(c));
          });
        });
    fill(finders_, right_.cells.size(), kNone);
    fill(cells_, found_.cells.size(), kNone);
    std::atomic<bool> areContested{false};
    parallelFor(stage_, found_.cells.size(), kMatchGrain, [&](std::size_t c) {
      Index only = kNone;
      bool isContested = false;
      forEachCandidate(c, [&](Index right) {
        isContested = only != kNone;
        only = right;
        return isContested;
      });
      if (isContested) areContested = true;
      if (only == kNone || isContested) return;
      cells_[c] = only;
      lowerTo(static_cast<Index>(c), finders_[only]);
    });
    if (areContested) matchContestedCells();
  }

  /// Where several cells share one place, e.g. in components that lie inside each other, cells
  /// match if their neighbours do: matches spread from matched cells to their neighbours.
  void matchContestedCells() {
    const adjacency::VertexCells around = adjacency::cellsAroundVertices(found_, stage_);
    Array<Index> rightOf;
    fill(rightOf, found_.points.size(), kNone);
    std::vector<Index> settled;
    const auto settle = [&](Index cell) {
      settled.push_back(cell);
      forEachCorner(cell, [&](Index found, Index right) { rightOf[found] = right; });
    };
    const auto match = [&](Index cell) {
      if (cells_[cell] != kNone) return;
      forEachCandidate(cell, [&](Index right) {
        if (finders_[right] != kNone) return false;
        cells_[cell] = right;
        bool agrees = true;
        forEachCorner(cell, [&](Index v, Index w) {
          agrees = agrees && (rightOf[v] == kNone || rightOf[v] == w);
        });
        if (agrees) {
          finders_[right] = cell;
          settle(cell);
        } else {
          cells_[cell] = kNone;
        }
        return agrees;
      });
    };
    for (Index c = 0; c < cells_.size(); ++c) {
      if (cells_[c] != kNone) settle(c);
    }
    for (Index start = 0; start < cells_.size(); ++start) {
      while (!settled.empty()) {
        const Index cell = settled.back();
        settled.pop_back();
        for (const Index v : found_.cells[cell]) {
          for (const Index neighbour : around(v)) match(neighbour);
        }
      }
      match(start);
    }
  }

  /// Vertices match if they are corners of matching cells.
  void matchVertices() {
    const auto forAllCorners = [this](const auto& visit) {
      parallelFor(stage_, found_.cells.size(), kMatchGrain,
                  [&](std::size_t c) { forEachCorner(c, visit); });
    };
    Array<Index> rightOf;
    Array<Index> foundOf;
    fill(rightOf, found_.points.size(), kNone);
    fill(foundOf, right_.points.size(), kNone);
    forAllCorners([&](Index found, Index right) {
      lowerTo(right, rightOf[found]);
      lowerTo(found, foundOf[right]);
    });
    fill(isGlued_, found_.points.size(), std::uint8_t{0});
    fill(isSplit_, found_.points.size(), std::uint8_t{0});
    const auto mark = [](std::uint8_t& flag) {
      std::atomic_ref(flag).store(1, std::memory_order_relaxed);
    };
    forAllCorners([&](Index found, Index right) {
      if (rightOf[found] != right) mark(isGlued_[found]);
      if (foundOf[right] != found) mark(isSplit_[found]);
    });
  }

  const HexMesh& right_;
  const HexMesh& found_;
  Stage& stage_;
  Array<Index> rightPlaces_;  ///< per vertex: the first vertex of the right mesh at its place
  Array<Index> foundPlaces_;  ///< the same, or kNone
  adjacency::VertexLists<Index> byFirstPlace_;  ///< cells of the right mesh, by their first place
  Array<Index> cells_;                          ///< per cell found: the matching cell, or kNone
  Array<Index> finders_;  ///< per cell of the right mesh: the first cell that matches it, or kNone
  Array<std::uint8_t> isGlued_;
  Array<std::uint8_t> isSplit_;
};

}  // namespace

Mismatch matchMeshes(const HexMesh& right, const HexMesh& found, double tolerance, Stage& stage) {
  return Matching(right, found, tolerance, stage).result();
}

}  // namespace hexhex::verification
