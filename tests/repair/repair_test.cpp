// Damaged maps: after a repair, the mesh must be that of the undamaged map.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <base/vector3.hpp>
#include <repair/valid_tets.hpp>

#include "extract/support.hpp"
#include "repair/same_connectivity.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using namespace repairs;

namespace {

/// Every corner at a vertex; in maps with one chart they have one parameter.
template <class Visit>
void forEachCornerAt(TetMap& map, Index vertex, const Visit& visit) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (map.tets[t][c] == vertex) visit(map.parameters[t][c]);
    }
  }
}

void expectRepaired(const TetMap& damaged, const TetMap& sound, bool round = false) {
  Context context;
  RepairReport report;
  RepairOptions options;
  options.round = round;
  const TetMap repaired = repair(damaged, options, context, &report);
  EXPECT_TRUE(report.changed);
  ASSERT_TRUE(check(repaired).valid());
  const HexMesh mesh = verifiedExtraction(repaired);
  EXPECT_TRUE(sameConnectivity(mesh, extract(sound)));
}

TetMap sample(SampleKind kind, const SampleOptions& options) {
  return generateSample(kind, options).map;
}

/// Number of boundary triangles at each vertex that lie in the plane u = 0, say.
std::vector<Index> verticesInsideFace(const TetMap& map, std::size_t axis, double value) {
  std::set<Index> inPlane;
  std::set<Index> otherwise;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3& u = map.parameters[t][c];
      int planes = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (u[k] == std::nearbyint(u[k]) && k != axis) ++planes;
      }
      if (u[axis] == value && planes == 0) inPlane.insert(map.tets[t][c]);
      if (u[axis] != value) otherwise.insert(map.tets[t][c]);
    }
  }
  std::vector<Index> result;
  for (const Index v : inPlane) {
    if (!otherwise.contains(v)) result.push_back(v);
  }
  return result;
}

TEST(Repair, LeavesAValidMapAlone) {
  const TetMap map = sample(SampleKind::Sphere, {});
  Context context;
  RepairReport report;
  const TetMap same = repair(map, {}, context, &report);
  EXPECT_FALSE(report.changed);
  EXPECT_EQ(same.parameters, map.parameters);
  EXPECT_EQ(same.tets, map.tets);
}

/// What the file knows of rotations and valences is used in the place of what damaged tets say.
TEST(Repair, BelievesWhatIsKnown) {
  if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  SampleOptions options;
  options.refine = 4;
  options.features = true;  // its curves are the edges of the box
  const TetMap sound = sample(SampleKind::Box, options);
  for (const DefectKind kind : {DefectKind::Interior, DefectKind::Singular}) {
    options.defects = 6;
    options.defectKind = kind;
    TetMap damaged = sample(SampleKind::Box, options);
    damaged.rotations.assign(damaged.tets.size(), {0, 0, 0, 0});
    for (const FeatureEdge& edge : damaged.features.edges) {
      damaged.edgeValences.push_back({edge.vertices[0], edge.vertices[1], -1});
    }
    expectRepaired(damaged, sound);
  }
}

class DamagedSamples : public ::testing::TestWithParam<DefectKind> {
 protected:
  void SetUp() override {
    if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  }
};

TEST_P(DamagedSamples, ComeOutRight) {
  for (int i = 0; i < cases(12); ++i) {
    SampleOptions options;
    options.cells = 1 + i % 3;
    options.refine = 2 + i % 3;
    options.valence = i % 2 == 0 ? 5 : 8;
    options.charts = static_cast<ChartStyle>(i % 4);
    options.jitter = 0.05 * i;
    options.offset = i % 4 == 0 ? 1e6 : 0;
    options.noise = i % 4 == 1 ? 1e-3 : 0;
    options.seed = static_cast<std::uint64_t>(i) + 1;
    const auto kind = sampleKinds()[static_cast<std::size_t>(i) % sampleKinds().size()].kind;
    const TetMap sound = sample(kind, options);
    options.defectKind = GetParam();
    options.defects = 1 + i;
    if (GetParam() == DefectKind::Singular && kind == SampleKind::Tetrahedron) continue;
    SCOPED_TRACE(nameOf(kind) + ", case " + std::to_string(i));
    const TetMap damaged = sample(kind, options);
    EXPECT_FALSE(check(damaged).valid());
    expectRepaired(damaged, sound);
  }
}

/// Everything but the damage fits exactly, and must. Four cells around an edge of valence 8 are as
/// much as no turn at all, so only angles tell that it is singular.
TEST_P(DamagedSamples, ComeOutRightWithoutAnyTolerance) {
  for (const SampleKind kind : {SampleKind::Box, SampleKind::Cylinder, SampleKind::Star}) {
    for (const int valence : {3, 5, 8}) {
      SampleOptions options;
      options.valence = valence;
      options.refine = 3;
      options.charts = ChartStyle::Random;
      const HexMesh wanted = extract(sample(kind, options));
      options.defectKind = GetParam();
      options.defects = 3;
      SCOPED_TRACE(nameOf(kind) + ", valence " + std::to_string(valence));
      Context context;
      const TetMap repaired = repair(sample(kind, options), {.tolerance = 0}, context);
      EXPECT_TRUE(sameConnectivity(verifiedExtraction(repaired, {.tolerance = 0}), wanted));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamagedSamples,
                         ::testing::Values(DefectKind::Interior, DefectKind::Singular,
                                           DefectKind::Boundary, DefectKind::Sliver));

class Repairs : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  }

  static TetMap damaged(int defects = 6, int cells = 4) {
    SampleOptions options;
    options.cells = cells;
    options.refine = 4;
    options.defects = defects;
    options.charts = ChartStyle::Random;
    return sample(SampleKind::Sphere, options);
  }
};

/// The mean of the vertices of all tets without positive volume, in space.
Vec3 middleOfBadTets(const TetMap& map) {
  Vec3 sum{};
  double vertices = 0;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (determinantOf(map.parameters[t]) > 0) continue;
    vertices += 4;
    for (const Index v : map.tets[t]) sum = plus(sum, map.points[v]);
  }
  for (double& x : sum) x /= vertices;
  return sum;
}

/// What changes is what the report says, in one patch.
void expectReportOf(const TetMap& before) {
  Context context;
  RepairReport report;
  const TetMap after = repair(before, {}, context, &report);
  ASSERT_EQ(report.regions.size(), 1U);
  EXPECT_EQ(after.points, before.points);
  EXPECT_EQ(after.tets, before.tets);
  std::set<Index> moved;
  std::set<Index> tets;
  double largest = 0;
  for (std::size_t t = 0; t < before.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (before.parameters[t][c] == after.parameters[t][c]) continue;
      moved.insert(before.tets[t][c]);
      tets.insert(static_cast<Index>(t));
      for (std::size_t k = 0; k < 3; ++k) {
        largest =
            std::max(largest, std::abs(before.parameters[t][c][k] - after.parameters[t][c][k]));
      }
    }
  }
  EXPECT_EQ(moved.size(), report.movedVertices);
  EXPECT_EQ(largest, report.largestMove);
  EXPECT_EQ(report.regions[0].badTets, report.badTets);
  const Vec3 middle = middleOfBadTets(before);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(report.regions[0].position[k], middle[k], 1e-12);
  }
  EXPECT_LE(tets.size(), report.regions[0].tets);
  EXPECT_LT(tets.size(), before.tets.size() / 4);
}

TEST_F(Repairs, TouchNothingOutsideOfThePatch) {
  // Tets as long as cells, and a quarter of that: there, all moves are below 1.
  for (const int cells : {4, 1}) expectReportOf(damaged(6, cells));
}

TEST_F(Repairs, AreTheSameForAnyNumberOfThreads) {
  const TetMap map = damaged(15);
  Context one(1);
  Context many(0);
  EXPECT_EQ(repair(map, {}, one).parameters, repair(map, {}, many).parameters);
}

TEST_F(Repairs, AreDoneByTheExtraction) {
  const TetMap map = damaged();
  Context context;
  RepairedMap repaired;
  const HexMesh mesh = extract(map, {.repair = &repaired}, context);
  EXPECT_TRUE(repaired.report.changed);
  ASSERT_NE(repaired.map, nullptr);
  EXPECT_TRUE(verify(*repaired.map, mesh).passed());
  EXPECT_EQ(Extractor(map, {.repair = &repaired}, context).cellsAtScaleOne(), mesh.cells.size());
  ASSERT_NE(repaired.map, nullptr);
  // The only owner of the map that it is to be made of.
  EXPECT_TRUE(sameConnectivity(extract(*repaired.map, {.repair = &repaired}, context), mesh));
  const TetMap sound = generateSample(SampleKind::Box).map;
  static_cast<void>(extract(sound, {.repair = &repaired}, context));
  EXPECT_EQ(repaired.map, nullptr) << "left from the call before";
  EXPECT_FALSE(repaired.report.changed);
  try {
    static_cast<void>(extract(map));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
  }
}

TEST_F(Repairs, AlsoOfMirroredMapsAndReversedTets) {
  SampleOptions options;
  options.refine = 3;
  options.charts = ChartStyle::Random;
  const TetMap sound = sample(SampleKind::Cylinder, options);
  options.defects = 5;
  TetMap map = sample(SampleKind::Cylinder, options);
  for (TetParameters& parameters : map.parameters) {
    for (Vec3& u : parameters) u[1] = -u[1];
  }
  expectRepaired(map, sound);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::swap(map.tets[t][0], map.tets[t][3]);
    std::swap(map.parameters[t][0], map.parameters[t][3]);
  }
  expectRepaired(map, sound);
}

/// Glues a flat tet onto two boundary triangles in one plane: all four vertices are bound to it.
TetMap withLockedTet(const TetMap& map) {
  TetMap locked = map;
  // Boundary triangles of the plane u = 0, by vertices.
  std::map<std::set<Index>, std::vector<std::pair<std::size_t, std::size_t>>> faces;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      std::set<Index> face(map.tets[t].begin(), map.tets[t].end());
      face.erase(map.tets[t][c]);
      faces[face].emplace_back(t, c);
    }
  }
  const auto parameterOf = [&](Index v) {
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      for (std::size_t c = 0; c < 4; ++c) {
        if (map.tets[t][c] == v) return map.parameters[t][c];
      }
    }
    return Vec3{};
  };
  const auto isFlat = [&](const std::set<Index>& face) {
    return std::all_of(face.begin(), face.end(), [&](Index v) { return parameterOf(v)[0] == 0; });
  };
  for (const auto& [first, tetsA] : faces) {
    if (tetsA.size() != 1 || !isFlat(first)) continue;
    for (const auto& [second, tetsB] : faces) {
      if (tetsB.size() != 1 || second <= first || !isFlat(second)) continue;
      std::vector<Index> common;
      std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                            std::back_inserter(common));
      if (common.size() != 2) continue;
      // The new tet sees the first triangle from the other side.
      const auto [t, c] = tetsA.front();
      Tet tet = map.tets[t];
      for (const Index v : second) {
        if (!first.contains(v)) tet[c] = v;
      }
      std::swap(tet[(c + 1) % 4], tet[(c + 2) % 4]);
      TetParameters parameters{};
      for (std::size_t k = 0; k < 4; ++k) parameters[k] = parameterOf(tet[k]);
      locked.tets.push_back(tet);
      locked.parameters.push_back(parameters);
      return locked;
    }
  }
  return locked;
}

TEST_F(Repairs, SplitEdgesOfLockedTets) {
  SampleOptions options;
  options.refine = 3;
  const TetMap sound = sample(SampleKind::Box, options);
  const TetMap locked = withLockedTet(sound);
  ASSERT_EQ(locked.tets.size(), sound.tets.size() + 1);
  Context context;
  RepairReport report;
  const TetMap repaired = repair(locked, {}, context, &report);
  EXPECT_GT(report.splitEdges, 0U);
  EXPECT_EQ(repaired.points.size(), locked.points.size() + report.splitEdges);
  EXPECT_EQ(repaired.tets.size(), locked.tets.size() + report.addedTets);
  EXPECT_TRUE(sameConnectivity(verifiedExtraction(repaired), extract(sound)));
  RepairOptions unrefined;
  unrefined.refine = false;
  EXPECT_EQ(codeOf([&] { static_cast<void>(repair(locked, unrefined)); }), ErrorCode::FlippedTet);
}

TEST_F(Repairs, RoundWhatIsNearlyOnTheGridIfAsked) {
  SampleOptions options;
  options.refine = 4;
  options.cells = 3;
  const TetMap sound = sample(SampleKind::Box, options);
  const std::vector<Index> vertices = verticesInsideFace(sound, 0, 0);
  ASSERT_GT(vertices.size(), 4U);
  TetMap map = sound;
  for (std::size_t i = 0; i < 4; ++i) {
    forEachCornerAt(map, vertices[i], [&](Vec3& u) { u[0] += 0.02 * static_cast<double>(i + 1); });
  }
  try {
    static_cast<void>(repair(map));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::BoundaryOffLattice);
    EXPECT_NE(std::string(error.what()).find("--round"), std::string::npos);
  }
  expectRepaired(map, sound, true);
  // Too far off to be rounded.
  forEachCornerAt(map, vertices[0], [&](Vec3& u) { u[0] += 0.15; });
  RepairOptions round;
  round.round = true;
  EXPECT_EQ(codeOf([&] { static_cast<void>(repair(map, round)); }), ErrorCode::BoundaryOffLattice);
}

TEST_F(Repairs, GuessNoIntegers) {
  // Half of the map is moved by half a unit: the transitions between the halves are no integers.
  SampleOptions options;
  options.defects = 3;
  options.refine = 3;
  TetMap map = sample(SampleKind::Torus, options);
  const std::size_t half = map.tets.size() / 2;
  for (std::size_t t = 0; t < half; ++t) {
    for (Vec3& u : map.parameters[t]) u[2] += 0.5;
  }
  try {
    static_cast<void>(repair(map));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_TRUE(error.code() == ErrorCode::TransitionResidual ||
                error.code() == ErrorCode::BoundaryOffLattice ||
                error.code() == ErrorCode::SingularityOffLattice)
        << error.what();
  }
}

struct RealCase {
  const char* name;
  int scale;
  std::size_t cells;
  std::size_t vertices;
};
void PrintTo(const RealCase& real, std::ostream* out) { *out << real.name << " x" << real.scale; }

std::filesystem::path defectiveFile(const std::string& name) {
  const char* chosen = std::getenv("HEXHEX_DATA");
  return std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "defective" /
         (name + ".hexex");
}

class RealDefects : public ::testing::TestWithParam<RealCase> {};

TEST_P(RealDefects, ComeOutWhole) {
  if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  const std::filesystem::path file = defectiveFile(GetParam().name);
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no real maps here";
  const TetMap repaired = repair(readMap(file));
  ExtractOptions options;
  options.scale = GetParam().scale;
  const HexMesh mesh = verifiedExtraction(repaired, options);
  EXPECT_EQ(mesh.cells.size(), GetParam().cells);
  EXPECT_EQ(mesh.points.size(), GetParam().vertices);
}

INSTANTIATE_TEST_SUITE_P(Maps, RealDefects,
                         ::testing::Values(RealCase{"sphere", 1, 216, 343},
                                           RealCase{"sphere", 2, 1728, 2197},
                                           RealCase{"notch", 1, 4780, 5778},
                                           RealCase{"notch", 2, 38240, 42117}));

TEST(RealDefects, BeyondRepairAreDiagnosed) {
  if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  const std::filesystem::path file = defectiveFile("spot");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no real maps here";
  try {
    static_cast<void>(repair(readMap(file)));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::TransitionResidual) << error.what();
  }
}

}  // namespace

}  // namespace hexhex::test
