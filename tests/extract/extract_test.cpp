// The public function: orientation, generators, what the caller may give along, errors,
// cancellation.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <hexhex/quality.hpp>

#include <base/vector3.hpp>
#include <propeller/propeller.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

Sample sphere() {
  SampleOptions o;
  o.cells = 4;
  o.refine = 3;
  o.charts = ChartStyle::Random;
  o.jitter = 0.05;  // all cells of the right mesh stay positive in space
  return generateSample(SampleKind::Sphere, o);
}

void reverseCorners(TetMap& map) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::swap(map.tets[t][2], map.tets[t][3]);
    std::swap(map.parameters[t][2], map.parameters[t][3]);
  }
}

void mirror(TetMap& map) {
  for (TetParameters& parameters : map.parameters) {
    for (Vec3& u : parameters) u[1] = -u[1];
  }
}

void expectPositive(const HexMesh& mesh) {
  Context context;
  EXPECT_EQ(summarize(scaledJacobians(mesh, context)).notPositive, 0U);
}

TEST(Extract, EitherOrientationGivesTheSameMesh) {
  const Sample sample = sphere();
  const HexMesh reference = verifiedExtraction(sample.map);
  expectPositive(reference);
  for (int variant = 1; variant < 4; ++variant) {
    TetMap map = sample.map;
    if (variant & 1) reverseCorners(map);
    if (variant & 2) mirror(map);
    Context context;
    ExtractStatistics statistics;
    const HexMesh mesh = extract(map, {}, context, &statistics);
    EXPECT_EQ(statistics.mirrored, (variant & 2) != 0);
    expectPositive(mesh);
    EXPECT_TRUE(sameUpToNumbering(reference, mesh)) << "variant " << variant;
    EXPECT_TRUE(verify(map, mesh).passed());
  }
}

TEST(Extract, NumberingOfTheInputDoesNotMatter) {
  const Sample sample = sphere();
  const HexMesh reference = verifiedExtraction(sample.map);
  TetMap map = sample.map;
  std::reverse(map.points.begin(), map.points.end());
  const auto last = static_cast<Index>(map.points.size() - 1);
  for (Tet& tet : map.tets) {
    for (Index& v : tet) v = last - v;
  }
  std::reverse(map.tets.begin(), map.tets.end());
  std::reverse(map.parameters.begin(), map.parameters.end());
  EXPECT_TRUE(sameUpToNumbering(reference, verifiedExtraction(map)));
}

// An independent look at cells: where all eight corners lie inside one tet, the tet's affine map
// must send them to a unit cube, in VTK order.
TEST(Extract, CellsInsideOneTetAreUnitCubes) {
  SampleOptions o;
  o.cells = 14;
  o.refine = 1;
  o.charts = ChartStyle::Random;
  const Sample sample = generateSample(SampleKind::Cylinder, o);
  const HexMesh mesh = verifiedExtraction(sample.map);
  constexpr int kCorner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::size_t seen = 0;
  for (const Hex& cell : mesh.cells) {
    const Index tet = mesh.generatorTet[cell[0]];
    const bool inside = std::all_of(cell.begin(), cell.end(), [&](Index v) {
      return mesh.generatorTet[v] == tet && mesh.generatorCorners[v] == 15;
    });
    if (!inside) continue;
    ++seen;
    // Solve for the parameters by Cramer's rule.
    const auto parameter = [&](const Vec3& p) {
      const auto det = [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
      };
      const auto corner = [&](std::size_t i) { return sample.map.points[sample.map.tets[tet][i]]; };
      const auto minus = [](const Vec3& a, const Vec3& b) {
        return Vec3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
      };
      const Vec3 a = minus(corner(1), corner(0));
      const Vec3 b = minus(corner(2), corner(0));
      const Vec3 c = minus(corner(3), corner(0));
      const Vec3 d = minus(p, corner(0));
      const double whole = det(a, b, c);
      const double w[3] = {det(d, b, c) / whole, det(a, d, c) / whole, det(a, b, d) / whole};
      const TetParameters& u = sample.map.parameters[tet];
      Vec3 result = u[0];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) result[k] += w[i] * (u[i + 1][k] - u[0][k]);
      }
      return result;
    };
    const Vec3 origin = parameter(mesh.points[cell[0]]);
    Vec3 axes[3];
    const std::size_t along[3] = {1, 3, 4};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 u = parameter(mesh.points[cell[along[i]]]);
      for (std::size_t k = 0; k < 3; ++k) axes[i][k] = u[k] - origin[k];
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec3 u = parameter(mesh.points[cell[i]]);
      for (std::size_t k = 0; k < 3; ++k) {
        double expected = origin[k];
        for (std::size_t j = 0; j < 3; ++j) expected += kCorner[i][j] * axes[j][k];
        ASSERT_NEAR(u[k], expected, 1e-9);
        ASSERT_NEAR(u[k], std::nearbyint(u[k]), 1e-9);
      }
    }
    const double volume = axes[0][0] * (axes[1][1] * axes[2][2] - axes[1][2] * axes[2][1]) +
                          axes[0][1] * (axes[1][2] * axes[2][0] - axes[1][0] * axes[2][2]) +
                          axes[0][2] * (axes[1][0] * axes[2][1] - axes[1][1] * axes[2][0]);
    ASSERT_NEAR(volume, 1, 1e-9);
  }
  EXPECT_GT(seen, 500U);
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(minus(b, a), minus(c, a)), minus(d, a));
}

TEST(Extract, GeneratorsNameSimplicesOfTheInput) {
  SampleOptions o;
  o.cells = 5;
  o.refine = 2;
  o.jitter = 0.05;
  const Sample sample = generateSample(SampleKind::Cylinder, o);
  const HexMesh mesh = verifiedExtraction(sample.map);
  std::array<std::size_t, 4> seen{};
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Index tet = mesh.generatorTet[v];
    const CornerSet corners = mesh.generatorCorners[v];
    ASSERT_LT(tet, sample.map.tets.size());
    ASSERT_GE(corners, 1);
    ASSERT_LE(corners, 15);
    ++seen[static_cast<std::size_t>(generatorKind(corners))];
    // Volumes of the tets that the point makes with the faces tell where it lies.
    const auto corner = [&](std::size_t i) { return sample.map.points[sample.map.tets[tet][i]]; };
    const double whole = volume(corner(0), corner(1), corner(2), corner(3));
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<Vec3, 4> part = {corner(0), corner(1), corner(2), corner(3)};
      part[i] = mesh.points[v];
      const double weight = volume(part[0], part[1], part[2], part[3]) / whole;
      if (lattice::contains(corners, static_cast<int>(i))) {
        ASSERT_GT(weight, 0);
      } else {
        ASSERT_NEAR(weight, 0, 1e-9);
      }
    }
    // The owner is the smallest tet at the simplex.
    for (Index t = 0; t < tet; ++t) {
      const Tet& other = sample.map.tets[t];
      bool all = true;
      for (std::size_t i = 0; i < 4; ++i) {
        if (!lattice::contains(corners, static_cast<int>(i))) continue;
        all = all && std::find(other.begin(), other.end(), sample.map.tets[tet][i]) != other.end();
      }
      ASSERT_FALSE(all);
    }
  }
  for (const std::size_t count : seen) EXPECT_GT(count, 0U);
}

TEST(Extract, GivenValencesAreUsed) {
  const Sample sample = sphere();
  const HexMesh reference = verifiedExtraction(sample.map);
  Context context;
  igm::DefectCollector defects;
  const igm::PreparedMap prepared = igm::prepareMap(sample.map, 1e-2, 1, context, defects);
  std::vector<EdgeValence> known;
  for (const igm::SingularEdge& edge : prepared.singularities.edges) {
    known.push_back({edge.vertex1, edge.vertex0, edge.valence - (edge.boundary ? 2 : 4)});
  }
  ASSERT_FALSE(known.empty());
  TetMapView view(sample.map);
  view.edgeValences = known;
  EXPECT_TRUE(sameBits(reference, extract(view)));
}

TEST(ExtractErrors, HaveTheirCodes) {
  const Sample sample = sphere();
  EXPECT_EQ(codeOf([] { static_cast<void>(extract(TetMap{})); }), ErrorCode::EmptyMesh);
  const auto with = [&](auto change) {
    TetMap map = sample.map;
    change(map);
    return codeOf([&] { static_cast<void>(extract(map)); });
  };
  EXPECT_EQ(with([](TetMap& m) { m.tets[5][1] = 1000000; }), ErrorCode::IndexOutOfRange);
  EXPECT_EQ(with([](TetMap& m) { m.tets[5][1] = m.tets[5][0]; }), ErrorCode::RepeatedVertex);
  EXPECT_EQ(with([](TetMap& m) { m.parameters[5][1][2] = NAN; }), ErrorCode::NotFinite);
  EXPECT_EQ(with([](TetMap& m) { m.points[0][0] = INFINITY; }), ErrorCode::NotFinite);
  EXPECT_EQ(with([](TetMap& m) { m.parameters[5][1][2] = 1e30; }), ErrorCode::TooLarge);
  EXPECT_EQ(with([](TetMap& m) {
              m.tets.push_back(m.tets[0]);
              m.parameters.push_back(m.parameters[0]);
            }),
            ErrorCode::NonManifoldFace);
  EXPECT_EQ(with([](TetMap& m) {
              for (TetParameters& u : m.parameters) {
                for (Vec3& p : u) p[0] += 0.1;
              }
            }),
            ErrorCode::TransitionResidual);
  EXPECT_EQ(with([](TetMap& m) { m.parameters.pop_back(); }), ErrorCode::InvalidArgument);
  const auto option = [&](auto change) {
    ExtractOptions o;
    change(o);
    return codeOf([&] { static_cast<void>(extract(sample.map, o)); });
  };
  EXPECT_EQ(option([](ExtractOptions& o) { o.scale = 0; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(option([](ExtractOptions& o) { o.tolerance = 0.25; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(option([](ExtractOptions& o) { o.scale = 2000000000; }), ErrorCode::TooLarge);
}

TEST(ExtractErrors, MoreVerticesThanIndicesAreRefused) {
  const Sample sample = generateSample(SampleKind::Box);
  ExtractOptions o;
  o.scale = 2000;  // 2^3 blocks of (4 * 2000)^3 cells
  EXPECT_EQ(codeOf([&] { static_cast<void>(extract(sample.map, o)); }), ErrorCode::TooLarge);
}

std::vector<std::string> stagesOf(Engine engine) {
  std::vector<std::string> stages = {"input",         "topology",     "transitions",
                                     "singularities", "sanitization", "cells"};
  const auto own =
      engine == Engine::Atlas
          ? std::vector<std::string>{"charts", "sweep", "grid", "overlaps", "cuts"}
          : std::vector<std::string>{"vertices", "local connectivity", "global connectivity"};
  stages.insert(stages.end(), own.begin(), own.end());
  return stages;
}

class ExtractStages : public ::testing::TestWithParam<Engine> {};

TEST_P(ExtractStages, AreReportedWithProgress) {
  const Sample sample = sphere();
  std::vector<std::string> stages;
  Context context(2, [&](std::string_view stage, double share) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
  });
  ExtractOptions options;
  options.engine = GetParam();
  ExtractStatistics statistics;
  static_cast<void>(extract(sample.map, options, context, &statistics));
  const std::set<std::string> unique(stages.begin(), stages.end());
  for (const std::string& stage : stagesOf(GetParam()))
    EXPECT_TRUE(unique.contains(stage)) << stage;
  std::set<std::string> timed;
  for (const StageTime& time : context.stageTimes()) {
    EXPECT_GE(time.seconds, 0) << time.stage;
    EXPECT_TRUE(timed.insert(time.stage).second) << time.stage;
  }
  EXPECT_EQ(timed, unique);
  EXPECT_GT(statistics.seconds, 0);
}

TEST_P(ExtractStages, CanBeCancelled) {
  const Sample sample = sphere();
  ExtractOptions options;
  options.engine = GetParam();
  for (const std::string& where : stagesOf(GetParam())) {
    Context* running = nullptr;
    Context context(2, [&](std::string_view stage, double /*share*/) {
      if (stage == where) running->cancel();
    });
    running = &context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(extract(sample.map, options, context)); }),
              ErrorCode::Cancelled)
        << where;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, ExtractStages,
                         ::testing::Values(Engine::Atlas, Engine::Propeller),
                         [](const ::testing::TestParamInfo<Engine>& engine) {
                           return engine.param == Engine::Atlas ? "Atlas" : "Propeller";
                         });

TEST(ExtractContext, AbsurdNumbersOfThreadsAreBounded) {
  const Sample sample = sphere();
  Context context(1000000);
  ExtractStatistics statistics;
  const HexMesh mesh = extract(sample.map, {}, context, &statistics);
  EXPECT_TRUE(sameBits(mesh, extract(sample.map)));
  EXPECT_LT(statistics.threads, 10000);
}

}  // namespace
}  // namespace hexhex::test
