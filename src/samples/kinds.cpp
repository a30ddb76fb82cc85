// Most kinds are planar sections, extruded; a warp makes the round ones round.
#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include <base/vector3.hpp>
#include <samples/kinds.hpp>

namespace hexhex::samples {

namespace {

using Vec2 = std::array<double, 2>;

/// Half the side of the inner square or cube of O-grids whose outer half side is 1: roughly where
/// the inner and outer blocks become equally large once the outside is round.
constexpr double kInnerSquare = 0.5;
constexpr double kInnerCube = 0.45;
/// Radius of the cavity of a shell with outer radius 1.
constexpr double kCavity = 0.5;
/// Torus: blocks along the ring, and radius of the ring's axis; the section has radius 1.
constexpr Index kRingBlocks = 6;
constexpr double kRingRadius = 2.5;
/// Star: distance of the outer corners; beyond 1, so that the sections of all blocks are convex.
constexpr double kStarCorner = 1.2;

/// The point on the unit circle at a fraction of a full turn, in [0, 1]. Computed from the power
/// series, because the last bits of std::sin and std::cos differ between machines.
Vec2 onUnitCircle(double turns) {
  constexpr double kFullTurn = 6.283185307179586;
  // Terms beyond the 40th are below 2 pi^40 / 40! < 1e-15.
  constexpr int kTerms = 40;
  const double angle = turns * kFullTurn;
  Vec2 sums = {0, 0};
  double term = 1;
  for (int n = 0; n < kTerms; ++n) {
    sums[static_cast<std::size_t>(n % 2)] += (n / 2) % 2 == 0 ? term : -term;
    term *= angle / (n + 1);
  }
  return sums;
}

/// Quadrilaterals in the plane; corner c of a quad is at (c & 1, c >> 1) of the unit square.
struct Section {
  std::vector<Vec2> points;
  std::vector<std::array<Index, 4>> quads;
};

/// nx times ny unit squares, except those in `holes`.
Section plate(Index nx, Index ny, const std::set<std::pair<Index, Index>>& holes = {}) {
  Section section;
  for (Index y = 0; y <= ny; ++y) {
    for (Index x = 0; x <= nx; ++x) {
      section.points.push_back({static_cast<double>(x), static_cast<double>(y)});
    }
  }
  for (Index y = 0; y < ny; ++y) {
    for (Index x = 0; x < nx; ++x) {
      if (holes.contains({x, y})) continue;
      const Index corner = x + y * (nx + 1);
      section.quads.push_back({corner, corner + 1, corner + nx + 1, corner + nx + 2});
    }
  }
  return section;
}

/// A square surrounded by four quads.
Section squareGrid() {
  Section section;
  for (const double half : {kInnerSquare, 1.0}) {
    for (const Vec2& corner : {Vec2{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
      section.points.push_back({half * corner[0], half * corner[1]});
    }
  }
  section.quads.push_back({0, 1, 2, 3});
  constexpr std::array<Index, 4> kAround = {0, 1, 3, 2};
  for (std::size_t side = 0; side < 4; ++side) {
    const Index from = kAround[side];
    const Index to = kAround[(side + 1) % 4];
    section.quads.push_back({from, from + 4, to, to + 4});
  }
  return section;
}

/// Quads around a common corner.
Section starSection(Index valence) {
  Section section;
  section.points.push_back({0, 0});
  for (Index i = 0; i < 2 * valence; ++i) {
    Vec2 point = onUnitCircle(static_cast<double>(i) / (2.0 * valence));
    if (i % 2 == 1) point = {kStarCorner * point[0], kStarCorner * point[1]};
    section.points.push_back(point);
  }
  for (Index i = 0; i < valence; ++i) {
    const Index spoke = 1 + 2 * i;
    const Index nextSpoke = 1 + 2 * ((i + 1) % valence);
    section.quads.push_back({0, spoke, nextSpoke, spoke + 1});
  }
  return section;
}

/// Adds a block.
/// @param cornerAt  returns the vertex and the position of a corner
template <class CornerAt>
void addBlock(BlockModel& model, const CornerAt& cornerAt) {
  BlockCorners& block = model.blocks.emplace_back();
  std::array<Vec3, 8>& shape = model.shapes.emplace_back();
  for (std::size_t c = 0; c < 8; ++c) std::tie(block[c], shape[c]) = cornerAt(c);
}

/// Copies of a section above each other, with blocks between them. A closed column ends where it
/// began, though its shape before the warp does not.
BlockModel extrude(const Section& section, Index layers, bool closed) {
  BlockModel model;
  const auto perLevel = static_cast<Index>(section.points.size());
  for (Index layer = 0; layer < layers; ++layer) {
    for (const std::array<Index, 4>& quad : section.quads) {
      addBlock(model, [&](std::size_t corner) {
        const Index level = layer + static_cast<Index>(corner / 4);
        const Index vertex = quad[corner % 4];
        const Vec2& point = section.points[vertex];
        return std::pair((closed ? level % layers : level) * perLevel + vertex,
                         Vec3{point[0], point[1], static_cast<double>(level)});
      });
    }
  }
  return model;
}

/// A corner of the cube around the origin with this half side.
Vec3 cubeCorner(std::size_t corner, double half) {
  Vec3 point{};
  for (std::size_t a = 0; a < 3; ++a) point[a] = (corner >> a & 1) == 1 ? half : -half;
  return point;
}

/// Six blocks between an inner and an outer cube, whose corners are vertices 0..7 and 8..15.
BlockModel cubeLayer(double innerHalf) {
  BlockModel model;
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face / 2;
    const std::size_t side = face % 2;
    // The frame of the block: two axes along the face and one outwards, right-handed.
    const std::size_t along0 = (axis + (side == 1 ? 1 : 2)) % 3;
    const std::size_t along1 = 3 - axis - along0;
    addBlock(model, [&](std::size_t corner) {
      const std::size_t ofCube =
          side << axis | (corner & 1) << along0 | (corner >> 1 & 1) << along1;
      const bool outer = corner >= 4;
      return std::pair(static_cast<Index>(ofCube + (outer ? 8 : 0)),
                       cubeCorner(ofCube, outer ? 1.0 : innerHalf));
    });
  }
  return model;
}

/// The same layer around a block that fills the inner cube.
BlockModel cubeGrid() {
  BlockModel model = cubeLayer(kInnerCube);
  addBlock(model, [](std::size_t corner) {
    return std::pair(static_cast<Index>(corner), cubeCorner(corner, kInnerCube));
  });
  return model;
}

/// A regular tetrahedron cut at the midpoints of its edges, its faces and itself. Each of these
/// points, and each corner, is the mean of a set of corners.
BlockModel midpointTetrahedron() {
  constexpr std::array<Vec3, 4> kCorners = {{{-1, -1, -1}, {1, 1, -1}, {-1, 1, 1}, {1, -1, 1}}};
  // The block's corner and the ends of its three edges: even permutations, hence right-handed.
  constexpr std::array<std::array<std::size_t, 4>, 4> kFrames = {
      {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
  BlockModel model;
  for (const std::array<std::size_t, 4>& frame : kFrames) {
    addBlock(model, [&](std::size_t corner) {
      std::size_t set = std::size_t{1} << frame[0];
      for (std::size_t a = 0; a < 3; ++a) set |= (corner >> a & 1) << frame[a + 1];
      Vec3 mean{};
      for (std::size_t v = 0; v < 4; ++v) {
        if ((set >> v & 1) == 1) mean = plus(mean, kCorners[v]);
      }
      for (double& coordinate : mean) coordinate /= std::popcount(set);
      return std::pair(static_cast<Index>(set - 1), mean);
    });
  }
  return model;
}

/// Moves a point along its ray from the origin, so that the cube (or square) of half side 1 becomes
/// the unit ball (or disc) and the one of half side `inner` stays in place with all it contains:
/// linear in between.
template <std::size_t dimension>
std::array<double, dimension> roundOutside(std::array<double, dimension> point, double inner) {
  double maximum = 0;
  double squares = 0;
  for (const double coordinate : point) {
    maximum = std::max(maximum, std::abs(coordinate));
    squares += coordinate * coordinate;
  }
  if (maximum <= inner) return point;
  const double outside = (maximum - inner) / (1 - inner);  // 0 at the inner cube, 1 at the outer
  const double factor = (1 - outside) * inner / maximum + outside / std::sqrt(squares);
  for (double& coordinate : point) coordinate *= factor;
  return point;
}

Vec3 warpCylinder(const Vec3& point) {
  const Vec2 section = roundOutside<2>({point[0], point[1]}, kInnerSquare);
  return {section[0], section[1], point[2]};
}

Vec3 warpBall(const Vec3& point) { return roundOutside<3>(point, kInnerCube); }

/// Concentric cubes become concentric spheres.
Vec3 warpShell(const Vec3& point) { return roundOutside<3>(point, 0); }

/// Bends a cylinder of height kRingBlocks into a ring around the y axis.
Vec3 warpTorus(const Vec3& point) {
  const Vec2 section = roundOutside<2>({point[0], point[1]}, kInnerSquare);
  const Vec2 turned = onUnitCircle(point[2] / kRingBlocks);
  const double radius = kRingRadius + section[0];
  return {radius * turned[0], section[1], radius * turned[1]};
}

BlockModel warped(BlockModel model, Vec3 (*warp)(const Vec3&)) {
  model.warp = warp;
  return model;
}

}  // namespace

Vec3 BlockModel::place(std::size_t block, const Vec3& local) const {
  Vec3 point{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (std::size_t a = 0; a < 3; ++a) weight *= (corner >> a & 1) == 1 ? local[a] : 1 - local[a];
    for (std::size_t a = 0; a < 3; ++a) point[a] += weight * shapes[block][corner][a];
  }
  return warp == nullptr ? point : warp(point);
}

BlockModel blockModel(SampleKind kind, int valence) {
  switch (kind) {
    case SampleKind::Box:
      return extrude(plate(2, 2), 2, false);
    case SampleKind::Star:
      return extrude(starSection(static_cast<Index>(valence)), 1, false);
    case SampleKind::HandleBody:
      return extrude(plate(5, 3, {{1, 1}, {3, 1}}), 1, false);
    case SampleKind::Tetrahedron:
      return midpointTetrahedron();
    case SampleKind::Cylinder:
      return warped(extrude(squareGrid(), 1, false), warpCylinder);
    case SampleKind::Torus:
      return warped(extrude(squareGrid(), kRingBlocks, true), warpTorus);
    case SampleKind::Sphere:
      return warped(cubeGrid(), warpBall);
    case SampleKind::Shell:
      return warped(cubeLayer(kCavity), warpShell);
  }
  return {};
}

}  // namespace hexhex::samples
