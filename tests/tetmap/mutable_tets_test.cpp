// Splits of edges and tets, in any order, against what the tets alone say of the mesh.
#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>
#include <tetmap/tetmap.hpp>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>

#include "adjacency/kuhn_grid.hpp"
#include "support/tet_volume.hpp"

namespace hexhex::tetmap {
namespace {

class Splitting : public ::testing::Test {
 protected:
  void SetUp() override {
    Stage stage(context_, "topology");
    auto topology = adjacency::manifoldTopology(grid_.tets, points_.size(), stage);
    ASSERT_TRUE(topology);
    mesh_ = MutableTets(grid_.tets, topology->mate, points_.size());
    for (Index t = 0; t < grid_.tets.size(); ++t) {
      original_.push_back(t);
      TetParameters corners{};
      for (std::size_t i = 0; i < 4; ++i) corners[i] = points_[grid_.tets[t][i]];
      corners_.push_back(corners);
    }
    for (adjacency::HalfFace h = 0; h < 4 * grid_.tets.size(); ++h) face_.push_back(h);
    perTet_.assign(grid_.tets.size(), {0, 1, 2, 3});
  }

  void split(const EdgeInTet& edge) {
    const auto [v, w] = edge.vertices;
    points_.push_back(middleOf(points_[v], points_[w]));
    for (const Cut& cut : mesh_.splitEdge(edge)) {
      carryTet(cut, original_);
      carryCorners(cut, corners_);
      carryFaces(cut, kInside, face_);
      carryFaces(cut, std::int8_t{-1}, perTet_);
      carryTet(cut, nothing_);
    }
  }

  /// What has been carried, and mates, are those of the tets as they are.
  void expectConsistent() {
    ASSERT_EQ(mesh_.vertexCount(), points_.size());
    ASSERT_EQ(mesh_.mate.size(), 4 * mesh_.tets.size());
    Stage stage(context_, "topology");
    auto topology = adjacency::manifoldTopology(mesh_.tets, points_.size(), stage);
    ASSERT_TRUE(topology);
    EXPECT_TRUE(std::equal(mesh_.mate.begin(), mesh_.mate.end(), topology->mate.begin()));
    double volume = 0;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      EXPECT_GT(test::sixfoldVolume(points_, mesh_.tets[t]), 0);
      volume += test::sixfoldVolume(points_, mesh_.tets[t]);
    }
    EXPECT_NEAR(volume, 6 * 8, 1e-9);
  }

  void expectCarried() {
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      for (Index i = 0; i < 4; ++i) {
        EXPECT_EQ(corners_[t][i], points_[mesh_.tets[t][i]]);
        const adjacency::HalfFace face = face_[4 * t + i];
        EXPECT_EQ(perTet_[t][i] < 0, face == kInside);
        if (face == kInside) continue;
        EXPECT_EQ(static_cast<Index>(perTet_[t][i]), face % 4);
        EXPECT_EQ(face / 4, original_[t]);
        // The plane of that face of the original tet has all three corners.
        Tet plane = grid_.tets[original_[t]];
        for (Index k = 0; k < 4; ++k) {
          plane[face % 4] = mesh_.tets[t][k];
          EXPECT_TRUE(k == i || test::sixfoldVolume(points_, plane) == 0);
        }
      }
    }
    EXPECT_TRUE(nothing_.empty());
  }

  static constexpr adjacency::HalfFace kInside = kNone;
  KuhnGrid grid_{2};
  std::vector<Vec3> points_ = grid_.points;
  Context context_;
  MutableTets mesh_;
  std::vector<Index> original_;
  std::vector<TetParameters> corners_;
  std::vector<adjacency::HalfFace> face_;
  std::vector<std::array<std::int8_t, 4>> perTet_;
  std::vector<int> nothing_;
};

TEST_F(Splitting, EdgesOneAfterTheOther) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    const auto t = static_cast<Index>(random() % mesh_.tetCount());
    const std::size_t a = random() % 4;
    const std::size_t b = (a + 1 + random() % 3) % 4;
    split({pairOf(mesh_.tets[t][a], mesh_.tets[t][b]), t});
  }
  expectConsistent();
  expectCarried();
}

TEST_F(Splitting, FindsEdgesOfTetsThatWereSplitMeanwhile) {
  // All edges of the grid, each named by the last tet at it, in an order that knows nothing.
  std::map<VertexPair, Index> tetAt;
  for (Index t = 0; t < grid_.tets.size(); ++t) {
    forEachEdgeOf(grid_.tets[t], [&](const VertexPair& edge, lattice::CornerMask /*corners*/) {
      tetAt[edge] = t;
    });
  }
  std::vector<EdgeInTet> edges;
  for (const auto& [edge, t] : tetAt) edges.push_back({edge, t});
  std::shuffle(edges.begin(), edges.end(), std::mt19937(3));
  for (const EdgeInTet& edge : edges) split(edge);
  expectConsistent();
  expectCarried();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [v, w] = edges[i].vertices;
    const Index middle = static_cast<Index>(grid_.points.size() + i);
    const MutableTets::Found found = mesh_.find(v, w, edges[i].tet);
    EXPECT_FALSE(found.edge.has_value());
    EXPECT_EQ(found.middle, middle);
    std::vector<VertexPair> parts;
    mesh_.forEachPart(v, w, edges[i].tet, [&](const adjacency::TetEdge& at) {
      parts.push_back({mesh_.tets[at.tet][at.corner0], mesh_.tets[at.tet][at.corner1]});
    });
    EXPECT_EQ(parts, (std::vector<VertexPair>{{v, middle}, {middle, w}}));
  }
  EXPECT_THROW(static_cast<void>(mesh_.splitEdge(edges[0])), Error);
  EXPECT_THROW(static_cast<void>(mesh_.find(0, 26, edges[0].tet)), Error);
}

TEST_F(Splitting, Tets) {
  for (Index t = 0; t < grid_.tets.size(); t += 2) {
    const Tet whole = mesh_.tets[t];
    Vec3 middle{};
    for (const Index v : whole) {
      for (std::size_t k = 0; k < 3; ++k) middle[k] += points_[v][k] / 4;
    }
    points_.push_back(middle);
    const std::array<Index, 4> parts = mesh_.splitTet(t);
    EXPECT_EQ(parts[0], t);
    for (std::size_t i = 0; i < 4; ++i) {
      Tet part = whole;
      part[i] = static_cast<Index>(points_.size() - 1);
      EXPECT_EQ(mesh_.tets[parts[i]], part);
    }
    // Its edges are still found.
    EXPECT_TRUE(mesh_.find(whole[0], whole[1], t).edge.has_value());
  }
  expectConsistent();
}

}  // namespace
}  // namespace hexhex::tetmap
