// Meshes end positive, on their surface, and no worse.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/samples.hpp>

#include <base/vector3.hpp>
#include <improve/all_at_once.hpp>
#include <improve/merit.hpp>
#include <improve/moving.hpp>

#include "improve/improved.hpp"
#include "mesh/grid_meshes.hpp"
#include "support/error_of.hpp"
#include "support/sampled_distance.hpp"

namespace hexhex::test {

namespace {

using hexhex::testing::gridMesh;
using hexhex::testing::Random;

ImproveReport improved(HexMesh& mesh, const ImproveOptions& options = {}, int threads = 2) {
  Context context(threads);
  return improve(mesh, options, context);
}

/// What holds of every mesh.
void expectNoWorse(const ImproveReport& report) {
  EXPECT_GE(report.after.quality.minimum, report.before.quality.minimum);
  for (std::size_t c = 0; c < report.before.validity.size(); ++c) {
    if (report.before.validity[c] != Validity::Positive) continue;
    EXPECT_EQ(report.after.validity[c], Validity::Positive) << "cell " << c;
  }
  EXPECT_EQ(report.notPositive.size(), report.after.refuted + report.after.undecided);
  EXPECT_EQ(report.farCells.empty(), report.distanceAfter.hausdorff() <= kSurfaceTolerance);
  EXPECT_EQ(report.farCellsBefore == 0, report.distanceBefore.hausdorff() <= kSurfaceTolerance);
}

/// Moves all vertices by up to so much; those of the boundary of [0, n]^3 within it, and by no more
/// than a third of a cell: it is the surface.
void distort(HexMesh& mesh, double n, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& point : mesh.points) {
    const bool isInside =
        std::all_of(point.begin(), point.end(), [n](double x) { return x > 0 && x < n; });
    const double most = isInside ? amount : std::min(amount, 0.3);
    for (double& x : point) {
      const double move = most * (2 * random.real() - 1);
      if (x > 0 && x < n) x += move;
    }
  }
}

std::filesystem::path dataFolder() {
  const char* const chosen = std::getenv("HEXHEX_DATA");
  return chosen != nullptr ? chosen : HEXHEX_DATA_DIR;
}

bool isOnCube(const Vec3& point, double n) {
  return std::any_of(point.begin(), point.end(), [n](double x) { return x == 0 || x == n; });
}

}  // namespace

TEST(Improve, MendsDistortedGrids) {
  int bad = 0;
  int mended = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    HexMesh mesh = gridMesh(6);
    distort(mesh, 6, 0.3 + 0.05 * static_cast<double>(seed % 6), seed);
    const ImproveReport report = improved(mesh);
    expectNoWorse(report);
    if (report.before.allPositive()) continue;
    ++bad;
    if (report.after.allPositive()) ++mended;
  }
  EXPECT_GE(bad, 8);
  EXPECT_EQ(mended, bad);
}

TEST(Improve, KeepsVerticesOnFacesEdgesAndCornersOfACube) {
  const HexMesh cube = gridMesh(5);
  HexMesh mesh = cube;
  distort(mesh, 5, 0.55, 3);
  const HexMesh before = mesh;
  const ImproveReport report = improved(mesh);
  EXPECT_EQ(report.vertices[3], 8U);
  EXPECT_EQ(report.vertices[2], 12U * 4);
  EXPECT_EQ(report.vertices[1], 6U * 16);
  EXPECT_EQ(report.vertices[0], 64U);
  EXPECT_GT(report.movedVertices, 100U);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-12);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cube.points[v][k] != 0 && cube.points[v][k] != 5) continue;
      EXPECT_NEAR(mesh.points[v][k], cube.points[v][k], 1e-9) << "vertex " << v;
    }
  }
}

TEST(Improve, LeavesTheBoundaryIfAsked) {
  HexMesh mesh = gridMesh(5);
  distort(mesh, 5, 0.45, 4);
  const HexMesh before = mesh;
  ImproveOptions options;
  options.fixBoundary = true;
  const ImproveReport report = improved(mesh, options);
  expectNoWorse(report);
  EXPECT_GT(report.movedVertices, 0U);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (isOnCube(before.points[v], 5)) {
      EXPECT_EQ(mesh.points[v], before.points[v]);
    }
  }
}

TEST(Improve, GivesTheSameBytesWithAnyNumberOfThreads) {
  HexMesh one = gridMesh(9);
  distort(one, 9, 0.5, 5);
  HexMesh two = one;
  improved(one, {}, 1);
  improved(two, {}, 2);
  EXPECT_EQ(one.points, two.points);
}

TEST(Improve, ReachesTheTarget) {
  HexMesh mesh = gridMesh(8);
  distort(mesh, 8, 0.4, 6);
  ImproveOptions options;
  options.passes = 0;
  options.target = 0.5;
  const ImproveReport report = improved(mesh, options);
  EXPECT_LT(report.before.quality.minimum, 0);
  EXPECT_GE(report.after.quality.minimum, 0.5);
  HexMesh smooth = mesh;
  options.passes = 5;
  const ImproveReport smoother = improved(smooth, options);
  EXPECT_GE(smoother.after.quality.minimum, 0.5);
  EXPECT_GT(smoother.after.quality.mean, report.after.quality.mean);
}

TEST(Improve, DoesNotCrossAThinPlate) {
  // Two cells across a plate that is a fiftieth as thick as it is wide, and wavy.
  HexMesh mesh = gridMesh(8, [](std::size_t, std::size_t, std::size_t z) { return z < 2; });
  const HexMesh grid = mesh;
  const auto middle = [](const Vec3& at) { return 0.2 * std::sin(at[0]) * std::cos(at[1]); };
  for (Vec3& point : mesh.points) point[2] = middle(point) + 0.08 * (point[2] - 1);
  Random random(7);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3& at = grid.points[v];
    if (at[2] != 1 || at[0] == 0 || at[0] == 8 || at[1] == 0 || at[1] == 8) continue;
    for (std::size_t k = 0; k < 2; ++k) mesh.points[v][k] += 0.5 * random.real() - 0.25;
    mesh.points[v][2] += 0.1 * random.real() - 0.05;
  }
  const ImproveReport report = improved(mesh);
  expectNoWorse(report);
  EXPECT_FALSE(report.before.allPositive());
  EXPECT_LT(report.after.refuted, report.before.refuted);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const double above = mesh.points[v][2] - middle(mesh.points[v]);
    if (grid.points[v][2] == 0) {
      EXPECT_LT(above, -0.01);
    }
    if (grid.points[v][2] == 2) {
      EXPECT_GT(above, 0.01);
    }
  }
}

TEST(Improve, StaysInsideSharpWedgesAndNeedles) {
  for (const double narrow : {0.1, 0.01}) {
    HexMesh mesh = gridMesh(6);
    distort(mesh, 6, 0.3, 8);
    // A wedge whose edge x = 0 is thin, then a needle with a thin end.
    for (Vec3& point : mesh.points) {
      const double width = narrow + point[0] / 6;
      point[1] = (point[1] - 3) * width;
      if (narrow < 0.1) point[2] = (point[2] - 3) * width;
    }
    const ImproveReport report = improved(mesh);
    expectNoWorse(report);
    EXPECT_TRUE(report.after.allPositive()) << narrow;
    EXPECT_LT(report.distanceAfter.hausdorff(), 1e-3);
  }
}

TEST(Improve, KeepsTaggedVerticesOfATorusOnItsSurface) {
  HEXHEX_LARGE_TEST();
  SampleOptions options;
  options.cells = 3;
  options.jitter = 0.6;
  options.features = true;
  const Sample sample = generateSample(SampleKind::Torus, options);
  HexMesh mesh = extracted(sample.map, 2);
  const HexMesh before = mesh;
  const ImproveReport report = improvedOn(mesh, sample.map);
  expectNoWorse(report);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_EQ(report.offSurface, 0U);
  EXPECT_EQ(mesh.features, before.features);
  EXPECT_EQ(mesh.cells, before.cells);
  EXPECT_GE(report.after.quality.mean, report.before.quality.mean);
}

/// Minima were 0.46 and 0.31 where cells at the target were left there.
TEST(Improve, RaisesTheWorstBeyondTheTargetWhereCellsWereBelowIt) {
  for (const double jitter : {0.3, 0.4}) {
    const TetMap map = generateSample(SampleKind::Star, {.cells = 2, .jitter = jitter}).map;
    HexMesh mesh = extracted(map, 4);
    HexMesh other = mesh;
    const ImproveReport report = improvedOn(mesh, map);
    expectNoWorse(report);
    EXPECT_FALSE(report.before.allPositive());
    EXPECT_GT(report.after.quality.minimum, 0.6);
    // Without a target, or without passes, cells that are good enough stay.
    Context context(2);
    ImproveOptions options;
    options.target = 0;
    options.passes = 0;
    const ImproveReport untangled = improve(other, map, options, context);
    EXPECT_TRUE(untangled.after.allPositive());
    EXPECT_LT(untangled.after.quality.minimum, 0.3);
    EXPECT_LT(untangled.movedVertices, report.movedVertices / 2);
  }
}

TEST(Improve, KeepsTaggedQuadsInsideWhereTheyAre) {
  const HexMesh grid = gridMesh(6);
  HexMesh mesh = grid;
  distort(mesh, 6, 0.45, 9);
  const auto numberOf = [&](const Vec3& at) {
    return static_cast<Index>(std::find(grid.points.begin(), grid.points.end(), at) -
                              grid.points.begin());
  };
  // A wall in the middle, and the bottom.
  for (double a = 0; a < 6; ++a) {
    for (double b = 0; b < 6; ++b) {
      mesh.features.quads.push_back({{numberOf({3, a, b}), numberOf({3, a + 1, b}),
                                      numberOf({3, a + 1, b + 1}), numberOf({3, a, b + 1})},
                                     7});
      mesh.features.quads.push_back({{numberOf({a, b, 0}), numberOf({a + 1, b, 0}),
                                      numberOf({a + 1, b + 1, 0}), numberOf({a, b + 1, 0})},
                                     8});
    }
  }
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (grid.points[v][0] == 3) mesh.points[v][0] = 3;
  }
  const HexMesh before = mesh;
  const ImproveReport report = improved(mesh);
  expectNoWorse(report);
  EXPECT_FALSE(report.before.allPositive());
  EXPECT_TRUE(report.after.allPositive());
  std::size_t moved = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (grid.points[v][0] != 3) continue;
    EXPECT_NEAR(mesh.points[v][0], 3, 1e-9) << "vertex " << v;
    moved += mesh.points[v] == before.points[v] ? 0 : 1;
  }
  EXPECT_GT(moved, 10U);
  // The wall is no part of the boundary: distances do not know it.
  EXPECT_LT(report.distanceBefore.hausdorff(), 1e-12);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-12);
  EXPECT_LT(report.innerDistanceAfter, 1e-12);
}

/// Blocks are regions here, so there are faces between them, which are moved off the grid.
TEST(Improve, MeasuresTheBoundaryAndWhatIsInsideByThemselves) {
  HEXHEX_LARGE_TEST();
  for (const SampleKind kind : {SampleKind::Sphere, SampleKind::Shell, SampleKind::Torus}) {
    SCOPED_TRACE(static_cast<int>(kind));
    const TetMap map = generateSample(kind, {.cells = 2, .jitter = 0.3, .features = true}).map;
    TetMap plain = map;
    plain.regions.clear();
    HexMesh rough = extracted(map, 2);
    HexMesh mesh = rough;
    const ImproveReport report = improvedOn(mesh, map);
    expectSampled(report.distanceBefore, rough, map);
    expectSampled(report.distanceAfter, mesh, map);
    // These are no planes of the grid, so no quads lie on them, and no vertices are held there.
    EXPECT_EQ(report.innerDistanceBefore, 0);
    EXPECT_EQ(report.innerDistanceAfter, 0);
    EXPECT_EQ(improvedOn(rough, plain).innerDistanceAfter, 0);
  }
}

TEST(Improve, MendsSamplesOfAllKinds) {
  HEXHEX_LARGE_TEST();
  int bad = 0;
  int mended = 0;
  for (const SampleKindName& kind : sampleKinds()) {
    SampleOptions options;
    options.cells = 3;
    options.jitter = 0.9;
    options.seed = 11;
    const Sample sample = generateSample(kind.kind, options);
    HexMesh mesh = extracted(sample.map, 2);
    const ImproveReport report = improvedOn(mesh, sample.map);
    expectNoWorse(report);
    if (report.before.allPositive()) continue;
    ++bad;
    mended += report.after.allPositive() ? 1 : 0;
  }
  EXPECT_EQ(mended, bad);
}

/// Vertices go back where the boundary came farther; otherwise, these would be 1.4 to 2.2 times as
/// far as before.
TEST(Improve, ComesNoFartherFromCurvedSurfaces) {
  for (const SampleKind kind :
       {SampleKind::Sphere, SampleKind::Cylinder, SampleKind::Shell, SampleKind::Torus}) {
    const TetMap map = generateSample(kind, {.cells = 1, .jitter = 0.3}).map;
    HexMesh mesh = extracted(map, 2);
    const Array<Vec3> before = mesh.points;
    const ImproveReport report = improvedOn(mesh, map);
    expectNoWorse(report);
    EXPECT_GT(report.distanceBefore.hausdorff(), kSurfaceTolerance);
    EXPECT_LE(report.distanceAfter.hausdorff(), 1.00001 * report.distanceBefore.hausdorff());
    EXPECT_GT(report.movedVertices, before.size() / 2);
    EXPECT_FALSE(report.farCells.empty());
  }
}

TEST(Improve, MendsMeshesOfRealMaps) {
  const std::filesystem::path folder = dataFolder() / "maps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without real maps";
  for (const auto& [name, scale] :
       {std::pair("fandisk_r0.01", 2), std::pair("s17c_sphere_r0.1", 4)}) {
    Context context(2);
    const TetMap map = readMap(folder / (std::string(name) + ".hexex"), {}, context);
    HexMesh mesh = extracted(map, scale);
    const ImproveReport report = improvedOn(mesh, map, {.slack = 0});
    expectNoWorse(report);
    EXPECT_FALSE(report.before.allPositive()) << name;
    EXPECT_TRUE(report.after.allPositive()) << name;
    EXPECT_GE(report.after.quality.minimum, 0.3) << name;
    EXPECT_EQ(report.offSurface, 0U) << name;
  }
}

/// Layers between two sides that do not move, one of which is refined: their cells are sheared more
/// than the target allows, wherever vertices inside go.
HexMesh shearedLayers(std::size_t n, std::size_t layers, double height, double grading) {
  HexMesh mesh =
      gridMesh(n, [&](std::size_t, std::size_t y, std::size_t z) { return y < 4 && z < layers; });
  const auto length = static_cast<double>(n);
  for (Vec3& point : mesh.points) {
    const double share = point[2] / static_cast<double>(layers);
    const double refined = length * std::pow(point[0] / length, grading);
    point = {(1 - share) * refined + share * point[0], point[1], share * height};
  }
  return mesh;
}

/// What could not reach the target pulled cells that had below it, too: 16, 52 and 24 of these.
TEST(Improve, LeavesGoodCellsGoodWhereOthersCannotBe) {
  HEXHEX_LARGE_TEST();
  for (HexMesh mesh :
       {shearedLayers(12, 3, 0.6, 3), shearedLayers(12, 6, 1, 4), shearedLayers(16, 8, 2, 5)}) {
    for (const int passes : {0, 2}) {
      ImproveOptions options;
      options.fixBoundary = true;
      options.passes = passes;
      HexMesh moved = mesh;
      const ImproveReport report = improved(moved, options);
      expectNoWorse(report);
      EXPECT_GT(report.movedVertices, 0U);
      std::size_t low = 0;
      std::size_t wereLow = 0;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const bool wasLow = report.before.scaledJacobians[c] < options.target;
        const bool isLow = report.after.scaledJacobians[c] < options.target;
        EXPECT_TRUE(wasLow || !isLow) << "cell " << c;
        low += isLow ? 1 : 0;
        wereLow += wasLow ? 1 : 0;
      }
      EXPECT_LE(low, wereLow);
      EXPECT_GT(low, 0U);
    }
  }
}

/// 48 cells at a flat corner that nothing mends: 826 others became worse for them.
TEST(Improve, LeavesAMeshAsGoodAsItWasWhereNothingMendsIt) {
  HEXHEX_LARGE_TEST();
  const std::filesystem::path file = dataFolder() / "hexes" / "hexbox_CAD10.mesh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "without public meshes";
  Context context(2);
  const HexMesh mesh = readHexMesh(file, context);
  for (const int passes : {0, 2}) {
    ImproveOptions options;
    options.passes = passes;
    HexMesh moved = mesh;
    const ImproveReport report = improved(moved, options);
    expectNoWorse(report);
    EXPECT_EQ(report.notPositive.size(), 48U);
    // Without passes, what raises cells below the target costs those above it a little.
    EXPECT_GE(report.after.quality.mean, report.before.quality.mean - (passes == 0 ? 1e-4 : 0));
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      if (report.before.scaledJacobians[c] < options.target) continue;
      EXPECT_GE(report.after.scaledJacobians[c], options.target) << "cell " << c;
    }
  }
}

/// What Edge-Cone Rectification (Livesu et al. 2015) makes of the same meshes lies beside them.
TEST(Improve, IsAsGoodAsPublishedResults) {
  HEXHEX_LARGE_TEST();
  const std::filesystem::path folder = dataFolder() / "hexes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without public meshes";
  for (const char* const name :
       {"ecr_block", "ecr_block_stresstest", "ecr_bust", "ecr_cap", "ecr_hanger_stresstest"}) {
    SCOPED_TRACE(name);
    Context context(2);
    const auto meshOf = [&, prefix = std::string(name)](const char* ending) {
      return readHexMesh(folder / (prefix + ending), context);
    };
    const HexMesh given = meshOf("_in.mesh");
    const HexMesh theirs = meshOf("_out.mesh");
    HexMesh ours = given;
    improved(ours);
    const Certificate published = certify(theirs, context);
    const Certificate found = certify(ours, context);
    EXPECT_TRUE(found.allPositive());
    EXPECT_GE(found.quality.minimum, published.quality.minimum);
    EXPECT_GE(found.quality.mean, published.quality.mean);
    const test::SampledDistance theirDistance = test::sampledDistance(theirs, given, 2);
    const test::SampledDistance ourDistance = test::sampledDistance(ours, given, 2);
    EXPECT_LE(ourDistance.fromMesh, theirDistance.fromMesh);
    EXPECT_LE(ourDistance.fromObject, theirDistance.fromObject);
  }
}

/// Of a point to the boundary of a mesh: quads are bilinear, and searched ever more finely.
double distanceToBoundary(const HexMesh& mesh, std::span<const Quad> quads, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Quad& quad : quads) {
    double u = 0.5;
    double v = 0.5;
    for (double width = 0.5; width > 1e-4; width /= 3) {
      const std::array<double, 2> centre = {u, v};
      double best = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 49; ++i) {
        const double a = std::clamp(centre[0] + width * (i % 7 - 3) / 3, 0.0, 1.0);
        const double b = std::clamp(centre[1] + width * (i / 7 - 3) / 3, 0.0, 1.0);
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto at = [&](std::size_t c) { return mesh.points[quad[c]][k]; };
          const double x =
              (1 - a) * ((1 - b) * at(0) + b * at(3)) + a * ((1 - b) * at(1) + b * at(2));
          square += (x - point[k]) * (x - point[k]);
        }
        if (square >= best) continue;
        best = square;
        u = a;
        v = b;
      }
      least = std::min(least, std::sqrt(best));
    }
  }
  return least;
}

/// The quads of the boundary, found as those that occur once.
std::vector<Quad> boundaryOf(const HexMesh& mesh) {
  std::map<Quad, std::vector<Quad>> quads;
  for (const Hex& cell : mesh.cells) {
    for (const auto& face : adjacency::kHexFaces) {
      const Quad quad = {cell[face[0]], cell[face[1]], cell[face[2]], cell[face[3]]};
      Quad key = quad;
      std::sort(key.begin(), key.end());
      quads[key].push_back(quad);
    }
  }
  std::vector<Quad> boundary;
  for (const auto& [key, found] : quads) {
    if (found.size() == 1) boundary.push_back(found[0]);
  }
  return boundary;
}

/// Moves some vertices of the boundary to beyond a neighbour there, so that quads are folded.
void crumple(HexMesh& mesh, std::size_t count, double share, std::uint64_t seed,
             const std::function<bool(const Vec3&)>& isMovable) {
  Random random(seed);
  const std::vector<Quad> boundary = boundaryOf(mesh);
  for (std::size_t done = 0; done < count;) {
    const Quad& quad = boundary[static_cast<std::size_t>(random.real() * 0.9999 *
                                                         static_cast<double>(boundary.size()))];
    Vec3& point = mesh.points[quad[0]];
    const Vec3 other = mesh.points[quad[2]];
    if (!isMovable(point) || !isMovable(other)) continue;
    for (std::size_t k = 0; k < 3; ++k) point[k] += share * (other[k] - point[k]);
    ++done;
  }
}

/// A ball with folds: vertices beyond neighbours, but as far from the centre as they were.
HexMesh crumpledBall(const HexMesh& ball, std::size_t count, double share, std::uint64_t seed) {
  HexMesh mesh = ball;
  crumple(mesh, count, share, seed, [](const Vec3&) { return true; });
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v] == ball.points[v]) continue;
    const double factor = length(ball.points[v]) / length(mesh.points[v]);
    for (double& x : mesh.points[v]) x *= factor;
  }
  return mesh;
}

/// The folds are no creases, though the surface turns by half a circle there, and the folded
/// surface is left by the slack in untangling and in raising. While all of them
/// were held, one of these meshes was mended; while they were let go as a last resort, four.
TEST(Improve, MendsCrumpledBalls) {
  HEXHEX_LARGE_TEST();
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 3}).map;
  const HexMesh ball = extracted(map, 3);
  const double coarse = sampledDistance(ball, map).largest();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    HexMesh mesh = crumpledBall(ball, 5, 1.2, seed);
    const ImproveReport report = improved(mesh);
    expectNoWorse(report);
    EXPECT_FALSE(report.before.allPositive());
    EXPECT_TRUE(report.after.allPositive()) << "seed " << seed;
    if (improvement::canMoveAtOnce()) {
      EXPECT_GE(report.after.quality.minimum, 0.3) << "seed " << seed;
    }
    EXPECT_LE(sampledDistance(mesh, map).largest(), 1.2 * coarse + 2 * ImproveOptions{}.slack)
        << "seed " << seed;
  }
}

/// A grid, or a ball, whose vertices inside are anywhere in its bounding box.
HexMesh scrambled(HexMesh mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<bool> isOutside(mesh.points.size(), false);
  for (const Quad& quad : boundaryOf(mesh)) {
    for (const Index v : quad) isOutside[v] = true;
  }
  Vec3 low = mesh.points[0];
  Vec3 high = low;
  for (const Vec3& point : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (isOutside[v]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.points[v][k] = low[k] + random.real() * (high[k] - low[k]);
    }
  }
  return mesh;
}

/// Its boundary says where the inside has to be. One by one, vertices came to a minimum of 0.30.
TEST(Improve, BringsAScrambledGridBack) {
  if (!improvement::canMoveAtOnce()) GTEST_SKIP() << "without the solver";
  HexMesh mesh = scrambled(gridMesh(12), 5);
  const ImproveReport report = improved(mesh);
  expectNoWorse(report);
  EXPECT_GT(report.before.refuted + report.before.undecided, 1500U);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GT(report.after.quality.minimum, 0.98);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-9);
}

/// One by one, vertices left it as it was.
TEST(Improve, BringsAScrambledBallBack) {
  HEXHEX_LARGE_TEST();
  if (!improvement::canMoveAtOnce()) GTEST_SKIP() << "without the solver";
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 4}).map;
  const HexMesh ball = extracted(map, 3);
  HexMesh mesh = scrambled(ball, 6);
  HexMesh other = mesh;
  const ImproveReport report = improvedOn(mesh, map);
  expectNoWorse(report);
  EXPECT_GT(report.before.refuted + report.before.undecided, ball.cells.size() / 2);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GT(report.after.quality.minimum, 0.45);
  EXPECT_GT(report.after.quality.mean, 0.9);
  EXPECT_LE(sampledDistance(mesh, map).largest(),
            sampledDistance(ball, map).largest() + ImproveOptions{}.slack);
  improvedOn(other, map, {}, 4);
  EXPECT_EQ(mesh.points, other.points);
}

/// So many folds that some of their edges form chains.
TEST(Improve, LetsCreasesGoAsALastResort) {
  HEXHEX_LARGE_TEST();
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 3}).map;
  HexMesh mesh = crumpledBall(extracted(map, 3), 20, 2.2, 3);
  const ImproveReport report = improved(mesh);
  expectNoWorse(report);
  EXPECT_FALSE(report.before.allPositive());
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GT(report.offCreases, 0U);
}

TEST(Improve, KeepsCreasesOfACrumpledCube) {
  constexpr double kSide = 6;
  const HexMesh cube = gridMesh(6);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    HexMesh mesh = cube;
    crumple(mesh, 8, 1.2, seed, [](const Vec3& point) {
      return std::count_if(point.begin(), point.end(),
                           [](double x) { return x == 0 || x == kSide; }) == 1;
    });
    const ImproveReport report = improved(mesh);
    expectNoWorse(report);
    EXPECT_FALSE(report.before.allPositive());
    EXPECT_TRUE(report.after.allPositive()) << "seed " << seed;
    EXPECT_EQ(report.offCreases, 0U) << "seed " << seed;
    const std::vector<Quad> boundary = boundaryOf(mesh);
    const double limit = kSurfaceTolerance * kSide * std::numbers::sqrt3;
    for (const Quad& quad : boundary) {
      for (const Index v : quad) {
        double outside = 0;
        double nearest = kSide;
        for (const double x : mesh.points[v]) {
          outside = std::max({outside, -x, x - kSide});
          nearest = std::min({nearest, std::abs(x), std::abs(kSide - x)});
        }
        EXPECT_LE(std::max(outside, nearest), limit) << "vertex " << v;
      }
    }
    for (std::size_t edge = 0; edge < 12; ++edge) {
      const std::size_t axis = edge / 4;
      for (int i = 0; i <= 12; ++i) {
        Vec3 point{};
        point[axis] = kSide * i / 12;
        point[(axis + 1) % 3] = edge % 2 == 0 ? 0 : kSide;
        point[(axis + 2) % 3] = edge / 2 % 2 == 0 ? 0 : kSide;
        EXPECT_LE(distanceToBoundary(mesh, boundary, point), 1.01 * limit) << "edge " << edge;
      }
    }
  }
}

/// A box with a roof: two cells lie at each edge of its ridge, so only angles tell that it is one.
TEST(Improve, KeepsTheRidgeOfACrumpledRoof) {
  constexpr double kSide = 8;
  const auto height = [](double x) { return 1.5 * kSide - std::abs(x - kSide / 2); };
  HexMesh roof = gridMesh(8);
  for (Vec3& point : roof.points) point[2] *= height(point[0]) / kSide;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    HexMesh mesh = roof;
    crumple(mesh, 12, 1.2, seed, [&](const Vec3& point) {
      const bool isInside = point[0] > 0 && point[0] < kSide && point[1] > 0 && point[1] < kSide;
      return isInside && point[0] != kSide / 2 && std::abs(point[2] - height(point[0])) < 1e-9;
    });
    const ImproveReport report = improved(mesh);
    expectNoWorse(report);
    EXPECT_FALSE(report.before.allPositive());
    EXPECT_TRUE(report.after.allPositive()) << "seed " << seed;
    EXPECT_EQ(report.offCreases, 0U) << "seed " << seed;
    const std::vector<Quad> boundary = boundaryOf(mesh);
    for (int i = 0; i <= 16; ++i) {
      const Vec3 point = {kSide / 2, kSide * i / 16, 1.5 * kSide};
      EXPECT_LE(distanceToBoundary(mesh, boundary, point), 1e-3) << "seed " << seed;
    }
  }
}

TEST(Improve, SaysWhatIsWrongWithItsInput) {
  HexMesh empty;
  EXPECT_EQ(codeOf([&] { improved(empty); }), ErrorCode::EmptyMesh);
  HexMesh mesh = gridMesh(2);
  mesh.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codeOf([&] { improved(mesh); }), ErrorCode::NotFinite);
  mesh = gridMesh(2);
  mesh.cells[1][2] = 1000;
  EXPECT_EQ(codeOf([&] { improved(mesh); }), ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  mesh.features.edges.push_back({{0, 1000}, 1});
  EXPECT_EQ(codeOf([&] { improved(mesh); }), ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  const TetMap map = hexhex::testing::identityMap(2);
  EXPECT_EQ(codeOf([&] { improvedOn(mesh, map); }), ErrorCode::InvalidArgument);
  for (const double bad : {-1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    ImproveOptions options;
    options.target = bad;
    EXPECT_EQ(codeOf([&] { improved(mesh, options); }), ErrorCode::InvalidArgument);
    options = {};
    options.slack = bad;
    EXPECT_EQ(codeOf([&] { improved(mesh, options); }), ErrorCode::InvalidArgument);
  }
}

TEST(Improve, EndsForWhateverCellsThereAre) {
  // Points that coincide, cells that share an edge only.
  HexMesh mesh = gridMesh(3);
  for (std::size_t v = 0; v < 20; ++v) mesh.points[v] = mesh.points[0];
  expectNoWorse(improved(mesh));
  mesh = gridMesh(2, [](std::size_t x, std::size_t y, std::size_t) { return x == y; });
  expectNoWorse(improved(mesh));
}

TEST(Improve, LooksWhetherMapsAreWhole) {
  TetMap map = generateSample(SampleKind::Box, {.cells = 2}).map;
  HexMesh mesh = extracted(map, 1);
  const auto codeWith = [&](const auto& damage) {
    TetMap damaged = map;
    damage(damaged);
    return codeOf([&] { improvedOn(mesh, damaged); });
  };
  EXPECT_EQ(codeWith([](TetMap& m) { m.tets[5][2] = 0xfffffffe; }), ErrorCode::IndexOutOfRange);
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.features.faces = {{{0, 1, 0x7fffffff}, 1}};
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.features.vertices = {{0x7fffffff, 1}};
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) { m.regions = {1, 2}; }), ErrorCode::InvalidArgument);
  // A triangle of three tets; a map that has fewer tets than the one that the mesh comes from.
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.tets.push_back(m.tets[0]);
              m.parameters.push_back(m.parameters[0]);
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.tets.resize(1);
              m.parameters.resize(1);
            }),
            ErrorCode::InvalidArgument);
  mesh.generatorCorners[4] = 16;
  EXPECT_EQ(codeWith([](TetMap&) {}), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) { m.points[7][0] = std::numeric_limits<double>::infinity(); }),
            ErrorCode::NotFinite);
}

/// Beyond, squares of areas overflow or vanish: without an end, or without an effect.
TEST(Improve, RefusesSizesThatItCannotCompute) {
  const auto scaled = [](double factor, auto points) {
    for (Vec3& point : points) {
      for (double& x : point) x *= factor;
    }
    return points;
  };
  const HexMesh grid = gridMesh(3);
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 2}).map;
  const HexMesh ball = extracted(map, 1);
  for (const double factor : {1e-320, 1e-100, 1e-12, 1e31, 1e38, 1e60, 1e160, 1e300}) {
    HexMesh mesh = grid;
    mesh.points = scaled(factor, grid.points);
    EXPECT_EQ(codeOf([&] { improved(mesh); }), ErrorCode::TooLarge) << factor;
    TetMap other = map;
    other.points = scaled(factor, map.points);
    mesh = ball;
    mesh.points = scaled(factor, ball.points);
    EXPECT_EQ(codeOf([&] { improvedOn(mesh, other); }), ErrorCode::TooLarge) << factor;
  }
  HexMesh distorted = grid;
  distort(distorted, 3, 0.2, 4);
  for (const double factor : {1e-10, 1e-3, 1e29}) {
    HexMesh mesh = distorted;
    mesh.points = scaled(factor, distorted.points);
    EXPECT_GT(improved(mesh).movedVertices, 0U) << factor;
  }
}

/// Cancelled from within, after so many calls.
TEST(Improve, LeavesTheMeshAloneIfItIsCancelled) {
  HexMesh mesh = gridMesh(8);
  distort(mesh, 8, 0.6, 9);
  const HexMesh before = mesh;
  int interrupted = 0;
  for (int calls = 0; calls < 2000; calls = calls * 2 + 1) {
    int left = calls;
    Context* running = nullptr;
    Context context(1, [&](std::string_view /*stage*/, double /*share*/) {
      if (left-- == 0) running->cancel();
    });
    running = &context;
    try {
      improve(mesh, ImproveOptions{}, context);
      break;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
    ++interrupted;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      ASSERT_EQ(mesh.points[v], before.points[v]) << calls;
    }
  }
  EXPECT_GT(interrupted, 2);
}

// Quads of a ball are largest in the middles of its blocks, where it bends as much as elsewhere.
TEST(Improve, MakesFarQuadsSmallerUntilTheyAreNearer) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 5, .refine = 4}).map;
  HexMesh mesh = extracted(map, 1);
  const ImproveReport report = improvedOn(mesh, map);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GE(report.after.quality.minimum, report.before.quality.minimum);
  EXPECT_LT(report.distanceAfter.hausdorff(), 0.75 * report.distanceBefore.hausdorff());
}

// Neither is near, and still one is better: what was nothing each made them alike.
TEST(Improve, MeritTellsMeshesApartThatAreFar) {
  ImproveReport near;
  near.after.validity.resize(1);
  near.after.positive = 1;
  near.after.quality.minimum = 0.2;
  near.distanceAfter.fromMesh = 0.02;
  ImproveReport far = near;
  far.distanceAfter.fromMesh = 0.03;
  EXPECT_GT(improvement::meritOf(near), improvement::meritOf(far));
  EXPECT_GT(improvement::meritOf(far), 0);
}

}  // namespace hexhex::test
