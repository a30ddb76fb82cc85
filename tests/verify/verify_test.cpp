// Verification passes the mesh of a map in any numbering, and no other mesh.
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

#include "extract/support.hpp"
#include "support/coarse_maps.hpp"
#include "support/error_of.hpp"
#include "support/joined_maps.hpp"

namespace hexhex::test {
namespace {

using testing::gridMesh;
using testing::identityMap;
using testing::Random;
using testing::reversed;
using testing::shuffled;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool passes(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options = {}) {
  return verify(map, mesh, options).passed();
}

/// A small map of any kind.
TetMap drawMap(std::uint64_t seed) {
  Random random(seed);
  const SampleKindName& kind = sampleKinds()[random.below(sampleKinds().size())];
  SampleOptions options;
  options.cells = static_cast<int>(1 + random.below(3));
  options.refine = static_cast<int>(1 + random.below(2));
  options.valence = static_cast<int>(3 + random.below(5));
  options.charts = chartStyles()[random.below(chartStyles().size())].kind;
  options.jitter = std::array{0.0, 0.3, 1.0}[random.below(3)];
  options.onLattice = std::array{0.0, 0.5, 1.0}[random.below(3)];
  options.seed = random.next();
  return generateSample(kind.kind, options).map;
}

/// Every cell as one of its 24 orientations sees it.
HexMesh turned(HexMesh mesh, Random& random) {
  for (Hex& c : mesh.cells) {
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]};
    }
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[3], c[2], c[6], c[7], c[0], c[1], c[5], c[4]};
    }
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[1], c[5], c[6], c[2], c[0], c[4], c[7], c[3]};
    }
  }
  return mesh;
}

HexMesh renumbered(const HexMesh& mesh, Random& random) {
  return turned(shuffled(mesh, random.next()), random);
}

std::uint64_t two(Random& random, std::uint64_t n, std::uint64_t& other) {
  const std::uint64_t one = random.below(n);
  other = (one + 1 + random.below(n - 1)) % n;
  return one;
}

double lengthOf(const HexMesh& mesh, Index a, Index b) {
  const Vec3& p = mesh.points[a];
  const Vec3& q = mesh.points[b];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Moves a vertex by a share of an edge.
void move(HexMesh& mesh, Random& random, double share) {
  const Hex& cell = mesh.cells[random.below(mesh.cells.size())];
  mesh.points[cell[0]][random.below(3)] += share * lengthOf(mesh, cell[0], cell[1]);
}

/// How often cells have a vertex.
std::vector<int> usesOf(const HexMesh& mesh) {
  std::vector<int> uses(mesh.points.size());
  for (const Hex& cell : mesh.cells) {
    for (const Index v : cell) ++uses[v];
  }
  return uses;
}

void dropVertex(HexMesh& mesh, Index vertex) {
  mesh.points.erase(mesh.points.begin() + vertex);
  for (Hex& cell : mesh.cells) {
    for (Index& v : cell) v -= v > vertex ? 1 : 0;
  }
}

/// Makes one vertex of two.
void merge(HexMesh& mesh, Index a, Index b) {
  for (Hex& cell : mesh.cells) std::replace(cell.begin(), cell.end(), b, a);
  dropVertex(mesh, b);
}

/// Something that makes another mesh of any mesh. Returns false for one that it cannot damage.
struct Mutation {
  const char* name;
  std::function<bool(HexMesh&, Random&)> apply;
};

const std::vector<Mutation>& mutations() {
  static const std::vector<Mutation> all = {
      {"positions of neighbours swapped",
       [](HexMesh& m, Random& r) {
         const Hex& cell = m.cells[r.below(m.cells.size())];
         std::swap(m.points[cell[0]], m.points[cell[1]]);
         return true;
       }},
      {"positions swapped",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         std::swap(m.points[a], m.points[b]);
         return true;
       }},
      {"three positions exchanged",
       [](HexMesh& m, Random& r) {
         const Hex& cell = m.cells[r.below(m.cells.size())];
         std::swap(m.points[cell[0]], m.points[cell[2]]);
         std::swap(m.points[cell[2]], m.points[cell[6]]);
         return true;
       }},
      {"neighbours merged",
       [](HexMesh& m, Random& r) {
         const Hex cell = m.cells[r.below(m.cells.size())];
         merge(m, cell[0], cell[r.below(2) == 0 ? 1 : 6]);
         return true;
       }},
      {"any vertices glued",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         merge(m, static_cast<Index>(a), static_cast<Index>(b));
         return true;
       }},
      {"a vertex split",
       [](HexMesh& m, Random& r) {
         const std::vector<int> uses = usesOf(m);
         Hex& cell = m.cells[r.below(m.cells.size())];
         Index& v = cell[r.below(8)];
         if (uses[v] == 1) return false;
         m.points.push_back(m.points[v]);
         v = static_cast<Index>(m.points.size() - 1);
         return true;
       }},
      {"a vertex on another one",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         m.points[a] = m.points[b];
         return true;
       }},
      {"off by 1e-3",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-3);
         return true;
       }},
      {"off by 1e-5",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-5);
         return true;
       }},
      {"off by 1e-7",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-7);
         return true;
       }},
      {"no number",
       [](HexMesh& m, Random& r) {
         m.points[r.below(m.points.size())][r.below(3)] = r.below(2) == 0 ? kNaN : INFINITY;
         return true;
       }},
      {"corners of a cell swapped",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, 8, b);
         std::swap(cell[a], cell[b]);
         return true;
       }},
      {"a corner repeated",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, 8, b);
         cell[a] = cell[b];
         return true;
       }},
      {"a cell mirrored",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         cell = reversed(cell);
         return true;
       }},
      {"all cells mirrored",
       [](HexMesh& m, Random& /*r*/) {
         for (Hex& cell : m.cells) cell = reversed(cell);
         return true;
       }},
      {"a cell dropped",
       [](HexMesh& m, Random& r) {
         m.cells.erase(m.cells.begin() + static_cast<std::ptrdiff_t>(r.below(m.cells.size())));
         return true;
       }},
      {"a cell doubled",
       [](HexMesh& m, Random& r) {
         m.cells.push_back(m.cells[r.below(m.cells.size())]);
         return true;
       }},
      {"a cell replaced by another",
       [](HexMesh& m, Random& r) {
         if (m.cells.size() == 1) return false;
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.cells.size(), b);
         m.cells[a] = m.cells[b];
         return true;
       }},
      {"corners of two cells exchanged",
       [](HexMesh& m, Random& r) {
         if (m.cells.size() == 1) return false;
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.cells.size(), b);
         Index& v = m.cells[a][r.below(8)];
         Index& w = m.cells[b][r.below(8)];
         if (v == w) return false;
         std::swap(v, w);
         return true;
       }},
      {"another vertex in a cell",
       [](HexMesh& m, Random& r) {
         Index& v = m.cells[r.below(m.cells.size())][r.below(8)];
         v = static_cast<Index>((v + 1 + r.below(m.points.size() - 1)) % m.points.size());
         return true;
       }},
      {"a vertex too many",
       [](HexMesh& m, Random& r) {
         m.points.push_back(m.points[r.below(m.points.size())]);
         return true;
       }},
      {"all points scaled",
       [](HexMesh& m, Random& /*r*/) {
         for (Vec3& p : m.points) {
           for (double& x : p) x *= 1 + 1e-7;
         }
         return true;
       }},
      {"all points shifted",
       [](HexMesh& m, Random& r) {
         const std::size_t k = r.below(3);
         const double shift = 1e-6 * lengthOf(m, m.cells[0][0], m.cells[0][1]);
         for (Vec3& p : m.points) p[k] += shift;
         return true;
       }},
      {"all points mirrored",
       [](HexMesh& m, Random& /*r*/) {
         for (Vec3& p : m.points) p[0] = -p[0];
         return true;
       }},
      {"out of range",
       [](HexMesh& m, Random& r) {
         m.cells[r.below(m.cells.size())][r.below(8)] =
             r.below(2) == 0 ? kNone : static_cast<Index>(m.points.size());
         return true;
       }},
      {"nothing", [](HexMesh& m, Random& /*r*/) {
         m = {};
         return true;
       }}};
  return all;
}

TEST(Verify, RefusesEveryOtherMesh) {
  int refused = 0;
  for (int i = 0; i < cases(200); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const TetMap map = drawMap(seed);
    const HexMesh mesh = extract(map);
    ASSERT_TRUE(passes(map, mesh)) << "map " << i;
    for (const Mutation& mutation : mutations()) {
      Random random(seed);
      HexMesh other = mesh;
      if (!mutation.apply(other, random)) continue;
      EXPECT_FALSE(passes(map, other)) << mutation.name << ", map " << i;
      if (other.cells.empty() || !mutation.apply(other = renumbered(mesh, random), random))
        continue;
      EXPECT_FALSE(passes(map, other)) << mutation.name << ", map " << i << ", renumbered";
      ++refused;
    }
  }
  EXPECT_GT(refused, cases(200));
}

TEST(Verify, AcceptsEveryNumbering) {
  for (int i = 0; i < cases(200); ++i) {
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
    verifying.scale = options.scale % 3 + 1;
    EXPECT_FALSE(passes(map, mesh, verifying));
    const TetMap another = drawMap(seed + 1000);
    EXPECT_FALSE(passes(another, mesh, verifying)) << i;
  }
}

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

TEST(Verify, IsNotImpressedByHugeMeshes) {
  const TetMap map = identityMap(1);
  HexMesh mesh = extract(map);
  mesh.cells.resize(100000, mesh.cells[0]);
  mesh.points.resize(100000, mesh.points[0]);
  const VerifyReport report = verify(map, mesh);
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(foundOf(report, "cells"), "100000");
}

/// Hands over a mesh in pieces of random sizes.
template <class Cell>
VerifyReport verifiedInPieces(const TetMap& map, const HexMesh& mesh, Random& random) {
  Context context(1 + static_cast<int>(random.below(3)));
  VerifySink sink(map, {}, context);
  std::vector<Cell> cells;
  for (const Hex& cell : mesh.cells) {
    std::copy(cell.begin(), cell.end(), cells.emplace_back().begin());
  }
  sink.begin(mesh.points.size(), mesh.cells.size());
  const auto inPieces = [&](std::size_t count, const auto& take) {
    for (std::size_t first = 0; first < count;) {
      const std::size_t size = std::min<std::size_t>(count - first, 1 + random.below(100));
      take(first, size);
      first += size;
    }
  };
  inPieces(mesh.points.size(), [&](std::size_t first, std::size_t size) {
    sink.points({first, std::span(mesh.points).subspan(first, size), {}, {}});
  });
  inPieces(cells.size(), [&](std::size_t first, std::size_t size) {
    sink.cells(first, std::span<const Cell>(cells).subspan(first, size));
  });
  sink.end();
  return sink.report();
}

TEST(VerifySink, PassesTheMeshAndNoOther) {
  std::vector<int> applied(mutations().size());
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const TetMap map = drawMap(seed);
    const HexMesh mesh = extract(map);
    Random random(seed);
    const VerifyReport right = verifiedInPieces<Hex>(map, mesh, random);
    EXPECT_TRUE(right.passed()) << seed;
    EXPECT_EQ(right.items.size(), 5U);
    EXPECT_TRUE(verifiedInPieces<Hex64>(map, mesh, random).passed()) << seed;
    for (std::size_t i = 0; i < mutations().size(); ++i) {
      HexMesh wrong = mesh;
      if (!mutations()[i].apply(wrong, random)) continue;
      ++applied[i];
      const VerifyReport report = seed % 2 == 0 ? verifiedInPieces<Hex>(map, wrong, random)
                                                : verifiedInPieces<Hex64>(map, wrong, random);
      EXPECT_FALSE(report.passed()) << mutations()[i].name << ", seed " << seed;
    }
  }
  for (std::size_t i = 0; i < applied.size(); ++i) EXPECT_GT(applied[i], 20) << mutations()[i].name;
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
