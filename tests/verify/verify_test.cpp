// What verification says of single meshes. (Of random ones: mutations_test.cpp.)
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <mesh/grid_meshes.hpp>

#include "support/coarse_maps.hpp"
#include "support/error_of.hpp"
#include "support/joined_maps.hpp"
#include "verify/mutations.hpp"

namespace hexhex::test {
namespace {

using testing::gridMesh;
using testing::identityMap;

/// Two boxes with a slit between them: vertices at the same places.
TetMap slitMap() {
  const TetMap box = identityMap(2);
  TetMap map = joined(box, box);
  for (std::size_t v = box.points.size(); v < map.points.size(); ++v) map.points[v][0] -= 8;
  return map;
}

TEST(Verify, KnowsTheTwoSidesOfASlit) {
  const TetMap map = slitMap();
  const HexMesh mesh = extract(map);
  ASSERT_EQ(mesh.points.size(), 54U);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const HexMesh other = renumbered(mesh, random);
    EXPECT_TRUE(passes(map, other));
    // Glue two vertices at one place, of cells at the slit; or exchange them.
    for (Index v = 0; v < other.points.size(); ++v) {
      for (Index w = 0; w < v; ++w) {
        if (other.points[v] != other.points[w]) continue;
        HexMesh glued = other;
        merge(glued, v, w);
        EXPECT_FALSE(passes(map, glued));
        HexMesh crossed = other;
        for (Hex& cell : crossed.cells) {
          const auto place = std::find(cell.begin(), cell.end(), v);
          if (place == cell.end()) continue;
          *place = w;
          break;
        }
        EXPECT_FALSE(passes(map, crossed));
      }
    }
  }
}

TEST(Verify, TellsCellsAtOnePlaceApart) {
  // The same box twice, one in the other, and a longer box in both.
  for (const std::size_t longer : {2U, 4U}) {
    const TetMap box = identityMap(2);
    const TetMap second = identityMap(longer);
    TetMap map = joined(box, second);
    for (std::size_t v = box.points.size(); v < map.points.size(); ++v) map.points[v][0] -= 10;
    const HexMesh mesh = extract(map);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Random random(seed);
      HexMesh other = renumbered(mesh, random);
      EXPECT_TRUE(passes(map, other)) << longer;
      std::swap(other.cells[0][0], other.cells[1][0]);
      EXPECT_EQ(passes(map, other), other.cells[0][0] == other.cells[1][0]);
    }
  }
}

TEST(Verify, KnowsHowManyDigitsPositionsHave) {
  SampleOptions sample;
  sample.jitter = 1;
  const TetMap map = generateSample(SampleKind::Sphere, sample).map;
  const HexMesh mesh = extract(map);
  HexMesh floats = mesh;
  HexMesh text = mesh;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = mesh.points[v][k];
      floats.points[v][k] = static_cast<double>(static_cast<float>(x));
      char digits[32];
      static_cast<void>(std::snprintf(digits, sizeof(digits), "%.7g", x));
      text.points[v][k] = std::strtod(digits, nullptr);
    }
  }
  EXPECT_TRUE(passes(map, floats));
  VerifyOptions options;
  EXPECT_FALSE(passes(map, text));
  options.digits = 7;
  EXPECT_TRUE(passes(map, text, options));
  options.digits = 17;
  EXPECT_FALSE(passes(map, floats, options));
  Random random(1);
  move(text, random, 1e-3);
  options.digits = 7;
  EXPECT_FALSE(passes(map, text, options));
  options.digits = 18;
  EXPECT_EQ(codeOf([&] { static_cast<void>(passes(map, text, options)); }),
            ErrorCode::InvalidArgument);
}

std::string foundOf(const VerifyReport& report, const std::string& name) {
  for (const VerifyItem& item : report.items) {
    if (item.name == name) return item.found;
  }
  return "no such item";
}

TEST(Verify, NamesWhatIsWrong) {
  const TetMap map = identityMap(3);
  const HexMesh mesh = extract(map);
  const auto found = [&](const auto& damage, const char* item) {
    HexMesh other = mesh;
    damage(other);
    return foundOf(verify(map, other), item);
  };
  EXPECT_EQ(found([](HexMesh& m) { m.points[21][1] += 0.1; }, "vertices_off_lattice"),
            "1 (first: vertex 21)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells[13] = reversed(m.cells[13]); }, "wrong_cells"),
            "1 (first: cell 13)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells[13] = m.cells[12]; }, "missing_cells"),
            "1 (first: in canonical order, cell 13)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells[13] = m.cells[12]; }, "wrong_cells"),
            "1 (first: cell 13)");
  EXPECT_EQ(found([](HexMesh& m) { m.points.push_back(m.points[5]); }, "unused_vertices"),
            "1 (first: vertex 64)");
  EXPECT_EQ(found([](HexMesh& m) { m.points.push_back({9, 9, 9}); }, "vertices"), "65");
  EXPECT_EQ(found([](HexMesh& m) { m.cells[7][3] = 64; }, "indices_in_range"),
            "no (first: cell 7)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells.pop_back(); }, "cells"), "26");
}

TEST(Verify, TellsWhatIsWrongWithTheMap) {
  const TetMap map = identityMap(2);
  EXPECT_TRUE(passes(map, gridMesh(2)));
  TetMap flipped = map;
  std::swap(flipped.parameters[7][1], flipped.parameters[7][2]);
  const VerifyReport report = verify(flipped, gridMesh(2));
  EXPECT_EQ(report.items.size(), 1U);
  EXPECT_TRUE(report.items[0].found.starts_with("no: ")) << report.items[0].found;
  TetMap empty;
  EXPECT_EQ(verify(empty, {}).items[0].found, "no: EmptyMesh");
}

TEST(Verify, DoesNotDependOnThreads) {
  const TetMap map = identityMap(12);
  HexMesh mesh = extract(map);
  for (const bool inOrder : {true, false}) {
    if (!inOrder) mesh = shuffled(mesh, 5);
    mesh.points[1000][0] += 0.2;
    mesh.points[2000][0] += 0.2;
    mesh.cells[300] = reversed(mesh.cells[300]);
    mesh.cells[600] = mesh.cells[601];
    Context one(1);
    const VerifyReport expected = verify(map, mesh, {}, one);
    EXPECT_FALSE(expected.passed());
    for (const int threads : {2, 5}) {
      Context many(threads);
      const VerifyReport report = verify(map, mesh, {}, many);
      ASSERT_EQ(report.items.size(), expected.items.size());
      for (std::size_t i = 0; i < report.items.size(); ++i) {
        EXPECT_EQ(report.items[i].found, expected.items[i].found) << report.items[i].name;
      }
    }
  }
}

TEST(Verify, EndsWhenCancelled) {
  Context context;
  context.cancel();
  EXPECT_EQ(codeOf([&] { static_cast<void>(verify(identityMap(3), gridMesh(3), {}, context)); }),
            ErrorCode::Cancelled);
}

TEST(Verify, RefusesWhatIsHardlyAMesh) {
  const TetMap map = drawMap(3);
  const HexMesh mesh = extract(map);
  const auto allCells = [](HexMesh& m, const Hex& cell) {
    std::fill(m.cells.begin(), m.cells.end(), cell);
  };
  const auto allCoordinates = [](HexMesh& m, double x) {
    for (Vec3& p : m.points) p = {x, x, x};
  };
  const auto repeatCorners = [](HexMesh& m, std::size_t from) {
    for (Hex& cell : m.cells) std::copy_n(cell.begin(), 4, cell.begin() + from);
  };
  const std::vector<std::pair<const char*, std::function<void(HexMesh&)>>> damages = {
      {"cells of one vertex", [&](HexMesh& m) { allCells(m, {}); }},
      {"one cell everywhere", [&](HexMesh& m) { allCells(m, m.cells[0]); }},
      {"flat cells", [&](HexMesh& m) { repeatCorners(m, 4); }},
      {"no index",
       [&](HexMesh& m) {
         allCells(m, {kNone, kNone, kNone, kNone, 0, 0, 0, 0});
       }},
      {"indices out of range", [](HexMesh& m) { m.points.resize(1); }},
      {"no points", [](HexMesh& m) { m.points.clear(); }},
      {"no cells", [](HexMesh& m) { m.cells.clear(); }},
      {"nothing", [](HexMesh& m) { m = {}; }},
      {"points far outside", [&](HexMesh& m) { allCoordinates(m, 1e308); }},
      {"a point far outside", [](HexMesh& m) { m.points[1][0] = -1e308; }},
      {"one point", [&](HexMesh& m) { allCoordinates(m, 0); }},
      {"no numbers", [&](HexMesh& m) { allCoordinates(m, std::nan("")); }},
      {"infinite", [&](HexMesh& m) { allCoordinates(m, -INFINITY); }},
      {"vertices that nothing uses", [](HexMesh& m) { m.points.resize(3 * m.points.size()); }},
      {"twice", [](HexMesh& m) {
         const HexMesh once = m;
         m.cells.insert(m.cells.end(), once.cells.begin(), once.cells.end());
       }}};
  VerifyOptions options;
  options.countElements = true;
  for (const auto& [name, damage] : damages) {
    HexMesh other = mesh;
    damage(other);
    Random random(1);
    EXPECT_FALSE(passes(map, other, options)) << name;
    EXPECT_FALSE(verifiedInPieces<Hex>(map, other, random).passed()) << name;
    HexMesh unordered = shuffled(mesh, 1);
    damage(unordered);
    EXPECT_FALSE(passes(map, unordered, options)) << name;
  }
}

/// (How much memory that takes, tests/app measures.)
TEST(Verify, IsNotImpressedByHugeMeshes) {
  const TetMap map = identityMap(1);
  HexMesh mesh = extract(map);
  mesh.cells.resize(1000000, mesh.cells[0]);
  mesh.points.resize(1000000, mesh.points[0]);
  const VerifyReport report = verify(map, mesh);
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(foundOf(report, "cells"), "1000000");
}

TEST(VerifySink, NamesWhatIsWrong) {
  const TetMap map = identityMap(3);
  const HexMesh mesh = extract(map);
  Random random(1);
  const auto found = [&](const std::function<void(HexMesh&)>& damage, const std::string& name) {
    HexMesh wrong = mesh;
    damage(wrong);
    return foundOf(verifiedInPieces<Hex>(map, wrong, random), name);
  };
  EXPECT_EQ(found([](HexMesh& m) { m.points[9][0] += 0.1; }, "vertices_off_lattice"),
            "1 (first: vertex 9)");
  EXPECT_EQ(found([](HexMesh& m) { std::swap(m.cells[7], m.cells[9]); }, "wrong_cells"),
            "2 (first: cell 7)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells[7][3] = 64; }, "wrong_cells"), "1 (first: cell 7)");
  EXPECT_EQ(found([](HexMesh& m) { m.cells.pop_back(); }, "cells"), "26");
  EXPECT_EQ(found([](HexMesh& m) { m.points.push_back({9, 9, 9}); }, "vertices"), "65");
  TetMap flipped = map;
  std::swap(flipped.parameters[7][1], flipped.parameters[7][2]);
  EXPECT_EQ(verifiedInPieces<Hex>(flipped, mesh, random).items.size(), 1U);

  // A piece that is missing, or comes twice, is one of the mesh's own, and yet not the mesh.
  Context context;
  VerifySink sink(map, {}, context);
  sink.begin(mesh.points.size(), mesh.cells.size());
  sink.points({0, mesh.points, {}, {}});
  for (int twice = 0; twice < 2; ++twice) sink.cells(0, std::span(mesh.cells).first(20));
  sink.end();
  EXPECT_EQ(foundOf(sink.report(), "cells"), "20");
  EXPECT_FALSE(sink.report().passed());
}

}  // namespace
}  // namespace hexhex::test
