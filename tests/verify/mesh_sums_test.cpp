// Many kinds of damage to a mesh change its numbers of faces, edges and components.
#include <algorithm>
#include <rapidcheck.h>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <verify/comparisons.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <mesh/grid_meshes.hpp>

namespace hexhex::verification {
namespace {

using testing::gridMesh;
using testing::Random;
using testing::reversed;
using testing::shuffled;

/// What an n x n x n grid should be.
Expectation boxExpectation(std::uint64_t n) {
  Expectation expected;
  expected.cells = n * n * n;
  expected.boundaryQuads = 6 * n * n;
  expected.boundarySingularEdges = {{1, 12 * n}};
  expected.eulerCharacteristic = 1;
  expected.components = 1;
  expected.boundaryComponents = 1;
  return expected;
}

VerifyReport compared(const Expectation& expected, const HexMesh& mesh, int threads = 0) {
  Context context(threads);
  Stage stage(context, "test");
  Comparisons comparisons;
  withThreads(threads, [&] { compareSums(expected, mesh, stage, comparisons); });
  return comparisons.take();
}

using Names = std::set<std::string>;

Names failedItems(const VerifyReport& report) {
  Names names;
  for (const VerifyItem& item : report.items) {
    if (!item.passed) names.insert(item.name);
  }
  EXPECT_EQ(report.passed(), names.empty());
  return names;
}

std::string foundOf(const VerifyReport& report, const std::string& name) {
  for (const VerifyItem& item : report.items) {
    if (item.name == name) return item.found;
  }
  return "no such item";
}

/// The mesh of the identity map of a 3 x 3 x 3 box.
class DamagedBox : public ::testing::Test {
 protected:
  [[nodiscard]] VerifyReport check() const { return compared(boxExpectation(3), mesh_); }
  [[nodiscard]] Names failed() const { return failedItems(check()); }
  /// The vertex at a grid point.
  [[nodiscard]] Index at(const Vec3& p) const {
    const auto found = std::find(mesh_.points.begin(), mesh_.points.end(), p);
    return static_cast<Index>(found - mesh_.points.begin());
  }

  HexMesh mesh_ = gridMesh(3);
};

TEST_F(DamagedBox, PassesUndamaged) {
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names());
  const std::vector<std::string> keys = {"boundary_quads",
                                         "inner_singular_edges",
                                         "boundary_singular_edges",
                                         "faces_shared_by_more_than_two_cells",
                                         "faces_with_wrong_direction",
                                         "euler_characteristic",
                                         "components",
                                         "boundary_closed",
                                         "boundary_components"};
  std::vector<std::string> found;
  for (const VerifyItem& item : report.items) found.push_back(item.name);
  EXPECT_EQ(found, keys);
  EXPECT_EQ(foundOf(report, "boundary_singular_edges"), "1:36");
  EXPECT_EQ(foundOf(report, "inner_singular_edges"), "none");
}

TEST_F(DamagedBox, PassesInAnyOrder) {
  mesh_ = shuffled(mesh_, 4);
  EXPECT_EQ(failed(), Names());
}

TEST_F(DamagedBox, RemovedCornerCell) {
  mesh_.cells.erase(mesh_.cells.begin());
  EXPECT_EQ(failed(), Names({"boundary_singular_edges"}));
}

TEST_F(DamagedBox, RemovedInnerCell) {
  mesh_.cells.erase(mesh_.cells.begin() + 13);
  EXPECT_EQ(failed(), Names({"boundary_quads", "boundary_singular_edges", "euler_characteristic",
                             "boundary_components"}));
}

TEST_F(DamagedBox, DuplicatedInnerCell) {
  mesh_.cells.push_back(mesh_.cells[13]);
  EXPECT_EQ(failed(), Names({"inner_singular_edges", "faces_shared_by_more_than_two_cells",
                             "euler_characteristic"}));
}

TEST_F(DamagedBox, ReversedCell) {
  mesh_.cells[13] = reversed(mesh_.cells[13]);
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names({"faces_with_wrong_direction"}));
  EXPECT_EQ(foundOf(report, "faces_with_wrong_direction").substr(0, 16), "6 (first: cell 4");
}

TEST_F(DamagedBox, SwappedCorners) {
  std::swap(mesh_.cells[13][0], mesh_.cells[13][1]);
  const Names names = failed();
  EXPECT_TRUE(names.count("boundary_quads"));
  EXPECT_TRUE(names.count("boundary_singular_edges"));
}

TEST_F(DamagedBox, RepeatedVertexInACell) {
  mesh_.cells[13][0] = mesh_.cells[13][6];
  const Names names = failed();
  EXPECT_TRUE(names.count("boundary_quads"));
}

TEST_F(DamagedBox, SplitVertex) {
  // One cell gets its own copy of a vertex in the middle: a slit.
  mesh_.points.push_back(mesh_.points[at({1, 1, 1})]);
  std::replace(mesh_.cells[0].begin(), mesh_.cells[0].end(), at({1, 1, 1}), Index{64});
  const Names names = failed();
  EXPECT_TRUE(names.count("boundary_quads"));
}

TEST_F(DamagedBox, EmptyMesh) {
  mesh_ = {};
  EXPECT_EQ(failed(), Names({"boundary_quads", "boundary_singular_edges", "euler_characteristic",
                             "components", "boundary_components"}));
}

TEST_F(DamagedBox, TouchingCells) {
  mesh_ = gridMesh(3, [](std::size_t x, std::size_t y, std::size_t) { return x == y; });
  EXPECT_TRUE(failed().count("boundary_closed"));
  EXPECT_TRUE(failed().count("components"));
}

TEST_F(DamagedBox, WrongExpectations) {
  const auto failedWith = [&](auto&& change) {
    Expectation expected = boxExpectation(3);
    change(expected);
    return failedItems(compared(expected, mesh_));
  };
  EXPECT_EQ(failedWith([](Expectation& e) { --e.boundaryQuads; }), Names({"boundary_quads"}));
  EXPECT_EQ(failedWith([](Expectation& e) { e.innerSingularEdges[3] = 1; }),
            Names({"inner_singular_edges"}));
  EXPECT_EQ(failedWith([](Expectation& e) { e.innerSingularEdges[5] = 0; }), Names());
  EXPECT_EQ(failedWith([](Expectation& e) { e.boundarySingularEdges[1] = 35; }),
            Names({"boundary_singular_edges"}));
  EXPECT_EQ(failedWith([](Expectation& e) { e.eulerCharacteristic = 0; }),
            Names({"euler_characteristic"}));
  EXPECT_EQ(failedWith([](Expectation& e) { e.components = 2; }), Names({"components"}));
  EXPECT_EQ(failedWith([](Expectation& e) { e.boundaryComponents = 2; }),
            Names({"boundary_components"}));
}

TEST(MeshSums, DoNotDependOnThreads) {
  HexMesh mesh = shuffled(gridMesh(12), 5);
  mesh.cells[300] = reversed(mesh.cells[300]);
  mesh.cells[600][0] = mesh.cells[601][1];
  const VerifyReport one = compared(boxExpectation(12), mesh, 1);
  EXPECT_FALSE(one.passed());
  for (const int threads : {2, 5}) {
    const VerifyReport many = compared(boxExpectation(12), mesh, threads);
    ASSERT_EQ(many.items.size(), one.items.size());
    for (std::size_t i = 0; i < one.items.size(); ++i) {
      EXPECT_EQ(many.items[i].found, one.items[i].found) << one.items[i].name;
      EXPECT_EQ(many.items[i].passed, one.items[i].passed) << one.items[i].name;
    }
  }
}

TEST(MeshSums, SurviveAnyIndices) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    HexMesh mesh = gridMesh(1 + random.below(3));
    // Few different vertices make everything coincide that can.
    const std::uint64_t range = 1 + random.below(mesh.points.size());
    const std::uint64_t changes = random.below(8 * mesh.cells.size() + 1);
    for (std::uint64_t i = 0; i < changes; ++i) {
      Hex& cell = mesh.cells[random.below(mesh.cells.size())];
      cell[random.below(8)] = static_cast<Index>(random.below(range));
    }
    Expectation other = boxExpectation(4);
    other.cells = mesh.cells.size();
    RC_ASSERT(!compared(other, mesh).passed());
  }));
}

}  // namespace
}  // namespace hexhex::verification
