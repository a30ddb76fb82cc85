// Cells of higher order that are positive where straight ones are. What judges them here is a
// dense sample of the determinant, from nodes alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

#include "curved/curved_maps.hpp"

namespace hexhex::test::blending {

namespace {

struct Blended {
  LagrangeMesh mesh;
  LagrangeMesh exact;
};

LagrangeMesh extracted(const TetMap& map, int order, int scale, CurvedNodes nodes) {
  ExtractOptions options;
  options.scale = scale;
  options.curvedNodes = nodes;
  Context context(2);
  return extractLagrange(map, order, options, context);
}

Blended blended(const TetMap& map, int order, int scale = 1) {
  return {extracted(map, order, scale, CurvedNodes::Blended),
          extracted(map, order, scale, CurvedNodes::Exact)};
}

/// The value and the derivative of the Lagrange polynomial of node i of p + 1 at x.
std::array<double, 2> lagrangeAt(int p, int i, double x) {
  double value = 1;
  double slope = 0;
  for (int j = 0; j <= p; ++j) {
    if (j == i) continue;
    const double factor = (p * x - j) / (i - j);
    slope = slope * factor + value * p / (i - j);
    value *= factor;
  }
  return {value, slope};
}

/// The least determinant of a cell, at places kSteps apart along each axis.
double leastDeterminant(const LagrangeMesh& mesh, std::size_t cell) {
  constexpr int kSteps = 7;
  const int n = mesh.order + 1;
  std::vector<std::array<double, 2>> weights;  // per place along an axis and node
  for (int i = 0; i < (kSteps + 1) * n; ++i) {
    weights.push_back(lagrangeAt(mesh.order, i % n, static_cast<double>(i / n) / kSteps));
  }
  double least = 1e300;
  for (int at = 0; at < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++at) {
    const auto* const u = &weights[static_cast<std::size_t>(at % (kSteps + 1) * n)];
    const auto* const v = &weights[static_cast<std::size_t>(at / (kSteps + 1) % (kSteps + 1) * n)];
    const auto* const w = &weights[static_cast<std::size_t>(at / (kSteps + 1) / (kSteps + 1) * n)];
    std::array<Vec3, 3> columns{};
    for (int i = 0; i < n * n * n; ++i) {
      const auto& [x, dx] = u[i % n];
      const auto& [y, dy] = v[i / n % n];
      const auto& [z, dz] = w[i / n / n];
      const Vec3& point =
          mesh.points[mesh.nodes[cell * mesh.nodesPerCell() + static_cast<std::size_t>(i)]];
      for (std::size_t k = 0; k < 3; ++k) {
        columns[0][k] += dx * y * z * point[k];
        columns[1][k] += x * dy * z * point[k];
        columns[2][k] += x * y * dz * point[k];
      }
    }
    const auto& [a, b, c] = columns;
    least =
        std::min(least, a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                            a[2] * (b[0] * c[1] - b[1] * c[0]));
  }
  return least;
}

std::set<Index> nodesOf(const LagrangeMesh& mesh, std::size_t cell) {
  const Index* const first = mesh.nodes.data() + cell * mesh.nodesPerCell();
  return {first, first + mesh.nodesPerCell()};
}

/// The nodes of each face of the cells, with its cells.
std::map<std::set<Index>, std::vector<std::size_t>> facesOf(const LagrangeMesh& mesh) {
  std::map<std::set<Index>, std::vector<std::size_t>> faces;
  const int n = mesh.order + 1;
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    for (int face = 0; face < 6; ++face) {
      std::set<Index> nodes;
      for (int i = 0; i < n * n * n; ++i) {
        const std::array<int, 3> place = {i % n, i / n % n, i / n / n};
        if (place[static_cast<std::size_t>(face / 2)] != face % 2 * mesh.order) continue;
        nodes.insert(mesh.nodes[c * mesh.nodesPerCell() + static_cast<std::size_t>(i)]);
      }
      faces[nodes].push_back(c);
    }
  }
  return faces;
}

/// All that must hold of any mesh. Returns how many cells fold over if nodes are exact.
std::size_t examine(const TetMap& map, int order, int scale = 1) {
  SCOPED_TRACE("order " + std::to_string(order) + ", scale " + std::to_string(scale));
  Context context(2);
  const Blended found = blended(map, order, scale);
  EXPECT_EQ(found.mesh.nodes, found.exact.nodes);
  const Certificate straight = certify(straightMesh(found.mesh), context);
  const Certificate curved = certify(found.mesh, context);
  std::size_t folded = 0;
  for (std::size_t c = 0; c < found.mesh.cellCount(); ++c) {
    if (straight.validity[c] != Validity::Positive) continue;
    EXPECT_EQ(curved.validity[c], Validity::Positive) << "cell " << c;
    EXPECT_GT(leastDeterminant(found.mesh, c), 0) << "cell " << c;
    if (leastDeterminant(found.exact, c) <= 0) ++folded;
  }
  // What stays is on the image of the map, unless its cell is named.
  std::set<Index> free;
  for (const Index cell : found.mesh.straightenedCells) free.merge(nodesOf(found.mesh, cell));
  for (const auto& [nodes, cells] : facesOf(found.mesh)) {
    if (cells.size() > 1) continue;
    for (const Index node : nodes) {
      if (free.count(node) > 0) continue;
      EXPECT_EQ(found.mesh.points[node], found.exact.points[node]) << "node " << node;
    }
  }
  return folded;
}

TEST(Blending, CellsArePositiveWhereStraightOnesAre) {
  std::size_t folded = 0;
  for (const SampleKind kind :
       {SampleKind::Sphere, SampleKind::Torus, SampleKind::Star, SampleKind::Shell}) {
    SampleOptions options;
    options.cells = 2;
    options.refine = 3;
    options.jitter = 0.6;
    options.charts = ChartStyle::Random;
    const TetMap map = generateSample(kind, options).map;
    folded += examine(map, 2);
    folded += examine(map, 3);
  }
  EXPECT_GT(folded, 10U);
}

TEST(Blending, RealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    if (extract(map.map).cells.size() > 3000) continue;
    examine(map.map, 2);
    examine(map.map, 3);
  }
}

/// A box of 2 x 2 x 2 blocks with points where a function puts them; cells are of size 1.
TetMap bentBox(const std::function<Vec3(const Vec3&)>& place, int cells = 1, int refine = 2) {
  SampleOptions options;
  options.cells = cells;
  options.refine = refine;
  TetMap map = generateSample(SampleKind::Box, options).map;
  // The corners of the box, whatever its size.
  Vec3 low = map.points[0];
  Vec3 high = low;
  for (const Vec3& point : map.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  for (Vec3& point : map.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      point[k] = 2 * cells * (point[k] - low[k]) / (high[k] - low[k]);
    }
    point = place(point);
  }
  return map;
}

bool isAt(const Vec3& point, const Vec3& place) {
  return std::abs(point[0] - place[0]) + std::abs(point[1] - place[1]) +
             std::abs(point[2] - place[2]) <
         1e-9;
}

std::size_t nodeAt(const LagrangeMesh& mesh, const Vec3& place) {
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (isAt(mesh.points[i], place)) return i;
  }
  ADD_FAILURE() << "no node at " << place[0] << ' ' << place[1] << ' ' << place[2];
  return 0;
}

TEST(Blending, WhatFoldsInsideIsStraight) {
  // The middle of an inner face is beyond the middle of the next cell.
  const TetMap map = bentBox([](const Vec3& x) {
    return isAt(x, {1, 0.5, 0.5}) ? Vec3{1.9, 0.5, 0.5} : x;
  });
  Context context(1);
  const Blended found = blended(map, 2);
  EXPECT_GT(certify(found.exact, context).refuted, 0U);
  EXPECT_TRUE(certify(found.mesh, context).allPositive());
  EXPECT_TRUE(found.mesh.straightenedCells.empty());
  const std::size_t node = nodeAt(found.exact, {1.9, 0.5, 0.5});
  EXPECT_TRUE(isAt(found.mesh.points[node], {1, 0.5, 0.5}));
}

TEST(Blending, ADentThatIsTooDeepIsHalved) {
  // The middle of a boundary face: a little way in it stays, and 1.5 cells deep it is half as deep.
  for (const double depth : {0.4, 1.5}) {
    const TetMap map = bentBox([depth](const Vec3& x) {
      return isAt(x, {0.5, 0.5, 0}) ? Vec3{0.5, 0.5, depth} : x;
    });
    Context context(1);
    const Blended found = blended(map, 2);
    EXPECT_TRUE(certify(found.mesh, context).allPositive());
    const std::size_t node = nodeAt(found.exact, {0.5, 0.5, depth});
    if (depth < 1) {
      EXPECT_TRUE(found.mesh.straightenedCells.empty());
      EXPECT_EQ(found.mesh.points[node], found.exact.points[node]);
    } else {
      EXPECT_EQ(certify(found.exact, context).refuted, 1U);
      ASSERT_EQ(found.mesh.straightenedCells.size(), 1U);
      EXPECT_EQ(
          nodesOf(found.mesh, found.mesh.straightenedCells[0]).count(static_cast<Index>(node)), 1U);
      EXPECT_TRUE(isAt(found.mesh.points[node], {0.5, 0.5, depth / 2}));
    }
    for (std::size_t i = 0; i < found.mesh.points.size(); ++i) {
      if (i != node && isAt(found.mesh.points[i], found.exact.points[i])) continue;
      // Beside it, the middle of the cell alone has moved.
      EXPECT_TRUE(i == node || isAt(found.exact.points[i], {0.5, 0.5, 0.5})) << i;
    }
  }
}

TEST(Blending, ABadStraightCellIsLeftAsItIs) {
  // A corner of the box is beyond the opposite corner of its cell.
  const TetMap map = bentBox([](const Vec3& x) {
    return isAt(x, {0, 0, 0}) ? Vec3{1.2, 1.2, 1.2} : x;
  });
  Context context(1);
  const Blended found = blended(map, 2);
  EXPECT_EQ(certify(straightMesh(found.mesh), context).refuted, 1U);
  EXPECT_EQ(certify(found.mesh, context).refuted, 1U);
  EXPECT_TRUE(found.mesh.straightenedCells.empty());
}

/// The largest distance of the boundary at radius 10 from the cylinder.
double distanceFromCylinder(const LagrangeMesh& mesh) {
  const int p = mesh.order;
  double largest = 0;
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    for (int at = 0; at < 121; ++at) {
      Vec3 sum{};
      for (int n = 0; n < (p + 1) * (p + 1); ++n) {
        const double weight = lagrangeAt(p, n % (p + 1), at % 11 / 10.0)[0] *
                              lagrangeAt(p, n / (p + 1), at / 11 / 10.0)[0];
        // The face at w = 0, of the lowest layer of cells.
        const Vec3& x =
            mesh.points[mesh.nodes[c * mesh.nodesPerCell() + static_cast<std::size_t>(n)]];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * x[k];
      }
      const double radius = std::hypot(sum[0], sum[2]);
      if (radius < 10.001) largest = std::max(largest, std::abs(radius - 10));
    }
  }
  return largest;
}

TEST(Blending, AThinPlateFollowsItsCylinderMoreCloselyWithEachOrder) {
  // A quarter of a cylinder, four cells long and 0.04 thick, in four layers: the chord of a
  // straight cell is 0.19 below the arc, so that nodes of all layers have to move together.
  constexpr double kQuarter = 1.5707963267948966;
  const auto onCylinder = [](const Vec3& x) {
    const double angle = kQuarter * (1 - x[0] / 4);
    const double radius = 10 + 0.01 * x[2];
    return Vec3{radius * std::cos(angle), x[1], radius * std::sin(angle)};
  };
  Context context(2);
  std::array<double, 4> distance{};
  for (int order = 1; order <= 3; ++order) {
    // Nodes are vertices of tets, and on the cylinder.
    const Blended found = blended(bentBox(onCylinder, 2, 2 * order), order);
    EXPECT_TRUE(certify(found.mesh, context).allPositive());
    EXPECT_TRUE(found.mesh.straightenedCells.empty());
    distance[static_cast<std::size_t>(order)] = distanceFromCylinder(found.mesh);
  }
  EXPECT_NEAR(distance[1], 10 * (1 - std::cos(kQuarter / 8)), 1e-3);
  EXPECT_LT(distance[2], distance[1] / 50);
  EXPECT_LT(distance[3], distance[2] / 3);
}

TEST(Blending, RegionsAndTagsKeepTheirNodes) {
  SampleOptions options;
  options.features = true;
  options.cells = 2;
  options.refine = 3;
  const TetMap tagged = generateSample(SampleKind::Sphere, options).map;
  const LagrangeMesh exact = extracted(tagged, 2, 1, CurvedNodes::Exact);
  const auto moved = [&](bool regions, bool features) {
    TetMap map = tagged;
    if (!regions) map.regions.clear();
    if (!features) map.features = {};
    const LagrangeMesh mesh = extracted(map, 2, 1, CurvedNodes::Blended);
    std::set<Index> nodes;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      if (!isAt(mesh.points[i], exact.points[i])) nodes.insert(static_cast<Index>(i));
    }
    return nodes;
  };
  const std::set<Index> withoutAny = moved(false, false);
  const std::set<Index> withRegions = moved(true, false);
  const std::set<Index> withTags = moved(false, true);
  // Faces between regions.
  for (const auto& [nodes, cells] : facesOf(exact)) {
    if (cells.size() < 2 || exact.regions[cells[0]] == exact.regions[cells[1]]) continue;
    for (const Index node : nodes) EXPECT_EQ(withRegions.count(node), 0U);
  }
  EXPECT_LT(withRegions.size(), withoutAny.size());
  // Singular curves are tagged, also inside: their middles are inside edges of cells.
  std::size_t inner = 0;
  for (const FeatureEdge& edge : exact.features.edges) {
    for (std::size_t c = 0; c < exact.cellCount(); ++c) {
      const Index* const n = exact.nodes.data() + c * exact.nodesPerCell();
      for (const std::array<int, 3>& e : {std::array<int, 3>{0, 1, 2},
                                          {0, 3, 6},
                                          {0, 9, 18},
                                          {2, 5, 8},
                                          {2, 11, 20},
                                          {6, 7, 8},
                                          {6, 15, 24},
                                          {8, 17, 26},
                                          {18, 19, 20},
                                          {18, 21, 24},
                                          {20, 23, 26},
                                          {24, 25, 26}}) {
        const std::set<Index> ends = {n[e[0]], n[e[2]]};
        if (ends != std::set<Index>{edge.vertices[0], edge.vertices[1]}) continue;
        EXPECT_EQ(withTags.count(n[e[1]]), 0U);
        inner += withoutAny.count(n[e[1]]);
      }
    }
  }
  EXPECT_GT(inner, 0U);
}

}  // namespace
}  // namespace hexhex::test::blending
