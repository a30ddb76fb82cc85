// Extraction straight into a file: the arrays of the ordinary writers, of whatever map.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/summary.hpp>

#include <io/io_test_support.hpp>

namespace hexhex::test {
namespace {

struct RandomCase {
  Sample sample;
  ExtractOptions options;
};

/// A sample of any kind with any difficulty, and a scale.
RandomCase randomCase(Random& random) {
  const auto kinds = sampleKinds();
  const auto upToOne = [&] { return 1e-3 * static_cast<double>(random.below(1001)); };
  SampleOptions options;
  options.cells = static_cast<int>(1 + random.below(5));
  options.refine = static_cast<int>(1 + random.below(3));
  options.valence = static_cast<int>(3 + random.below(6));
  options.charts = static_cast<ChartStyle>(random.below(4));
  options.jitter = 0.5 * upToOne();
  options.onLattice = upToOne();
  options.offset = random.below(2) == 0 ? 0 : 1e6;
  options.seed = random.next();
  RandomCase result{generateSample(kinds[random.below(kinds.size())].kind, options), {}};
  result.options.scale = static_cast<int>(1 + random.below(3));
  return result;
}

/// The ordinary writer's text without boundary quads.
std::string withoutQuads(std::string text) {
  const std::size_t begin = text.find("Quadrilaterals");
  return text.erase(begin, text.find("Hexahedra") - begin);
}

TEST(ExtractToFile, HasTheArraysOfTheOrdinaryWriters) {
  const TemporaryFolder folder;
  Random random(41);
  for (int i = 0; i < 40; ++i) {
    const RandomCase drawn = randomCase(random);
    Context context(1 + i % 3);
    const HexMesh mesh = extract(drawn.sample.map, drawn.options, context);
    for (const std::string extension : {".vtu", ".mesh"}) {
      ExtractStatistics statistics;
      writeHexMesh(mesh, folder / ("whole" + extension), context);
      extractToFile(folder / ("pieces" + extension), drawn.sample.map, drawn.options, context,
                    &statistics);
      EXPECT_EQ(statistics.vertices[0] + statistics.vertices[1] + statistics.vertices[2] +
                    statistics.vertices[3],
                mesh.points.size());
      EXPECT_EQ(summarizeFile(folder / ("pieces" + extension), context), summarize(mesh, context));
    }
    EXPECT_TRUE(contentOf(folder / "pieces.mesh") == withoutQuads(contentOf(folder / "whole.mesh")))
        << i;
    const std::string whole = contentOf(folder / "whole.vtu");
    const std::string pieces = contentOf(folder / "pieces.vtu");
    for (const char* name : {"generator_kind", "generator_tet", "generator_corners", "Points",
                             "connectivity", "offsets", "types"}) {
      ASSERT_NE(arrayOf(whole, name), "no such array") << name;
      EXPECT_TRUE(arrayOf(pieces, name) == arrayOf(whole, name)) << name << " of case " << i;
    }
  }
  EXPECT_EQ(folder.fileCount(), 4U);
}

TEST(ExtractToFile, LeavesNothingBehindAnInvalidMap) {
  const TemporaryFolder folder;
  TetMap map = generateSample(SampleKind::Box).map;
  std::swap(map.parameters[0][0], map.parameters[0][1]);
  Context context;
  EXPECT_NE(failureOf([&] { extractToFile(folder / "a.vtu", map, {}, context); }).code,
            ErrorCode::Internal);
  EXPECT_EQ(failureOf([&] { extractToFile(folder / "a.ovm", map, {}, context); }).code,
            ErrorCode::FileUnsupported);
  EXPECT_EQ(folder.fileCount(), 0U);
}

}  // namespace
}  // namespace hexhex::test
