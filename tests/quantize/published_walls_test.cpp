// Maps as they are published, with walls of another program's motorcycle complex: from the file to
// an improved mesh, walls are no features, unless they are kept.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

#include "quantize/real_maps.hpp"
#include "support/effort.hpp"
#include "support/published_map.hpp"
#include "support/sampled_distance.hpp"

namespace hexhex::test {

namespace {

constexpr std::array kBlockKinds = {SampleKind::Box,  SampleKind::Cylinder, SampleKind::Sphere,
                                    SampleKind::Star, SampleKind::Torus,    SampleKind::Shell};

Sample seamlessSample(SampleKind kind) {
  return generateSample(
      kind, {.cells = 3, .charts = ChartStyle::Blocks, .stretch = 0.3, .features = true});
}

TetMap parse(const PublishedMap& published, bool keepWalls = false) {
  Context context;
  return readBytes<io::readHexex>(published.text, "published.hexex", context,
                                  ReadOptions{.keepWalls = keepWalls});
}

/// What `extract --quantize --improve` makes of a map.
struct Result {
  TetMap map;  ///< quantized
  HexMesh rough;
  HexMesh mesh;
  ImproveReport report;
};

Result quantizeAndImprove(const TetMap& map, double cells) {
  Context context(2);
  Result result;
  QuantizeOptions options;
  options.cells = cells;
  result.map = quantize(map, options, context).map;
  result.rough = extract(result.map, {}, context);
  result.mesh = result.rough;
  result.report = improve(result.mesh, result.map, {}, context);
  return result;
}

std::set<Index> boundaryVertices(const HexMesh& mesh) {
  std::set<Index> vertices;
  for (const Quad& quad : sampled::boundaryOf(mesh)) vertices.insert(quad.begin(), quad.end());
  return vertices;
}

void expectDistances(const Result& result) {
  expectSampled(result.report.distanceBefore, result.rough, result.map);
  expectSampled(result.report.distanceAfter, result.mesh, result.map);
}

/// At an angle that coarse meshes of round surfaces stay below.
std::size_t patchCount(const HexMesh& mesh) {
  Context context;
  std::set<std::int32_t> patches;
  for (const FeatureQuad& quad : boundaryPatches(mesh, 80, context)) patches.insert(quad.tag);
  return patches.size();
}

/// Cells that are connected otherwise than across tagged quads.
std::size_t blockCount(const HexMesh& mesh) {
  std::set<std::array<Index, 4>> walls;
  const auto ascending = [](Quad quad) {
    std::sort(quad.begin(), quad.end());
    return quad;
  };
  for (const FeatureQuad& quad : mesh.features.quads) walls.insert(ascending(quad.vertices));
  std::map<std::array<Index, 4>, std::vector<std::size_t>> cellsOf;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (const auto& corners : sampled::kFacesOfHex) {
      const Hex& cell = mesh.cells[c];
      cellsOf[ascending({cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]})]
          .push_back(c);
    }
  }
  std::vector<std::size_t> block(mesh.cells.size());
  for (std::size_t c = 0; c < block.size(); ++c) block[c] = c;
  for (bool changes = true; changes;) {
    changes = false;
    for (const auto& [face, cells] : cellsOf) {
      if (cells.size() != 2 || walls.contains(face) || block[cells[0]] == block[cells[1]]) continue;
      block[cells[0]] = block[cells[1]] = std::min(block[cells[0]], block[cells[1]]);
      changes = true;
    }
  }
  return std::set<std::size_t>(block.begin(), block.end()).size();
}

}  // namespace

TEST(Walls, AreNoFeaturesOfAMesh) {
  HEXHEX_LARGE_TEST();
  for (const SampleKind kind : kBlockKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    const Sample sample = seamlessSample(kind);
    const auto cells = static_cast<double>(sample.answer.expected.cells);
    const Result result = quantizeAndImprove(parse(published(sample.map)), cells);
    expectDistances(result);
    // The same as without any list of triangles.
    TetMap plain = sample.map;
    plain.features.faces.clear();
    plain.regions.clear();
    EXPECT_EQ(result.mesh.points, quantizeAndImprove(plain, cells).mesh.points);
    EXPECT_TRUE(result.mesh.features.quads.empty());
    // Curves of those that are left out divide smooth surfaces.
    if (kind != SampleKind::Torus && kind != SampleKind::Shell) {
      EXPECT_EQ(patchCount(result.mesh), sample.answer.features.quads.size());
    }
    // Without curves, all vertices inside are free.
    const ImproveReport report =
        quantizeAndImprove(parse(published(sample.map, false)), cells).report;
    EXPECT_EQ(report.vertices[0], result.mesh.points.size() - boundaryVertices(result.mesh).size());
  }
}

TEST(Walls, AreFacesBetweenBlocksIfTheyAreKept) {
  HEXHEX_LARGE_TEST();
  for (const SampleKind kind : kBlockKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    const Sample sample = seamlessSample(kind);
    for (const bool withFeatures : {false, true}) {
      const PublishedMap file = published(sample.map, withFeatures);
      const TetMap map = parse(file, true);
      EXPECT_EQ(map.features.faces.size(), file.innerWalls.size());
      const Result result =
          quantizeAndImprove(map, static_cast<double>(sample.answer.expected.cells));
      EXPECT_EQ(blockCount(result.mesh), sample.answer.features.regions);
      expectDistances(result);
    }
  }
}

TEST(Walls, OfPublishedMapsAreNoFeatures) {
  HEXHEX_LARGE_TEST();
  if (realMaps().empty()) GTEST_SKIP() << "no real maps";
  const std::vector<std::filesystem::path> all = realMaps();
  for (std::size_t i = 0; i < all.size(); i += 2) {  // each takes seconds
    const std::filesystem::path& file = all[i];
    SCOPED_TRACE(file.stem().string());
    const TetMap map = readMap(file);
    const Result result = quantizeAndImprove(map, static_cast<double>(map.tets.size()) / 4);
    expectDistances(result);
    EXPECT_TRUE(result.mesh.features.quads.empty());
    EXPECT_TRUE(result.report.after.allPositive());
    if (file.stem() == "s01c_cube") {
      EXPECT_EQ(patchCount(result.mesh), 6U);
      EXPECT_LT(sampledDistance(result.mesh, map).largest(), 1e-9);
    }
  }
}

}  // namespace hexhex::test
