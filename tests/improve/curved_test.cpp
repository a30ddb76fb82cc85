// Curved meshes end positive, with their nodes on the surface, and no worse.
#include <algorithm>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/samples.hpp>

#include <base/vector3.hpp>
#include <improve/curved_cells.hpp>

#include "mesh/grid_meshes.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using namespace improvement;

namespace {

using hexhex::testing::Random;

LagrangeMesh extractedCurved(const TetMap& map, int order, int scale) {
  ExtractOptions options;
  options.scale = scale;
  options.curvedNodes = CurvedNodes::Exact;  // of which some fold over
  Context context(2);
  return extractLagrange(map, order, options, context);
}

ImproveReport improvedCurved(LagrangeMesh& mesh, const TetMap* map,
                             const ImproveOptions& options = {}, int threads = 2) {
  Context context(threads);
  return map != nullptr ? improve(mesh, *map, options, context) : improve(mesh, options, context);
}

/// What holds of every mesh: certificates are found anew.
void expectNoWorseCurved(const LagrangeMesh& mesh, const ImproveReport& report) {
  Context context(2);
  const Certificate found = certify(mesh, context);
  EXPECT_EQ(found.validity, report.after.validity);
  EXPECT_EQ(found.scaledJacobians, report.after.scaledJacobians);
  EXPECT_GE(found.quality.minimum, report.before.quality.minimum);
  for (std::size_t c = 0; c < report.before.validity.size(); ++c) {
    if (report.before.validity[c] != Validity::Positive) continue;
    EXPECT_EQ(report.after.validity[c], Validity::Positive) << "cell " << c;
  }
}

/// Moves all nodes inside of a box from 0 to n.
void distortInside(LagrangeMesh& mesh, double n, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& point : mesh.points) {
    const bool isInside =
        std::all_of(point.begin(), point.end(), [n](double x) { return x > 1e-9 && x < n - 1e-9; });
    if (!isInside) continue;
    for (double& x : point) x += amount * (2 * random.real() - 1);
  }
}

}  // namespace

/// A step of any node changes determinants and squares as the terms say.
TEST(ImproveCurved, TermsTellHowDeterminantsChange) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 1, .jitter = 0.3}).map;
  Context context(1);
  Stage stage(context, "test");
  for (const int order : {1, 2, 3}) {
    const LagrangeMesh mesh = extractedCurved(map, order, 1);
    const CurvedCells cells(mesh, stage);
    ImprovedCells::Scratch scratch;
    const std::array<Index, 1> around = {0};
    const Array<IdealBox> boxes(mesh.cellCount(), {1, 2, 3});
    Random random(5);
    for (std::size_t i = 0; i < mesh.nodesPerCell(); ++i) {
      const Index node = mesh.nodes[i];
      const Vec3 step = {0.1 * random.real(), -0.1 * random.real(), 0.05};
      Array<Vec3> moved = mesh.points;
      for (std::size_t k = 0; k < 3; ++k) moved[node][k] += step[k];
      for (const TermKind kind : {TermKind::Corners, TermKind::Bezier}) {
        EnergyTerms before;
        EnergyTerms after;
        cells.addTerms(mesh.points, around, node, boxes, kind, scratch, before);
        cells.addTerms(moved, around, node, boxes, kind, scratch, after);
        ASSERT_EQ(before.blocks().size(), after.blocks().size());
        const auto places = static_cast<std::size_t>((kind == TermKind::Bezier ? 3 : 2) * order);
        ASSERT_EQ(before.blocks().size(), places * places * places);
        for (std::size_t t = 0; t < before.blocks().size(); ++t) {
          const TermLanes& term = before.blocks()[t];
          for (std::size_t lane = 0; lane < TermLanes::kCount; ++lane) {
            EXPECT_EQ(term.weight[lane], lane < around.size() ? 1 : 0);
            const auto along = [&](const auto& vector) {
              return vector[0][lane] * step[0] + vector[1][lane] * step[1] +
                     vector[2][lane] * step[2];
            };
            if (term.weight[lane] == 0) continue;
            EXPECT_NEAR(term.determinant[lane] + along(term.normal),
                        after.blocks()[t].determinant[lane], 1e-7);
            EXPECT_NEAR(
                term.square[lane] + 2 * along(term.slope) + term.growth[lane] * dot(step, step),
                after.blocks()[t].square[lane], 1e-7);
          }
        }
      }
    }
  }
}

TEST(ImproveCurved, IsTheSameBitsForAllWidthsOfRegisters) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 1, .jitter = 0.6}).map;
  for (const int order : {2, 3}) {
    const LagrangeMesh mesh = extractedCurved(map, order, 1);
    LagrangeGrid grid = {{order, curved::equidistant(3 * order - 1)}};
    grid.toBezier = mesh::nodeMatrices<double>(3 * static_cast<std::size_t>(order) - 1).values;
    const auto nodesOf = [&](std::size_t i) { return &mesh.nodes[i * mesh.nodesPerCell()]; };
    const curved::LagrangeCells cells(mesh.points.data(), 3, nodesOf);
    const MovingNode moving{cells, 3, {0, 1, 2, 2}, {{{1, 2, 3}, {1, 1, 1}, {2, 2, 1}, {2, 2, 1}}}};
    const auto results = [&](const LagrangeKernels& kernels) {
      curved::LagrangeScratch scratch;
      std::vector<TermLanes> terms(grid.columns.placeCount());
      kernels.terms(grid, moving, scratch, terms.data());
      return std::pair(std::move(terms), kernels.leastShares(grid, cells, scratch));
    };
    const auto [terms, shares] = results(lagrangeKernels().front());
    for (const LagrangeKernels& kernels : lagrangeKernels()) {
      const auto [sameTerms, sameShares] = results(kernels);
      EXPECT_EQ(sameShares, shares);
      EXPECT_EQ(std::memcmp(sameTerms.data(), terms.data(), terms.size() * sizeof(TermLanes)), 0);
    }
    // A cell has the same share in any lane.
    const curved::LagrangeCells turned(mesh.points.data(), 3,
                                       [&](std::size_t i) { return nodesOf(2 - i); });
    curved::LagrangeScratch scratch;
    const auto ofTurned = lagrangeKernels().front().leastShares(grid, turned, scratch);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(ofTurned[i], shares[2 - i]);
  }
}

TEST(ImproveCurved, MendsDistortedBoxes) {
  const TetMap map = generateSample(SampleKind::Box, {.cells = 1}).map;
  for (const int order : {2, 3}) {
    int bad = 0;
    for (std::uint64_t seed = 1; seed <= (order == 2 ? 2U : 1U); ++seed) {
      LagrangeMesh mesh = extractedCurved(map, order, 1);
      double n = 0;
      for (const Vec3& point : mesh.points) n = std::max(n, point[0]);
      distortInside(mesh, n, 0.35 * n / order, seed);
      const Array<Vec3> before = mesh.points;
      const ImproveReport report = improvedCurved(mesh, nullptr, {.target = 0.1, .passes = 1});
      expectNoWorseCurved(mesh, report);
      if (!report.before.allPositive()) ++bad;
      EXPECT_TRUE(report.after.allPositive()) << order << ", " << seed;
      EXPECT_LT(report.distanceAfter.hausdorff(), 1e-12);
      EXPECT_EQ(report.offSurface, 0U);
      EXPECT_EQ(report.vertices[3], 8U);
      for (std::size_t v = 0; v < before.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (before[v][k] == 0) {
            EXPECT_NEAR(mesh.points[v][k], 0, 1e-12 * n);
          }
        }
      }
    }
    EXPECT_GE(bad, 1) << order;
  }
}

TEST(ImproveCurved, MendsSamplesOfAllKinds) {
  HEXHEX_LARGE_TEST();
  int bad = 0;
  int mended = 0;
  for (const SampleKindName& kind : sampleKinds()) {
    // Without tags, nodes may use the slack.
    const bool isTagged = kind.kind == SampleKind::Torus;
    const Sample sample =
        generateSample(kind.kind, {.cells = 1, .jitter = 0.4, .features = isTagged, .seed = 11});
    for (const int order : {2, 3}) {
      if (order == 3 && kind.kind != SampleKind::Star) continue;  // for time
      LagrangeMesh mesh = extractedCurved(sample.map, order, 1);
      const LagrangeMesh before = mesh;
      const ImproveReport report = improvedCurved(mesh, &sample.map, {.target = 0.1, .passes = 1});
      expectNoWorseCurved(mesh, report);
      EXPECT_EQ(mesh.nodes, before.nodes);
      EXPECT_EQ(mesh.features, before.features);
      if (report.before.allPositive()) continue;
      ++bad;
      mended += report.after.allPositive() ? 1 : 0;
    }
  }
  EXPECT_GE(bad, 3);
  EXPECT_EQ(mended, bad);
}

TEST(ImproveCurved, GivesTheSameBytesWithAnyNumberOfThreads) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 1, .jitter = 0.8}).map;
  LagrangeMesh one = extractedCurved(map, 2, 1);
  LagrangeMesh two = one;
  improvedCurved(one, &map, {}, 1);
  const ImproveReport report = improvedCurved(two, &map, {}, 2);
  EXPECT_GT(report.movedVertices, 0U);
  EXPECT_EQ(one.points, two.points);
}

TEST(ImproveCurved, KeepsTagsOfAMeshWithoutItsMap) {
  const Sample sample = generateSample(SampleKind::Box, {.cells = 2, .features = true});
  LagrangeMesh mesh = extractedCurved(sample.map, 2, 1);
  ASSERT_FALSE(mesh.features.edges.empty());
  Context context(1);
  Stage stage(context, "nodes");
  const HexMesh refined = refinedMesh(mesh, stage);
  EXPECT_EQ(refined.features.edges.size(), 2 * mesh.features.edges.size());
  EXPECT_EQ(refined.features.quads.size(), 4 * mesh.features.quads.size());
  EXPECT_EQ(refined.cells.size(), 8 * mesh.cellCount());
  EXPECT_TRUE(certify(refined, context).allPositive());
}

TEST(ImproveCurved, SaysWhatIsWrongWithItsInput) {
  const TetMap map = generateSample(SampleKind::Box, {.cells = 1}).map;
  LagrangeMesh mesh = extractedCurved(map, 4, 1);
  EXPECT_EQ(codeOf([&] { improvedCurved(mesh, &map); }), ErrorCode::InvalidArgument);
  mesh = extractedCurved(map, 2, 1);
  mesh.nodes[5] = 100000;
  EXPECT_EQ(codeOf([&] { improvedCurved(mesh, &map); }), ErrorCode::InvalidArgument);
  mesh = extractedCurved(map, 2, 1);
  mesh.points.back()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codeOf([&] { improvedCurved(mesh, &map); }), ErrorCode::NotFinite);
  mesh = extractedCurved(map, 2, 1);
  mesh.generatorTet.clear();
  mesh.generatorCorners.clear();
  EXPECT_EQ(codeOf([&] { improvedCurved(mesh, &map); }), ErrorCode::InvalidArgument);
}

}  // namespace hexhex::test
