// Singular edges and nodes of samples against their answers.
#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <igm/measures.hpp>

#include "map_samples.hpp"
#include "support/error_of.hpp"

namespace hexhex::igm {
namespace {

using test::Prepared;

class SingularitiesOfKind : public test::EveryKind {};

std::vector<SampleOptions> variants() {
  std::vector<SampleOptions> all(5);
  all[1].jitter = 0.9;
  all[2].charts = ChartStyle::Random;
  all[3].noise = 0.004;
  all[3].charts = ChartStyle::Blocks;
  all[4].refine = 3;
  all[4].cells = 7;
  return all;
}

/// The lengths of singular edges, by valence.
void expectLengths(const Prepared& prepared, const Expectation& expected) {
  std::map<int, std::uint64_t> inner;
  std::map<int, std::uint64_t> boundary;
  for (const SingularEdge& edge : prepared.singularities().edges) {
    (edge.boundary ? boundary : inner)[edge.valence] +=
        static_cast<std::uint64_t>(latticeLength(edge, prepared.exact()));
  }
  const auto unit = static_cast<std::uint64_t>(prepared.exact().unit);
  const auto times = [&](std::map<int, std::uint64_t> counts) {
    for (auto& [valence, count] : counts) count *= unit;
    return counts;
  };
  EXPECT_EQ(inner, times(expected.innerSingularEdges));
  EXPECT_EQ(boundary, times(expected.boundarySingularEdges));
}

TEST_P(SingularitiesOfKind, HaveTheExpectedLengths) {
  for (const SampleOptions& options : variants()) {
    const Sample sample = generateSample(kind(), options);
    const Prepared prepared(sample.map);
    ASSERT_TRUE(prepared.defects().empty());
    expectLengths(prepared, sample.answer.expected);
  }
}

TEST_P(SingularitiesOfKind, AreListedInOrderWithTheirCorners) {
  const TetMap map = generateSample(kind(), {.charts = ChartStyle::Random}).map;
  const Prepared prepared(map);
  const std::vector<SingularEdge>& edges = prepared.singularities().edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    EXPECT_LT(edges[e].vertex0, edges[e].vertex1);
    EXPECT_EQ(map.tets[edges[e].tet][edges[e].corner0], edges[e].vertex0);
    EXPECT_EQ(map.tets[edges[e].tet][edges[e].corner1], edges[e].vertex1);
    EXPECT_EQ(edges[e].tet, adjacency::ownerTet(prepared.topology(), edges[e].tet,
                                                static_cast<lattice::CornerMask>(
                                                    lattice::cornerBit(edges[e].corner0) |
                                                    lattice::cornerBit(edges[e].corner1))));
    if (e == 0) continue;
    EXPECT_LT(std::pair(edges[e - 1].vertex0, edges[e - 1].vertex1),
              std::pair(edges[e].vertex0, edges[e].vertex1));
  }
}

TEST_P(SingularitiesOfKind, AreFoundAtTheirVertices) {
  const TetMap map = generateSample(kind()).map;
  const Prepared prepared(map);
  const Singularities& singularities = prepared.singularities();
  for (Index v = 0; v < map.points.size(); ++v) {
    std::vector<Index> incident;
    for (std::size_t e = 0; e < singularities.edges.size(); ++e) {
      const SingularEdge& edge = singularities.edges[e];
      if (edge.vertex0 == v || edge.vertex1 == v) incident.push_back(static_cast<Index>(e));
    }
    const std::span<const Index> listed = singularities.at(v);
    EXPECT_EQ(std::vector<Index>(listed.begin(), listed.end()), incident);
    EXPECT_EQ(singularities.degree(v), incident.size());
    EXPECT_EQ(singularities.isNode(v), !incident.empty() && incident.size() != 2);
  }
}

/// The edges of a list that are marked singular, as frame-field tools store them.
std::vector<EdgeValence> offsetsOf(const Singularities& singularities) {
  std::vector<EdgeValence> offsets;
  for (const SingularEdge& edge : singularities.edges) {
    offsets.push_back({edge.vertex1, edge.vertex0, edge.valence - (edge.boundary ? 2 : 4)});
  }
  return offsets;
}

TEST_P(SingularitiesOfKind, GivenValencesReproduceTheComputedOnes) {
  const TetMap map = generateSample(kind(), {.charts = ChartStyle::Blocks}).map;
  const Prepared computed(map);
  std::vector<EdgeValence> offsets = offsetsOf(computed.singularities());
  offsets.push_back({map.tets[0][0], map.tets[0][1], 0});  // listed, but regular or listed already
  const bool listedTwice = computed.singularities().degree(map.tets[0][0]) > 0;
  if (listedTwice) offsets.pop_back();
  std::reverse(offsets.begin(), offsets.end());
  TetMapView view(map);
  view.edgeValences = offsets;
  const Prepared given(view);
  ASSERT_TRUE(given.defects().empty());
  ASSERT_EQ(given.singularities().edges.size(), computed.singularities().edges.size());
  for (std::size_t e = 0; e < computed.singularities().edges.size(); ++e) {
    const SingularEdge& expected = computed.singularities().edges[e];
    const SingularEdge& found = given.singularities().edges[e];
    EXPECT_EQ(found.vertex0, expected.vertex0);
    EXPECT_EQ(found.vertex1, expected.vertex1);
    EXPECT_EQ(found.tet, expected.tet);
    EXPECT_EQ(found.boundary, expected.boundary);
    EXPECT_EQ(found.valence, expected.valence);
  }
  EXPECT_EQ(given.exact().corners, computed.exact().corners);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SingularitiesOfKind, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

TEST(Singularities, GivenValenceIsBelieved) {
  // A box has no inner singular edge; this one is claimed.
  const TetMap map = generateSample(SampleKind::Box).map;
  const Prepared before(map);
  std::vector<EdgeValence> offsets = offsetsOf(before.singularities());
  const adjacency::TetTopology& topology = before.topology();
  std::vector<adjacency::EdgeCorner> scratch;
  std::vector<EdgeValence> inner;
  for (Index v = 0; v < map.points.size() && inner.empty(); ++v) {
    adjacency::forEachEdge(topology, v, scratch,
                           [&](Index w, std::span<const adjacency::EdgeCorner> fan) {
                             if (inner.empty() && adjacency::boundaryFacesAt(topology, fan) == 0)
                               inner.push_back({v, w, 1});
                           });
  }
  ASSERT_EQ(inner.size(), 1U);
  offsets.push_back(inner[0]);
  TetMapView view(map);
  view.edgeValences = offsets;
  EXPECT_EQ(check(view).innerSingularTetEdges, (std::map<int, std::uint64_t>{{5, 1}}));
}

TEST(Singularities, GivenValenceOfAVertexThatDoesNotExist) {
  const TetMap map = generateSample(SampleKind::Box).map;
  const std::vector<EdgeValence> offsets = {{0, static_cast<Index>(map.points.size()), 1}};
  TetMapView view(map);
  view.edgeValences = offsets;
  EXPECT_EQ(test::codeOf([&] { (void)check(view); }), ErrorCode::InvalidArgument);
}

TEST(Singularities, StarsOfEveryValence) {
  for (int valence = 3; valence <= 12; ++valence) {
    SCOPED_TRACE(valence);
    for (const double jitter : {0.0, 0.5}) {
      const Sample sample = generateSample(SampleKind::Star, {.cells = 3,
                                                              .refine = 2,
                                                              .valence = valence,
                                                              .charts = ChartStyle::Random,
                                                              .jitter = jitter});
      const Prepared prepared(sample.map);
      ASSERT_TRUE(prepared.defects().empty());
      expectLengths(prepared, sample.answer.expected);
      const CheckReport report = check(sample.map);
      if (valence == 4) {
        EXPECT_TRUE(report.innerSingularTetEdges.empty());
      } else {
        EXPECT_EQ(report.innerSingularTetEdges, (std::map<int, std::uint64_t>{{valence, 2}}));
      }
    }
  }
}

TEST(Singularities, NodesAreWhereHandsCountThem) {
  const std::map<SampleKind, std::uint64_t> nodes = {
      {SampleKind::Box, 8},          // corners
      {SampleKind::Cylinder, 8},     // both ends of four inner edges
      {SampleKind::Sphere, 16},      // corners of the inner cube, and where its rays end
      {SampleKind::Star, 12},        // both ends of the inner edge and of the five outer ones
      {SampleKind::Tetrahedron, 9},  // the centre, the faces' centres, the corners
      {SampleKind::Torus, 0},        // its singular lines are closed
      {SampleKind::Shell, 16},       // both ends of eight rays
      {SampleKind::HandleBody, 24}   // corners of the plate and of its two holes
  };
  for (const auto& [kind, count] : nodes) {
    for (const int refine : {1, 3}) {
      EXPECT_EQ(check(generateSample(kind, {.refine = refine}).map).singularNodes, count);
    }
  }
}

}  // namespace
}  // namespace hexhex::igm
