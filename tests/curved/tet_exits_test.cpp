// What floating point says about the exits of tets, against exact arithmetic: what is certain must
// be right, and where it would be wrong, it must not be certain.
#include <algorithm>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include <base/stage.hpp>
#include <curved/arcs.hpp>
#include <curved/frame.hpp>
#include <curved/simplex_point.hpp>
#include <curved/tet_exits.hpp>
#include <igm/defects.hpp>
#include <igm/prepare.hpp>

#include "curved/curved_maps.hpp"
#include "curved/same_arcs.hpp"
#include "lattice/random.hpp"

namespace hexhex::test {

namespace {

using testing::Random;

/// What occurred: tests that miss a case say nothing.
struct ExitCounts {
  int sure = 0;
  int unsure = 0;
  int misled = 0;  ///< not sure, and wrong
};

/// A tet with an edge along an axis whose midpoint it has inside.
struct Situation {
  LatticeTet corners;
  GridPoint z;
  int axis;
};

constexpr Tet kVertices = {0, 1, 2, 3};

class ExitExaminer {
 public:
  ExitExaminer(std::int64_t unit, ExitCounts& counts)
      : unit_(unit), counts_(counts), exits_(unit) {}

  void examine(const Situation& situation) {
    std::array<Vec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        points[i][k] = static_cast<double>(situation.corners[i][k]) / static_cast<double>(unit_);
      }
    }
    exits_.enter(situation.corners);
    exits_.turn(situation.axis);
    const TetExits::Weights middle = exits_.atMiddle(situation.z);
    const TetExits::Zeros zeros = exits_.zeros(middle);
    const Frame frame = Frame::along(situation.z, situation.axis);
    const TetExits::Exit ahead = exits_.exit<Way::Forward>(zeros);
    examineWay(situation, points, frame, middle, ahead, ahead.at);
    const TetExits::Exit back = exits_.exit<Way::Backward>(zeros);
    examineWay(situation, points, frame.reversed(), middle, back, -back.at);
  }

 private:
  /// @param frame  such that the way is forward
  void examineWay(const Situation& situation, std::span<const Vec3> points, const Frame& frame,
                  const TetExits::Weights& middle, const TetExits::Exit& exit, double distance) {
    const LatticeTet seen = frame.see(situation.corners, unit_);
    const SimplexPoint expected = exitPoint(seen, kWholeTet, 0);
    const TetExits::Point point = exits_.point(middle, exit);
    const bool right = expected.simplex() == faceMask(exit.face);
    if (!point.sure) {
      ++counts_.unsure;
      if (!right) ++counts_.misled;
      return;
    }
    ++counts_.sure;
    EXPECT_TRUE(right);
    compare(expected, seen, points, point, distance);
  }

  void compare(const SimplexPoint& expected, const LatticeTet& seen, std::span<const Vec3> points,
               const TetExits::Point& point, double distance) const {
    const auto shares = expected.normalized();
    EXPECT_NEAR(distance, coordinate(shares, seen, 0) / static_cast<double>(unit_) - 0.5, 1e-8);
    const Vec3 place = position(shares, kVertices, points);
    const Vec3 found = position(point.shares.byCorner(), kVertices, points);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], place[k], 1e-8);
    const int side = expected.compare(seen, 0, unit_);
    const TetExits::End end = exits_.endAt(distance);
    EXPECT_TRUE(end != TetExits::End::Beyond || side < 0);
    EXPECT_TRUE(end != TetExits::End::Inside || side > 0);
  }

  std::int64_t unit_;
  ExitCounts& counts_;
  TetExits exits_;
};

/// Whether a positive tet has the midpoint inside.
bool hasMiddle(const Situation& situation, std::int64_t unit) {
  const LatticeTet& c = situation.corners;
  if (orientation(c[0], c[1], c[2], c[3]) <= 0) return false;
  LatticePoint middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = situation.z[k] * unit;
  middle[static_cast<std::size_t>(situation.axis)] += unit / 2;
  return simplexBySides([&](std::size_t face) { return sideOfFace(c, face, middle); }) == kWholeTet;
}

/// A tet around a midpoint that has an edge or a corner on the line, a face along it, or neither;
/// all of them exactly or nearly.
Situation drawSituation(Random& random, std::int64_t unit) {
  Situation s{{}, {}, static_cast<int>(random.index(3))};
  const auto axis = static_cast<std::size_t>(s.axis);
  LatticePoint middle;
  for (std::size_t k = 0; k < 3; ++k) {
    s.z[k] = static_cast<std::int32_t>(random.between(-1000, 1000));
    middle[k] = s.z[k] * unit;
  }
  middle[axis] += unit / 2;
  const std::int64_t size =
      std::max<std::int64_t>(4, unit * random.between(1, 20) / (random.oneIn(3) ? 64 : 4));
  for (LatticePoint& corner : s.corners) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = middle[k] + random.between(-size, size);
  }
  // A point of the line, sometimes an end of the edge, then moved by very little.
  LatticePoint near = middle;
  near[axis] += random.oneIn(4) ? unit / 2 : random.between(-size, size);
  for (std::int64_t& coordinate : near) coordinate += random.oneIn(4) ? random.between(-2, 2) : 0;
  const std::size_t across = (axis + 1) % 3;
  switch (random.index(4)) {
    case 0:
      s.corners[0] = near;
      break;
    case 1:
      for (std::size_t k = 0; k < 3; ++k) s.corners[1][k] = 2 * near[k] - s.corners[0][k];
      break;
    case 2:
      for (std::size_t c = 0; c < 3; ++c) {
        s.corners[c][across] = near[across] + random.between(0, 1) * unit / 8;
      }
      break;
    default:
      break;
  }
  if (random.oneIn(2)) std::swap(s.corners[2], s.corners[3]);
  if (random.oneIn(2)) {
    std::swap(s.corners[0], s.corners[2]);
    std::swap(s.corners[1], s.corners[3]);
  }
  return s;
}

TEST(TetExits, CertainExitsAreRight) {
  ExitCounts counts;
  Random random(20261);
  for (int i = 0; i < testing::cases(300000) && !HasFailure(); ++i) {
    const std::int64_t unit = std::int64_t{1} << random.between(4, 40);
    const Situation situation = drawSituation(random, unit);
    if (hasMiddle(situation, unit)) ExitExaminer(unit, counts).examine(situation);
  }
  EXPECT_GT(counts.sure, testing::cases(5000));
  EXPECT_GT(counts.unsure, 0);
  // Without regard to certainty, the test would fail.
  EXPECT_GT(counts.misled, testing::cases(500));
}

/// A map at a scale, with its numbers.
struct Numbered {
  Numbered(const TetMap& given, int scale, Context& context) : map(prepare(given, scale, context)) {
    Stage stage(context, "numbers");
    if (scale != 1) scaleMap(map.exact, scale, stage);
  }
  static PreparedMap prepare(const TetMap& given, int scale, Context& context) {
    DefectCollector defects;
    PreparedMap map = prepareMap(given, 1e-3, scale, context, defects);
    defects.throwIfAny();
    return map;
  }
  PreparedMap map;
};

/// Where tets are not tiny and nothing is degenerate, nearly everything is certain.
TEST(TetExits, ExitsAreMostlyCertain) {
  const TetMap map = generateSample(SampleKind::Sphere, curvedOptions()[1]).map;
  Context context(1);
  const Numbered numbered(map, 4, context);
  Stage stage(context, "edges");
  const ElementNumbers edges(numbered.map, ElementKind::Edges, stage);
  ExitCounts counts;
  ExitExaminer examiner(numbered.map.exact.unit, counts);
  for (std::size_t t = 0; t < numbered.map.topology.tetCount(); ++t) {
    edges.forEach(static_cast<Index>(t), [&](const Element& edge) {
      if (edge.simplex != kWholeTet || HasFailure()) return;
      examiner.examine({numbered.map.exact.corners[t], edge.z, edge.axis});
    });
  }
  EXPECT_GT(counts.sure, 2000);
  EXPECT_GT(counts.sure, 20 * counts.unsure);
}

/// By exits wherever they are certain, against exact arithmetic alone.
void compareWays(const TetMap& map, int scale) {
  Context context(2);
  const Numbered numbered(map, scale, context);
  Stage stage(context, "arcs");
  const auto [vertices, edges] = numberVerticesAndEdges(numbered.map, stage);
  const Arcs exact = traceArcs(numbered.map, vertices, edges, stage, edges.count() + 1);
  const Arcs byExits = traceArcs(numbered.map, vertices, edges, stage, 0);
  expectSameBits(exact, traceArcs(numbered.map, vertices, edges, stage));
  expectSameBits(exact, byExits);
}

TEST(ArcsByExits, AreThoseOfExactArithmetic) {
  for (const CurvedMap& map : generatedMaps()) {
    for (const int scale : {1, 3}) {
      SCOPED_TRACE(map.name + " x" + std::to_string(scale));
      compareWays(map.map, scale);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(ArcsByExits, AreThoseOfExactArithmeticOnNoisyMaps) {
  SampleOptions options;
  options.cells = 3;
  options.refine = 2;
  options.jitter = 0.6;
  for (const double noise : {1e-12, 1e-7}) {
    options.noise = noise;
    compareWays(generateSample(SampleKind::Cylinder, options).map, 2);
  }
}

TEST(ArcsByExits, AreThoseOfExactArithmeticOnRealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    compareWays(map.map, 1);
  }
}

}  // namespace
}  // namespace hexhex::test
