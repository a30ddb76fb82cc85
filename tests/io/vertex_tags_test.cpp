// Which references of vertices of MEDIT files are corners: those that the file lists as such, or
// that few vertices have.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {

using namespace io;
namespace {

constexpr int kSide = 4;

/// On how many of the three pairs of sides of the grid a point is: 3 for corners, 0 inside.
int sidesOf(const Vec3& p) {
  return static_cast<int>(
      std::count_if(p.begin(), p.end(), [](double x) { return x == 0 || x == kSide; }));
}

/// A grid as another program writes it.
std::string gridText(const std::function<int(const Vec3&)>& referenceOf,
                     const std::string& sections = "") {
  const HexMesh mesh = hexhex::testing::gridMesh(kSide);
  std::string text =
      "MeshVersionFormatted 1\nDimension 3\nVertices\n" + std::to_string(mesh.points.size()) + "\n";
  for (const Vec3& p : mesh.points) {
    for (const double x : p) text += std::to_string(x) + " ";
    text += std::to_string(referenceOf(p)) + "\n";
  }
  text += "Hexahedra\n" + std::to_string(mesh.cells.size()) + "\n";
  for (const Hex& cell : mesh.cells) {
    for (const Index v : cell) text += std::to_string(v + 1) + " ";
    text += "0\n";
  }
  return text + sections + "End\n";
}

std::vector<FeatureVertex> tagsOf(const std::string& text) {
  Context context(2);
  return readBytes<Medit::readMesh>(text, "m.mesh", context).features.vertices;
}

TEST(VertexTags, AReferenceThatAllShareSaysNothing) {
  for (const int shared : {-1, 0, 1, 7}) {
    EXPECT_TRUE(tagsOf(gridText([&](const Vec3&) { return shared; })).empty()) << shared;
  }
}

TEST(VertexTags, AReferenceOfFewVerticesIsACorner) {
  const auto tags = tagsOf(gridText([](const Vec3& p) { return sidesOf(p) == 3 ? 5 : -1; }));
  ASSERT_EQ(tags.size(), 8U);
  for (const FeatureVertex& tag : tags) EXPECT_EQ(tag.tag, 5);
  EXPECT_EQ(tags[0].vertex, 0U);
  EXPECT_EQ(tags[7].vertex, 124U);
}

/// Some programs number vertices, curves, surfaces and parts, and say of each vertex where it is.
TEST(VertexTags, ReferencesOfCurvesSurfacesAndPartsAreNoCorners) {
  int corner = 100;
  const auto tags = tagsOf(gridText([&](const Vec3& p) {
    if (sidesOf(p) == 3) return corner++;
    if (sidesOf(p) == 2)
      return 10 + (p[0] == 0 ? 1 : 0) + (p[1] == 0 ? 2 : 0) + (p[2] == 0 ? 4 : 0);
    return sidesOf(p) == 1 ? 2 : 3;
  }));
  ASSERT_EQ(tags.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(tags[i].tag, 100 + static_cast<int>(i));
}

TEST(VertexTags, ListsOfCornersDecide) {
  const auto surface = [](const Vec3& p) { return sidesOf(p) > 0 ? 4 : 0; };
  const auto tags = tagsOf(gridText(surface, "Corners\n2\n1 125\nRequiredVertices\n2\n63\n1\n"));
  const std::vector<FeatureVertex> wanted = {{0, 4}, {62, 1}, {124, 4}};
  EXPECT_EQ(tags, wanted);
  EXPECT_EQ(tagsOf(gridText([](const Vec3&) { return 0; }, "Corners\n1\n3\n")),
            (std::vector<FeatureVertex>{{2, 1}}));
  EXPECT_TRUE(tagsOf(gridText(surface, "Corners\n0\n")).empty());
}

TEST(VertexTags, CornersThatDoNotExistAreRefused) {
  for (const char* number : {"0", "126", "-1"}) {
    const std::string text =
        gridText([](const Vec3&) { return 0; }, std::string("Corners\n1\n") + number + "\n");
    EXPECT_EQ(failureOf([&] { static_cast<void>(tagsOf(text)); }).code, ErrorCode::IndexOutOfRange);
  }
  const Failure many = failureOf([] {
    static_cast<void>(tagsOf(gridText([](const Vec3&) { return 0; }, "RequiredVertices\n9\n1\n")));
  });
  EXPECT_EQ(many.code, ErrorCode::FileSyntax);
}

TEST(VertexTags, BinaryFilesListCornersToo) {
  const TemporaryFolder folder;
  writeHexMesh(hexhex::testing::gridMesh(kSide), folder / "a.meshb");
  std::string bytes = contentOf(folder / "a.meshb");
  const auto append = [&](std::int32_t value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  bytes.resize(bytes.size() - 8);  // the end
  const auto next = static_cast<std::int32_t>(bytes.size() + 20);
  for (const std::int32_t value : {13, next, 2, 125, 1, 54, 0}) append(value);
  Context context(1);
  const HexMesh read = readBytes<Meshb::readMesh>(bytes, "a.meshb", context);
  EXPECT_EQ(read.features.vertices, (std::vector<FeatureVertex>{{0, 1}, {124, 1}}));
}

}  // namespace
}  // namespace hexhex::test
