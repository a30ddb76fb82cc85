// Regular vertices: what is concluded without a look at their stars, against a look at their stars.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <rapidcheck.h>
#include <vector>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <igm/regular_vertices.hpp>
#include <igm/sanitization.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
namespace {

using test::Prepared;

/// The preprocessing of a valid map up to its regular vertices.
struct Analysis : test::Topology {
  LocalParameters parameters;
  RegularVertices regular;

  explicit Analysis(const TetMapView& map)
      : Topology(map),
        parameters(input),
        regular(findRegularVertices(topology, parameters, stage)) {
    adjacency::addStars(topology, stage);
  }
};

/// What follows from the stars of irregular vertices.
struct Stars {
  Transitions transitions;
  Array<HalfFaceTransition> faceTransitions;
  VertexKinds vertices;

  /// @param noneIsFlat  declares all transitions inexact
  explicit Stars(Analysis& analysis, bool noneIsFlat = false)
      : transitions(computeTransitions(analysis.topology, analysis.parameters, analysis.regular, {},
                                       0.1, analysis.stage)),
        faceTransitions(findHalfFaceTransitions(analysis.topology, analysis.regular, transitions,
                                                analysis.stage)) {
    if (noneIsFlat) {
      for (HalfFaceTransition& across : faceTransitions) {
        across = across.isBoundary()
                     ? HalfFaceTransition::boundary(
                           static_cast<std::size_t>(std::countr_zero(across.plane())), false)
                     : HalfFaceTransition::inner(across.rotation(), false);
      }
    }
    vertices = classifyVertices(analysis.topology, analysis.parameters, analysis.regular,
                                faceTransitions, {}, true, analysis.stage);
  }

  [[nodiscard]] std::optional<Singularities> singularities(Analysis& analysis) const {
    return computeSingularities(analysis.topology, analysis.parameters, analysis.regular,
                                faceTransitions, vertices, {}, analysis.stage);
  }
};

/// The sum of dihedral angles around an edge in right angles, by trigonometry.
double rightAngles(const TetMapView& map, std::span<const adjacency::EdgeCorner> fan) {
  double sum = 0;
  for (const adjacency::EdgeCorner& at : fan) {
    const TetParameters& u = map.parameters[at.tet];
    std::vector<Vec3> normals;
    const Vec3 edge = minus(u[at.corner1], u[at.corner0]);
    for (std::size_t i = 0; i < 4; ++i) {
      if (i != at.corner0 && i != at.corner1) {
        normals.push_back(cross(edge, minus(u[i], u[at.corner0])));
      }
    }
    const Vec3 across = cross(normals[0], normals[1]);
    sum += std::atan2(length(across), dot(normals[0], normals[1]));
  }
  return sum / (std::numbers::pi / 2);
}

/// Everything that being regular promises about edges.
std::size_t expectRegularEdges(const Analysis& analysis) {
  std::vector<adjacency::EdgeCorner> scratch;
  std::size_t edges = 0;
  for (Index v = 0; v < analysis.topology.pointCount; ++v) {
    adjacency::forEachEdge(
        analysis.topology, v, scratch, [&](Index w, std::span<const adjacency::EdgeCorner> fan) {
          if (analysis.regular.isIrregular[v] != 0 && analysis.regular.isIrregular[w] != 0) return;
          const double regular = adjacency::boundaryFacesAt(analysis.topology, fan) > 0 ? 2 : 4;
          EXPECT_NEAR(rightAngles(analysis.input.view, fan), regular, 1e-6);
          ++edges;
        });
  }
  return edges;
}

class RegularVerticesOfKind : public test::EveryKind {};

TEST_P(RegularVerticesOfKind, HaveRegularEdgesOnly) {
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map =
        generateSample(kind(), {.cells = 7, .refine = 3, .charts = charts, .jitter = 0.6}).map;
    const Analysis analysis(map);
    ASSERT_TRUE(analysis.defects.empty());
    const std::size_t edges = expectRegularEdges(analysis);
    if (charts == ChartStyle::Aligned || charts == ChartStyle::Blocks) {
      EXPECT_GT(edges, map.tets.size() / 2);
    }
  }
}

TEST_P(RegularVerticesOfKind, AreNeitherSingularNorBetweenPlanesNorAtJumps) {
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map = generateSample(kind(), {.refine = 3, .charts = charts, .jitter = 0.6}).map;
    const Analysis analysis(map);
    const Prepared prepared(map);
    for (Index v = 0; v < map.points.size(); ++v) {
      if (analysis.regular.isIrregular[v] != 0) continue;
      EXPECT_EQ(prepared.singularities().degree(v), 0);
      bool boundary = false;
      for (const adjacency::CornerIndex corner : prepared.topology().star(v)) {
        for (int face = 0; face < 4; ++face) {
          if (face == adjacency::localOf(corner)) continue;
          const adjacency::HalfFace halfFace = adjacency::halfFaceOf(corner / 4, face);
          boundary = boundary || analysis.topology.isBoundary(halfFace);
          EXPECT_FALSE(prepared.transitions().isNonTrivial(halfFace));
        }
      }
      EXPECT_EQ(analysis.regular.plane[v] != 0, boundary);
    }
  }
}

/// Calls f(map, charts, noise) for samples with all styles of charts, exact ones and noisy ones.
template <class F>
void forEachChartStyle(SampleKind kind, const F& f) {
  for (const ChartStyle charts : test::kChartStyles) {
    for (const double noise : {0.0, 1e-4}) {
      f(generateSample(kind, {.refine = 3, .charts = charts, .jitter = 0.6, .noise = noise}).map,
        charts, noise);
    }
  }
}

/// Regular vertices take another path through sanitization: with all vertices declared irregular,
/// the result must be the same, bit for bit.
TEST_P(RegularVerticesOfKind, AreSanitizedAsTheirStarsAre) {
  forEachChartStyle(kind(), [](const TetMap& map, ChartStyle charts, double noise) {
    const auto sanitized = [&](bool allIrregular) {
      Analysis analysis(map);
      if (allIrregular) {
        for (std::uint8_t& isIrregular : analysis.regular.isIrregular) isIrregular = 1;
      }
      Stars stars(analysis, allIrregular);
      EXPECT_TRUE(stars.transitions.misfits.empty());
      const bool flat = std::ranges::count(stars.vertices.kind, VertexKind::Flat) > 0;
      if (allIrregular || noise > 0) {
        EXPECT_FALSE(flat);
      }
      if (!allIrregular && noise == 0 && charts != ChartStyle::Aligned) {
        EXPECT_TRUE(flat);
      }
      const auto singularities = stars.singularities(analysis);
      ExactMap exact = sanitize(analysis.topology, analysis.parameters,
                                std::move(stars.transitions), analysis.regular, stars.vertices,
                                singularities.value(), 0.1, 1, analysis.stage, analysis.defects);
      EXPECT_TRUE(analysis.defects.empty());
      return std::pair(std::move(exact), singularities->edges.size());
    };
    const auto [fast, fastEdges] = sanitized(false);
    const auto [slow, slowEdges] = sanitized(true);
    EXPECT_EQ(fast.corners, slow.corners);
    EXPECT_EQ(fast.maxDisplacement, slow.maxDisplacement);
    EXPECT_EQ(fastEdges, slowEdges);
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, RegularVerticesOfKind, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

/// A fan of tets around an edge along the third axis, closed after `turns` turns in one chart: a
/// double cone over a polygon of 5 * turns corners.
TetMap windingFan(int turns, double angle) {
  TetMap map;
  const int corners = 5 * turns;
  map.points = {{0, 0, 0}, {0, 0, 1}};
  std::vector<Vec3> parameters = map.points;
  for (int i = 0; i < corners; ++i) {
    const double phi = angle + 2 * std::numbers::pi * i / 5;
    parameters.push_back({2 * std::cos(phi), 2 * std::sin(phi), 0.5});
    // In space, the same corners around once.
    const double psi = 2 * std::numbers::pi * i / corners;
    map.points.push_back({std::cos(psi), std::sin(psi), 0.5});
  }
  for (Index i = 0; i < static_cast<Index>(corners); ++i) {
    const Tet tet = {0, 2 + i, 2 + (i + 1) % static_cast<Index>(corners), 1};
    map.tets.push_back(tet);
    map.parameters.push_back(
        {parameters[tet[0]], parameters[tet[1]], parameters[tet[2]], parameters[tet[3]]});
  }
  return map;
}

TEST(RegularVertices, TurnsInOneChartAreCounted) {
  for (const int turns : {1, 2, 3}) {
    for (const double angle : {0.0, 0.1, 1.0, 3.0}) {
      const TetMap map = windingFan(turns, angle);
      Analysis analysis(map);
      ASSERT_TRUE(analysis.defects.empty());
      const auto singularities = Stars(analysis).singularities(analysis);
      ASSERT_TRUE(singularities.has_value());
      int valence = 4;
      for (const SingularEdge& edge : singularities->edges) {
        if (edge.boundary) continue;
        EXPECT_EQ(edge.vertex0, 0U);
        EXPECT_EQ(edge.vertex1, 1U);
        valence = edge.valence;
      }
      EXPECT_EQ(valence, 4 * turns);
    }
  }
}

/// Which vertices have stars that are flat, but not regular.
std::vector<Index> flatVertices(const TetMap& map) {
  Analysis analysis(map);
  EXPECT_TRUE(analysis.defects.empty());
  const Stars stars(analysis);
  std::vector<Index> flat;
  for (Index v = 0; v < map.points.size(); ++v) {
    if (stars.vertices.kind[v] == VertexKind::Flat) flat.push_back(v);
  }
  return flat;
}

/// A cube of side 2 around vertex 0, in tets between the centre and halves of the faces' quarters.
TetMap centredCube() {
  std::vector<Vec3> points = {{0, 0, 0}};
  const auto at = [&](int x, int y, int z) {
    const Vec3 p = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    const auto found = std::find(points.begin(), points.end(), p);
    if (found == points.end()) points.push_back(p);
    return static_cast<Index>(std::find(points.begin(), points.end(), p) - points.begin());
  };
  std::vector<Tet> tets;
  for (const int s : {-1, 1}) {
    for (const int y : {-1, 0}) {
      for (const int z : {-1, 0}) {
        for (int turn = 0; turn < 3; ++turn) {
          std::array<std::array<int, 3>, 4> quad = {
              {{s, y, z}, {s, y + 1, z}, {s, y + 1, z + 1}, {s, y, z + 1}}};
          for (std::array<int, 3>& p : quad) {
            std::rotate(p.begin(), p.begin() + turn, p.end());
          }
          std::array<Index, 4> q{};
          for (std::size_t i = 0; i < 4; ++i) q[i] = at(quad[i][0], quad[i][1], quad[i][2]);
          if (s < 0) std::swap(q[1], q[3]);
          tets.push_back({0, q[0], q[1], q[2]});
          tets.push_back({0, q[0], q[2], q[3]});
        }
      }
    }
  }
  return test::identityMap(points, tets);
}

Vec3 meanOf(const TetParameters& corners) {
  Vec3 sum{};
  for (const Vec3& u : corners) sum = plus(sum, u);
  return {sum[0] / 4, sum[1] / 4, sum[2] / 4};
}

/// The tets of a map with certain centres.
template <class Keep>
TetMap partOf(const TetMap& map, const Keep& keep) {
  TetMap part = map;
  part.tets.clear();
  part.parameters.clear();
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (!keep(meanOf(map.parameters[t]))) continue;
    part.tets.push_back(map.tets[t]);
    part.parameters.push_back(map.parameters[t]);
  }
  return part;
}

bool isRegular(const TetMap& map, Index vertex) {
  const Analysis analysis(map);
  EXPECT_TRUE(analysis.defects.empty());
  return analysis.regular.isIrregular[vertex] == 0;
}

TEST(RegularVertices, OfTheBoundaryAreOnOneSideOfOnePlane) {
  const TetMap cube = centredCube();
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double side : {-1.0, 1.0}) {
      EXPECT_TRUE(isRegular(partOf(cube, [&](const Vec3& u) { return side * u[k] > 0; }), 0));
      for (const double other : {-1.0, 1.0}) {
        const std::size_t l = (k + 1) % 3;
        const auto isIn = [&](const Vec3& u) { return side * u[k] > 0 && other * u[l] > 0; };
        EXPECT_FALSE(isRegular(partOf(cube, isIn), 0));
        EXPECT_FALSE(isRegular(partOf(cube, [&](const Vec3& u) { return !isIn(u); }), 0));
      }
    }
  }
}

TEST(RegularVertices, AreNotWhereASlitEnds) {
  // Cut open along half a plane, the star is on both sides of it.
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double side : {-1.0, 1.0}) {
      TetMap map = centredCube();
      const std::size_t l = (k + 1) % 3;
      const auto pointsBefore = static_cast<Index>(map.points.size());
      for (Index v = 0; v < pointsBefore; ++v) map.points.push_back(map.points[v]);
      for (std::size_t t = 0; t < map.tets.size(); ++t) {
        if (meanOf(map.parameters[t])[k] < 0) continue;
        for (Index& v : map.tets[t]) {
          if (map.points[v][k] == 0 && side * map.points[v][l] > 0) v += pointsBefore;
        }
      }
      EXPECT_FALSE(isRegular(map, 0));
    }
  }
}

/// Rotates by a quarter turn about the third axis, and translates.
void changeChart(TetParameters& parameters, double translation) {
  for (Vec3& u : parameters) u = {-u[1] + translation, u[0], u[2] - translation};
}

TEST(FlatStars, AreThoseOfExactTransitionsWithoutHolonomy) {
  const TetMap regular = centredCube();
  EXPECT_EQ(std::ranges::count(flatVertices(regular), 0U), 0);  // but regular

  TetMap flat = regular;
  for (const std::size_t t : {3U, 8U, 20U, 21U}) changeChart(flat.parameters[t], 3);
  EXPECT_EQ(std::ranges::count(flatVertices(flat), 0U), 1);

  TetMap rounded = flat;
  rounded.parameters[8][0][0] += 0x1p-50;
  EXPECT_EQ(std::ranges::count(flatVertices(rounded), 0U), 0);

  // 0 + 3 was rounded here: the sum is right, but the numbers differ.
  TetMap cancelled = flat;
  for (std::size_t t = 0; t < cancelled.tets.size(); ++t) {
    if (t != 3 && t != 8 && t != 20 && t != 21) cancelled.parameters[t][0][1] = 1e-20;
  }
  EXPECT_EQ(std::ranges::count(flatVertices(cancelled), 0U), 0);
}

TEST(FlatStars, OfTheBoundaryLieInOnePlane) {
  // What is left of the star on one side of a plane, or of two.
  const TetMap cube = centredCube();
  const auto part = [&](auto keep) {
    TetMap map = partOf(cube, keep);
    for (std::size_t t = 2; t < map.tets.size(); t += 3) changeChart(map.parameters[t], 5);
    return map;
  };
  const TetMap half = part([](const Vec3& u) { return u[0] > 0; });
  EXPECT_EQ(std::ranges::count(flatVertices(half), 0U), 1);
  const TetMap quarter = part([](const Vec3& u) { return u[0] > 0 && u[1] > 0; });
  EXPECT_EQ(std::ranges::count(flatVertices(quarter), 0U), 0);
  const TetMap rest = part([](const Vec3& u) { return u[0] > 0 || u[1] > 0; });
  EXPECT_EQ(std::ranges::count(flatVertices(rest), 0U), 0);

  TetMap between = half;  // halfway between two planes, where rounding depends on the chart
  for (TetParameters& parameters : between.parameters) {
    for (Vec3& u : parameters) u = {u[0] + 0.5, u[1] + 0.5, u[2]};
  }
  EXPECT_EQ(std::ranges::count(flatVertices(between), 0U), 0);
}

TEST(TetSides, ConesOfACornerCoverADirectionOnce) {
  // Any positive tet: the direction leads into it from at most one corner, inward from at least one
  // face and outward from at least one; mirrored twice it is the same.
  const bool passed = rc::check([] {
    TetParameters u{};
    for (Vec3& corner : u) {
      for (double& x : corner) x = *rc::gen::inRange(-50, 51) * 0.125;
    }
    if (test::determinant(u) < 0) std::swap(u[2], u[3]);
    const bool degenerate = test::determinant(u) == 0;
    for (const unsigned mirror : {0U, 1U, 2U, 4U}) {
      const std::size_t axis = mirror / 2;
      const TetSides sides = sidesOf(u, kRays[0][mirror == 0 ? kNoReflection : axis]);
      RC_ASSERT((sides == kUncertainSides) == degenerate);
      if (degenerate) continue;
      RC_ASSERT(sides > 0 && sides < 15);
      // Mirroring the tet instead, which swaps its orientation, gives the same.
      TetParameters mirrored = u;
      for (Vec3& corner : mirrored) {
        for (std::size_t k = 0; k < 3; ++k) {
          if ((mirror >> k) & 1U) corner[k] = -corner[k];
        }
      }
      if (mirror == 0) continue;
      std::swap(mirrored[2], mirrored[3]);
      const TetSides swapped = sidesOf(mirrored);
      RC_ASSERT((sides & 3) == (swapped & 3));
      RC_ASSERT(((sides >> 2) & 1) == ((swapped >> 3) & 1));
      RC_ASSERT(((sides >> 3) & 1) == ((swapped >> 2) & 1));
    }
  });
  EXPECT_TRUE(passed);
}

TEST(TetSides, NegativeTetsAreUncertain) {
  TetParameters u = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  EXPECT_NE(sidesOf(u), kUncertainSides);
  std::swap(u[0], u[1]);
  EXPECT_EQ(sidesOf(u), kUncertainSides);
  u.fill({1, 2, 3});
  EXPECT_EQ(sidesOf(u), kUncertainSides);
}

}  // namespace
}  // namespace hexhex::igm
