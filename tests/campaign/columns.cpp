// Structures that are extruded from quads in the plane.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "campaign/block_structure.hpp"

namespace hexhex::campaign {

namespace {

using samples::BlockCorners;
using samples::BlockModel;

using Vec2 = std::array<double, 2>;

/// Corner c of a quad is at (c & 1, c >> 1) of the unit square.
struct Quads {
  std::size_t vertexCount = 0;
  std::vector<std::array<Index, 4>> quads;
};

/// Blocks between copies of the quads, one above the other.
/// @param vertexAt  number and place of vertex v of level l
BlockModel extrude(
    const Quads& section, std::size_t layers,
    const std::function<std::pair<std::size_t, Vec3>(Index, std::size_t)>& vertexAt) {
  BlockModel model;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    for (const std::array<Index, 4>& quad : section.quads) {
      BlockCorners& block = model.blocks.emplace_back();
      std::array<Vec3, 8>& shape = model.shapes.emplace_back();
      for (std::size_t c = 0; c < 8; ++c) {
        const auto [number, place] = vertexAt(quad[c % 4], layer + c / 4);
        block[c] = static_cast<Index>(number);
        shape[c] = place;
      }
    }
  }
  return model;
}

Vec2 onCircle(double turns) {
  const double angle = 2 * std::numbers::pi * turns;
  return {std::cos(angle), std::sin(angle)};
}

/// Convex polygons, counter-clockwise, that fill one.
struct Polygons {
  std::vector<Vec2> points;
  std::vector<std::vector<Index>> polygons;
};

Vec2 meanOf(const std::vector<Vec2>& points, const std::vector<Index>& corners) {
  Vec2 sum{};
  for (const Index corner : corners) {
    for (std::size_t a = 0; a < 2; ++a) sum[a] += points[corner][a];
  }
  for (double& coordinate : sum) coordinate /= static_cast<double>(corners.size());
  return sum;
}

/// A regular polygon; then, again and again, one is cut into triangles around a new vertex, or in
/// two along a diagonal.
Polygons drawPolygons(Random& random) {
  Polygons plane;
  const std::size_t corners = 3 + random.below(6);
  plane.polygons.emplace_back();
  for (std::size_t i = 0; i < corners; ++i) {
    plane.points.push_back(onCircle(static_cast<double>(i) / static_cast<double>(corners)));
    plane.polygons[0].push_back(static_cast<Index>(i));
  }
  const std::size_t cuts = random.below(oftenOr(4, 7, random));
  for (std::size_t i = 0; i < cuts; ++i) {
    const std::size_t chosen = random.below(plane.polygons.size());
    const std::vector<Index> polygon = plane.polygons[chosen];
    const std::size_t n = polygon.size();
    plane.polygons.erase(plane.polygons.begin() + static_cast<std::ptrdiff_t>(chosen));
    if (n > 3 && random.below(2) == 0) {
      const auto begin = polygon.begin();
      const auto end = static_cast<std::ptrdiff_t>(2 + random.below(n - 3));
      plane.polygons.emplace_back(begin, begin + end + 1);
      plane.polygons.emplace_back(begin + end, polygon.end());
      plane.polygons.back().push_back(polygon[0]);
      continue;
    }
    const auto centre = static_cast<Index>(plane.points.size());
    plane.points.push_back(meanOf(plane.points, polygon));
    for (std::size_t c = 0; c < n; ++c) {
      plane.polygons.push_back({centre, polygon[c], polygon[(c + 1) % n]});
    }
  }
  return plane;
}

/// A quad for each corner of each polygon. Adds midpoints of edges and polygons.
Quads cutAtMidpoints(Polygons& plane) {
  std::map<std::pair<Index, Index>, Index> middles;
  const auto add = [&](const std::vector<Index>& corners) {
    plane.points.push_back(meanOf(plane.points, corners));
    return static_cast<Index>(plane.points.size() - 1);
  };
  const auto middle = [&](Index a, Index b) {
    const auto [entry, isNew] = middles.try_emplace(std::minmax(a, b), 0);
    if (isNew) entry->second = add({a, b});
    return entry->second;
  };
  Quads section;
  for (const std::vector<Index>& polygon : plane.polygons) {
    const Index centre = add(polygon);
    const std::size_t n = polygon.size();
    for (std::size_t c = 0; c < n; ++c) {
      section.quads.push_back({polygon[c], middle(polygon[c], polygon[(c + 1) % n]),
                               middle(polygon[(c + n - 1) % n], polygon[c]), centre});
    }
  }
  section.vertexCount = plane.points.size();
  return section;
}

}  // namespace

BlockStructure drawPrism(Random& random) {
  Polygons plane = drawPolygons(random);
  const Quads section = cutAtMidpoints(plane);
  return {"prism", extrude(section, 1 + random.below(3), [&](Index v, std::size_t level) {
            const Vec2& point = plane.points[v];
            return std::pair(level * section.vertexCount + v,
                             Vec3{point[0], point[1], static_cast<double>(level)});
          })};
}

BlockStructure drawTwistedRing(Random& random) {
  // Around one vertex, where quads have two of the ring's vertices each; or around a hole.
  const bool hasHole = random.below(3) == 0;
  const std::size_t n = 3 + random.below(6);
  const std::size_t around = hasHole ? n : 2 * n;
  Quads section{hasHole ? 2 * n : 2 * n + 1, {}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = [around](std::size_t place) { return static_cast<Index>(place % around); };
    if (hasHole) {
      const auto inner = static_cast<Index>(n);
      section.quads.push_back({at(i), at(i + 1), at(i) + inner, at(i + 1) + inner});
    } else {
      section.quads.push_back({static_cast<Index>(2 * n), at(2 * i), at(2 * i + 2), at(2 * i + 1)});
    }
  }
  const std::size_t layers = 3 + random.below(4);
  const std::size_t turn = random.below(n) * (hasHole ? 1 : 2);
  const auto vertexAt = [&](Index v, std::size_t level) {
    std::size_t vertex = v;
    if (level == layers && v < 2 * n) {
      vertex = v / around * around + (v % around + turn) % around;
    }
    const std::size_t ringLevel = level % layers;
    const double radius = v == 2 * n ? 0 : (hasHole && v >= n ? 0.5 : 1);
    const double share = static_cast<double>(ringLevel) / static_cast<double>(layers);
    const Vec2 inSection =
        onCircle((static_cast<double>(vertex % around) - share * static_cast<double>(turn)) /
                 static_cast<double>(around));
    const Vec2 direction = onCircle(share);
    const double distance = 3 + radius * inSection[0];
    return std::pair(ringLevel * section.vertexCount + vertex,
                     Vec3{distance * direction[0], radius * inSection[1], distance * direction[1]});
  };
  return {"twisted ring", extrude(section, layers, vertexAt)};
}

}  // namespace hexhex::campaign
