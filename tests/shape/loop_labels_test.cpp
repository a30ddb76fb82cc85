// Labels of prisms by loops along handles, checked as what they are: faces that meet as those of a
// prism, with holes that go around the handles of the part. Surfaces are read anew from triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <shape/edge_classes.hpp>
#include <shape/label_search.hpp>
#include <shape/loop_labels.hpp>
#include <shape/wall_directions.hpp>

#include <base/random.hpp>

#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"
#include "support/tet_volume.hpp"

namespace hexhex::shape::loops {
namespace {

using test::CubeBody;
using Cell = CubeBody::Cell;
using Edge = std::array<Index, 2>;

LoopLabels loopLabels(const TetMesh& mesh) {
  Context context;
  const PositiveTets tets(mesh);
  Surface surface = readSurface(tets, context);
  Stage stage(context, "labelling");
  return labelsByLoops(tets, std::move(surface), stage).value();
}

/// The faces of a labelled surface, and how they meet.
class Faces {
 public:
  explicit Faces(const LoopLabels& found) : labels_(found.labels) {
    for (Index t = 0; t < found.labels.size(); ++t) {
      triangles_.push_back({found.surface.tails[3 * t], found.surface.head(3 * t),
                            found.surface.head(Surface::next(3 * t))});
      for (std::size_t k = 0; k < 3; ++k) {
        sides_[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
      }
    }
    for (Index t = 0; t < triangles_.size(); ++t) faceOf_.push_back(t);
    componentOf_ = faceOf_;
    for (bool changes = true; changes;) {
      changes = false;
      for (const auto& [edge, t] : sides_) {
        const Index beyond = sides_.at({edge[1], edge[0]});
        changes |= lower(componentOf_, t, beyond);
        if (labels_[t] == labels_[beyond]) changes |= lower(faceOf_, t, beyond);
      }
    }
    for (const auto& [edge, t] : sides_) {
      if (faceOf_[t] != faceOf_[sides_.at({edge[1], edge[0]})]) ++borders_[edge[0]];
    }
  }

  [[nodiscard]] std::set<Index> all() const { return {faceOf_.begin(), faceOf_.end()}; }
  [[nodiscard]] int labelOf(Index face) const { return labels_[face]; }
  [[nodiscard]] Index componentOf(Index face) const { return componentOf_[face]; }

  [[nodiscard]] int characteristicOf(Index face) const {
    std::set<Index> vertices;
    std::set<Edge> edges;
    int triangles = 0;
    for (const auto& [edge, t] : sides_) {
      if (faceOf_[t] != face) continue;
      vertices.insert(edge[0]);
      edges.insert({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
      ++triangles;  // three times
    }
    return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + triangles / 3;
  }

  /// The loops around a face, each as its sides, with the face to their left.
  [[nodiscard]] std::vector<std::vector<Edge>> loopsAround(Index face) const {
    std::map<Index, Edge> from;  // a border passes a vertex once, as no more than three meet there
    for (const auto& [edge, t] : sides_) {
      if (faceOf_[t] == face && faceOf_[sides_.at({edge[1], edge[0]})] != face) {
        EXPECT_TRUE(from.emplace(edge[0], edge).second);
      }
    }
    std::vector<std::vector<Edge>> loops;
    while (!from.empty()) {
      std::vector<Edge>& loop = loops.emplace_back();
      for (auto at = from.begin(); at != from.end(); at = from.find(loop.back()[1])) {
        loop.push_back(at->second);
        from.erase(at);
      }
    }
    return loops;
  }

  /// The labels beyond a loop, from corner to corner.
  [[nodiscard]] std::vector<int> labelsBeyond(const std::vector<Edge>& loop) const {
    std::vector<int> result;
    const auto corner = std::find_if(loop.begin(), loop.end(),
                                     [&](const Edge& e) { return borders_.at(e[0]) > 2; });
    EXPECT_NE(corner, loop.end());
    const auto first = static_cast<std::size_t>(corner - loop.begin());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Edge& edge = loop[(first + i) % loop.size()];
      const int label = labels_[sides_.at({edge[1], edge[0]})];
      if (borders_.at(edge[0]) > 2) result.push_back(label);
      EXPECT_EQ(label, result.back());
    }
    return result;
  }

  [[nodiscard]] int mostBorders() const {
    int most = 0;
    for (const auto& [vertex, count] : borders_) most = std::max(most, count);
    return most;
  }

 private:
  static bool lower(std::vector<Index>& names, Index a, Index b) {
    const Index name = std::min(names[a], names[b]);
    const bool changes = names[a] != names[b];
    names[a] = names[b] = name;
    return changes;
  }

  Labels labels_;
  std::vector<std::array<Index, 3>> triangles_;
  std::map<Edge, Index> sides_;     // from tail to head: the triangle to the left
  std::vector<Index> faceOf_;       // per triangle: the first one of its face
  std::vector<Index> componentOf_;  // the same of its component
  std::map<Index, int> borders_;    // per vertex: how many faces meet there
};

/// Left quarter turns of labels around a face, as seen from where it faces.
int turnsOf(const std::vector<int>& labels, int face) {
  int turns = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto here = static_cast<lattice::Direction>(labels[i]);
    const auto next = static_cast<lattice::Direction>(labels[(i + 1) % labels.size()]);
    EXPECT_NE(lattice::axisOf(here), lattice::axisOf(next));
    turns += lattice::cross(here, next) == face ? 1 : -1;
  }
  return turns;
}

/// Six times the volume.
double volumeOf(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& tet : mesh.tets) {
    const double volume = test::sixfoldVolume(mesh.points, tet);
    EXPECT_GT(volume, 0);
    sum += volume;
  }
  return sum;
}

using Loop = std::vector<Vec3>;

/// Around a top or bottom, edges are convex, so directions tell where they turn: once around it,
/// and the other way around each hole, as for any polygon.
/// @return the loops around holes
std::vector<Loop> expectEnd(const Faces& faces, Index face, const std::vector<Vec3>& points) {
  std::vector<Loop> holes;
  int outer = 0;
  for (const std::vector<Edge>& loop : faces.loopsAround(face)) {
    const int turns = turnsOf(faces.labelsBeyond(loop), faces.labelOf(face));
    EXPECT_EQ(std::abs(turns), 4);
    outer += turns > 0 ? 1 : 0;
    if (turns > 0) continue;
    Loop& hole = holes.emplace_back();
    for (const Edge& edge : loop) hole.push_back(points[edge[0]]);
  }
  EXPECT_EQ(outer, 1);
  return holes;
}

/// Whether a face is between a top and a bottom, with a wall to each side.
bool isWall(const Faces& faces, Index face, int axisOfPrism) {
  const auto loops = faces.loopsAround(face);
  if (loops.size() != 1) return false;
  const std::vector<int> beyond = faces.labelsBeyond(loops.front());
  const auto isEnd = [&](std::size_t i) { return beyond[i] / 2 == axisOfPrism; };
  return beyond.size() == 4 && isEnd(0) == isEnd(2) && isEnd(1) == isEnd(3) &&
         isEnd(0) != isEnd(1) && beyond[isEnd(0) ? 0 : 1] != beyond[isEnd(0) ? 2 : 3];
}

/// Whether all faces are walls but a top and a bottom of each component.
/// @param[out] ends  per component
bool isPrism(const Faces& faces, int axis, std::map<Index, std::vector<Index>>& ends) {
  ends.clear();
  for (const Index face : faces.all()) {
    if (faces.labelOf(face) / 2 != axis) {
      if (!isWall(faces, face, axis)) return false;
      ends[faces.componentOf(face)];
    } else {
      ends[faces.componentOf(face)].push_back(face);
    }
  }
  return std::all_of(ends.begin(), ends.end(), [&](const auto& each) {
    return each.second.size() == 2 &&
           faces.labelOf(each.second[0]) != faces.labelOf(each.second[1]);
  });
}

/// @param handles  of each component of the boundary, ascending
/// @return per top or bottom: the loops around its holes
std::vector<std::vector<Loop>> expectPrisms(const TetMesh& mesh, const std::vector<int>& handles) {
  const LoopLabels found = loopLabels(mesh);
  const TetMesh& split = found.tets.mesh();
  EXPECT_NEAR(volumeOf(split), volumeOf(mesh), 1e-9 * volumeOf(mesh));
  EXPECT_TRUE(std::equal(mesh.points.begin(), mesh.points.end(), split.points.begin()));
  const Faces faces(found);
  EXPECT_EQ(faces.mostBorders(), 3);
  for (const Index face : faces.all()) {
    const auto loops = faces.loopsAround(face);
    EXPECT_EQ(faces.characteristicOf(face), 2 - static_cast<int>(loops.size()));
  }
  std::map<Index, std::vector<Index>> ends;
  int axis = 0;
  while (axis < 3 && !isPrism(faces, axis, ends)) ++axis;
  EXPECT_LT(axis, 3);
  std::vector<int> got;
  std::vector<std::vector<Loop>> holes;
  for (const auto& [component, each] : ends) {
    for (const Index face : each) holes.push_back(expectEnd(faces, face, split.points));
    got.push_back(static_cast<int>(holes.back().size()));
  }
  std::sort(got.begin(), got.end());
  EXPECT_EQ(got, handles);
  return holes;
}

Vec3 asItIs(const Vec3& p) { return p; }

CubeBody box() {
  return {{2, 2, 1}, [](const Cell&) { return true; }};
}
/// A plate with holes in a row.
CubeBody plate(int holes) {
  return {{2 * holes + 1, 3, 1}, [](const Cell& c) { return c[0] % 2 == 0 || c[1] != 1; }};
}
/// The edges of a cube.
CubeBody frame() {
  return {{3, 3, 3}, [](const Cell& c) { return (c[0] == 1) + (c[1] == 1) + (c[2] == 1) < 2; }};
}
/// A block around a void that is a ring.
CubeBody ringInBlock() {
  return {{5, 5, 3}, [](const Cell& c) {
            const int away = std::max(std::abs(c[0] - 2), std::abs(c[1] - 2));
            return c[2] != 1 || away != 1;
          }};
}
/// Two rings, each through the other.
CubeBody link() {
  return {{5, 8, 5}, [](const Cell& c) {
            const bool isFlat =
                c[2] == 2 && c[1] < 5 && std::max(std::abs(c[0] - 2), std::abs(c[1] - 2)) == 2;
            const bool isUpright =
                c[0] == 2 && c[1] > 1 && std::max(std::abs(c[2] - 2), std::abs(c[1] - 4)) == 2;
            return isFlat || isUpright;
          }};
}

/// How often a loop goes around an upright line, counterclockwise.
int windingAround(const Loop& loop, double x, double y) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3& p = loop[i];
    const Vec3& q = loop[(i + 1) % loop.size()];
    const std::array<double, 2> a = {p[0] - x, p[1] - y};
    const std::array<double, 2> b = {q[0] - x, q[1] - y};
    sum += std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  }
  return static_cast<int>(std::lround(sum / (2 * std::numbers::pi)));
}

TEST(LoopLabels, AreThoseOfPrismsWithAHolePerHandle) {
  const auto turnedBall = [](const Vec3& p) {
    const Vec3 q = test::rounded(Vec3{p[0] - 1, p[1] - 1, 2 * p[2] - 1});
    return test::turned(q, 0.7);
  };
  const auto bent = [](const Vec3& p) {
    return test::turned({p[0] + 0.3 * std::sin(2 * p[1]), p[1], p[2] + 0.2 * p[0] * p[0]}, 0.5);
  };
  expectPrisms(box().labelled(3, turnedBall).tets, {0});
  for (const int holes : {0, 1, 2, 4}) expectPrisms(plate(holes).labelled(2, bent).tets, {holes});
  expectPrisms(frame().labelled(2, bent).tets, {5});
  expectPrisms(ringInBlock().labelled(1, bent).tets, {0, 1});
  expectPrisms(link().labelled(2, bent).tets, {1, 1});
}

TEST(LoopLabels, FindRoomOnTheCoarsestMeshes) {
  const TetMesh tet = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  expectPrisms(tet, {0});
  expectPrisms(plate(1).labelled(1, asItIs).tets, {1});
  expectPrisms(frame().labelled(1, asItIs).tets, {5});
}

TEST(LoopLabels, HaveHolesThatGoAroundThoseOfTheSolid) {
  // A loop around the bar of a ring goes around its own hole, too, but not around that of the ring.
  for (const std::vector<Loop>& holes : expectPrisms(plate(1).labelled(3, asItIs).tets, {1})) {
    EXPECT_EQ(std::abs(windingAround(holes.at(0), 1.5, 1.5)), 1);
  }
  for (const std::vector<Loop>& holes : expectPrisms(plate(2).labelled(3, asItIs).tets, {2})) {
    const auto around = [&](std::size_t i, double x) { return windingAround(holes.at(i), x, 1.5); };
    const int determinant = around(0, 1.5) * around(1, 3.5) - around(0, 3.5) * around(1, 1.5);
    EXPECT_EQ(std::abs(determinant), 1);
  }
}

TEST(LoopLabels, OfBodiesOfCubesBecomeTheirFaces) {
  for (const int handles : {0, 1, 3}) {
    const CubeBody body = handles == 0 ? box() : plate(handles);
    const test::Labelled input = body.labelled(3, asItIs);
    const LoopLabels found = loopLabels(input.tets);
    const LabelCosts costs(found.surface);
    Context context;
    const CheckedLabels better =
        LabelSearch(found.surface, costs, Random(1, 2)).improve(found.labels, 1000, context);
    EXPECT_TRUE(better.verdict.report.isValid());
    std::vector<FaceFlags> flags(found.tets.mesh().tets.size(), FaceFlags{-1, -1, -1, -1});
    for (Index t = 0; t < better.labels.size(); ++t) {
      EXPECT_GT(cosine(found.surface.normals[t], better.labels[t]), 0.99);
      const adjacency::HalfFace h = found.surface.faces[t];
      flags[adjacency::tetOf(h)][h % 4] = static_cast<std::int8_t>(better.labels[t]);
    }
    test::expectPolycube(body, {found.tets.mesh(), flags}, handles);
  }
}

TEST(LoopLabels, CarryTagsOfSplitTets) {
  test::Labelled input = box().labelled(1, asItIs);
  input.tets.regions.assign(input.tets.tets.size(), 1);
  input.tets.regions.back() = 2;
  const auto numberOf = [&](const Vec3& p) {
    const auto& points = input.tets.points;
    return static_cast<Index>(std::find(points.begin(), points.end(), p) - points.begin());
  };
  input.tets.features.edges = {{{numberOf({0, 0, 0}), numberOf({1, 0, 0})}, 7}};
  const TetMesh before = input.tets;
  const LoopLabels found = loopLabels(input.tets);
  const TetMesh& after = found.tets.mesh();
  ASSERT_EQ(after.regions.size(), after.tets.size());
  double part = 0;
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const double volume = test::sixfoldVolume(after.points, after.tets[t]);
    if (after.regions[t] == 2) part += volume;
  }
  EXPECT_NEAR(part, test::sixfoldVolume(before.points, before.tets.back()), 1e-12);
  double length = 0;
  for (const FeatureEdge& edge : after.features.edges) {
    EXPECT_EQ(edge.tag, 7);
    const auto& [a, b] = edge.vertices;
    length += std::abs(after.points[a][0] - after.points[b][0]);
  }
  EXPECT_NEAR(length, 1, 1e-12);
}

TEST(LoopLabels, OfVoidsFaceInside) {
  const CubeBody body = {{3, 3, 3}, [](const Cell& c) { return c != Cell{1, 1, 1}; }};
  for (const int fineness : {2, 4}) {
    const LoopLabels found = loopLabels(body.labelled(fineness, asItIs).tets);
    for (Index t = 0; t < found.labels.size(); ++t) {
      EXPECT_GT(cosine(found.surface.normals[t], found.labels[t]), 0.99);
    }
  }
}

TEST(LoopLabels, HaveRoomAtSpikes) { expectPrisms(test::spikedTet(), {0}); }

TEST(LoopLabels, CanBeCancelled) {
  Context context;
  const PositiveTets tets(plate(2).labelled(2, asItIs).tets);
  const Surface surface = readSurface(tets, context);
  Stage stage(context, "labelling");
  context.cancel();
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(labelsByLoops(tets, surface, stage)); }),
            ErrorCode::Cancelled);
}

TEST(EdgeClasses, TellLoopsAroundAHoleFromThoseThatBound) {
  const TetMesh mesh = plate(2).labelled(1, asItIs).tets;
  Context context;
  Stage stage(context, "test");
  const EdgeClasses classes(mesh.tets, mesh.points.size(), stage);
  const auto classAlong = [&](const std::vector<Vec3>& corners) {
    HomologyClass sum;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto numberOf = [&](const Vec3& p) {
        return static_cast<Index>(std::find(mesh.points.begin(), mesh.points.end(), p) -
                                  mesh.points.begin());
      };
      sum = sumOf(sum, classes(numberOf(corners[i]), numberOf(corners[(i + 1) % corners.size()])));
    }
    return sum;
  };
  const HomologyClass first = classAlong({{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}});
  const HomologyClass second = classAlong({{3, 1, 1}, {4, 1, 1}, {4, 2, 1}, {3, 2, 1}});
  EXPECT_TRUE(classAlong({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}).empty());
  EXPECT_TRUE(classAlong({{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}).empty());
  EXPECT_FALSE(first.empty());
  EXPECT_FALSE(second.empty());
  EXPECT_NE(first, second);
  EXPECT_EQ(
      classAlong(
          {{1, 1, 1}, {2, 1, 1}, {3, 1, 1}, {4, 1, 1}, {4, 2, 1}, {3, 2, 1}, {2, 2, 1}, {1, 2, 1}}),
      sumOf(first, second));
}

/// The least cost, by trying all.
double leastCost(const std::vector<std::array<double, 4>>& costs, int turns, double costOfCorner) {
  double least = std::numeric_limits<double>::infinity();
  std::size_t all = 4;
  for (std::size_t i = 1; i <= costs.size(); ++i) all *= 3;
  for (std::size_t code = 0; code < all; ++code) {
    int direction = static_cast<int>(code % 4);
    std::size_t rest = code / 4;
    double cost = 0;
    int sum = 0;
    for (const std::array<double, 4>& column : costs) {
      cost += column[static_cast<std::size_t>((direction + 400) % 4)];
      const int turn = static_cast<int>(rest % 3) - 1;
      rest /= 3;
      cost += turn == 0 ? 0 : costOfCorner;
      direction += turn;
      sum += turn;
    }
    if (sum == turns) least = std::min(least, cost);
  }
  return least;
}

TEST(WallDirections, AreTheCheapestOfAllThatTurnAsOften) {
  Random random(7, 0);
  for (int i = 0; i < 40; ++i) {
    std::vector<std::array<double, 4>> costs(4 + random.below(4));
    for (std::array<double, 4>& each : costs) {
      for (double& cost : each) cost = random.share();
    }
    const double costOfCorner = 0.3 * random.share();
    const int turns = i % 2 == 0 ? 4 : -4;
    const WallDirections found = cheapestDirections(costs, turns, costOfCorner);
    double cost = 0;
    int sum = 0;
    for (std::size_t k = 0; k < costs.size(); ++k) {
      const int turn = (found.ofColumns[(k + 1) % costs.size()] - found.ofColumns[k] + 5) % 4 - 1;
      ASSERT_LE(turn, 1);
      sum += turn;
      cost +=
          costs[k][static_cast<std::size_t>(found.ofColumns[k])] + (turn == 0 ? 0 : costOfCorner);
    }
    EXPECT_EQ(sum, turns);
    EXPECT_NEAR(cost, found.cost, 1e-12);
    EXPECT_NEAR(cost, leastCost(costs, turns, costOfCorner), 1e-12);
  }
}

}  // namespace
}  // namespace hexhex::shape::loops
