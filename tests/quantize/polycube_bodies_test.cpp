// Polycubes of bodies that are not much like them: labels change on smooth surfaces, and do not on
// edges. Corners and topology are known from the cubes that the bodies were made of.
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>
#include <quantize/bend/bend.hpp>
#include <quantize/polycube/borders.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test {

using namespace quantization;

namespace {

using Cell = CubeBody::Cell;

CubeBody cube() {
  return {{1, 1, 1}, [](const Cell&) { return true; }};
}
CubeBody ring() {
  return {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
}
CubeBody angle() {
  return {{2, 2, 1}, [](const Cell& c) { return c[0] == 0 || c[1] == 0; }};
}
CubeBody notched() {
  return {{2, 2, 2}, [](const Cell& c) { return c != Cell{1, 1, 1}; }};
}
/// With a corner at which six edges meet.
CubeBody stairs() {
  return {{2, 2, 2}, [](const Cell& c) { return c[2] == 0 ? c[0] + c[1] < 2 : c == Cell{}; }};
}

TEST(PolycubeBodies, AreBalls) {
  for (const double turn : {0.0, 0.3}) {
    for (const double share : {0.7, 1.0}) {
      const Labelled ball = cube().labelled(4, [&](const Vec3& p) {
        const Vec3 inBox = {2 * p[0] - 1, 2 * p[1] - 1, 2 * p[2] - 1};
        const Vec3 inBall = rounded(inBox);
        Vec3 place{};
        for (std::size_t k = 0; k < 3; ++k) place[k] = inBox[k] + share * (inBall[k] - inBox[k]);
        return turned({2 * place[0], place[1], place[2]}, turn);
      });
      SCOPED_TRACE(std::to_string(turn) + ", " + std::to_string(share));
      expectPolycube(cube(), ball);
    }
  }
}

TEST(PolycubeBodies, AreCylinders) {
  const Labelled cylinder = cube().labelled(4, [](const Vec3& p) {
    const auto [x, y] = rounded<2>({2 * p[0] - 1, 2 * p[1] - 1});
    // Bent, too.
    return turned({(3 + x) * std::cos(p[2]), y, (3 + x) * std::sin(p[2])}, 0.2);
  });
  expectPolycube(cube(), cylinder);
}

TEST(PolycubeBodies, AreTori) {
  const Labelled torus = ring().labelled(3, [](const Vec3& p) {
    const Vec3 inRing = {2 * p[0] - 3, 2 * p[1] - 3, 2 * p[2] - 1};
    const double radius = std::max(std::abs(inRing[0]), std::abs(inRing[1]));  // 1 to 3
    const double length = std::hypot(inRing[0], inRing[1]);
    const auto [out, up] = rounded<2>({radius - 2, inRing[2]});
    return turned({(3 + out) * inRing[0] / length, (3 + out) * inRing[1] / length, up}, 0.1);
  });
  expectPolycube(ring(), torus, 1);
}

TEST(PolycubeBodies, HaveTheCornersThatOneCanCount) {
  EXPECT_EQ(cube().corners(), (std::map<int, int>{{1, 8}}));
  EXPECT_EQ(ring().corners(), (std::map<int, int>{{1, 8}, {3, 8}}));
  EXPECT_EQ(angle().corners(), (std::map<int, int>{{1, 10}, {3, 2}}));
  EXPECT_EQ(notched().corners(), (std::map<int, int>{{1, 10}, {3, 3}, {7, 1}}));
}

TEST(PolycubeBodies, HaveCornersOfAllKinds) {
  for (const auto& body : {angle(), notched(), stairs()}) {
    for (const double turn : {0.0, 0.25}) {
      const Labelled input = body.labelled(3, [&](const Vec3& p) {
        const double twist = 0.2 * p[2];
        return turned({p[0] * std::cos(twist) - p[1] * std::sin(twist),
                       p[0] * std::sin(twist) + p[1] * std::cos(twist), p[2] + 0.1 * p[0] * p[0]},
                      turn);
      });
      expectPolycube(body, input);
    }
  }
}

/// Those of a body as it is.
IrregularEdges turnsOf(const CubeBody& body,
                       const std::function<std::int64_t(const Vec3&, int)>& planes) {
  const Labelled input = body.labelled(2, [](const Vec3& p) { return p; });
  Context context;
  Stage stage(context, "test");
  const LabelledMesh mesh = readLabels(input.tets, input.flags, stage);
  IrregularEdges turns;
  for (const PolycubeEdge& edge : PolycubeBorders(mesh).edges(
           [&](int axis, Index v) { return planes(input.tets.points[v], axis); })) {
    turns[edge.vertices] = edge.quarters;
  }
  return turns;
}

std::int64_t asTheyAre(const Vec3& p, int axis) {
  return std::llround(2 * p[static_cast<std::size_t>(axis)]);
}

/// Of eight cubes around a point on an edge.
int fullAround(const CubeBody& body, const Vec3& point) {
  int full = 0;
  for (int i = 0; i < 8; ++i) {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      cell[k] = static_cast<int>(std::floor(point[k] + ((i >> k & 1) != 0 ? 0.1 : -0.1)));
    }
    full += body.isFull(cell) ? 1 : 0;
  }
  return full;
}

TEST(PolycubeBorders, TurnAsTheCubesDo) {
  for (const auto& body : {cube(), ring(), angle(), notched(), stairs()}) {
    const Labelled input = body.labelled(2, [](const Vec3& p) { return p; });
    const IrregularEdges turns = turnsOf(body, asTheyAre);
    EXPECT_FALSE(turns.empty());
    for (const auto& [edge, quarters] : turns) {
      const Vec3& a = input.tets.points[edge[0]];
      const Vec3& b = input.tets.points[edge[1]];
      const Vec3 middle = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
      EXPECT_EQ(2 * quarters, fullAround(body, middle));
    }
  }
}

void expectError(const Error& error, ErrorCode code, PlaceKind place, const std::string& words) {
  EXPECT_EQ(error.code(), code);
  EXPECT_EQ(error.place().kind, place);
  EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
}

TEST(PolycubeBorders, PutPlanesIntoAnotherOrderWhereFacesOverlap) {
  // The notch is deeper than the body.
  EXPECT_EQ(turnsOf(notched(),
                    [](const Vec3& p, int axis) {
                      const std::int64_t at = asTheyAre(p, axis);
                      return axis == 2 && at == 2 ? -1 : at;
                    }),
            turnsOf(notched(), asTheyAre));
}

TEST(PolycubeBorders, PutPlanesIntoTheOrderInSpaceWhereFacesTurnOtherwise) {
  // The hole is inside out, and has room at all of its corners.
  const auto isInHole = [](double x) { return x > 0.9 && x < 2.1; };
  EXPECT_EQ(turnsOf(ring(),
                    [&](const Vec3& p, int axis) {
                      const std::int64_t at = asTheyAre(p, axis);
                      return axis == 0 && isInHole(p[0]) && isInHole(p[1]) ? 6 - at : at;
                    }),
            turnsOf(ring(), asTheyAre));
}

TEST(PolycubeBorders, RefusePlanesThatLeaveNoRoom) {
  const Error flat = errorOf([] {
    static_cast<void>(turnsOf(
        notched(), [](const Vec3& p, int axis) { return axis == 1 ? 0 : asTheyAre(p, axis); }));
  });
  expectError(flat, ErrorCode::FlippedTet, PlaceKind::Edge, "has no length");
}

/// Boundary triangles, each with its middle.
template <class Visit>
void forEachTriangle(Labelled& input, const Visit& visit) {
  for (std::size_t t = 0; t < input.flags.size(); ++t) {
    for (std::size_t face = 0; face < 4; ++face) {
      if (input.flags[t][face] < 0) continue;
      Vec3 middle{};
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (i != face) middle[k] += input.tets.points[input.tets.tets[t][i]][k] / 3;
        }
      }
      visit(middle, input.flags[t][face]);
    }
  }
}

/// A box whose side at x = 1 has other labels in places.
template <class Relabel>
Error errorOfBox(const Relabel& relabel) {
  Labelled box = cube().labelled(4, [](const Vec3& p) { return p; });
  forEachTriangle(box, [&](const Vec3& middle, std::int8_t& flag) {
    if (flag == 0) flag = static_cast<std::int8_t>(relabel(middle[1], middle[2]));
  });
  return errorOf([&] { static_cast<void>(mapOf(box)); });
}

void expectRefusal(const Error& error, PlaceKind place, const std::string& words) {
  expectError(error, ErrorCode::InvalidArgument, place, words);
}

TEST(PolycubeLabels, ThatFitNoPolycubeAreRefusedWhereTheyDoNot) {
  const auto isIn = [](double x, double low, double high) { return low < x && x < high; };
  expectRefusal(errorOfBox([](double y, double) { return y < 0.5 ? 0 : 1; }), PlaceKind::Edge,
                "the labels +x and -x meet at an edge");
  expectRefusal(errorOfBox([&](double y, double z) {
                  return isIn(y, 0.25, 0.75) && isIn(z, 0.25, 0.75) ? 2 : 0;
                }),
                PlaceKind::Face, "no straight edges");
  // Between +x and +y: it has two edges, whichever way they run.
  expectRefusal(
      errorOfBox([&](double y, double z) { return y > 0.75 && isIn(z, 0.25, 0.75) ? 4 : 0; }),
      PlaceKind::Face, "label +z have a border of 2 straight edges");
  expectRefusal(errorOfBox([&](double y, double z) {
                  return (y < 0.5) == (z < 0.5) && isIn(y, 0.25, 0.75) && isIn(z, 0.25, 0.75) ? 2
                                                                                              : 0;
                }),
                PlaceKind::Vertex, "More than two edges");
}

TEST(PolycubeLabels, OfACornerThatNoPlanesGiveRoomAreRefused) {
  Labelled body = notched().labelled(3, [](const Vec3& p) { return p; });
  forEachTriangle(body, [](const Vec3& middle, std::int8_t& flag) {
    if (flag == 0 && middle[0] < 1.5) flag = 1;  // a side of the notch
  });
  expectError(errorOf([&] { static_cast<void>(mapOf(body)); }), ErrorCode::FlippedTet,
              PlaceKind::Vertex, "faces overlap around a vertex, whose labels are -x");
}

/// Whose corners are those of polycubes: only all planes together contradict each other.
TEST(PolycubeLabels, OfStairsThatLeadUpToThemselvesAreRefused) {
  Labelled body = ring().labelled(3, [](const Vec3& p) { return p; });
  forEachTriangle(body, [](const Vec3& middle, std::int8_t& flag) {
    if (flag != 4) return;
    // Steps across the four arms.
    const auto isStep = [&](std::size_t along, std::size_t across, bool isFar) {
      return std::abs(middle[along] - 1.5) < 0.17 && (middle[across] > 1.5) == isFar;
    };
    if (isStep(0, 1, false)) flag = 1;
    if (isStep(1, 0, true)) flag = 3;
    if (isStep(0, 1, true)) flag = 0;
    if (isStep(1, 0, false)) flag = 2;
  });
  expectError(errorOf([&] { static_cast<void>(mapOf(body)); }), ErrorCode::FlippedTet,
              PlaceKind::Tet, "stay flipped");
}

TEST(PolycubeLabels, OfOneKindAreRefused) {
  Labelled box = cube().labelled(2, [](const Vec3& p) { return p; });
  forEachTriangle(box, [](const Vec3&, std::int8_t& flag) { flag = 4; });
  expectRefusal(errorOf([&] { static_cast<void>(mapOf(box)); }), PlaceKind::Face,
                "All triangles of a closed piece of the boundary have the label +z");
}

TEST(PolycubeLabels, ThatAreMirroredAreRefused) {
  Labelled box = cube().labelled(4, [](const Vec3& p) { return p; });
  forEachTriangle(box, [](const Vec3&, std::int8_t& flag) {
    if (flag < 2) flag = static_cast<std::int8_t>(1 - flag);
  });
  expectError(errorOf([&] { static_cast<void>(mapOf(box)); }), ErrorCode::FlippedTet,
              PlaceKind::Face, "makes -4 quarter turns to the left, and not 4");
}

TEST(PolycubeLabels, NeedTetsThatAreNotInsideOut) {
  const Labelled good = cube().labelled(2, [](const Vec3& p) { return p; });
  const auto expectTet = [](const Labelled& bad, const std::string& tet,
                            const std::string& others) {
    const Error error = errorOf([&] { static_cast<void>(mapOf(bad)); });
    EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
    EXPECT_EQ(toString(error.place()), "tet " + tet);
    const std::string start =
        "Tet " + tet + " of the mesh is inside out or flat" + others + ". Swap";
    EXPECT_EQ(std::string(error.what()).find(start), 0U) << error.what();
  };
  Labelled bad = good;
  std::swap(bad.tets.tets[7][0], bad.tets.tets[7][1]);
  expectTet(bad, "7", "");
  std::swap(bad.tets.tets[9][2], bad.tets.tets[9][3]);
  expectTet(bad, "7", ", and 1 more are");
  // The middle of the box, through its side: the tets of the next side stay positive.
  bad = good;
  for (Vec3& p : bad.tets.points) {
    if (p == Vec3{0.5, 0.5, 0.5}) p[2] = 1.1;
  }
  EXPECT_EQ(codeOf([&] { static_cast<void>(mapOf(bad)); }), ErrorCode::FlippedTet);
}

/// Labels of others, where they are.
TEST(PolycubeRealLabels, AreBent) {
  HEXHEX_LARGE_TEST();
  const char* chosen = std::getenv("HEXHEX_DATA");
  const auto folder =
      std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "labels";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no labels";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".flags") continue;
    const std::string name = entry.path().stem().string();
    SCOPED_TRACE(name);
    Context context;
    const TetMesh tets = readTetMesh(folder / (name + ".mesh"), {}, context);
    const TetMap map =
        mapFromFlags(tets, readFlags({folder / (name + ".flags")}, tets, context), context);
    ExtractOptions exact;
    exact.tolerance = 0;
    const HexMesh mesh = verifiedExtraction(quantize(map, {.cells = 1000}).map, exact);
    if (name.starts_with('x')) {
      EXPECT_EQ(cornersOf(mesh), cube().corners());
    }
  }
}

}  // namespace

}  // namespace hexhex::test
