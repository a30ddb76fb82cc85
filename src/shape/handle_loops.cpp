// J. Erickson, K. Whittlesey, "Greedy optimal homotopy and homology generators", SODA 2005: edges
// that neither a tree of triangles nor a tree of vertices crosses close loops around handles.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <shape/handle_loops.hpp>
#include <shape/triangle_paths.hpp>

#include <base/disjoint_sets.hpp>
#include <base/random.hpp>

namespace hexhex::shape {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Limits of the number of triangles to start from, for each loop, and of triangles visited from
/// there: about a tenth of a second.
constexpr double kFewestStarts = 10;
constexpr double kMostStarts = 60;
constexpr double kMostVisits = 3e5;
/// A loop around the solid counts as this many times its length: labels around holes are harder to
/// find.
constexpr double kAroundSolid = 2;

class LoopFinder {
 public:
  LoopFinder(const Surface& surface, std::uint64_t seed)
      : surface_(surface), random_(seed, 7), isCut_(surface.triangleCount()) {}

  /// Finds a short loop and cuts the surface along it.
  /// @return a loop without triangles if no handle is left
  HandleLoop next(Context& context) {
    HandleLoop best;
    double least = kInfinity;
    const auto triangles = static_cast<double>(surface_.triangleCount());
    const double starts = std::clamp(kMostVisits / triangles, kFewestStarts, kMostStarts);
    for (int i = 0; i < starts; ++i) {
      context.throwIfCancelled();
      const auto start = static_cast<Index>(random_.below(surface_.triangleCount()));
      if (isCut_[start]) continue;
      paths_ = shortestPaths(surface_, std::array{start}, kInfinity, isCut_);
      for (const Side side : closingSides()) {
        HandleLoop loop = loopThrough(side);
        const double weight = loop.length * (isAroundHole(loop) ? 1 : kAroundSolid);
        if (weight >= least) continue;
        least = weight;
        best = std::move(loop);
      }
    }
    for (const Index t : best.triangles) isCut_[t] = true;
    return best;
  }

 private:
  /// Returns a side of each edge that closes a loop around a handle: those edges left over by a
  /// spanning tree of the vertices that takes edges of long loops first.
  [[nodiscard]] std::vector<Side> closingSides() const {
    DisjointSets vertices(surface_.pointCount);
    std::vector<std::pair<double, Side>> sides;
    for (Side side = 0; side < surface_.tails.size(); ++side) {
      const Index here = Surface::triangleOf(side);
      const Index beyond = surface_.beyond(side);
      // As if the cuts were filled with disks.
      if (isCut_[here] != isCut_[beyond]) vertices.unite(surface_.tails[side], surface_.head(side));
      if (side > surface_.twins[side] || isCut_[here] || isCut_[beyond]) continue;
      if (paths_.entries[here] == side || paths_.entries[beyond] == surface_.twins[side]) continue;
      const double length = paths_.distances[here] + paths_.distances[beyond] +
                            distanceBetween(surface_, here, beyond);
      if (std::isfinite(length)) sides.emplace_back(-length, side);
    }
    std::sort(sides.begin(), sides.end());
    std::vector<Side> closing;
    for (const auto& [length, side] : sides) {
      const Index tail = vertices.find(surface_.tails[side]);
      const Index head = vertices.find(surface_.head(side));
      if (tail == head) {
        closing.push_back(side);
      } else {
        vertices.unite(tail, head);
      }
    }
    return closing;
  }

  /// The triangles from one to the start, which comes last.
  [[nodiscard]] std::vector<Index> pathFrom(Index triangle) const {
    std::vector<Index> path = {triangle};
    while (paths_.entries[path.back()] != kNone)
      path.push_back(surface_.beyond(paths_.entries[path.back()]));
    return path;
  }

  [[nodiscard]] HandleLoop loopThrough(Side side) const {
    std::vector<Index> here = pathFrom(Surface::triangleOf(side));
    std::vector<Index> beyond = pathFrom(surface_.beyond(side));
    Index meeting = here.back();
    while (!here.empty() && !beyond.empty() && here.back() == beyond.back()) {
      meeting = here.back();
      here.pop_back();
      beyond.pop_back();
    }
    here.push_back(meeting);
    here.insert(here.end(), beyond.rbegin(), beyond.rend());
    return loopOf(std::move(here));
  }

  [[nodiscard]] HandleLoop loopOf(std::vector<Index> triangles) const {
    HandleLoop loop;
    loop.triangles = std::move(triangles);
    Index last = loop.triangles.back();
    const Vec3& origin = surface_.centres[last];
    for (const Index t : loop.triangles) {
      loop.length += distanceBetween(surface_, last, t);
      const Vec3 twice =
          cross(minus(surface_.centres[last], origin), minus(surface_.centres[t], origin));
      loop.area = plus(loop.area, times(0.5, twice));
      last = t;
    }
    return loop;
  }

  /// Whether most of it faces its middle.
  [[nodiscard]] bool isAroundHole(const HandleLoop& loop) const {
    std::vector<Vec3> centres;
    for (const Index t : loop.triangles) centres.push_back(surface_.centres[t]);
    const Vec3 middle = centreOf(centres);
    double sum = 0;
    for (const Index t : loop.triangles) {
      sum += dot(surface_.normals[t], minus(middle, surface_.centres[t]));
    }
    return sum > 0;
  }

  const Surface& surface_;
  Random random_;
  std::vector<bool> isCut_;
  TrianglePaths paths_;
};

}  // namespace

std::vector<HandleLoop> handleLoops(const Surface& surface, std::uint64_t seed, Context& context) {
  LoopFinder finder(surface, seed);
  std::vector<HandleLoop> loops;
  while (true) {
    HandleLoop loop = finder.next(context);
    if (loop.triangles.empty()) return loops;
    loops.push_back(std::move(loop));
  }
}

}  // namespace hexhex::shape
