// Parts that are no solids, or nearly none: each is refused with a sentence that says why, whatever
// the method; or it is a solid after all, and gets its mesh.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/mesh.hpp>
#include <hexhex/shape.hpp>
#include <hexhex/structure.hpp>

#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test {
namespace {

using Cell = CubeBody::Cell;

constexpr std::array<ShapeMethod, 3> kMethods = {ShapeMethod::Auto, ShapeMethod::Polycube,
                                                 ShapeMethod::Frames};

Vec3 asItIs(const Vec3& p) { return p; }

TetMesh cube(int fineness) {
  return CubeBody({1, 1, 1}, [](const Cell&) { return true; }).labelled(fineness, asItIs).tets;
}

Index vertexAt(const TetMesh& tets, const Vec3& place) {
  const auto found = std::find(tets.points.begin(), tets.points.end(), place);
  EXPECT_NE(found, tets.points.end());
  return static_cast<Index>(found - tets.points.begin());
}

MeshedPart meshed(const TetMesh& tets, ShapeMethod method) {
  Context context;
  MeshOptions options;
  options.shape.method = method;
  options.quantize = {.cells = 200, .densify = true};
  return meshFromTets(tets, options, context);
}

/// By map and mesh alike.
void expectRefusal(const TetMesh& tets, ErrorCode code, const std::string& words) {
  for (const ShapeMethod method : kMethods) {
    SCOPED_TRACE(static_cast<int>(method));
    const Error error = errorOf([&] { static_cast<void>(meshed(tets, method)); });
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    Context context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(mapFromTets(tets, {.method = method}, context)); }),
              code);
  }
}

TEST(BadParts, HaveFoldedTets) {
  TetMesh tets = cube(4);
  tets.points[vertexAt(tets, {0.5, 0.5, 0.5})] = {0.5, 2.5, 0.5};
  expectRefusal(tets, ErrorCode::Orientation, "folded over");
}

/// Corners in another order are no fault.
TEST(BadParts, DoNotIncludeTetsThatAreInsideOut) {
  TetMesh tets = cube(3);
  for (std::size_t t = 0; t < tets.tets.size(); t += 2) std::swap(tets.tets[t][0], tets.tets[t][1]);
  for (const ShapeMethod method : kMethods) {
    EXPECT_TRUE(meshed(tets, method).improvement.after.allPositive());
  }
}

TEST(BadParts, HaveFlatTetsAndSlivers) {
  for (const double height : {0.0, 1e-30, 1e-14}) {
    SCOPED_TRACE(height);
    TetMesh tets = cube(2);
    // On the middle of a face, in the plane of a tet's other corners, but for the height.
    const Tet tet = tets.tets.front();
    Vec3 middle{};
    for (std::size_t i = 1; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) middle[k] += tets.points[tet[i]][k] / 3;
    }
    const auto apex = static_cast<Index>(tets.points.size());
    tets.points.push_back(middle);
    tets.points.push_back(middle);
    tets.points.back()[2] += height;
    tets.tets.push_back({tet[1], tet[2], apex, apex + 1});
    expectRefusal(tets, ErrorCode::FlippedTet, "flat");
  }
}

TEST(BadParts, HaveNoThickness) {
  TetMesh tets = cube(2);
  for (Vec3& point : tets.points) point[2] = 0;
  expectRefusal(tets, ErrorCode::FlippedTet, "flat");
}

TEST(BadParts, AreEmpty) { expectRefusal({}, ErrorCode::EmptyMesh, "no tets"); }

TEST(BadParts, TouchThemselves) {
  for (const bool atEdge : {true, false}) {
    const CubeBody touching({2, 2, 2}, [&](const Cell& c) {
      return c == Cell{0, 0, 0} || c == Cell{1, 1, atEdge ? 0 : 1};
    });
    expectRefusal(touching.labelled(2, asItIs).tets,
                  atEdge ? ErrorCode::NonManifoldEdge : ErrorCode::NonManifoldVertex,
                  atEdge ? "edge" : "vertex");
  }
}

TEST(BadParts, HaveTrianglesOfThreeTets) {
  TetMesh tets = cube(2);
  const auto apex = static_cast<Index>(tets.points.size());
  tets.points.push_back({0.3, 0.1, 5});
  // A triangle between two tets.
  const Tet tet = tets.tets.front();
  const Index centre = vertexAt(tets, {0.5, 0.5, 0.5});
  ASSERT_NE(std::find(tet.begin(), tet.end(), centre), tet.end());
  for (std::size_t out = 0; out < 4; ++out) {
    if (tet[out] == centre) continue;
    Tet other = tet;
    other[out] = apex;
    tets.tets.push_back(other);
  }
  expectRefusal(tets, ErrorCode::NonManifoldFace, "triangle");
}

TEST(BadParts, HaveTooManyTets) {
  TetMesh tets = cube(1);
  tets.tets.resize(1'000'000, tets.tets.front());
  expectRefusal(tets, ErrorCode::TooLarge, "longer edges");
}

TEST(BadParts, AreNotMappedForMoreCellsThanThereCanBe) {
  Context context;
  MeshOptions options;
  options.quantize = {.cells = 1e12};
  const Error error = errorOf([&] { static_cast<void>(meshFromTets(cube(2), options, context)); });
  EXPECT_EQ(error.code(), ErrorCode::TooLarge);
  EXPECT_TRUE(context.stageTimes().empty());
}

/// Each by itself: cells and boundary are those of both.
TEST(BadParts, DoNotIncludeSeveralComponentsAndVoids) {
  const CubeBody two({3, 1, 1}, [](const Cell& c) { return c[0] != 1; });
  const CubeBody hollow({3, 3, 3}, [](const Cell& c) { return c != Cell{1, 1, 1}; });
  for (const ShapeMethod method : kMethods) {
    const MeshedPart both = meshed(two.labelled(3, asItIs).tets, method);
    EXPECT_TRUE(both.improvement.after.allPositive());
    Context context;
    EXPECT_EQ(findStructure(both.mesh, context).components, 2U);
    EXPECT_TRUE(meshed(hollow.labelled(2, asItIs).tets, method).improvement.after.allPositive());
  }
}

/// Both sides of a cut that has no width are boundary: a polycube opens it.
TEST(BadParts, DoNotIncludeCutsWithoutWidth) {
  TetMesh tets = cube(4);
  const std::size_t count = tets.points.size();
  std::vector<Index> copy(count, kNone);
  for (Index v = 0; v < count; ++v) {
    const Vec3 p = tets.points[v];
    if (p[2] != 0.5 || p[0] < 0.75) continue;
    copy[v] = static_cast<Index>(tets.points.size());
    tets.points.push_back(p);
  }
  for (Tet& tet : tets.tets) {
    double height = 0;
    for (const Index v : tet) height += 0.25 * tets.points[v][2];
    if (height < 0.5) continue;
    for (Index& v : tet) {
      if (v < count && copy[v] != kNone) v = copy[v];
    }
  }
  for (const ShapeMethod method : {ShapeMethod::Auto, ShapeMethod::Polycube}) {
    const MeshedPart part = meshed(tets, method);
    EXPECT_TRUE(part.improvement.after.allPositive());
    EXPECT_LT(part.improvement.distanceAfter.fromSurface, 0.02) << "where it was closed";
  }
}

}  // namespace
}  // namespace hexhex::test
