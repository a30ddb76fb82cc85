#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <base/vector3.hpp>
#include <improve/curve_paths.hpp>
#include <improve/surface_distance.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

namespace {

/// Extra cost, in lengths, of an edge whose end is one edge length off the curve: stairs along a
/// diagonal, a third of an edge off, must be cheaper than two sides of the square.
constexpr double kOffPrice = 4;
/// Paths that cost more than this many times the length of their curve lead elsewhere.
constexpr double kDearest = 4;
/// Minimum length of edges on a curve, relative to their proportional share of it.
constexpr double kShortest = 0.4;
/// Corners are matched with vertices within this many edges of the nearest one.
constexpr int kCornerRings = 2;

/// Maximum number of orders in which to find paths.
constexpr int kOrders = 8;

/// Consecutive points of a curve.
using Chain = std::vector<Index>;

/// Per point of a chain: the length of the chain up to there.
std::vector<double> lengthsAlong(const Chain& chain, const ReferenceSurface& surface) {
  std::vector<double> along(chain.size(), 0);
  for (std::size_t i = 1; i < chain.size(); ++i) {
    along[i] =
        along[i - 1] + length(minus(surface.points()[chain[i]], surface.points()[chain[i - 1]]));
  }
  return along;
}

class ChainFinder {
 public:
  explicit ChainFinder(const ReferenceSurface& surface)
      : surface_(surface), isDone_(surface.segmentCount(), false) {}

  std::vector<Chain> find() {
    std::vector<Chain> chains;
    for (const Index corner : surface_.corners()) {
      for (const Index s : surface_.segmentsAt(corner)) {
        if (!isDone_[s]) add(chainFrom(corner, s), chains);
      }
    }
    for (Index s = 0; s < isDone_.size(); ++s) {
      if (!isDone_[s]) add(chainFrom(surface_.segmentVertices(s)[0], s), chains);
    }
    return chains;
  }

 private:
  Chain chainFrom(Index point, Index segment) {
    const std::span<const Index> corners = surface_.corners();
    Chain chain = {point};
    while (!isDone_[segment]) {
      isDone_[segment] = true;
      const auto& [a, b] = surface_.segmentVertices(segment);
      point = a == point ? b : a;
      chain.push_back(point);
      if (std::binary_search(corners.begin(), corners.end(), point)) break;
      for (const Index next : surface_.segmentsAt(point)) {
        if (!isDone_[next]) segment = next;
      }
    }
    return chain;
  }

  /// Splits a closed chain in three: two paths between the same ends could coincide.
  void add(const Chain& chain, std::vector<Chain>& chains) const {
    if (chain.front() != chain.back()) {
      chains.push_back(chain);
      return;
    }
    const std::vector<double> along = lengthsAlong(chain, surface_);
    auto begin = chain.begin();
    for (int third = 1; third <= 3; ++third) {
      const auto cut = std::lower_bound(along.begin(), along.end(), along.back() * third / 3);
      auto end = third == 3 ? chain.end() - 1 : chain.begin() + (cut - along.begin());
      if (end > begin) chains.emplace_back(begin, end + 1);
      begin = end;
    }
  }

  const ReferenceSurface& surface_;
  std::vector<bool> isDone_;  ///< per segment
};

class PathFinder {
 public:
  PathFinder(const Array<Vec3>& points, std::span<const Quad> quads,
             const ReferenceSurface& surface, Stage& stage)
      : points_(points),
        surface_(surface),
        beside_(adjacency::verticesBeside(quads, points.size(), stage)),
        edgeLength_(meanEdge(points, quads)),
        owner_(points.size(), kNone) {
    for (Index v = 0; v < points.size(); ++v) {
      if (!beside_(v).empty()) boundary_.push_back(v);
    }
  }

  /// Finds paths along short curves first, which have the least choice; then again, starting with
  /// curves without a path. Keeps the order that leaves the fewest without.
  CurvePaths find() {
    std::vector<Chain> chains = ChainFinder(surface_).find();
    matchEnds(chains);
    std::stable_sort(chains.begin(), chains.end(),
                     [this](const Chain& a, const Chain& b) { return lengthOf(a) < lengthOf(b); });
    CurvePaths best;
    for (int round = 0; round < kOrders; ++round) {
      CurvePaths paths;
      std::vector<Chain> missing;
      std::vector<Chain> found;
      const std::vector<Index> owners = owner_;
      for (const Chain& chain : chains) {
        std::optional<CurvePath> path = pathOf(chain);
        (path ? found : missing).push_back(chain);
        if (path) paths.paths.push_back(std::move(*path));
      }
      owner_ = owners;
      isUsed_.clear();
      paths.missing = missing.size();
      if (round == 0 || paths.missing < best.missing) best = std::move(paths);
      if (missing.empty()) break;
      chains = std::move(missing);
      chains.insert(chains.end(), found.begin(), found.end());
    }
    return best;
  }

 private:
  [[nodiscard]] double lengthOf(const Chain& chain) const {
    return lengthsAlong(chain, surface_).back();
  }

  /// Matches ends of chains with vertices, nearest pairs first: each end gets the nearest vertex
  /// that is left and has enough edges.
  void matchEnds(const std::vector<Chain>& chains) {
    std::map<Index, std::size_t> ends;  // number of chains that meet there
    for (const Chain& chain : chains) {
      ++ends[chain.front()];
      ++ends[chain.back()];
    }
    std::vector<std::array<Vec3, 3>> vertices;
    for (const Index v : boundary_) vertices.push_back({points_[v], points_[v], points_[v]});
    const TriangleTree tree(vertices);
    struct Pair {
      double distance;
      Index end;
      Index vertex;
      auto operator<=>(const Pair&) const = default;
    };
    std::vector<Pair> pairs;
    for (const auto& [end, curves] : ends) {
      const Vec3& point = surface_.points()[end];
      std::vector<Index> near = {boundary_[tree.nearest(point).triangle]};
      for (int ring = 0; ring < kCornerRings; ++ring) {
        for (std::size_t i = 0, n = near.size(); i < n; ++i) {
          const std::span<const Index> beside = beside_(near[i]);
          near.insert(near.end(), beside.begin(), beside.end());
        }
      }
      for (const Index v : near) {
        if (beside_(v).size() < curves) continue;
        pairs.push_back({length(minus(points_[v], point)), end, v});
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const Pair& pair : pairs) {
      if (owner_[pair.vertex] != kNone || vertexOf_.contains(pair.end)) continue;
      owner_[pair.vertex] = pair.end;
      vertexOf_[pair.end] = pair.vertex;
    }
  }

  std::optional<CurvePath> pathOf(const Chain& chain) {
    const auto from = vertexOf_.find(chain.front());
    const auto to = vertexOf_.find(chain.back());
    if (from == vertexOf_.end() || to == vertexOf_.end()) return std::nullopt;
    std::vector<std::array<Vec3, 3>> segments;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec3& end = surface_.points()[chain[i]];
      segments.push_back({surface_.points()[chain[i - 1]], end, end});
    }
    const TriangleTree tree(segments);
    CurvePath path;
    path.vertices =
        shortest(from->second, to->second, tree, kDearest * (lengthOf(chain) + edgeLength_));
    if (path.vertices.empty()) return std::nullopt;
    for (const Index v : path.vertices) {
      if (owner_[v] == kNone) owner_[v] = chain.front();
    }
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      isUsed_.insert(ascending(path.vertices[i - 1], path.vertices[i]));
    }
    for (std::size_t i = 1; i < chain.size(); ++i) {
      path.segments.push_back(ascending(chain[i - 1], chain[i]));
    }
    place(chain, tree, path);
    return path;
  }

  /// Dijkstra's algorithm over vertices that no other path uses.
  [[nodiscard]] std::vector<Index> shortest(Index from, Index to, const TriangleTree& curve,
                                            double dearest) const {
    struct Reached {
      double cost;
      Index vertex;
      Index previous;
      auto operator<=>(const Reached&) const = default;
    };
    std::map<Index, Index> previousOf;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    open.push({0, from, kNone});
    while (!open.empty()) {
      const Reached now = open.top();
      open.pop();
      if (now.cost > dearest) break;
      if (!previousOf.emplace(now.vertex, now.previous).second) continue;
      if (now.vertex == to) {
        std::vector<Index> path;
        for (Index v = to; v != kNone; v = previousOf.at(v)) path.push_back(v);
        std::reverse(path.begin(), path.end());
        return path;
      }
      for (const Index next : beside_(now.vertex)) {
        if ((next != to && owner_[next] != kNone) || previousOf.contains(next)) continue;
        if (isUsed_.contains(ascending(now.vertex, next))) continue;
        const double step = length(minus(points_[next], points_[now.vertex]));
        const double off = next == to ? 0 : curve.nearest(points_[next]).distance / edgeLength_;
        open.push({now.cost + step * (1 + kOffPrice * off * off), next, now.vertex});
      }
    }
    return {};
  }

  /// Places vertices at the nearest points of the curve, but in order and apart from each other.
  void place(const Chain& chain, const TriangleTree& tree, CurvePath& path) const {
    const std::vector<double> starts = lengthsAlong(chain, surface_);
    const std::size_t n = path.vertices.size();
    std::vector<double> at(n, 0);
    std::vector<double> steps(n, 0);
    double sum = 0;
    for (std::size_t i = 1; i < n; ++i) {
      steps[i] = length(minus(points_[path.vertices[i]], points_[path.vertices[i - 1]]));
      sum += steps[i];
      const Vec3& point = points_[path.vertices[i]];
      const std::size_t s = tree.nearest(point).triangle;
      const Vec3& begin = surface_.points()[chain[s]];
      const Vec3 nearest =
          nearestOf(std::array<Vec3, 2>{begin, surface_.points()[chain[s + 1]]}, point);
      at[i] = starts[s] + length(minus(nearest, begin));
    }
    const double least = sum > 0 ? kShortest * starts.back() / sum : 0;
    at[n - 1] = starts.back();
    for (std::size_t i = 1; i + 1 < n; ++i) at[i] = std::max(at[i], at[i - 1] + least * steps[i]);
    for (std::size_t i = n - 1; i > 1; --i)
      at[i - 1] = std::min(at[i - 1], at[i] - least * steps[i]);
    for (std::size_t i = 0; i < n; ++i) path.places.push_back(placeAt(chain, starts, at[i]));
    path.places.front().segment = {chain.front(), chain.front()};
    path.places.back().segment = {chain.back(), chain.back()};
  }

  [[nodiscard]] PlaceOnCurve placeAt(const Chain& chain, const std::vector<double>& starts,
                                     double along) const {
    const auto after = std::upper_bound(starts.begin() + 1, starts.end() - 1, along);
    const auto s = static_cast<std::size_t>(after - starts.begin()) - 1;
    const Vec3& begin = surface_.points()[chain[s]];
    const Vec3 step = minus(surface_.points()[chain[s + 1]], begin);
    const double size = starts[s + 1] - starts[s];
    const double share = size > 0 ? std::clamp((along - starts[s]) / size, 0.0, 1.0) : 0;
    return {ascending(chain[s], chain[s + 1]), plus(begin, times(share, step))};
  }

  const Array<Vec3>& points_;
  const ReferenceSurface& surface_;
  adjacency::VertexLists<Index> beside_;  ///< per vertex: its neighbours on the boundary
  double edgeLength_;                     ///< mean length of boundary edges
  std::vector<Index> boundary_;
  std::vector<Index> owner_;         ///< per vertex: an end of the chain that uses it, or kNone
  std::map<Index, Index> vertexOf_;  ///< per end of a chain: its vertex
  std::set<std::array<Index, 2>> isUsed_;
};

}  // namespace

CurvePaths pathsAlongCurves(const Array<Vec3>& points, std::span<const Quad> quads,
                            const ReferenceSurface& surface, Stage& stage) {
  return PathFinder(points, quads, surface, stage).find();
}

}  // namespace hexhex::improvement
