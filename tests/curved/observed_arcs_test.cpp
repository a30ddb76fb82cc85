// Arcs of the lines that the atlas engine has swept while it was observed, against those of a map
// that is swept anew.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <atlas/atlas.hpp>
#include <base/stage.hpp>
#include <curved/arcs.hpp>
#include <curved/element_numbers.hpp>
#include <igm/defects.hpp>
#include <igm/igm.hpp>
#include <igm/measures.hpp>

#include "curved/curved_maps.hpp"
#include "curved/same_arcs.hpp"
#include "lattice/random.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

using testing::LatticeRandom;

/// What occurred: tests that miss a case say nothing.
struct PointKinds {
  std::size_t inFaces = 0;
  std::size_t elsewhere = 0;     ///< on edges and vertices of the tets
  std::size_t flatSegments = 0;  ///< in faces and edges

  void count(const Arcs& arcs) {
    for (const CornerSet corners : arcs.generatorCorners) {
      ++(lattice::dimension(corners) == 2 ? inFaces : elsewhere);
    }
    for (const CornerSet corners : arcs.segmentCorners)
      flatSegments += corners != lattice::kWholeTet;
  }
};

igm::PreparedMap prepareAt(const TetMap& given, int scale, Context& context) {
  igm::DefectCollector defects;
  igm::PreparedMap map = igm::prepareMap(given, 1e-3, scale, context, defects);
  defects.throwIfAny();
  Stage stage(context, "topology");
  adjacency::addStars(map.topology, stage);
  return map;
}

/// Of the lines that the atlas engine has swept.
/// @param mesh  that it makes if nobody observes it
Arcs arcsOfObservedAtlas(const igm::PreparedMap& map, const HexMesh& mesh, Context& context,
                         Stage& stage) {
  ExtractStatistics statistics;
  EdgeObserver observer(map);
  const HexMesh observed =
      atlas::runAtlas(map, mesh.cells.size(), context, statistics, {}, &observer);
  EXPECT_TRUE(observed.points == mesh.points && observed.cells == mesh.cells);
  EXPECT_TRUE(observed.generatorTet == mesh.generatorTet &&
              observed.generatorCorners == mesh.generatorCorners);
  const GridNumbers numbers = observer.finish(stage);
  EXPECT_EQ(numbers.vertices.count(), mesh.points.size());
  return traceArcs(map, numbers.vertices, numbers.edges, stage);
}

/// With several numbers of threads.
void compareWithSweptAnew(const TetMap& given, int scale, PointKinds& kinds) {
  Context context(2);
  igm::PreparedMap map = prepareAt(given, scale, context);
  const std::uint64_t cells =
      igm::parametricVolume(map.exact) * static_cast<std::uint64_t>(scale * scale * scale);
  Stage stage(context, "arcs");
  if (scale != 1) igm::scaleMap(map.exact, scale, stage);
  const GridNumbers numbers = numberVerticesAndEdges(map, stage);
  const Arcs expected = traceArcs(map, numbers.vertices, numbers.edges, stage);
  kinds.count(expected);
  ExtractStatistics statistics;
  const HexMesh mesh = atlas::runAtlas(map, cells, context, statistics);
  for (const int threads : {1, 2, 5}) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    withThreads(threads,
                [&] { expectSameBits(expected, arcsOfObservedAtlas(map, mesh, context, stage)); });
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(ObservedArcs, AreThoseOfMapsSweptAnew) {
  PointKinds kinds;
  for (const CurvedMap& map : generatedMaps()) {
    for (const int scale : {1, 3}) {
      SCOPED_TRACE(map.name + " x" + std::to_string(scale));
      compareWithSweptAnew(map.map, scale, kinds);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(kinds.inFaces, 100U);
  EXPECT_GT(kinds.elsewhere, 100U);
  EXPECT_GT(kinds.flatSegments, 100U);
}

TEST(ObservedArcs, AreThoseOfMapsSweptAnewOnRandomMaps) {
  PointKinds kinds;
  LatticeRandom random(20262);
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
    const auto& kind = all[random.below(all.size())];
    const int scale = static_cast<int>(random.between(1, 3));
    SCOPED_TRACE(std::string(kind.name) + ", case " + std::to_string(i));
    compareWithSweptAnew(generateSample(kind.kind, options).map, scale, kinds);
  }
  EXPECT_GT(kinds.inFaces, 0U);
  EXPECT_GT(kinds.elsewhere, 0U);
}

TEST(ObservedArcs, EdgesThatComeBack) {
  PointKinds kinds;
  for (const int cells : {1, 2}) compareWithSweptAnew(tightTorus(cells), 1, kinds);
}

TEST(ObservedArcs, AreThoseOfMapsSweptAnewOnRealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  PointKinds kinds;
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    compareWithSweptAnew(map.map, 1, kinds);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace hexhex::test
