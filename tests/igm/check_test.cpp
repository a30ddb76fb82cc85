// check(): what it tells about valid maps, and that every defect is found where it is.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <rapidcheck.h>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>
#include <hexhex/io.hpp>

#include "map_samples.hpp"
#include "support/error_of.hpp"
#include "support/joined_maps.hpp"

namespace hexhex::igm {
namespace {

using test::moveParameters;
using test::Prepared;

class CheckKind : public test::EveryKind {};

void expectExpectation(const Expectation& found, const Expectation& atScale1, int scale = 1) {
  const auto s = static_cast<std::uint64_t>(scale);
  const auto times = [s](std::map<int, std::uint64_t> counts) {
    for (auto& [valence, count] : counts) count *= s;
    return counts;
  };
  EXPECT_EQ(found.cells, atScale1.cells * s * s * s);
  EXPECT_EQ(found.boundaryQuads, atScale1.boundaryQuads * s * s);
  EXPECT_EQ(found.innerSingularEdges, times(atScale1.innerSingularEdges));
  EXPECT_EQ(found.boundarySingularEdges, times(atScale1.boundarySingularEdges));
  EXPECT_EQ(found.eulerCharacteristic, atScale1.eulerCharacteristic);
  EXPECT_EQ(found.components, atScale1.components);
  EXPECT_EQ(found.boundaryComponents, atScale1.boundaryComponents);
}

/// The map is valid, and what is expected of it is the sample's answer.
CheckReport expectValid(const TetMap& map, const Expectation& answer) {
  const CheckReport report = check(map);
  EXPECT_TRUE(report.valid()) << (report.valid() ? "" : report.defects[0].sentence);
  expectExpectation(report.expected, answer);
  return report;
}

const Defect* find(const CheckReport& report, ErrorCode code) {
  for (const Defect& defect : report.defects) {
    if (defect.code == code) return &defect;
  }
  return nullptr;
}

TEST_P(CheckKind, ExpectsTheSamplesAnswerAtAnyScale) {
  for (const ChartStyle charts : test::kChartStyles) {
    for (const double noise : {0.0, 1e-3}) {
      const Sample sample =
          generateSample(kind(), {.charts = charts, .jitter = 0.3, .noise = noise});
      for (const int scale : {1, 2, 3, 100}) {
        const CheckReport report = check(sample.map, {.scale = scale});
        ASSERT_TRUE(report.valid());
        expectExpectation(report.expected, sample.answer.expected, scale);
      }
    }
  }
}

TEST_P(CheckKind, ReportsThePlainCase) {
  const Sample sample = generateSample(kind());
  const CheckReport report = check(sample.map);
  EXPECT_EQ(report.points, sample.map.points.size());
  EXPECT_EQ(report.tets, sample.map.tets.size());
  EXPECT_EQ(report.isolatedVertices, 0U);
  EXPECT_EQ(report.tetsInvertedInSpace, 0U);
  EXPECT_FALSE(report.mirrored);
  EXPECT_FALSE(report.cornersReversed);
  EXPECT_EQ(report.maxTransitionResidual, 0);
  EXPECT_EQ(report.maxDisplacement, 0);
}

TetMap mirrored(TetMap map) {
  for (TetParameters& tet : map.parameters) {
    for (Vec3& corner : tet) corner[0] = -corner[0];
  }
  return map;
}

TetMap reversed(TetMap map) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::swap(map.tets[t][2], map.tets[t][3]);
    std::swap(map.parameters[t][2], map.parameters[t][3]);
  }
  return map;
}

TEST_P(CheckKind, UnderstandsMirroredMapsAndReversedCorners) {
  for (const ChartStyle charts : test::kChartStyles) {
    const Sample sample = generateSample(kind(), {.charts = charts, .jitter = 0.3});
    const Expectation& answer = sample.answer.expected;
    const CheckReport mirror = expectValid(mirrored(sample.map), answer);
    EXPECT_TRUE(mirror.mirrored);
    EXPECT_FALSE(mirror.cornersReversed);
    const CheckReport reverse = expectValid(reversed(sample.map), answer);
    EXPECT_FALSE(reverse.mirrored);
    EXPECT_TRUE(reverse.cornersReversed);
    const CheckReport both = expectValid(reversed(mirrored(sample.map)), answer);
    EXPECT_TRUE(both.mirrored);
    EXPECT_TRUE(both.cornersReversed);
  }
}

TEST_P(CheckKind, CountsIsolatedVertices) {
  Sample sample = generateSample(kind());
  // In front, so that all other vertices are renumbered, and at the end.
  sample.map.points.insert(sample.map.points.begin(), Vec3{9, 9, 9});
  sample.map.points.insert(sample.map.points.end(), 2, Vec3{-9, 9, 9});
  for (Tet& tet : sample.map.tets) {
    for (Index& vertex : tet) ++vertex;
  }
  EXPECT_EQ(expectValid(sample.map, sample.answer.expected).isolatedVertices, 3U);
}

/// Whether a vertex is the middle of a sub-block: it has 12 tets, all in one chart, and none of
/// them has a boundary face at the vertex.
bool isCentre(const adjacency::TetTopology& topology, Index v) {
  const std::span<const adjacency::CornerIndex> star = topology.star(v);
  return star.size() == 12 &&
         std::all_of(star.begin(), star.end(), [&](adjacency::CornerIndex corner) {
           for (int face = 0; face < 4; ++face) {
             if (face != adjacency::localOf(corner) &&
                 topology.isBoundary(adjacency::halfFaceOf(corner / 4, face))) {
               return false;
             }
           }
           return true;
         });
}

Index centreVertex(const TetMap& map) {
  const Prepared prepared(map);
  Index v = 0;
  while (!isCentre(prepared.topology(), v)) ++v;
  return v;
}

TEST_P(CheckKind, OnlyWarnsOfTetsInvertedInSpace) {
  Sample sample = generateSample(kind());
  Vec3& centre = sample.map.points[centreVertex(sample.map)];
  centre = {centre[0] + 100, centre[1], centre[2]};
  const CheckReport report = expectValid(sample.map, sample.answer.expected);
  EXPECT_GE(report.tetsInvertedInSpace, 2U);
  EXPECT_LE(report.tetsInvertedInSpace, 10U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CheckKind, testing::ValuesIn(sampleKinds()), test::kindTestName);

TEST(Check, TellsTheGenusOfEachBoundaryComponent) {
  const std::map<SampleKind, std::vector<std::int64_t>> genus = {
      {SampleKind::Box, {0}},         {SampleKind::Cylinder, {0}},  {SampleKind::Sphere, {0}},
      {SampleKind::Star, {0}},        {SampleKind::Torus, {1}},     {SampleKind::Shell, {0, 0}},
      {SampleKind::Tetrahedron, {0}}, {SampleKind::HandleBody, {2}}};
  for (const auto& [kind, expected] : genus) {
    EXPECT_EQ(check(generateSample(kind).map).boundaryGenus, expected);
  }
}

TEST(Check, AddsUpComponents) {
  const Sample torus = generateSample(SampleKind::Torus);
  const Sample shell = generateSample(SampleKind::Shell);
  const CheckReport report = check(test::joined(torus.map, shell.map));
  ASSERT_TRUE(report.valid());
  EXPECT_EQ(report.boundaryGenus, (std::vector<std::int64_t>{1, 0, 0}));
  EXPECT_EQ(report.expected.components, 2U);
  EXPECT_EQ(report.expected.boundaryComponents, 3U);
  EXPECT_EQ(report.expected.cells, torus.answer.expected.cells + shell.answer.expected.cells);
  EXPECT_EQ(report.expected.eulerCharacteristic, 2);
}

/// Tets without positive volume in the map.
std::set<std::uint64_t> flippedTets(const TetMap& map) {
  std::set<std::uint64_t> flipped;
  for (std::size_t t = 0; t < map.parameters.size(); ++t) {
    if (test::determinant(map.parameters[t]) <= 0) flipped.insert(t);
  }
  return flipped;
}

void expectFlipped(const TetMap& map) {
  const std::set<std::uint64_t> flipped = flippedTets(map);
  const CheckReport report = check(map);
  // Dihedral angles of flipped tets may not add up, so that there can be other defects as well.
  ASSERT_NE(find(report, ErrorCode::FlippedTet), nullptr);
  const Defect& defect = *find(report, ErrorCode::FlippedTet);
  EXPECT_EQ(defect.count, flipped.size());
  EXPECT_EQ(defect.worst.size(), std::min<std::size_t>(10, flipped.size()));
  for (std::size_t i = 0; i < defect.worst.size(); ++i) {
    const Defect::Occurrence& found = defect.worst[i];
    EXPECT_EQ(found.place.kind, PlaceKind::Tet);
    ASSERT_TRUE(flipped.contains(found.place.index));
    EXPECT_NEAR(found.amount, -test::determinant(map.parameters[found.place.index]) / 6, 1e-12);
    if (i > 0) {
      EXPECT_GE(defect.worst[i - 1].amount, found.amount);
    }
  }
}

TEST(Check, FindsFlippedTets) {
  TetMap map = generateSample(SampleKind::Box).map;          // sub-blocks of length 2
  moveParameters(map, centreVertex(map), {1.1, 0.5, 0.25});  // through its wall
  EXPECT_EQ(flippedTets(map).size(), 2U);
  expectFlipped(map);
}

TEST(Check, KeepsTheTenWorstOfManyFlippedTets) {
  TetMap map = generateSample(SampleKind::Box, {.refine = 3}).map;
  const Prepared prepared(map);
  for (Index v = 0; v < map.points.size(); ++v) {
    // Every other centre, by a distance of its own, through the wall of its sub-block.
    if (v % 2 == 0 || !isCentre(prepared.topology(), v)) continue;
    moveParameters(map, v, {0.7 + 0.0001 * v, 0, 0});
  }
  ASSERT_GT(flippedTets(map).size(), 20U);
  expectFlipped(map);
}

TEST(Check, FindsDegenerateTets) {
  TetMap map = generateSample(SampleKind::Box).map;
  moveParameters(map, centreVertex(map), {1, 0.5, 0.25});  // into a triangle of its wall
  EXPECT_EQ(flippedTets(map).size(), 2U);
  expectFlipped(map);
  const CheckReport report = check(map);
  EXPECT_EQ(report.defects.size(), 1U);
  EXPECT_EQ(report.defects[0].worst[0].amount, 0);
}

/// A vertex inside a wall of a box: not on an edge of the box, but on its boundary.
struct WallVertex {
  Index vertex = kNone;
  std::size_t axis = 0;   ///< across the wall
  std::size_t faces = 0;  ///< boundary triangles at it
};

std::vector<WallVertex> wallVertices(const TetMap& map, const Prepared& prepared) {
  const adjacency::TetTopology& topology = prepared.topology();
  std::vector<WallVertex> found;
  for (Index v = 0; v < map.points.size(); ++v) {
    if (prepared.singularities().degree(v) != 0) continue;
    WallVertex wall;
    for (const adjacency::CornerIndex corner : topology.star(v)) {
      for (const adjacency::HalfFace face : {0U, 1U, 2U, 3U}) {
        if (face == corner % 4 || !topology.isBoundary(4 * (corner / 4) + face)) continue;
        wall.vertex = v;
        ++wall.faces;
        const TetParameters& u = map.parameters[corner / 4];
        const std::array<int, 3>& local = lattice::kFaceCorners[face];
        const auto at = [&](std::size_t k, std::size_t a) {
          return u[static_cast<std::size_t>(local[k])][a];
        };
        for (std::size_t a = 0; a < 3; ++a) {
          if (at(0, a) == at(1, a) && at(0, a) == at(2, a)) wall.axis = a;
        }
      }
    }
    if (wall.vertex != kNone) found.push_back(wall);
  }
  return found;
}

/// Wherever a vertex is among the corners of its triangles.
TEST(Check, FindsEveryVertexOffItsWall) {
  const TetMap sound = generateSample(SampleKind::Box, {.jitter = 0.3}).map;
  const Prepared before(sound);
  const std::vector<WallVertex> walls = wallVertices(sound, before);
  ASSERT_GT(walls.size(), 5U);
  for (const auto& [vertex, axis, faces] : walls) {
    SCOPED_TRACE(vertex);
    TetMap map = sound;
    Vec3 shift{};
    shift[axis] = -0.1;
    moveParameters(map, vertex, shift);
    const CheckReport report = check(map);
    const Defect* const defect = find(report, ErrorCode::BoundaryOffLattice);
    ASSERT_NE(defect, nullptr);
    EXPECT_EQ(defect->count, faces + 1);  // its triangles, and the vertex itself
  }
}

TEST(Check, FindsTheBoundaryOffTheLattice) {
  TetMap map = generateSample(SampleKind::Box).map;
  const Prepared before(map);
  const adjacency::TetTopology& topology = before.topology();
  const std::vector<WallVertex> walls = wallVertices(map, before);
  ASSERT_FALSE(walls.empty());
  const auto& [vertex, axis, faces] = walls.front();
  Vec3 shift{};
  shift[axis] = 0.1;
  moveParameters(map, vertex, shift);

  const CheckReport report = check(map);
  const Defect* defect = find(report, ErrorCode::BoundaryOffLattice);
  ASSERT_NE(defect, nullptr);
  EXPECT_EQ(defect->count, faces + 1);  // its triangles, and the vertex itself
  std::size_t vertices = 0;
  for (const Defect::Occurrence& found : defect->worst) {
    EXPECT_NEAR(found.amount, 0.1, 1e-12);
    if (found.place.kind == PlaceKind::Vertex) {
      EXPECT_EQ(found.place.index, vertex);
      ++vertices;
      continue;
    }
    ASSERT_EQ(found.place.kind, PlaceKind::Face);
    EXPECT_NE(map.tets[found.place.index][found.place.second], vertex);
    EXPECT_TRUE(topology.isBoundary(
        static_cast<adjacency::HalfFace>(4 * found.place.index + found.place.second)));
  }
  EXPECT_EQ(vertices, 1U);
  EXPECT_TRUE(check(map, {.tolerance = 0.11}).valid());
}

/// What finds regular vertices fast may be left out, also where vertices have no tets.
TEST(Check, FindsTheSameWithoutShortcuts) {
  for (const ChartStyle charts : {ChartStyle::Aligned, ChartStyle::Random}) {
    TetMap map = generateSample(SampleKind::Sphere, {.charts = charts, .noise = 1e-4}).map;
    const Index last = static_cast<Index>(map.points.size()) - 1;
    map.points.push_back({7, 7, 7});
    std::swap(map.points[0], map.points.back());
    for (Tet& tet : map.tets) {
      for (Index& v : tet) v = v == 0 ? last + 1 : v;
    }
    EngineSwitches slow;
    slow.regularVertices = false;
    Context context;
    DefectCollector defects;
    const PreparedMap expected =
        prepareMap(map, 1e-2, 1, context, defects, ChartChoice::AsGiven, slow);
    ASSERT_TRUE(defects.empty());
    const Prepared found(map);
    EXPECT_EQ(found.exact().corners, expected.exact.corners);
    EXPECT_EQ(found.singularities().edges.size(), expected.singularities.edges.size());
  }
}

/// Whichever corner it is, and in whichever direction.
TEST(Check, FindsTheOneCornerThatIsTooFarAway) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double far : {0x1p30, -0x1p30}) {
        TetMap map =
            test::identityMap({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
        map.parameters[0][corner][axis] = far;
        EXPECT_NE(find(check(map), ErrorCode::TooLarge), nullptr);
      }
    }
  }
}

/// In terms of the caller's corners, also if those are reversed.
TEST(Check, NamesFacesOfReversedTetsAsTheCallerDoes) {
  TetMap map = generateSample(SampleKind::Box).map;
  for (TetParameters& tet : map.parameters) {
    for (Vec3& corner : tet) corner[0] *= 1.025;  // the wall at 8 moves to 8.2
  }
  const auto places = [](const TetMap& of) {
    std::set<std::vector<Index>> triangles;
    const CheckReport report = check(of);
    const Defect* defect = find(report, ErrorCode::BoundaryOffLattice);
    if (defect == nullptr) return triangles;
    for (const Defect::Occurrence& found : defect->worst) {
      std::vector<Index> triangle;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != found.place.second) triangle.push_back(of.tets[found.place.index][i]);
      }
      std::sort(triangle.begin(), triangle.end());
      triangles.insert(triangle);
    }
    return triangles;
  };
  EXPECT_FALSE(places(map).empty());
  EXPECT_EQ(places(reversed(map)), places(map));
}

TEST(Check, FindsASingularVertexOffItsLine) {
  TetMap map = generateSample(SampleKind::Star).map;
  const Prepared before(map);
  const std::vector<SingularEdge>& edges = before.singularities().edges;
  const auto inner =
      std::find_if(edges.begin(), edges.end(), [](const SingularEdge& e) { return !e.boundary; });
  ASSERT_NE(inner, edges.end());
  const bool firstIsNode = before.singularities().isNode(inner->vertex0);
  moveParameters(map, firstIsNode ? inner->vertex1 : inner->vertex0, {0.1, 0.1, 0.1});
  const CheckReport report = check(map);
  const Defect* defect = find(report, ErrorCode::SingularityOffLattice);
  ASSERT_NE(defect, nullptr);
  EXPECT_EQ(defect->worst[0].place.kind, PlaceKind::Edge);
  EXPECT_NEAR(defect->worst[0].amount, 0.1, 1e-9);
}

/// Where the inner singular line of an aligned star is, in each tet's chart, and along which axis
/// it runs. All blocks contain the line; a chart is that of a block.
struct StarLine {
  std::size_t along = 0;
  Vec3 position{};
  bool sameInAllCharts = true;
};

StarLine lineOfStar(const TetMap& map) {
  const Prepared prepared(map);
  StarLine line;
  bool first = true;
  std::vector<adjacency::EdgeCorner> scratch;
  for (const SingularEdge& edge : prepared.singularities().edges) {
    if (edge.boundary) continue;
    adjacency::forEachEdge(prepared.topology(), edge.vertex0, scratch,
                           [&](Index w, std::span<const adjacency::EdgeCorner> fan) {
                             if (w != edge.vertex1) return;
                             for (const adjacency::EdgeCorner& at : fan) {
                               const Vec3& p = map.parameters[at.tet][at.corner0];
                               const Vec3& q = map.parameters[at.tet][at.corner1];
                               std::size_t along = 0;
                               while (p[along] == q[along]) ++along;
                               Vec3 position = p;
                               position[along] = 0;
                               if (first) {
                                 line.along = along;
                                 line.position = position;
                               }
                               first = false;
                               line.sameInAllCharts = line.sameInAllCharts && line.along == along &&
                                                      line.position == position;
                             }
                           });
  }
  return line;
}

/// The column grows by half a unit across its line, which moves to half-integers: charts still
/// differ by automorphisms, and the boundary is still at integers.
TEST(Check, FindsASingularLineAtHalfIntegers) {
  for (const int valence : {3, 5, 6}) {
    SCOPED_TRACE(valence);
    TetMap map = generateSample(SampleKind::Star, {.valence = valence}).map;
    const StarLine line = lineOfStar(map);
    ASSERT_TRUE(line.sameInAllCharts);
    const double cells = 4;
    for (TetParameters& tet : map.parameters) {
      for (Vec3& u : tet) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (k == line.along) continue;
          u[k] = line.position[k] + 0.5 + (u[k] - line.position[k]) * (cells + 0.5) / cells;
        }
      }
    }
    const CheckReport report = check(map);
    EXPECT_LT(report.maxTransitionResidual, 1e-12);
    EXPECT_EQ(find(report, ErrorCode::BoundaryOffLattice), nullptr);
    const Defect* defect = find(report, ErrorCode::SingularityOffLattice);
    ASSERT_NE(defect, nullptr);
    EXPECT_EQ(defect->count, 5U);  // both tet edges of the line, and their three vertices
    EXPECT_DOUBLE_EQ(defect->worst[0].amount, 0.5);
    EXPECT_NE(find(report, ErrorCode::HalfIntegerFixedPoint), nullptr);
  }
}

/// The same line when the caller denies that it is singular: only its fixed points give it away.
TEST(Check, FindsHalfIntegerFixedPointsOfADeniedLine) {
  TetMap map = generateSample(SampleKind::Star).map;
  const Prepared before(map);
  std::vector<EdgeValence> boundaryOnly;
  for (const SingularEdge& edge : before.singularities().edges) {
    if (edge.boundary) boundaryOnly.push_back({edge.vertex0, edge.vertex1, edge.valence - 2});
  }
  TetMapView view(map);
  view.edgeValences = boundaryOnly;
  // On integers, the line does no harm; the corners are consistent.
  EXPECT_TRUE(check(view).valid());

  const StarLine line = lineOfStar(map);
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) {
      for (std::size_t k = 0; k < 3; ++k) u[k] += k == line.along ? 0 : 0.001;
    }
  }
  const CheckReport report = check(view);
  EXPECT_NE(find(report, ErrorCode::HalfIntegerFixedPoint), nullptr);
}

TEST(Check, RejectsArgumentsOutOfRange) {
  const TetMap map = generateSample(SampleKind::Box).map;
  const auto codeOf = [](const TetMapView& view, const CheckOptions& options) {
    return test::codeOf([&] { static_cast<void>(check(view, options)); });
  };
  for (const double tolerance : {std::numeric_limits<double>::quiet_NaN(), -1.0, 0.25, 1e300}) {
    EXPECT_EQ(codeOf(map, {.tolerance = tolerance}), ErrorCode::InvalidArgument);
  }
  for (const int scale : {0, -1, std::numeric_limits<int>::min()}) {
    EXPECT_EQ(codeOf(map, {.scale = scale}), ErrorCode::InvalidArgument);
  }
  TetMap shortOfParameters = map;
  shortOfParameters.parameters.pop_back();
  EXPECT_EQ(codeOf(shortOfParameters, {}), ErrorCode::InvalidArgument);
  const std::vector<std::array<std::int8_t, 4>> tooFew(map.tets.size() - 1);
  TetMapView view(map);
  view.rotations = tooFew;
  EXPECT_EQ(codeOf(view, {}), ErrorCode::InvalidArgument);
  EXPECT_TRUE(check(map, {.tolerance = 0}).valid());
}

TEST(Check, StopsWhenAsked) {
  const TetMap map = generateSample(SampleKind::Box).map;
  Context context;
  context.cancel();
  try {
    (void)check(map, {}, context);
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(Check, DefectsDoNotDependOnThreads) {
  TetMap map = generateSample(SampleKind::Sphere, {.refine = 8, .jitter = 1}).map;
  for (std::size_t t = 0; t < map.parameters.size(); t += 3) {
    std::swap(map.parameters[t][0], map.parameters[t][1]);
  }
  Context one(1);
  Context two(2);
  const CheckReport a = check(map, {}, one);
  const CheckReport b = check(map, {}, two);
  ASSERT_FALSE(a.valid());
  ASSERT_EQ(a.defects.size(), b.defects.size());
  for (std::size_t d = 0; d < a.defects.size(); ++d) {
    EXPECT_EQ(a.defects[d].code, b.defects[d].code);
    EXPECT_EQ(a.defects[d].count, b.defects[d].count);
    ASSERT_EQ(a.defects[d].worst.size(), b.defects[d].worst.size());
    for (std::size_t i = 0; i < a.defects[d].worst.size(); ++i) {
      EXPECT_EQ(a.defects[d].worst[i].amount, b.defects[d].worst[i].amount);
      EXPECT_EQ(toString(a.defects[d].worst[i].place), toString(b.defects[d].worst[i].place));
    }
  }
}

TEST(Check, RandomSamplesAreValidWithTheirAnswer) {
  const bool passed = rc::check([] {
    const auto kinds = sampleKinds();
    const auto kind = kinds[*rc::gen::inRange<std::size_t>(0, kinds.size())].kind;
    SampleOptions options;
    options.cells = *rc::gen::inRange(1, 9);
    options.refine = *rc::gen::inRange(1, 4);
    options.valence = *rc::gen::inRange(3, 13);
    options.charts = *rc::gen::elementOf(
        std::vector<ChartStyle>(std::begin(test::kChartStyles), std::end(test::kChartStyles)));
    options.jitter = *rc::gen::inRange(0, 11) / 10.0;
    options.onLattice = *rc::gen::inRange(0, 11) / 10.0;
    // Half of what the sample allows, and a transition's residual is at most four times the noise.
    options.noise = *rc::gen::inRange(0, 3) * 0.001 * options.cells / options.refine;
    options.offset = *rc::gen::inRange(0, 1000000000);
    options.seed = *rc::gen::arbitrary<std::uint64_t>();
    const int scale = *rc::gen::inRange(1, 5);
    const Sample sample = generateSample(kind, options);
    const CheckReport report = check(sample.map, {.tolerance = 0.1, .scale = scale});
    RC_ASSERT(report.valid());
    expectExpectation(report.expected, sample.answer.expected, scale);
    RC_ASSERT(!testing::Test::HasFailure());
  });
  EXPECT_TRUE(passed);
}

TEST(Check, RealDefectiveMapsHaveDefects) {
  const std::filesystem::path folder = std::filesystem::path(HEXHEX_DATA_DIR) / "defective";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "skipped: no " << folder;
  std::size_t maps = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".hexex") continue;
    SCOPED_TRACE(entry.path().filename());
    ++maps;
    const CheckReport report = check(readMap(entry.path()));
    const Defect* flipped = find(report, ErrorCode::FlippedTet);
    ASSERT_NE(flipped, nullptr);
    EXPECT_GE(flipped->count, 2U);
    EXPECT_FALSE(flipped->worst.empty());
  }
  EXPECT_GT(maps, 0U);
}

}  // namespace
}  // namespace hexhex::igm
