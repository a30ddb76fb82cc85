// Verification passes the mesh of a map in any numbering, and no other mesh: random maps.
#include "verify/mutations.hpp"

#include <string>

#include <gtest/gtest.h>

#include "support/joined_maps.hpp"

namespace hexhex::test {
namespace {

/// How many maps of each test, at HEXHEX_TEST_EFFORT 1.
constexpr int kMaps = 200;

/// How often something was done to a mesh, by kind.
class Counts {
 public:
  void add(const std::string& kind) { ++counts_[kind]; }
  /// Hardly any map is too small for any of them.
  void expectHundreds(std::size_t kinds) const {
    EXPECT_EQ(counts_.size(), kinds);
    for (const auto& [kind, count] : counts_) EXPECT_GE(count, cases(kMaps * 3 / 4)) << kind;
  }

 private:
  std::map<std::string, int> counts_;
};

TEST(Mutations, AreRefusedAll) {
  Counts canonical;
  Counts shuffled;
  for (int i = 0; i < cases(kMaps); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const TetMap map = drawMap(seed);
    const HexMesh mesh = extract(map);
    ASSERT_TRUE(passes(map, mesh)) << "map " << i;
    for (const Mutation& mutation : mutations()) {
      Random random(seed);
      HexMesh other = mesh;
      if (!mutation.apply(other, random)) continue;
      EXPECT_FALSE(passes(map, other)) << mutation.name << ", map " << i;
      canonical.add(mutation.name);
      other = renumbered(mesh, random);
      if (!mutation.apply(other, random)) continue;
      EXPECT_FALSE(passes(map, other)) << mutation.name << ", map " << i << ", renumbered";
      shuffled.add(mutation.name);
    }
  }
  canonical.expectHundreds(mutations().size());
  shuffled.expectHundreds(mutations().size());
}

TEST(Mutations, AreRefusedInPieces) {
  Counts counts;
  for (int i = 0; i < cases(kMaps); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const TetMap map = drawMap(seed);
    const HexMesh mesh = extract(map);
    Random random(seed);
    const VerifyReport right = verifiedInPieces<Hex>(map, mesh, random);
    EXPECT_TRUE(right.passed()) << i;
    EXPECT_EQ(right.items.size(), 5U);
    EXPECT_TRUE(verifiedInPieces<Hex64>(map, mesh, random).passed()) << i;
    for (const Mutation& mutation : mutations()) {
      HexMesh wrong = mesh;
      if (!mutation.apply(wrong, random)) continue;
      counts.add(mutation.name);
      const VerifyReport report = i % 2 == 0 ? verifiedInPieces<Hex>(map, wrong, random)
                                             : verifiedInPieces<Hex64>(map, wrong, random);
      EXPECT_FALSE(report.passed()) << mutation.name << ", map " << i;
    }
  }
  counts.expectHundreds(mutations().size());
}

TEST(Numberings, AreAcceptedAll) {
  for (int i = 0; i < cases(kMaps); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    Random random(seed);
    const TetMap map = drawMap(seed);
    ExtractOptions options;
    options.scale = static_cast<int>(1 + random.below(3));
    const HexMesh mesh = extract(map, options);
    VerifyOptions verifying;
    verifying.scale = options.scale;
    verifying.countElements = true;
    for (const HexMesh& same : {turned(mesh, random), renumbered(mesh, random)}) {
      const VerifyReport report = verify(map, same, verifying);
      EXPECT_TRUE(report.passed()) << "map " << i << ": " << failures(report);
    }
    // Meshes of the wrong scale, and of another map.
    verifying.scale = options.scale % 3 + 1;
    EXPECT_FALSE(passes(map, mesh, verifying)) << i;
    EXPECT_FALSE(verifiedInPieces<Hex>(map, mesh, random, verifying).passed()) << i;
    verifying.scale = options.scale;
    const TetMap another = drawMap(seed + 1000);
    EXPECT_FALSE(passes(another, mesh, verifying)) << i;
    EXPECT_FALSE(verifiedInPieces<Hex>(another, mesh, random, verifying).passed()) << i;
  }
}

/// The same map twice, one at the place of the other: each vertex has a twin, as if all of space
/// was a slit.
TEST(Twins, AreNotGluedOrExchanged) {
  for (int i = 0; i < cases(kMaps); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    Random random(seed);
    const TetMap one = drawMap(seed);
    TetMap map = joined(one, one);
    std::copy(one.points.begin(), one.points.end(),
              map.points.begin() + static_cast<std::ptrdiff_t>(one.points.size()));
    const HexMesh mesh = extract(map);
    const auto n = static_cast<Index>(mesh.points.size() / 2);
    ASSERT_EQ(mesh.points[0], mesh.points[n]);
    // The same is the second time, where no vertex is at the place of its number.
    for (const bool inOrder : {true, false}) {
      const std::uint64_t turn = random.next();
      const auto numbered = [&](const HexMesh& m) {
        Random same(turn);
        return inOrder ? m : renumbered(m, same);
      };
      const VerifyReport report = verify(map, numbered(mesh));
      EXPECT_TRUE(report.passed()) << i << ": " << failures(report);
      const Index v = mesh.cells[random.below(mesh.cells.size() / 2)][random.below(8)];
      HexMesh glued = mesh;
      merge(glued, v, v + n);
      EXPECT_FALSE(passes(map, numbered(glued))) << i;
      // Of one cell, if another one has the vertex as well: otherwise, twins are the same.
      const std::vector<int> uses = usesOf(mesh);
      if (uses[v] < 2) continue;
      HexMesh exchanged = mesh;
      for (Hex& cell : exchanged.cells) {
        const auto place = std::find(cell.begin(), cell.end(), v);
        if (place == cell.end()) continue;
        *place = v + n;
        break;
      }
      EXPECT_FALSE(passes(map, numbered(exchanged))) << i;
    }
  }
}

}  // namespace
}  // namespace hexhex::test
