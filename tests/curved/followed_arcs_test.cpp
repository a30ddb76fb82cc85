// Arcs of what the engines hand over, followed edges or swept lines, against those of a map that is
// swept anew, traced from their midpoints by exact arithmetic.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <atlas/atlas.hpp>
#include <base/stage.hpp>
#include <curved/arc_guest.hpp>
#include <curved/arcs.hpp>
#include <curved/edge_guest.hpp>
#include <igm/defects.hpp>
#include <igm/measures.hpp>
#include <igm/prepare.hpp>
#include <propeller/pipeline.hpp>

#include "curved/curved_maps.hpp"
#include "curved/same_arcs.hpp"
#include "lattice/random.hpp"

namespace hexhex::test {

namespace {

using testing::Random;

/// What occurred: tests that miss a case say nothing.
struct PointKinds {
  std::size_t inFaces = 0;
  std::size_t elsewhere = 0;     ///< on edges and vertices of the tets
  std::size_t flatSegments = 0;  ///< in faces and edges

  void count(const Arcs& arcs) {
    for (const CornerSet corners : arcs.generatorCorners) {
      ++(dimension(corners) == 2 ? inFaces : elsewhere);
    }
    for (const CornerSet corners : arcs.segmentCorners) flatSegments += corners != kWholeTet;
  }
};

PreparedMap prepareAt(const TetMap& given, int scale, Context& context) {
  DefectCollector defects;
  PreparedMap map = prepareMap(given, 1e-3, scale, context, defects);
  defects.throwIfAny();
  Stage stage(context, "topology");
  addStars(map.topology, stage);
  return map;
}

/// Of the edges that the propeller engine has followed.
struct FollowedArcs {
  Arcs arcs;
  std::vector<Index> arcOf;  ///< per edge
};

FollowedArcs followedArcs(const PreparedMap& map, const ElementNumbers& edges, std::uint64_t cells,
                          double epsilon, Context& context, Stage& stage) {
  ExtractStatistics statistics;
  ArcGuest guest(map, true);
  const HexMesh mesh = runPipeline(map, cells, epsilon, context, statistics, &guest);
  EXPECT_EQ(guest.numbers(stage).count(), mesh.points.size());
  FollowedArcs result{guest.takeArcs(), {}};
  result.arcOf.assign(edges.count(), kNone);
  EXPECT_EQ(guest.keys().size(), edges.count());
  Index arc = 0;
  for (const EdgeKey& key : guest.keys()) {
    LineHint hint;
    Index& found = result.arcOf[edges.find(key.tet, key.axis, key.z, hint)];
    EXPECT_EQ(found, kNone);
    found = arc++;
  }
  return result;
}

/// Of the lines that the atlas engine has swept.
/// @param mesh  that it makes if nobody watches
Arcs arcsOfWatchedAtlas(const PreparedMap& map, const HexMesh& mesh, Context& context,
                        Stage& stage) {
  ExtractStatistics statistics;
  EdgeGuest guest(map);
  const HexMesh watched = runAtlas(map, mesh.cells.size(), context, statistics, {}, &guest);
  EXPECT_TRUE(watched.points == mesh.points && watched.cells == mesh.cells);
  EXPECT_TRUE(watched.generatorTet == mesh.generatorTet &&
              watched.generatorCorners == mesh.generatorCorners);
  const GridNumbers numbers = guest.finish(stage);
  EXPECT_EQ(numbers.vertices.count(), mesh.points.size());
  return traceArcs(map, numbers.vertices, numbers.edges, stage);
}

/// With several numbers of threads.
void compareWithExact(const TetMap& given, int scale, double epsilon, PointKinds& kinds) {
  Context context(2);
  PreparedMap map = prepareAt(given, scale, context);
  const std::uint64_t cells =
      parametricVolume(map.exact) * static_cast<std::uint64_t>(scale * scale * scale);
  Stage stage(context, "arcs");
  if (scale != 1) scaleMap(map.exact, scale, stage);
  const GridNumbers numbers = numberVerticesAndEdges(map, stage);
  const ElementNumbers& edges = numbers.edges;
  const Arcs exact = traceArcs(map, numbers.vertices, edges, stage, edges.count() + 1);
  kinds.count(exact);
  ExtractStatistics statistics;
  const HexMesh mesh = runAtlas(map, cells, context, statistics);
  Arcs first;
  for (const int threads : {1, 2, 5}) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    withThreads(threads, [&] {
      const FollowedArcs followed = followedArcs(map, edges, cells, epsilon, context, stage);
      expectSameBits(exact, reordered(followed.arcs, followed.arcOf));
      if (threads == 1) first = followed.arcs;
      expectSameBits(first, followed.arcs);
      expectSameBits(exact, arcsOfWatchedAtlas(map, mesh, context, stage));
    });
    if (::testing::Test::HasFailure()) return;
  }
}

constexpr double kEpsilon = 1e-6;

TEST(FollowedArcs, AreThoseOfExactArithmetic) {
  PointKinds kinds;
  for (const CurvedMap& map : generatedMaps()) {
    for (const int scale : {1, 3}) {
      SCOPED_TRACE(map.name + " x" + std::to_string(scale));
      compareWithExact(map.map, scale, kEpsilon, kinds);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(kinds.inFaces, 100U);
  EXPECT_GT(kinds.elsewhere, 100U);
  EXPECT_GT(kinds.flatSegments, 100U);
}

TEST(FollowedArcs, AreThoseOfExactArithmeticOnRandomMaps) {
  PointKinds kinds;
  Random random(20262);
  const auto share = [&](double most) {
    return most * static_cast<double>(random.between(0, 100)) / 100;
  };
  const auto& all = sampleKinds();
  for (int i = 0; i < std::max(8, testing::cases(60)) && !HasFailure(); ++i) {
    SampleOptions options;
    options.seed = static_cast<std::uint32_t>(random.between(1, 1 << 30));
    options.cells = static_cast<int>(random.between(1, 3));
    options.refine = static_cast<int>(random.between(1, 3));
    options.jitter = random.oneIn(4) ? 0 : share(0.9);
    options.onLattice = random.oneIn(2) ? 0 : share(0.7);
    options.noise = random.oneIn(3) ? 1e-9 : 0;
    options.charts = random.oneIn(2) ? ChartStyle::Random : ChartStyle::Blocks;
    options.offset = random.oneIn(3) ? 1e6 : 0;
    const auto& kind = all[random.index(all.size())];
    const int scale = static_cast<int>(random.between(1, 3));
    SCOPED_TRACE(std::string(kind.name) + ", case " + std::to_string(i));
    compareWithExact(generateSample(kind.kind, options).map, scale, kEpsilon, kinds);
  }
  EXPECT_GT(kinds.inFaces, 0U);
  EXPECT_GT(kinds.elsewhere, 0U);
}

TEST(FollowedArcs, EdgesThatComeBack) {
  PointKinds kinds;
  for (const int cells : {1, 2}) compareWithExact(tightTorus(cells), 1, kEpsilon, kinds);
}

/// With no epsilon at all, the engine starts over; with an infinite one, there are empty lines.
TEST(FollowedArcs, DoNotDependOnEpsilon) {
  PointKinds kinds;
  const TetMap map = generateSample(SampleKind::Sphere, curvedOptions()[2]).map;
  for (const double epsilon : {0.0, std::numeric_limits<double>::infinity()}) {
    compareWithExact(map, 2, epsilon, kinds);
  }
}

TEST(FollowedArcs, AreThoseOfExactArithmeticOnRealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  PointKinds kinds;
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    compareWithExact(map.map, 1, kEpsilon, kinds);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace hexhex::test
