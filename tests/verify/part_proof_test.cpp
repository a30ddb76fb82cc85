// The proof of parts passes those of random maps, and nothing else.
#include <gtest/gtest.h>
#include <verify/proof.hpp>

#include <base/parallel.hpp>
#include <igm/defects.hpp>
#include <sweep/tet_counts.hpp>

#include "verify/mutations.hpp"

namespace hexhex::test {

using namespace verification;
namespace {

/// How many maps of each test, at HEXHEX_TEST_EFFORT 1.
constexpr int kPartMaps = 100;

/// A map that is ready to prove parts.
class Reference {
 public:
  explicit Reference(const TetMapView& map)
      : map_(prepare(map)),
        stage_(context_, "verification"),
        expected_(expectationOf(map_, stage_)),
        counts_(sweep::countElements(map_, expected_.cells, nullptr, stage_)),
        proof_(map_, expected_, counts_) {}

  [[nodiscard]] bool passes(const MeshPart& part) {
    try {
      proof_.compare(part, stage_);
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::VerificationFailed);
      return false;
    }
  }

 private:
  igm::PreparedMap prepare(const TetMapView& map) {
    igm::DefectCollector defects;
    return igm::prepareMap(map, ExtractOptions().tolerance, 1, context_, defects,
                           igm::ChartChoice::Unfolded);
  }

  Context context_{1};
  igm::PreparedMap map_;
  Stage stage_;
  Expectation expected_;
  sweep::ElementCounts counts_;
  PartProof proof_;
};

PartOptions drawParts(Random& random) {
  PartOptions options;
  options.parts = static_cast<std::uint32_t>(1 + random.below(6));
  options.ghostLayers = static_cast<std::uint32_t>(random.below(3));
  options.verify = true;
  return options;
}

std::vector<MeshPart> partsOf(const TetMapView& map, const PartOptions& options) {
  Context context(1);
  return extractParts(map, {}, options, context);
}

TEST(PartProof, PassesWhatIsExtracted) {
  for (int i = 0; i < cases(kPartMaps); ++i) {
    Random random(static_cast<std::uint64_t>(i));
    const TetMap map = drawMap(random.next());
    const PartOptions options = drawParts(random);
    EXPECT_NO_THROW(static_cast<void>(partsOf(map, options))) << "map " << i;
    Context context(2);
    ExtractOptions scaled;
    scaled.scale = 2;
    EXPECT_NO_THROW(static_cast<void>(extractParts(map, scaled, options, context))) << "map " << i;
  }
}

TEST(PartProof, RefusesOtherMeshes) {
  std::map<std::string, int> refused;
  for (int i = 0; i < cases(kPartMaps); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    Random random(seed);
    const TetMap map = drawMap(seed);
    const std::vector<MeshPart> parts = partsOf(map, drawParts(random));
    const MeshPart& part = parts[random.below(parts.size())];
    if (part.mesh.cells.empty()) continue;
    Reference reference(map);
    ASSERT_TRUE(reference.passes(part)) << "map " << i;
    for (const Mutation& mutation : mutations()) {
      MeshPart wrong = part;
      if (!mutation.apply(wrong.mesh, random)) continue;
      // Parts list as many numbers as they have vertices and cells: no mutation of the lists.
      if (wrong.mesh.points.size() != part.mesh.points.size() ||
          wrong.mesh.cells.size() != part.mesh.cells.size()) {
        continue;
      }
      EXPECT_FALSE(reference.passes(wrong)) << mutation.name << ", map " << i;
      ++refused[mutation.name];
    }
    EXPECT_TRUE(reference.passes(part)) << "map " << i;
  }
  EXPECT_GE(refused.size(), 10U);
}

TEST(PartProof, RefusesOtherNumbers) {
  const TetMap map = generateSample(SampleKind::Torus).map;
  const MeshPart part = partsOf(map, {.parts = 3, .ghostLayers = 1}).at(1);
  Reference reference(map);
  const auto refuses = [&](const auto& change) {
    MeshPart wrong = part;
    change(wrong);
    return !reference.passes(wrong);
  };
  EXPECT_TRUE(reference.passes(part));
  EXPECT_TRUE(refuses([](MeshPart& p) { std::swap(p.globalPoints[0], p.globalPoints[1]); }));
  EXPECT_TRUE(refuses([](MeshPart& p) { std::swap(p.globalCells[0], p.globalCells[1]); }));
  EXPECT_TRUE(refuses([](MeshPart& p) { ++p.globalPoints.back(); }));
  EXPECT_TRUE(refuses([](MeshPart& p) { p.globalCells.back() = 0; }));
  EXPECT_TRUE(refuses([](MeshPart& p) { p.globalPoints[2] = kNone; }));
  EXPECT_TRUE(refuses([](MeshPart& p) { p.globalCells[2] = std::uint64_t{1} << 63U; }));
}

TEST(PartProof, WantsAsManyElementsAsTheMapHas) {
  const TetMap map = generateSample(SampleKind::Box).map;
  Context context(1);
  igm::DefectCollector defects;
  igm::PreparedMap prepared =
      igm::prepareMap(map, 1e-2, 1, context, defects, igm::ChartChoice::Unfolded);
  Stage stage(context, "verification");
  Expectation expected = expectationOf(prepared, stage);
  const sweep::ElementCounts counts =
      sweep::countElements(prepared, expected.cells, nullptr, stage);
  EXPECT_NO_THROW(PartProof(prepared, expected, counts));
  ++expected.cells;
  EXPECT_THROW(PartProof(prepared, expected, counts), Error);
}

}  // namespace
}  // namespace hexhex::test
