// Adjacency of tets against brute force on samples, and every way not to be a manifold.
#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <map/tet_topology.hpp>

#include "map_samples.hpp"

namespace hexhex {
namespace {

using test::identityMap;
using test::Prepared;

/// The vertices of a simplex of a tet, ascending.
std::vector<Index> verticesOf(const Tet& tet, CornerMask simplex) {
  std::vector<Index> vertices;
  for (int i = 0; i < 4; ++i) {
    if (contains(simplex, i)) vertices.push_back(tet[static_cast<std::size_t>(i)]);
  }
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// All tets that contain each simplex, ascending, found without any adjacency.
std::map<std::vector<Index>, std::vector<Index>> tetsBySimplex(const std::vector<Tet>& tets) {
  std::map<std::vector<Index>, std::vector<Index>> result;
  for (Index t = 0; t < tets.size(); ++t) {
    for (CornerMask simplex = 1; simplex <= kWholeTet; ++simplex) {
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
  const TetTopology& topology = prepared.topology();
  const auto simplices = tetsBySimplex(map.tets);
  ASSERT_EQ(topology.mate.size(), 4 * map.tets.size());
  for (HalfFace here = 0; here < topology.mate.size(); ++here) {
    const Index tet = tetOf(here);
    const std::vector<Index> triangle = verticesOf(map.tets[tet], faceMask(localOf(here)));
    const std::vector<Index>& around = simplices.at(triangle);
    const HalfFace there = topology.mate[here];
    ASSERT_EQ(there == kNone, around.size() == 1);
    ASSERT_EQ(topology.isBoundary(here), around.size() == 1);
    if (there == kNone) continue;
    EXPECT_EQ(topology.mate[there], here);
    EXPECT_EQ(tetOf(there), around[0] == tet ? around[1] : around[0]);
    EXPECT_EQ(verticesOf(map.tets[tetOf(there)], faceMask(localOf(there))), triangle);
  }
}

TEST_P(TopologyOfKind, StarsAreCompleteAndSorted) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const auto simplices = tetsBySimplex(map.tets);
  for (Index v = 0; v < map.points.size(); ++v) {
    std::vector<Index> tets;
    for (const CornerIndex corner : prepared.topology().star(v)) {
      EXPECT_EQ(prepared.topology().vertex(corner), v);
      tets.push_back(corner / 4);
    }
    EXPECT_EQ(tets, simplices.at({v}));
  }
}

TEST_P(TopologyOfKind, EdgesAreSortedUniqueAndFound) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const TetTopology& topology = prepared.topology();
  std::uint64_t edge = 0;
  // A std::map lists them in lexicographic order.
  for (const auto& [vertices, tets] : tetsBySimplex(map.tets)) {
    if (vertices.size() != 2) continue;
    ASSERT_LT(edge, topology.edgeCount());
    EXPECT_EQ(topology.edgeEnd[edge], vertices[1]);
    EXPECT_LE(topology.edgeBegin[vertices[0]], edge);
    EXPECT_LT(edge, topology.edgeBegin[vertices[0] + 1]);
    EXPECT_EQ(topology.edgeIndex(vertices[0], vertices[1]), edge);
    EXPECT_EQ(topology.edgeIndex(vertices[1], vertices[0]), edge);
    ++edge;
  }
  EXPECT_EQ(topology.edgeCount(), edge);
}

TEST_P(TopologyOfKind, FansOfEdgesAreComplete) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const TetTopology& topology = prepared.topology();
  const auto simplices = tetsBySimplex(map.tets);
  std::vector<EdgeCorner> scratch;
  std::uint64_t edge = 0;
  for (Index v = 0; v < map.points.size(); ++v) {
    forEachEdge(topology, v, scratch, [&](Index w, std::span<const EdgeCorner> fan) {
      EXPECT_EQ(topology.edgeIndex(v, w), edge++);
      std::vector<Index> tets;
      std::size_t boundaryFaces = 0;
      for (const EdgeCorner& at : fan) {
        EXPECT_EQ(at.other, w);
        EXPECT_EQ(map.tets[at.tet][at.corner0], v);
        EXPECT_EQ(map.tets[at.tet][at.corner1], w);
        tets.push_back(at.tet);
        for (int face = 0; face < 4; ++face) {
          if (face == at.corner0 || face == at.corner1) continue;
          const auto triangle = verticesOf(map.tets[at.tet], faceMask(face));
          boundaryFaces += simplices.at(triangle).size() == 1 ? 1 : 0;
        }
      }
      EXPECT_EQ(tets, simplices.at({v, w}));
      EXPECT_EQ(boundaryFacesAt(topology, fan), boundaryFaces);
    });
  }
  EXPECT_EQ(edge, topology.edgeCount());
}

TEST_P(TopologyOfKind, OwnerIsTheSmallestTet) {
  const TetMap map = sampleOf(kind()).map;
  const Prepared prepared(map);
  const auto simplices = tetsBySimplex(map.tets);
  for (Index t = 0; t < map.tets.size(); ++t) {
    for (CornerMask simplex = 1; simplex <= kWholeTet; ++simplex) {
      EXPECT_EQ(ownerTet(prepared.topology(), t, simplex),
                simplices.at(verticesOf(map.tets[t], simplex)).front());
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

TEST(Topology, TetThatListsItsCornersInReverse) {
  TetMap map = sampleOf(SampleKind::Box).map;
  const Prepared before(map);
  Index inner = 0;
  const auto touchesBoundary = [&](Index t) {
    return std::any_of(&before.topology().mate[4 * t], &before.topology().mate[4 * t] + 4,
                       [](HalfFace mate) { return mate == kNone; });
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
}  // namespace hexhex
