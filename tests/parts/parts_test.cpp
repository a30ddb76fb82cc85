// Parts make up the mesh in one piece, whatever the map, the number of parts and that of threads.
#include <algorithm>
#include <mutex>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>

#include "support/coarse_maps.hpp"
#include "support/damaged_maps.hpp"
#include "support/effort.hpp"
#include "support/part_check.hpp"

namespace hexhex {
namespace {

using test::comparePartsWithWhole;

TEST(Parts, MakeUpRandomSamples) {
  std::mt19937_64 random(27);
  for (int i = 0; i < test::cases(12); ++i) {
    test::MapDamage draw(random());
    const TetMap map = draw.sample();
    ExtractOptions options;
    options.scale = map.tets.size() < 1000 ? 1 + draw.below(3) : 1;
    PartOptions parts;
    parts.parts = 1U << draw.below(7U);
    if (draw.below(2) == 0) parts.parts += draw.below(5U);
    parts.ghostLayers = draw.below(3U);
    EXPECT_EQ(comparePartsWithWhole(map, options, parts), "")
        << "case " << i << ": " << map.tets.size() << " tets, scale " << options.scale << ", "
        << parts.parts << " parts, " << parts.ghostLayers << " layers";
  }
}

TEST(Parts, MakeUpMeshesWhoseCellsMeetThemselves) {
  for (const Index cells : {1U, 2U}) {
    for (const std::uint32_t parts : {2U, 3U, 8U}) {
      EXPECT_EQ(comparePartsWithWhole(test::threeTorus(cells), {}, {parts, 1}), "") << cells;
    }
  }
}

TEST(Parts, MakeUpMeshesOfLargeTets) {
  // Faces are so large that what may leave a part through them is bounded piece by piece.
  SampleOptions options;
  options.cells = 1;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Box, options).map;
  EXPECT_EQ(comparePartsWithWhole(map, {.scale = 16}, {3, 1}), "");
}

TEST(Parts, MakeUpTheMeshIfThereAreHundreds) {
  HEXHEX_LARGE_TEST();
  SampleOptions options;
  options.charts = ChartStyle::Random;
  options.cells = 8;
  options.refine = 2;
  const TetMap small = generateSample(SampleKind::Sphere, options).map;
  EXPECT_EQ(comparePartsWithWhole(small, {}, {512, 0}), "");
  options.cells = 2;
  options.refine = 1;
  const TetMap large = generateSample(SampleKind::Sphere, options).map;  // tets larger than parts
  EXPECT_EQ(comparePartsWithWhole(large, {.scale = 5}, {512, 1}), "");
}

/// Where the region of a part is the whole map: without that, each of these takes seconds.
TEST(Parts, OfCoarseMapsAroundSingularitiesMakeUpTheMesh) {
  SampleOptions options;
  options.cells = 3;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const std::uint32_t ghosts : {0U, 2U}) {
    EXPECT_EQ(comparePartsWithWhole(map, {}, {4, ghosts}), "");
  }
}

/// Largest part over the mean, and vertices of more than one part, once in each.
struct Cut {
  double imbalance;
  std::uint64_t shared;
};
Cut cutOf(const TetMap& map, const PartOptions& options, int scale) {
  class Nothing final : public PartSink {
   public:
    void begin(const PartsInfo& /*info*/) override {}
    void part(MeshPart&& /*part*/) override {}
    void end() override {}
  };
  Nothing nothing;
  PartSummarySink checked(nothing);
  Context context;
  ExtractOptions extraction;
  extraction.scale = scale;
  extractParts(checked, map, extraction, options, context);
  const PartsSummary& summary = checked.result();
  return {static_cast<double>(summary.largest) * options.parts / static_cast<double>(summary.cells),
          summary.sharedVertices};
}

TEST(Parts, AreEven) {
  SampleOptions options;
  options.cells = 8;
  for (const SampleKind kind : {SampleKind::Box, SampleKind::Shell}) {
    // 96 tets and 576: parts are far smaller than tets, and a few tets large.
    const TetMap map = generateSample(kind, options).map;
    for (const std::uint32_t parts : {3U, 16U, 100U}) {
      EXPECT_LE(cutOf(map, {parts}, 2).imbalance, 1.05) << parts;
    }
  }
}

TEST(Parts, OfMetisAndScotchMakeUpTheMeshToo) {
  SampleOptions options;
  options.cells = 6;
  const TetMap map = generateSample(SampleKind::Torus, options).map;
  const TetMap large = generateSample(SampleKind::Shell).map;  // tets that are cut into cubes
  for (const PartitionMethod method : {PartitionMethod::Metis, PartitionMethod::Scotch}) {
    const PartOptions parts{16, 0, method};
    Cut cut{};
    try {
      cut = cutOf(map, parts, 1);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::InvalidArgument) << error.what();
      GTEST_SKIP() << error.what();
    }
    EXPECT_EQ(comparePartsWithWhole(map, {}, parts), "");
    EXPECT_EQ(comparePartsWithWhole(large, {.scale = 4}, {5, 1, method}), "");
    EXPECT_LE(cut.imbalance, 1.05);
    const Cut curve = cutOf(map, {16}, 1);
    EXPECT_LE(cut.shared, curve.shared);
    if (method == PartitionMethod::Metis) {
      EXPECT_LE(static_cast<double>(curve.shared), 1.5 * static_cast<double>(cut.shared));
    }
  }
}

TEST(Parts, OfScotchAreTheSameEachTime) {
  const TetMap map = generateSample(SampleKind::HandleBody).map;
  const PartOptions parts{5, 0, PartitionMethod::Scotch};
  constexpr int kScale = 3;
  Cut first{};
  try {
    first = cutOf(map, parts, kScale);
  } catch (const Error& error) {
    ASSERT_EQ(error.code(), ErrorCode::InvalidArgument) << error.what();
    GTEST_SKIP() << error.what();
  }
  constexpr int kRuns = 6;
  for (int i = 1; i < kRuns; ++i) {
    const Cut again = cutOf(map, parts, kScale);
    EXPECT_EQ(again.shared, first.shared) << i;
    EXPECT_EQ(again.imbalance, first.imbalance) << i;
  }
}

TEST(Parts, ThatDoNotFitTogetherAreRefused) {
  class Counter final : public PartSink {
   public:
    void begin(const PartsInfo& /*info*/) override {}
    void part(MeshPart&& /*part*/) override {}
    void end() override { ++ends; }
    int ends = 0;
  };
  const TetMap map = generateSample(SampleKind::Sphere).map;
  Context context;
  const std::vector<MeshPart> parts = extractParts(map, {}, {3}, context);
  const HexMesh mesh = extract(map);
  const auto refusedWith = [&](const auto& change) {
    std::vector<MeshPart> changed = parts;
    change(changed[1]);
    Counter counter;
    PartSummarySink checked(counter);
    checked.begin({3, 0, mesh.points.size(), mesh.cells.size()});
    for (MeshPart& part : changed) checked.part(std::move(part));
    try {
      checked.end();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::VerificationFailed);
      EXPECT_EQ(counter.ends, 0);
      return true;
    }
    EXPECT_EQ(counter.ends, 1);
    return false;
  };
  EXPECT_FALSE(refusedWith([](MeshPart&) {}));
  EXPECT_TRUE(refusedWith([](MeshPart& part) { --part.ownCells; }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) { ++part.globalCells[0]; }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) {
    const auto own = std::find(part.pointOwners.begin(), part.pointOwners.end(), 1U);
    part.pointOwners[static_cast<std::size_t>(own - part.pointOwners.begin())] = 0;
  }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) {
    const auto own = std::find(part.pointOwners.begin(), part.pointOwners.end(), 1U);
    ++part.globalPoints[static_cast<std::size_t>(own - part.pointOwners.begin())];
  }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) { part.neighbours.pop_back(); }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) { part.neighbours[0].vertices.pop_back(); }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) { part.neighbours[0].faces.pop_back(); }));
  EXPECT_TRUE(refusedWith([](MeshPart& part) {
    std::swap(part.neighbours[0].vertices[0], part.neighbours[0].vertices[1]);
  }));
}

/// Keeps what it receives, from any thread.
class Receiver : public PartSink {
 public:
  explicit Receiver(bool anyOrder) : anyOrder_(anyOrder) {}
  [[nodiscard]] bool takesAnyOrder() const override { return anyOrder_; }
  void begin(const PartsInfo& /*info*/) override {}
  void part(MeshPart&& part) override {
    if (part.part == failing) throw Error(ErrorCode::FileWrite, "as if the disk were full");
    const std::lock_guard lock(mutex_);
    received.push_back(std::move(part));
  }
  void end() override { ended = true; }

  std::uint32_t failing = kMaxParts;
  bool ended = false;
  std::vector<MeshPart> received;

 private:
  bool anyOrder_;
  std::mutex mutex_;
};

TEST(Parts, ComeInOrderUnlessTheSinkTakesThemInAny) {
  const TetMap map = generateSample(SampleKind::Sphere).map;
  Context context(4);
  const std::vector<MeshPart> expected = extractParts(map, {}, {23, 1}, context);
  for (const bool anyOrder : {false, true}) {
    Receiver sink(anyOrder);
    PartSummarySink checked(sink);
    extractParts(checked, map, {}, {23, 1}, context);
    EXPECT_TRUE(sink.ended);
    std::vector<MeshPart>& parts = sink.received;
    ASSERT_EQ(parts.size(), 23U);
    const auto comesFirst = [](const MeshPart& a, const MeshPart& b) { return a.part < b.part; };
    if (anyOrder) std::sort(parts.begin(), parts.end(), comesFirst);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(parts[i].part, i);
      EXPECT_EQ(parts[i].globalCells, expected[i].globalCells);
      EXPECT_EQ(parts[i].mesh.cells, expected[i].mesh.cells);
    }
  }
}

TEST(Parts, EndWhereASinkFails) {
  const TetMap map = generateSample(SampleKind::Sphere).map;
  for (const bool anyOrder : {false, true}) {
    Receiver sink(anyOrder);
    sink.failing = 3;
    Context context(2);
    try {
      extractParts(sink, map, {}, {1000}, context);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::FileWrite);
    }
    EXPECT_FALSE(sink.ended);
    if (!anyOrder) {
      EXPECT_EQ(sink.received.size(), 3U);
    }
  }
}

TEST(Parts, AreRefusedForOptionsOutOfRange) {
  Context context;
  const TetMap map = generateSample(SampleKind::Box).map;
  for (const PartOptions& options :
       {PartOptions{0}, PartOptions{kMaxParts + 1}, PartOptions{2, kMaxGhostLayers + 1}}) {
    try {
      static_cast<void>(extractParts(map, {}, options, context));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    }
  }
}

}  // namespace
}  // namespace hexhex
