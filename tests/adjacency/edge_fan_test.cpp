// The walk around an edge, against a search through all tets.
#include <algorithm>
#include <set>

#include <adjacency/edge_fan.hpp>
#include <gtest/gtest.h>

#include <hexhex/context.hpp>

#include "kuhn_grid.hpp"

namespace hexhex::adjacency {
namespace {

class EdgeFan : public ::testing::Test {
 protected:
  void SetUp() override {
    Stage stage(context_, "topology");
    topology_.tets = grid_.tets;
    topology_.pointCount = grid_.points.size();
    ASSERT_TRUE(matchFaces(topology_, stage));
    addStars(topology_, stage);
  }

  [[nodiscard]] std::set<Index> tetsWith(Index v, Index w) const {
    std::set<Index> tets;
    for (Index t = 0; t < grid_.tets.size(); ++t) {
      const Tet& tet = grid_.tets[t];
      if (std::count(tet.begin(), tet.end(), v) + std::count(tet.begin(), tet.end(), w) == 2) {
        tets.insert(t);
      }
    }
    return tets;
  }
  /// By coordinates: both ends on one side of the cube.
  [[nodiscard]] bool isOnBoundary(Index v, Index w) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = grid_.points[v][k];
      if (x == grid_.points[w][k] && (x == 0 || x == kSize)) return true;
    }
    return false;
  }
  /// visit(tet edge, its vertices)
  template <class Visit>
  void forEachTetEdge(const Visit& visit) const {
    for (Index t = 0; t < grid_.tets.size(); ++t) {
      for (std::uint8_t a = 0; a < 4; ++a) {
        for (std::uint8_t b = 0; b < 4; ++b) {
          if (a != b) visit(TetEdge{t, a, b}, grid_.tets[t][a], grid_.tets[t][b]);
        }
      }
    }
  }

  static constexpr Index kSize = 2;
  KuhnGrid grid_{kSize};
  Context context_;
  TetTopology topology_;
};

TEST_F(EdgeFan, VisitsEachTetOnceAndCarriesValues) {
  forEachTetEdge([&](const TetEdge& at, Index v, Index w) {
    std::set<Index> left = tetsWith(v, w);
    const std::size_t count = left.size();
    left.erase(at.tet);
    std::size_t first = 0;  // carried values count steps, from anew in the second direction
    const std::optional<std::size_t> around = visitAroundEdge(
        topology_, at.tet, at.mask(), std::size_t{0},
        [](std::size_t steps, HalfFace /*out*/) { return steps + 1; },
        [&](const auto& turn, std::size_t steps) {
          EXPECT_EQ(left.erase(turn.tet()), 1U);
          EXPECT_EQ(turn.edge(), topology_.edge(turn.tet(), v, w).mask());
          EXPECT_TRUE(steps == 1 || steps == first + 1);
          first = steps;
          return true;
        });
    EXPECT_TRUE(left.empty());
    EXPECT_EQ(around.has_value(), !isOnBoundary(v, w));
    EXPECT_EQ(around.value_or(count), count);
  });
}

TEST_F(EdgeFan, StopsWhenTold) {
  forEachTetEdge([&](const TetEdge& at, Index /*v*/, Index /*w*/) {
    int visits = 0;
    const auto around = visitAroundEdge(
        topology_, at.tet, at.mask(), 0, [](int value, HalfFace /*out*/) { return value; },
        [&](const auto& /*turn*/, int /*value*/) {
          ++visits;
          return false;
        });
    EXPECT_LE(visits, 1);
    EXPECT_FALSE(around.has_value());
  });
}

TEST_F(EdgeFan, GoesToTheBoundaryOrOnceAround) {
  forEachTetEdge([&](const TetEdge& at, Index v, Index w) {
    for (int face = 0; face < 4; ++face) {
      if (lattice::contains(at.mask(), face)) continue;
      EdgeTurn turn(topology_, at.tet, at.mask(), face);
      EXPECT_EQ(turn.ahead(), static_cast<std::size_t>(6 - at.corner0 - at.corner1 - face));
      EXPECT_EQ(turn.goToBoundary(), isOnBoundary(v, w));
      EXPECT_EQ(turn.edge(), topology_.edge(turn.tet(), v, w).mask());
      if (isOnBoundary(v, w)) {
        EXPECT_TRUE(topology_.isBoundary(turn.out()));
      } else {
        EXPECT_EQ(turn.out(), halfFaceOf(at.tet, face));
      }
    }
  });
}

TEST_F(EdgeFan, TableHasAllEdges) {
  const EdgeFans edges(topology_);
  Stage stage(context_, "edges");
  EXPECT_EQ(edges.size(), countEdges(topology_, stage));
  forEachTetEdge([&](const TetEdge& at, Index v, Index w) {
    const Index edge = edges.edgeOf(at);
    std::vector<Index> tets;
    for (const EdgeCorner& corner : edges(edge)) {
      EXPECT_EQ(corner.other, std::max(v, w));
      EXPECT_EQ(grid_.tets[corner.tet][corner.corner0], std::min(v, w));
      EXPECT_EQ(grid_.tets[corner.tet][corner.corner1], std::max(v, w));
      tets.push_back(corner.tet);
    }
    const std::set<Index> expected = tetsWith(v, w);
    EXPECT_EQ(tets, std::vector<Index>(expected.begin(), expected.end()));
    EXPECT_EQ(edges.isBoundary(edge), isOnBoundary(v, w));
  });
}

}  // namespace
}  // namespace hexhex::adjacency
