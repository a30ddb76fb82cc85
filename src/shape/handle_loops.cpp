// J. Erickson, K. Whittlesey, "Greedy optimal homotopy and homology generators" (2005): the
// shortest loop through a root, of those that are independent of others, is an edge and two paths
// of the tree of shortest paths.
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include <shape/handle_loops.hpp>
#include <shape/label_costs.hpp>

#include <base/sorted.hpp>

namespace hexhex::shape {
namespace {

using tetmap::pairOf;
using tetmap::VertexPair;

/// Lengths of sides are small where the surface faces one way.
std::vector<double> lengthsFor(const Surface& surface, lattice::Direction up) {
  constexpr double kLeast = 0.1;
  std::vector<double> lengths;
  lengths.reserve(surface.tails.size());
  for (Side side = 0; side < surface.tails.size(); ++side) {
    const double cosines = cosine(surface.normals[Surface::triangleOf(side)], up) +
                           cosine(surface.normals[surface.beyond(side)], up);
    lengths.push_back(surface.lengths[side] * (1 + kLeast - 0.5 * cosines));
  }
  return lengths;
}

/// Shortest paths from some vertices (Dijkstra).
struct Paths {
  std::vector<double> length;  ///< per vertex
  std::vector<Side> last;      ///< per vertex: the side that leads to it, or kNone
  std::vector<Index> order;    ///< the vertices that were reached, the nearest first
};

/// Loops and paths, as sides, that have no vertex of earlier ones inside.
class PathSearch {
 public:
  PathSearch(const Surface& surface, const std::vector<Side>& sideAt, lattice::Direction up)
      : surface_(surface),
        sideAt_(sideAt),
        lengths_(lengthsFor(surface, up)),
        isUsed_(surface.pointCount),
        found_{std::vector<double>(surface.pointCount, kInfinity),
               std::vector<Side>(surface.pointCount, kNone),
               {}},
        classTo_(surface.pointCount) {}

  /// The shortest loop that is independent of others, of those through some of the vertices.
  [[nodiscard]] std::vector<Side> loop(const std::vector<Index>& vertices,
                                       const std::vector<HomologyClass>& classes,
                                       const ClassBasis& others) {
    constexpr std::size_t kVisits = 50'000;  // over all roots
    const std::size_t step = 1 + vertices.size() * vertices.size() / kVisits;
    std::vector<bool> isReached(surface_.pointCount);
    std::vector<Side> best;
    double least = kInfinity;
    std::size_t next = 0;  // that is a root, though it was reached
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (isUsed_[vertices[i]] || (i < next && isReached[vertices[i]])) continue;
      search({vertices[i]});
      for (const Index v : found_.order) isReached[v] = true;
      improve(classes, others, best, least);
      next = i + step;
    }
    return best;
  }

  /// The shortest path from used vertices to one of others.
  [[nodiscard]] std::vector<Side> path(const std::vector<Index>& from) {
    search(from);
    for (const Index v : found_.order) {
      if (isUsed_[v] && found_.last[v] != kNone) return sidesTo(v);
    }
    return {};
  }

  void use(const std::vector<Side>& sides) {
    for (const Side side : sides) {
      isUsed_[surface_.tails[side]] = isUsed_[surface_.head(side)] = true;
    }
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// Paths end at used vertices.
  void search(const std::vector<Index>& from) {
    for (const Index v : found_.order) {
      found_.length[v] = kInfinity;
      found_.last[v] = kNone;
    }
    found_.order.clear();
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : from) {
      found_.length[v] = 0;
      queue.emplace(0, v);
    }
    while (!queue.empty()) {
      const auto [length, v] = queue.top();
      queue.pop();
      if (length > found_.length[v]) continue;
      found_.order.push_back(v);
      if (isUsed_[v] && found_.last[v] != kNone) continue;
      surface_.forEachSideAround(sideAt_[v], [&, length = length](Side side) {
        const Index w = surface_.head(side);
        const double there = length + lengths_[side];
        if (there >= found_.length[w]) return;
        found_.length[w] = there;
        found_.last[w] = side;
        queue.emplace(there, w);
      });
    }
  }

  [[nodiscard]] std::vector<Side> sidesTo(Index vertex) const {
    std::vector<Side> sides;
    while (found_.last[vertex] != kNone) {
      sides.push_back(found_.last[vertex]);
      vertex = surface_.tails[sides.back()];
    }
    return sides;
  }

  void improve(const std::vector<HomologyClass>& classes, const ClassBasis& others,
               std::vector<Side>& best, double& least) {
    for (const Index v : found_.order) {
      const Side last = found_.last[v];
      classTo_[v] =
          last == kNone ? HomologyClass() : sumOf(classTo_[surface_.tails[last]], classes[last]);
    }
    for (const Index v : found_.order) {
      if (isUsed_[v]) continue;
      surface_.forEachSideAround(sideAt_[v], [&](Side side) {
        const Index w = surface_.head(side);
        const double length = found_.length[v] + lengths_[side] + found_.length[w];
        if (w < v || isUsed_[w] || length >= least) return;
        if (others.reduced(sumOf(sumOf(classTo_[v], classes[side]), classTo_[w])).empty()) return;
        least = length;
        best = loopOf(side);
      });
    }
  }

  /// Without what the paths to both ends have in common.
  [[nodiscard]] std::vector<Side> loopOf(Side side) const {
    std::vector<Side> loop = sidesTo(surface_.tails[side]);
    std::vector<Side> rest = sidesTo(surface_.head(side));
    while (!loop.empty() && !rest.empty() && loop.back() == rest.back()) {
      loop.pop_back();
      rest.pop_back();
    }
    loop.push_back(side);
    loop.insert(loop.end(), rest.begin(), rest.end());
    return loop;
  }

  const Surface& surface_;
  const std::vector<Side>& sideAt_;     ///< per vertex
  std::vector<double> lengths_;         ///< per side
  std::vector<bool> isUsed_;            ///< per vertex
  Paths found_;                         ///< by the last search
  std::vector<HomologyClass> classTo_;  ///< per vertex: of the path to it
};

/// Columns of the wall around a vertex: the edges that are split before one beside them, as the
/// longest are first.
int columnsAround(const Surface& surface, Side first) {
  const auto key = [&surface](Side side) {
    return std::pair(-surface.lengths[side], pairOf(surface.tails[side], surface.head(side)));
  };
  int count = 0;
  surface.forEachSideAround(first, [&](Side side) {
    const Side before = Surface::next(Surface::next(side));
    const Side after = Surface::next(surface.twins[side]);
    if (key(side) < key(before) || key(side) < key(after)) ++count;
  });
  return count;
}

HomologyClass sumAlong(const std::vector<Side>& sides, const std::vector<HomologyClass>& classes) {
  HomologyClass sum;
  for (const Side side : sides) sum = sumOf(sum, classes[side]);
  return sum;
}

/// Connects loops, and adds all to a graph.
/// @return false if there is no room for a path
bool join(const Surface& surface, std::vector<std::vector<Side>> loops, PathSearch& search,
          LoopGraph& graph) {
  std::vector<Index> joined;
  const auto add = [&](const std::vector<Side>& sides) {
    search.use(sides);
    for (const Side side : sides) {
      const VertexPair edge = pairOf(surface.tails[side], surface.head(side));
      graph.edges.push_back(edge);
      for (const Index v : edge) {
        graph.has[v] = true;
        joined.push_back(v);
      }
    }
  };
  add(loops.back());
  loops.pop_back();
  while (!loops.empty()) {
    const std::vector<Side> path = search.path(joined);
    if (path.empty()) return false;
    const Index end = surface.head(path.front());
    const auto reached = std::find_if(loops.begin(), loops.end(), [&](const auto& loop) {
      return std::any_of(loop.begin(), loop.end(), [&](Side side) {
        return surface.tails[side] == end || surface.head(side) == end;
      });
    });
    add(path);
    add(*reached);
    loops.erase(reached);
  }
  return true;
}

}  // namespace

HandleLoops::HandleLoops(const std::vector<Tet>& tets, const Surface& surface,
                         const std::vector<Vec3>& points, Stage& stage)
    : surface_(surface), points_(points), sideAt_(surface.sidesAt()) {
  const EdgeClasses classes(tets, points.size(), stage);
  classes_.reserve(surface.tails.size());
  for (Side side = 0; side < surface.tails.size(); ++side) {
    classes_.push_back(classes(surface.tails[side], surface.head(side)));
  }
  std::vector<Index> valences(surface.pointCount);
  for (const Index v : surface.tails) ++valences[v];
  const std::vector<Index> componentOf = surface.components();
  std::map<Index, Component> components;
  for (Index v = 0; v < valences.size(); ++v) {
    if (valences[v] > 0) components[componentOf[v]].vertices.push_back(v);
  }
  components_.reserve(components.size());
  for (auto& [first, each] : components) {
    std::size_t sides = 0;
    for (const Index v : each.vertices) sides += valences[v];
    // V - E + F = 2 - 2 handles, and two triangles have three edges.
    each.handles = (2 + sides / 6 - each.vertices.size()) / 2;
    components_.push_back(std::move(each));
  }
}

Index HandleLoops::tip(const Component& component, lattice::Direction up) const {
  const auto heightOf = [&](Index v) {
    return lattice::signOf(up) * points_[v][static_cast<std::size_t>(lattice::axisOf(up))];
  };
  Index best = kNone;
  for (const Index v : component.vertices) {
    if (best != kNone && heightOf(v) <= heightOf(best)) continue;
    double facing = 0;  // of the ceiling of a void, it is negative
    surface_.forEachSideAround(sideAt_[v], [&](Side side) {
      facing += cosine(surface_.normals[Surface::triangleOf(side)], up);
    });
    if (facing > 0 && columnsAround(surface_, sideAt_[v]) >= kLeastColumns) best = v;
  }
  return best;
}

std::optional<LoopGraph> HandleLoops::graph(lattice::Direction up, Stage& stage) const {
  LoopGraph graph{std::vector<bool>(surface_.pointCount), {}};
  PathSearch search(surface_, sideAt_, up);
  ClassBasis basis;
  for (const Component& component : components_) {
    std::vector<std::vector<Side>> loops;
    while (loops.size() < component.handles) {
      stage.context().throwIfCancelled();
      loops.push_back(search.loop(component.vertices, classes_, basis));
      if (loops.back().empty()) return std::nullopt;
      basis.add(sumAlong(loops.back(), classes_));
      search.use(loops.back());
    }
    if (loops.empty()) {
      const Index vertex = tip(component, up);
      if (vertex == kNone) return std::nullopt;
      graph.has[vertex] = true;
    } else if (!join(surface_, std::move(loops), search, graph)) {
      return std::nullopt;
    }
  }
  sortUnique(graph.edges);
  return graph;
}

}  // namespace hexhex::shape
