// Adjacency of tets against brute force on samples, and every way not to be a manifold.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <rapidcheck.h>
#include <set>
#include <string>

#include <adjacency/tet_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <igm/defects.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
namespace {

using test::identityMap;
using test::Prepared;

/// The vertices of a simplex of a tet, ascending.
std::vector<Index> verticesOf(const Tet& tet, lattice::CornerMask simplex) {
  std::vector<Index> vertices;
  for (int i = 0; i < 4; ++i) {
    if (lattice::contains(simplex, i)) vertices.push_back(tet[static_cast<std::size_t>(i)]);
  }
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// All tets that contain each simplex, ascending, found without any adjacency.
std::map<std::vector<Index>, std::vector<Index>> tetsBySimplex(const std::vector<Tet>& tets) {
  std::map<std::vector<Index>, std::vector<Index>> result;
  for (Index t = 0; t < tets.size(); ++t) {
    for (lattice::CornerMask simplex = 1; simplex <= lattice::kWholeTet; ++simplex) {
      result[verticesOf(tets[t], simplex)].push_back(t);
    }
  }
  return result;
}

Sample sampleOf(SampleKind kind) {
  SampleOptions options;
  options.charts = ChartStyle::Random;  // also shuffles the corners of tets
  return generateSample(kind, options);
}

class TopologyOfKind : public test::EveryKind {};

TEST_P(TopologyOfKind, MatesAreTheTwoTetsAtATriangle) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const adjacency::TetTopology& topology = prepared.topology();
  const auto simplices = tetsBySimplex(map.tets);
  ASSERT_EQ(topology.mate.size(), 4 * map.tets.size());
  for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
    const Index tet = adjacency::tetOf(here);
    const std::vector<Index> triangle =
        verticesOf(map.tets[tet], lattice::faceMask(adjacency::localOf(here)));
    const std::vector<Index>& around = simplices.at(triangle);
    const adjacency::HalfFace there = topology.mate[here];
    ASSERT_EQ(there == kNone, around.size() == 1);
    ASSERT_EQ(topology.isBoundary(here), around.size() == 1);
    if (there == kNone) continue;
    EXPECT_EQ(topology.mate[there], here);
    EXPECT_EQ(adjacency::tetOf(there), around[0] == tet ? around[1] : around[0]);
    EXPECT_EQ(
        verticesOf(map.tets[adjacency::tetOf(there)], lattice::faceMask(adjacency::localOf(there))),
        triangle);
  }
}

TEST_P(TopologyOfKind, StarsAreCompleteAndSorted) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const auto simplices = tetsBySimplex(map.tets);
  for (Index v = 0; v < map.points.size(); ++v) {
    std::vector<Index> tets;
    for (const adjacency::CornerIndex corner : prepared.topology().star(v)) {
      EXPECT_EQ(prepared.topology().vertex(corner), v);
      tets.push_back(corner / 4);
    }
    EXPECT_EQ(tets, simplices.at({v}));
  }
}

/// In lexicographic order.
std::vector<std::array<Index, 2>> edgesOf(const TetMap& map) {
  std::vector<std::array<Index, 2>> edges;
  for (const auto& [vertices, tets] : tetsBySimplex(map.tets)) {
    if (vertices.size() == 2) edges.push_back({vertices[0], vertices[1]});
  }
  return edges;
}

TEST_P(TopologyOfKind, EdgesAreCountedOnce) {
  const TetMap map = sampleOf(kind()).map;
  Context context;
  Stage stage(context, "test");
  EXPECT_EQ(adjacency::countEdges(Prepared(map).topology(), stage), edgesOf(map).size());
}

TEST_P(TopologyOfKind, FansOfEdgesAreComplete) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const adjacency::TetTopology& topology = prepared.topology();
  const auto simplices = tetsBySimplex(map.tets);
  const std::vector<std::array<Index, 2>> edges = edgesOf(map);
  std::vector<adjacency::EdgeCorner> scratch;
  std::size_t edge = 0;
  for (Index v = 0; v < map.points.size(); ++v) {
    adjacency::forEachEdge(
        topology, v, scratch, [&](Index w, std::span<const adjacency::EdgeCorner> fan) {
          EXPECT_EQ((std::array<Index, 2>{v, w}), edges.at(edge++));
          std::vector<Index> tets;
          std::size_t boundaryFaces = 0;
          for (const adjacency::EdgeCorner& at : fan) {
            EXPECT_EQ(at.other, w);
            EXPECT_EQ(map.tets[at.tet][at.corner0], v);
            EXPECT_EQ(map.tets[at.tet][at.corner1], w);
            tets.push_back(at.tet);
            for (int face = 0; face < 4; ++face) {
              if (face == at.corner0 || face == at.corner1) continue;
              const auto triangle = verticesOf(map.tets[at.tet], lattice::faceMask(face));
              boundaryFaces += simplices.at(triangle).size() == 1 ? 1 : 0;
            }
          }
          EXPECT_EQ(tets, simplices.at({v, w}));
          EXPECT_EQ(adjacency::boundaryFacesAt(topology, fan), boundaryFaces);
        });
  }
  EXPECT_EQ(edge, edges.size());
}

TEST_P(TopologyOfKind, OwnerIsTheSmallestTet) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const auto simplices = tetsBySimplex(map.tets);
  for (Index t = 0; t < map.tets.size(); ++t) {
    for (lattice::CornerMask simplex = 1; simplex <= lattice::kWholeTet; ++simplex) {
      const Index owner = simplices.at(verticesOf(map.tets[t], simplex)).front();
      EXPECT_EQ(adjacency::ownerTet(prepared.topology(), t, simplex), owner);
      EXPECT_EQ(adjacency::ownsSimplex(prepared.topology(), t, simplex), owner == t);
    }
  }
}

TEST_P(TopologyOfKind, SimplicesOfAFaceAreThoseOfTheNeighbour) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const adjacency::TetTopology& topology = prepared.topology();
  for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
    if (topology.isBoundary(here)) continue;
    const lattice::CornerMask face = lattice::faceMask(adjacency::localOf(here));
    const Index there = adjacency::tetOf(topology.mate[here]);
    for (lattice::CornerMask simplex = 1; simplex <= face; ++simplex) {
      if ((simplex & face) != simplex) continue;
      const lattice::CornerMask across = adjacency::acrossFace(topology, here, simplex);
      ASSERT_EQ(verticesOf(map.tets[there], across),
                verticesOf(map.tets[adjacency::tetOf(here)], simplex));
      ASSERT_EQ(across, topology.translated(simplex, adjacency::tetOf(here), there));
    }
  }
}

TEST_P(TopologyOfKind, EulerCharacteristicIsTheSamples) {
  const Sample sample = sampleOf(kind());
  const CheckReport report = check(sample.map);
  const auto characteristic =
      static_cast<std::int64_t>(report.points + report.faces - report.edges - report.tets);
  EXPECT_EQ(characteristic, sample.answer.expected.eulerCharacteristic);
  EXPECT_EQ(report.faces, report.innerFaces + report.boundaryFaces);
  EXPECT_EQ(4 * report.tets, 2 * report.innerFaces + report.boundaryFaces);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TopologyOfKind, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

/// check() lists the defect, and only it, with its place; prepareMap() throws the same.
void expectDefect(const TetMap& map, ErrorCode code, const std::string& place,
                  std::uint64_t count = 1) {
  SCOPED_TRACE(name(code));
  const CheckReport report = check(map);
  ASSERT_EQ(report.defects.size(), 1U);
  const Defect& defect = report.defects[0];
  EXPECT_EQ(defect.code, code);
  EXPECT_EQ(defect.count, count);
  EXPECT_FALSE(defect.sentence.empty());
  ASSERT_FALSE(defect.worst.empty());
  EXPECT_EQ(toString(defect.worst[0].place), place);
  EXPECT_EQ(defect.worst[0].amount, 0);  // there is nothing to measure

  const Prepared prepared(map);
  try {
    prepared.defects().throwIfAny();
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_EQ(toString(error.place()), place);
    EXPECT_NE(std::string(error.what()).find(place), std::string::npos);
  }
}

/// The four corners of the unit tet, and further points.
std::vector<Vec3> unitTetAnd(std::vector<Vec3> more) {
  std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

TEST(Topology, TriangleOfThreeTets) {
  expectDefect(
      identityMap(unitTetAnd({{0, 0, -1}, {0, 0, 2}}), {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}),
      ErrorCode::NonManifoldFace, toString({PlaceKind::Face, 0, 3}));
}

TEST(Topology, FansThatShareOnlyAnEdge) {
  expectDefect(identityMap(unitTetAnd({{0, -1, 0}, {0, 0, -1}}), {{0, 1, 2, 3}, {0, 1, 4, 5}}),
               ErrorCode::NonManifoldEdge, toString({PlaceKind::Edge, 0, 1}));
}

TEST(Topology, TetsThatShareOnlyAVertex) {
  expectDefect(
      identityMap(unitTetAnd({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}), {{0, 1, 2, 3}, {0, 5, 4, 6}}),
      ErrorCode::NonManifoldVertex, toString({PlaceKind::Vertex, 0}));
}

/// A link of an annulus and a disk has the Euler characteristic of a disk.
TEST(Topology, RingAndTetThatShareOnlyAVertex) {
  std::vector<Vec3> points = {{0, 0, 0}, {-1, 0, -1}, {0, -1, -1}, {0, 0, -2}};
  for (const double radius : {1.0, 2.0}) {
    points.push_back({radius, 0, 1});
    points.push_back({-radius, radius, 1});
    points.push_back({-radius, -radius, 1});
  }
  std::vector<Tet> tets = {{0, 1, 2, 3}};
  for (Index i = 0; i < 3; ++i) {
    const Index next = (i + 1) % 3;
    tets.push_back({0, 4 + i, 7 + i, 7 + next});
    tets.push_back({0, 4 + i, 7 + next, 4 + next});
  }
  TetMap map = identityMap(points, tets);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (test::determinant(map.parameters[t]) > 0) continue;
    std::swap(map.tets[t][2], map.tets[t][3]);
    std::swap(map.parameters[t][2], map.parameters[t][3]);
  }
  expectDefect(map, ErrorCode::NonManifoldVertex, toString({PlaceKind::Vertex, 0}));
}

/// A ball of five tets around the edge from one pole to the other.
void addBall(TetMap& map, Index pole0, Index pole1, double x) {
  const auto first = static_cast<Index>(map.points.size());
  for (int i = 0; i < 5; ++i) {
    const double angle = 1.2566370614359172 * i;
    map.points.push_back({x + std::cos(angle), std::sin(angle), 0.5});
  }
  for (Index i = 0; i < 5; ++i) map.tets.push_back({pole0, first + i, first + (i + 1) % 5, pole1});
}

TEST(Topology, BallsThatShareAnInnerEdge) {
  TetMap map;
  map.points = {{0, 0, 0}, {0, 0, 1}};
  addBall(map, 0, 1, 0);
  addBall(map, 0, 1, 0.25);
  expectDefect(identityMap(map.points, map.tets), ErrorCode::NonManifoldVertex,
               toString({PlaceKind::Vertex, 0}), 2);
}

/// Inside both, so that no boundary is near.
TEST(Topology, BallsThatShareAnInnerVertex) {
  const TetMap box = sampleOf(SampleKind::Box).map;
  const Prepared before(box);
  Index inner = 0;
  const auto onBoundary = [&](Index v) {
    return std::any_of(
        before.topology().star(v).begin(), before.topology().star(v).end(),
        [&](adjacency::CornerIndex corner) {
          for (int face = 0; face < 4; ++face) {
            if (face != adjacency::localOf(corner) &&
                before.topology().isBoundary(adjacency::halfFaceOf(corner / 4, face))) {
              return true;
            }
          }
          return false;
        });
  };
  while (onBoundary(inner)) ++inner;
  TetMap map = box;
  const auto shift = static_cast<Index>(box.points.size());
  map.points.insert(map.points.end(), box.points.begin(), box.points.end());
  for (std::size_t t = 0; t < box.tets.size(); ++t) {
    Tet tet = box.tets[t];
    for (Index& v : tet) v = v == inner ? inner : v + shift;
    map.tets.push_back(tet);
    map.parameters.push_back(box.parameters[t]);
  }
  expectDefect(map, ErrorCode::NonManifoldVertex, toString({PlaceKind::Vertex, inner}));
}

/// What the fast checks let pass, and only that, passes the slow ones, on meshes with all sorts of
/// pinches: samples without a random part of their tets, in random order.
TEST(Topology, FastAndSlowChecksAgree) {
  int manifolds = 0;
  int others = 0;
  const bool passed = rc::check([&] {
    const auto kinds = sampleKinds();
    SampleOptions options;
    options.refine = *rc::gen::inRange(1, 3);
    options.charts = *rc::gen::element(ChartStyle::Aligned, ChartStyle::Random);
    const TetMap whole =
        generateSample(kinds[*rc::gen::inRange<std::size_t>(0, kinds.size())].kind, options).map;
    const auto kept = *rc::gen::inRange<std::size_t>(1, 40);
    const bool fewMissing = *rc::gen::arbitrary<bool>();
    TetMap map;
    map.points = whole.points;
    const std::vector<Index> order =
        test::permutation(whole.tets.size(), *rc::gen::arbitrary<std::uint64_t>());
    const std::size_t size = fewMissing ? whole.tets.size() - kept / 8 : kept;
    for (std::size_t i = 0; i < size; ++i) {
      map.tets.push_back(whole.tets[order[i]]);
      map.parameters.push_back(whole.parameters[order[i]]);
    }
    Context context;
    Stage stage(context, "test");
    DefectCollector slow;
    adjacency::TetTopology topology;
    topology.tets = map.tets;
    topology.pointCount = map.points.size();
    collectTopologyDefects(topology, stage, slow);

    const CheckReport fast = check(map);
    const std::vector<Defect> expected = slow.defects();
    const auto isTopological = [](const Defect& defect) {
      return defect.code == ErrorCode::NonManifoldEdge ||
             defect.code == ErrorCode::NonManifoldVertex;
    };
    if (expected.empty()) {
      ++manifolds;
      RC_ASSERT(std::none_of(fast.defects.begin(), fast.defects.end(), isTopological));
      return;
    }
    ++others;
    RC_ASSERT(fast.defects.size() == expected.size());
    for (std::size_t d = 0; d < expected.size(); ++d) {
      RC_ASSERT(fast.defects[d].code == expected[d].code);
      RC_ASSERT(fast.defects[d].count == expected[d].count);
    }
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(manifolds, 0);
  EXPECT_GT(others, 0);
}

TEST(CornerOrder, ListsTheCornersOfEachFaceByVertex) {
  std::set<adjacency::CornerOrder> orders;
  Tet tet = {2, 3, 5, 0xfffffff0};
  do {
    const adjacency::CornerOrder order = adjacency::cornerOrder(tet);
    ASSERT_LT(order, adjacency::kCornerOrders);
    orders.insert(order);
    for (std::size_t face = 0; face < 4; ++face) {
      Tet expected = tet;
      expected[face] = kNone;
      std::sort(expected.begin(), expected.end());
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(tet[adjacency::kAscendingFaceCorners[order][face][k]], expected[k]);
      }
    }
  } while (std::next_permutation(tet.begin(), tet.end()));
  EXPECT_EQ(orders.size(), 24U);
}

/// So many faces at one vertex that the table for matching them has to grow.
TEST(Topology, VertexWithManyTets) {
  TetMap map;
  map.points = {{0, 0, 0}, {0, 0, 1}};
  constexpr Index kCorners = 2000;
  for (Index i = 0; i < kCorners; ++i) {
    const double angle = 6.283185307179586 * i / kCorners;
    map.points.push_back({std::cos(angle), std::sin(angle), 0.5});
  }
  for (Index i = 0; i < kCorners; ++i) {
    map.tets.push_back({0, 2 + i, 2 + (i + 1) % kCorners, 1});
  }
  map = identityMap(map.points, map.tets);
  const Prepared prepared(map);
  EXPECT_FALSE(prepared.defects().has(ErrorCode::NonManifoldVertex));
  for (Index t = 0; t < kCorners; ++t) {
    EXPECT_EQ(prepared.topology().mate[adjacency::halfFaceOf(t, 1)],
              adjacency::halfFaceOf((t + 1) % kCorners, 2));
    EXPECT_EQ(prepared.topology().mate[adjacency::halfFaceOf(t, 2)],
              adjacency::halfFaceOf((t + kCorners - 1) % kCorners, 1));
    EXPECT_TRUE(prepared.topology().isBoundary(adjacency::halfFaceOf(t, 0)));
    EXPECT_TRUE(prepared.topology().isBoundary(adjacency::halfFaceOf(t, 3)));
  }
}

TEST(Topology, TetThatListsItsCornersInReverse) {
  TetMap map = sampleOf(SampleKind::Box).map;
  const Prepared before(map);
  Index inner = 0;
  const auto touchesBoundary = [&](Index t) {
    return std::any_of(&before.topology().mate[4 * t], &before.topology().mate[4 * t] + 4,
                       [](adjacency::HalfFace mate) { return mate == kNone; });
  };
  while (touchesBoundary(inner)) ++inner;
  std::swap(map.tets[inner][2], map.tets[inner][3]);
  std::swap(map.parameters[inner][2], map.parameters[inner][3]);

  const CheckReport report = check(map);
  ASSERT_FALSE(report.valid());
  EXPECT_EQ(report.defects[0].code, ErrorCode::Orientation);
  EXPECT_EQ(report.defects[0].count, 4U);  // its four faces
  EXPECT_EQ(report.defects[0].worst[0].place.kind, PlaceKind::Face);
}

TEST(Topology, TetTwice) {
  const std::vector<Vec3> points = unitTetAnd({});
  EXPECT_EQ(check(identityMap(points, {{0, 1, 2, 3}, {0, 1, 2, 3}})).defects[0].code,
            ErrorCode::Orientation);
}

TEST(Topology, VertexThatDoesNotExist) {
  TetMap map = sampleOf(SampleKind::Box).map;
  map.tets[5][2] = static_cast<Index>(map.points.size());
  map.tets[7][0] = kNone;
  expectDefect(map, ErrorCode::IndexOutOfRange, toString({PlaceKind::Tet, 5}), 2);
}

TEST(Topology, VertexTwiceInATet) {
  TetMap map = sampleOf(SampleKind::Box).map;
  map.tets[9][3] = map.tets[9][1];
  expectDefect(map, ErrorCode::RepeatedVertex, toString({PlaceKind::Tet, 9}));
}

TEST(Topology, NumbersThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    TetMap map = sampleOf(SampleKind::Box).map;
    map.points[11][1] = bad;
    expectDefect(map, ErrorCode::NotFinite, toString({PlaceKind::Vertex, 11}));
    map = sampleOf(SampleKind::Box).map;
    map.parameters[13][3][2] = bad;
    expectDefect(map, ErrorCode::NotFinite, toString({PlaceKind::Tet, 13}));
  }
}

TEST(Topology, NoTets) {
  expectDefect({}, ErrorCode::EmptyMesh, "");
  expectDefect({{{0, 0, 0}}, {}, {}}, ErrorCode::EmptyMesh, "");
}

}  // namespace
}  // namespace hexhex::igm
