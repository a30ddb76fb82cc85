// Every kind of damage to a mesh is noticed, by the items that are about it and by no others.
#include <algorithm>
#include <cmath>
#include <rapidcheck.h>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <mesh/grid_meshes.hpp>
#include <mesh/verify_against.hpp>

namespace hexhex {
namespace {

using testing::gridMesh;
using testing::identityMap;
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

VerifyReport verified(const Expectation& expected, const TetMapView& map, const HexMesh& mesh,
                      const VerifyOptions& options = {}, int threads = 0) {
  Context context(threads);
  Stage stage(context, "test");
  VerifyReport report;
  withThreads(threads, [&] { report = verifyAgainst(expected, map, mesh, options, stage); });
  return report;
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
  [[nodiscard]] VerifyReport check(const VerifyOptions& options = {}) const {
    return verified(boxExpectation(3), map_, mesh_, options);
  }
  [[nodiscard]] Names failed(const VerifyOptions& options = {}) const {
    return failedItems(check(options));
  }
  /// The vertex at a grid point.
  [[nodiscard]] Index at(const Vec3& p) const {
    const auto found = std::find(mesh_.points.begin(), mesh_.points.end(), p);
    return static_cast<Index>(found - mesh_.points.begin());
  }

  TetMap map_ = identityMap(3);
  HexMesh mesh_ = gridMesh(3);
};

TEST_F(DamagedBox, PassesUndamaged) {
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names());
  const std::vector<std::string> keys = {"indices_in_range",
                                         "cells",
                                         "boundary_quads",
                                         "inner_singular_edges",
                                         "boundary_singular_edges",
                                         "faces_shared_by_more_than_two_cells",
                                         "faces_with_wrong_direction",
                                         "euler_characteristic",
                                         "components",
                                         "boundary_closed",
                                         "boundary_components",
                                         "unused_vertices",
                                         "vertices_off_lattice"};
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

TEST_F(DamagedBox, MovedVertex) {
  const Index inner = at({1, 2, 1});
  mesh_.points[inner] = {1, 2.1, 1};
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names({"vertices_off_lattice"}));
  EXPECT_EQ(foundOf(report, "vertices_off_lattice"), "1 (first: vertex " + std::to_string(inner) +
                                                         " is 0.100000 hex edges off the lattice)");
}

TEST_F(DamagedBox, VertexMovedWithinTolerance) {
  mesh_.points[at({1, 2, 1})] = {1, 2.009, 1};
  EXPECT_EQ(failed(), Names());
  EXPECT_EQ(failed({1, 1e-3}), Names({"vertices_off_lattice"}));
}

TEST_F(DamagedBox, VertexOutside) {
  mesh_.points[at({0, 0, 0})] = {-1, 0, 0};
  mesh_.points[at({3, 1, 1})] = {3.001, 1, 1};
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names({"vertices_off_lattice"}));
  EXPECT_EQ(foundOf(report, "vertices_off_lattice"), "2 (first: vertex 0 is outside of all tets)");
}

TEST_F(DamagedBox, PointThatIsNoNumber) {
  mesh_.points[at({1, 1, 1})][2] = NAN;
  mesh_.points[at({2, 1, 1})][0] = INFINITY;
  EXPECT_EQ(failed(), Names({"vertices_off_lattice"}));
}

TEST_F(DamagedBox, RemovedCornerCell) {
  mesh_.cells.erase(mesh_.cells.begin());
  EXPECT_EQ(failed(), Names({"cells", "boundary_singular_edges", "unused_vertices"}));
}

TEST_F(DamagedBox, RemovedInnerCell) {
  mesh_.cells.erase(mesh_.cells.begin() + 13);
  EXPECT_EQ(failed(), Names({"cells", "boundary_quads", "boundary_singular_edges",
                             "euler_characteristic", "boundary_components"}));
}

TEST_F(DamagedBox, DuplicatedInnerCell) {
  mesh_.cells.push_back(mesh_.cells[13]);
  EXPECT_EQ(failed(), Names({"cells", "inner_singular_edges", "faces_shared_by_more_than_two_cells",
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
  EXPECT_FALSE(names.count("cells"));
  EXPECT_FALSE(names.count("unused_vertices"));
  EXPECT_FALSE(names.count("vertices_off_lattice"));
}

TEST_F(DamagedBox, RepeatedVertexInACell) {
  mesh_.cells[13][0] = mesh_.cells[13][6];
  const Names names = failed();
  EXPECT_TRUE(names.count("boundary_quads"));
  EXPECT_FALSE(names.count("vertices_off_lattice"));
}

TEST_F(DamagedBox, UnusedVertex) {
  mesh_.points.push_back({1, 1, 1});
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names({"unused_vertices"}));
  EXPECT_EQ(foundOf(report, "unused_vertices"), "1 (first: vertex 64)");
}

TEST_F(DamagedBox, SplitVertex) {
  // One cell gets its own copy of a vertex in the middle: a slit.
  mesh_.points.push_back(mesh_.points[at({1, 1, 1})]);
  std::replace(mesh_.cells[0].begin(), mesh_.cells[0].end(), at({1, 1, 1}), Index{64});
  const Names names = failed();
  EXPECT_TRUE(names.count("boundary_quads"));
  EXPECT_FALSE(names.count("unused_vertices"));
  EXPECT_FALSE(names.count("vertices_off_lattice"));
}

TEST_F(DamagedBox, IndexOutOfRange) {
  mesh_.cells[7][3] = 64;
  const VerifyReport report = check();
  EXPECT_EQ(failedItems(report), Names({"indices_in_range"}));
  EXPECT_EQ(foundOf(report, "indices_in_range"), "no (first: cell 7)");
}

TEST_F(DamagedBox, EmptyMesh) {
  mesh_ = {};
  EXPECT_EQ(failed(), Names({"cells", "boundary_quads", "boundary_singular_edges",
                             "euler_characteristic", "components", "boundary_components"}));
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
    return failedItems(verified(expected, map_, mesh_));
  };
  EXPECT_EQ(failedWith([](Expectation& e) { ++e.cells; }), Names({"cells"}));
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

TEST_F(DamagedBox, ParametersOff) {
  // Corner (1, 1, 1) of all tets, so that the map stays continuous.
  for (const double error : {0.3, 0.05, 0.011}) {
    map_ = identityMap(3);
    for (std::size_t t = 0; t < map_.tets.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (map_.points[map_.tets[t][i]] == Vec3{1, 1, 1}) map_.parameters[t][i][1] += error;
      }
    }
    EXPECT_EQ(failed(), Names({"vertices_off_lattice"})) << error;
    EXPECT_EQ(failed({1, 0.31}), Names()) << error;
  }
}

// ---------------------------------------------------------------------------------------------
// Positions in maps that are not simply the identity.

/// The map with the tets of another chart each, far away, and in another order of corners.
TetMap withRandomCharts(TetMap map, std::uint64_t seed, double offset) {
  Random random(seed);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    Vec3 shift;
    for (double& x : shift) x = std::round(offset * (2 * random.real() - 1));
    const std::size_t turn = random.below(3);
    const double sign = random.below(2) == 0 ? 1 : -1;  // mirrors: irrelevant for positions
    TetParameters turned;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        turned[i][k] = sign * map.parameters[t][i][(k + turn) % 3] + shift[k];
      }
    }
    const std::size_t first = random.below(4);
    std::swap(map.tets[t][0], map.tets[t][first]);
    std::swap(turned[0], turned[first]);
    map.parameters[t] = turned;
  }
  return map;
}

/// Maps points, e.g. far away or by a shear; straight tets stay straight.
template <class Points>
void transform(Points& points, double size, const Vec3& shift) {
  for (Vec3& p : points) {
    p = {size * (p[0] + 0.7 * p[1]) + shift[0], size * (p[1] - 0.3 * p[2]) + shift[1],
         size * p[2] + shift[2]};
  }
}

TEST(VerifyPositions, ChartsMayBeAnywhere) {
  for (const double offset : {0.0, 10.0, 1e6, 1e9}) {
    const TetMap map = withRandomCharts(identityMap(3), 1, offset);
    HexMesh mesh = gridMesh(3);
    EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh, {1, 0})), Names()) << offset;
    mesh.points[21][2] += 1e-3;
    EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh, {1, 0})),
              Names({"vertices_off_lattice"}));
  }
}

TEST(VerifyPositions, SizeAndPlaceInSpaceDoNotMatter) {
  struct Case {
    double size;
    Vec3 shift;
  };
  for (const auto& [size, shift] :
       {Case{1e-6, {0, 0, 0}}, Case{1e8, {0, 0, 0}}, Case{1, {1e6, -1e5, 3e6}},
        Case{1e-3, {100, 200, 300}}, Case{-1, {0, 0, 0}}}) {
    TetMap map = identityMap(3);
    HexMesh mesh = gridMesh(3);
    transform(map.points, size, shift);
    transform(mesh.points, size, shift);
    EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh, {1, 0})), Names()) << size;
    mesh.points[21][2] += 0.1 * size;
    EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names({"vertices_off_lattice"}))
        << size;
  }
}

TEST(VerifyPositions, ScaleRefinesTheLattice) {
  const TetMap map = identityMap(2);
  HexMesh mesh = gridMesh(6);
  for (Vec3& p : mesh.points) {
    for (double& x : p) x /= 3;
  }
  EXPECT_EQ(failedItems(verified(boxExpectation(6), map, mesh, {3, 1e-2})), Names());
  EXPECT_EQ(failedItems(verified(boxExpectation(6), map, mesh, {2, 1e-2})),
            Names({"vertices_off_lattice"}));
}

/// Names one of the tets around each vertex, as the extraction does.
void addHints(const TetMap& map, HexMesh& mesh) {
  mesh.generatorTet.resize(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      for (const Index corner : map.tets[t]) {
        if (map.points[corner] == mesh.points[v]) mesh.generatorTet[v] = static_cast<Index>(t);
      }
    }
  }
}

TEST(VerifyPositions, HintsHelpButAreNotBelieved) {
  const TetMap map = identityMap(3);
  HexMesh mesh = gridMesh(3);
  addHints(map, mesh);
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names());
  mesh.points[21][0] += 0.1;
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names({"vertices_off_lattice"}));
  mesh.points[21][0] -= 0.1;
  std::reverse(mesh.generatorTet.begin(), mesh.generatorTet.end());
  mesh.generatorTet[4] = kNone;
  mesh.generatorTet[5] = static_cast<Index>(map.tets.size());
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names());
  mesh.generatorTet.pop_back();
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names());
}

TEST(VerifyPositions, FlatTetsAreIgnored) {
  // Tets without volume whose parameters would put every point on the lattice, or none.
  TetMap map = identityMap(3);
  HexMesh mesh = gridMesh(3);
  const Index centre = 21;
  mesh.points[centre][1] += 0.2;
  map.points.push_back(mesh.points[centre]);
  const auto extra = static_cast<Index>(map.points.size() - 1);
  for (Index v = 0; v + 2 < 20; ++v) {
    map.tets.push_back({extra, v, v + 1, v + 2});  // many of them flat
    map.tets.push_back({extra, extra, v, v + 1});  // all of them flat
    map.parameters.push_back({});
    map.parameters.push_back({});
    for (TetParameters* p : {&map.parameters.back(), &map.parameters[map.parameters.size() - 2]}) {
      *p = {{{0.5, 0.5, 0.5}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    }
  }
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names({"vertices_off_lattice"}));
  mesh.points[centre][1] -= 0.2;
  EXPECT_EQ(failedItems(verified(boxExpectation(3), map, mesh)), Names());
}

TEST(VerifyPositions, PointsOfFlatTetsAreImagesOfLatticePoints) {
  // All points in one plane: a legal map, in which positions do not tell parameters.
  TetMap map = identityMap(2);
  HexMesh mesh = gridMesh(2);
  for (Vec3& p : map.points) p[2] = 0;
  for (Vec3& p : mesh.points) p[2] = 0;
  mesh.generatorTet.resize(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (Index t = 0; t < map.tets.size(); ++t) {
      for (const Index corner : map.tets[t]) {
        if (map.points[corner] == mesh.points[v]) mesh.generatorTet[v] = t;
      }
    }
  }
  for (const bool hints : {true, false}) {
    if (!hints) mesh.generatorTet.clear();
    EXPECT_EQ(failedItems(verified(boxExpectation(2), map, mesh)), Names());
    for (const double move : {0.25, 10.0}) {
      HexMesh moved = mesh;
      moved.points[5][0] += move;
      EXPECT_EQ(failedItems(verified(boxExpectation(2), map, moved)),
                Names({"vertices_off_lattice"}));
    }
  }
}

TEST(VerifyPositions, FlatTetsBetweenOthersDoNotMatter) {
  // A point in a nearly flat tet is found in its neighbours: split the tets around one diagonal by
  // a point just beside the diagonal, with lattice points on the diagonal.
  for (const double height : {1e-6, 1e-10, 1e-13, 1e-15, 0.0}) {
    TetMap map;
    map.points = {{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {2, height, 3}, {2, height, -3}, {2, -3, 0}};
    // The tets around the edge 0-1, which has the lattice points (1,0,0), (2,0,0), (3,0,0).
    map.tets = {{0, 1, 2, 3}, {0, 1, 3, 5}, {0, 1, 5, 4}, {0, 1, 4, 2}};
    for (const Tet& tet : map.tets) {
      map.parameters.push_back(
          {map.points[tet[0]], map.points[tet[1]], map.points[tet[2]], map.points[tet[3]]});
    }
    // Flat: below the edge, of height `height`.
    map.points.push_back({2, -height, 0});
    map.tets.push_back({0, 1, 3, 6});
    map.parameters.push_back({{{0, 0, 0}, {4, 0, 0}, {2, 0, 3}, {2.5, 0.5, 0.5}}});
    HexMesh mesh;
    mesh.points = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 0, 0}, {4, 0, 0}};
    const std::string found = foundOf(verified({}, map, mesh, {1, 0}), "vertices_off_lattice");
    EXPECT_EQ(found, "0") << height;
  }
}

TEST(Verify, DoesNotDependOnThreads) {
  const TetMap map = withRandomCharts(identityMap(12), 3, 100);
  HexMesh mesh = shuffled(gridMesh(12), 5);
  mesh.points[1000][0] += 0.2;
  mesh.points[2000][0] += 0.2;
  mesh.cells[300] = reversed(mesh.cells[300]);
  mesh.cells[600] = mesh.cells[601];
  const VerifyReport one = verified(boxExpectation(12), map, mesh, {}, 1);
  EXPECT_FALSE(one.passed());
  for (const int threads : {2, 5}) {
    const VerifyReport many = verified(boxExpectation(12), map, mesh, {}, threads);
    ASSERT_EQ(many.items.size(), one.items.size());
    for (std::size_t i = 0; i < one.items.size(); ++i) {
      EXPECT_EQ(many.items[i].found, one.items[i].found) << one.items[i].name;
      EXPECT_EQ(many.items[i].passed, one.items[i].passed) << one.items[i].name;
    }
  }
}

TEST(Verify, TellsWhatIsWrongWithTheMap) {
  const TetMap map = identityMap(2);
  EXPECT_TRUE(verify(map, gridMesh(2)).passed());
  TetMap flipped = map;
  std::swap(flipped.parameters[7][1], flipped.parameters[7][2]);
  const VerifyReport report = verify(flipped, gridMesh(2));
  EXPECT_EQ(failedItems(report), Names({"map_valid"}));
  EXPECT_EQ(report.items.size(), 1U);
  EXPECT_TRUE(report.items[0].found.starts_with("no: ")) << report.items[0].found;
  TetMap empty;
  EXPECT_EQ(verify(empty, {}).items[0].found, "no: EmptyMesh");
}

TEST(Verify, EndsWhenCancelled) {
  Context context;
  Stage stage(context, "test");
  context.cancel();
  try {
    (void)verifyAgainst(boxExpectation(3), identityMap(3), gridMesh(3), {}, stage);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(Verify, SurvivesAnyIndices) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    HexMesh mesh = gridMesh(1 + random.below(3));
    // Few different vertices make everything coincide that can; sometimes one is out of range.
    const std::uint64_t range = 1 + random.below(mesh.points.size() + random.below(2));
    const std::uint64_t changes = random.below(8 * mesh.cells.size() + 1);
    for (std::uint64_t i = 0; i < changes; ++i) {
      Hex& cell = mesh.cells[random.below(mesh.cells.size())];
      cell[random.below(8)] = static_cast<Index>(random.below(range));
    }
    const bool inRange = std::all_of(mesh.cells.begin(), mesh.cells.end(), [&](const Hex& cell) {
      return *std::max_element(cell.begin(), cell.end()) < mesh.points.size();
    });
    const VerifyReport report = verified({}, identityMap(3), mesh);
    RC_ASSERT(report.items.front().passed == inRange);
    RC_ASSERT(report.items.size() == (inRange ? 13U : 1U));
    RC_ASSERT(!report.passed());
  }));
}

}  // namespace
}  // namespace hexhex
