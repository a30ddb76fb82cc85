#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <fill/flat_triangles.hpp>
#include <fill/intersections.hpp>

#include <base/vector3.hpp>

namespace hexhex::fill {
namespace {

using Corners = std::array<Index, 3>;

bool hasNoArea(const TriangleMesh& surface, const Corners& corners) {
  const auto& [a, b, c] = corners;
  return isFlat({surface.points[a], surface.points[b], surface.points[c]});
}

/// The ends of this side are the outer two of the corners, which are on a line.
Index longestSide(const TriangleMesh& surface, Index t) {
  const auto squaredLength = [&](Index i) {
    const Corners& corners = surface.triangles[t];
    const Vec3 side = minus(surface.points[corners[(i + 1) % 3]], surface.points[corners[i]]);
    return dot(side, side);
  };
  Index longest = 0;
  for (const Index i : {1U, 2U}) {
    if (squaredLength(i) > squaredLength(longest)) longest = i;
  }
  return 3 * t + longest;
}

/// The only other side at the edge of a side.
std::optional<Index> otherSide(const TriangleMesh& surface, std::span<const Side> sides,
                               Index side) {
  const Corners& corners = surface.triangles[side / 3];
  const Index a = corners[side % 3];
  const Index b = corners[(side + 1) % 3];
  const Side first{{std::min(a, b), std::max(a, b)}, 0};
  const auto begin = std::lower_bound(sides.begin(), sides.end(), first);
  const auto end =
      std::find_if(begin, sides.end(), [&](const Side& other) { return other.ends != first.ends; });
  if (end - begin != 2) return {};
  return begin->side == side ? std::next(begin)->side : begin->side;
}

/// Flips each triangle whose neighbour has an area, so that both halves of that have one.
/// @return the number of triangles that are not flat any more
std::size_t flipOnce(TriangleMesh& surface, std::vector<Index>& flat) {
  const std::vector<Side> sides = sortedSides(surface);
  std::vector<bool> isDone(surface.triangles.size(), false);
  for (const Index t : flat) {
    const Index side = longestSide(surface, t);
    const std::optional<Index> other = otherSide(surface, sides, side);
    if (!other || isDone[*other / 3]) continue;
    Corners& neighbour = surface.triangles[*other / 3];
    if (*other / 3 == t || hasNoArea(surface, neighbour)) continue;
    const Index middle = surface.triangles[t][(side + 2) % 3];
    surface.triangles[t] = neighbour;
    surface.triangles[t][*other % 3] = middle;
    neighbour[(*other + 1) % 3] = middle;
    isDone[t] = isDone[*other / 3] = true;
  }
  return std::erase_if(flat, [&](Index t) { return isDone[t]; });
}

}  // namespace

std::vector<Side> sortedSides(const TriangleMesh& surface) {
  std::vector<Side> sides;
  sides.reserve(3 * surface.triangles.size());
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      const Index a = surface.triangles[t][i];
      const Index b = surface.triangles[t][(i + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, 3 * t + i});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::size_t removeFlatTriangles(TriangleMesh& surface) {
  std::size_t removed = std::erase_if(surface.triangles, [](const Corners& corners) {
    const auto [a, b, c] = corners;
    return a == b || b == c || c == a;
  });
  std::vector<Index> flat;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    if (hasNoArea(surface, surface.triangles[t])) flat.push_back(t);
  }
  // Each round makes neighbours of others ready.
  while (!flat.empty()) {
    const std::size_t flipped = flipOnce(surface, flat);
    removed += flipped;
    if (flipped == 0) break;
  }
  return removed;
}

}  // namespace hexhex::fill
