// `.meshb` files: versions, exact bytes, errors.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::meshb {

using namespace io;
namespace {

HexMesh parse(const std::string& text) {
  Context context;
  return readBytes<Meshb::readMesh>(text, "m.meshb", context);
}

template <class... T>
std::string bytes(T... values) {
  std::string result;
  (result.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
  return result;
}

HexMesh taggedMesh() {
  HexMesh mesh = gridMesh(3, 2, 1);
  mesh.features.vertices = {{5, 3}};
  mesh.features.edges = {{{0, 1}, 4}, {{1, 2}, 2}};
  mesh.features.quads = {{{0, 1, 5, 4}, 8}};
  return mesh;
}

TEST(Meshb, AllVersionsHoldTheMesh) {
  const TemporaryFolder folder;
  const HexMesh mesh = taggedMesh();
  Context context;
  std::size_t previous = 0;
  for (const std::uint32_t version : {2U, 3U, 4U}) {
    writeBy(folder / "a.meshb", context, [&](OutputFile& output, Stage& stage) {
      writeMeshbVersion(mesh, output, version, stage);
    });
    const std::string file = contentOf(folder / "a.meshb");
    EXPECT_TRUE(file.starts_with(bytes(1U, version)));
    EXPECT_GT(file.size(), previous);
    previous = file.size();
    const HexMesh read = readHexMesh(folder / "a.meshb");
    expectSameBits(read.points, mesh.points);
    EXPECT_EQ(read.cells, mesh.cells);
  }
  writeHexMesh(mesh, folder / "b.meshb");
  EXPECT_TRUE(contentOf(folder / "b.meshb").starts_with(bytes(1U, 2U)));
}

TEST(Meshb, ReferencesAreNumbersOfGroups) {
  const TemporaryFolder folder;
  writeHexMesh(taggedMesh(), folder / "a.meshb");
  const std::string file = contentOf(folder / "a.meshb");
  const std::string dimension = bytes(1U, 2U, 3U, 20U, 3U);
  EXPECT_TRUE(file.starts_with(dimension));
  const std::size_t vertices = dimension.size();
  EXPECT_EQ(file.substr(vertices, 12), bytes(4U, 20U + 12U + 24U * 28U, 24U));
  EXPECT_EQ(file.substr(vertices + 12 + 4 * 28 + 24, 4), bytes(0U));
  EXPECT_EQ(file.substr(vertices + 12 + 5 * 28 + 24, 4), bytes(3U));
  const std::size_t edges = vertices + 12 + 24 * 28;
  EXPECT_EQ(file.substr(edges, 36),
            bytes(5U, static_cast<std::uint32_t>(edges) + 36U, 2U, 2U, 3U, 2U, 1U, 2U, 4U));
  const std::size_t quads = edges + 36;
  EXPECT_EQ(file.substr(quads, 4), bytes(7U));
  EXPECT_EQ(file.substr(quads + 8, 24), bytes(22U, 1U, 5U, 6U, 2U, 8U));  // facing outwards
  const std::size_t cells = quads + 12 + 22 * 20;
  EXPECT_EQ(file.substr(cells, 12),
            bytes(10U, static_cast<std::uint32_t>(cells) + 12U + 6U * 36U, 6U));
  EXPECT_EQ(file.substr(cells + 12 + 6 * 36), bytes(54U, 0U));
}

TEST(Meshb, VersionOneHasSinglePrecision) {
  std::string file = bytes(1, 1, 3, 20, 3) + bytes(4, 20 + 12 + 8 * 16, 8);
  for (int i = 0; i < 8; ++i) {
    file += bytes(i % 2 == 0 ? 0.1F : 2.0F, static_cast<float>(i), 0.0F, 0);
  }
  file += bytes(26, static_cast<int>(file.size()) + 16, 0, 0);  // a section that nobody knows
  file += bytes(10, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8, 0);
  const HexMesh mesh = parse(file);
  EXPECT_EQ(mesh.points[2], (Vec3{0.1F, 2, 0}));
  EXPECT_EQ(mesh.cells[0], (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
}

/// Writes a grid of 2000 cells, overwrites some of its bytes, and reads it.
Failure failureAfter(std::size_t place, const std::string& change) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(20, 10, 10), folder / "a.meshb");
  std::string bad = contentOf(folder / "a.meshb");
  bad.replace(place, change.size(), change);
  return failureOf([&] { static_cast<void>(parse(bad)); });
}

TEST(Meshb, WrongHeads) {
  EXPECT_EQ(failureAfter(0, bytes(1U << 24U)).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failureAfter(0, bytes(7U)).code, ErrorCode::FileSyntax);
  EXPECT_EQ(failureAfter(4, bytes(5U)).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failureAfter(16, bytes(2U)).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failureAfter(8, bytes(77U)).code, ErrorCode::FileSyntax);  // no dimension
}

TEST(Meshb, WrongPositionsAndCounts) {
  for (const std::uint32_t next : {1U, 20U, 0x7fffffffU, 0xffffffffU}) {
    const Failure wrong = failureAfter(24, bytes(next));
    EXPECT_NE(wrong.sentence.find("m.meshb, byte 28:"), std::string::npos) << wrong.sentence;
  }
  const Failure many = failureAfter(28, bytes(0x40000000U));
  EXPECT_NE(many.sentence.find("m.meshb, byte 32: announces 1073741824 vertices"),
            std::string::npos)
      << many.sentence;
}

TEST(Meshb, WrongElements) {
  constexpr std::size_t kVertices = 32;
  const Failure notFinite =
      failureAfter(kVertices + 28 * 7 + 8, bytes(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(notFinite.code, ErrorCode::NotFinite);
  const std::size_t quads = kVertices + 28 * std::size_t{21 * 11 * 11};
  const std::size_t cells = quads + 12 + 20 * std::size_t{2 * (200 + 200 + 100)} + 12;
  const Failure index = failureAfter(cells + 36 * 1500 + 4, bytes(0U));
  EXPECT_EQ(index.code, ErrorCode::IndexOutOfRange);
  EXPECT_EQ(toString(index.place), "cell 1500");
}

/// Where libMeshb has the nodes of a hexahedron of order 2, in halves.
using Places = std::array<std::array<int, 3>, 27>;
constexpr Places kNodesOfOrder2 = {
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
     {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
     {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {1, 1, 0},
     {1, 1, 2}, {1, 0, 1}, {2, 1, 1}, {1, 2, 1}, {0, 1, 1}, {1, 1, 1}}};

std::string listed(const Places& places, const char* end) {
  std::string text;
  for (const auto& [x, y, z] : places) {
    text += std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + end;
  }
  return text;
}

/// A cell of order 2 with a tagged face.
/// @param ordering  the section HexahedraQ2Ordering, or nothing
std::string cubeOfOrder2(const Places& places, const std::string& ordering) {
  std::string cell;
  for (int i = 1; i <= 27; ++i) cell += std::to_string(i) + ' ';
  return "MeshVersionFormatted 2\nDimension 3\nVertices\n27\n" + listed(places, " 0\n") + ordering +
         "QuadrilateralsQ2\n1\n1 4 3 2 12 11 10 9 21 5\nHexahedraQ2\n1\n" + cell + "7\nEnd\n";
}

void expectItsCube(const LagrangeMesh& mesh) {
  expectCubeOfOrder2(mesh);
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{7}));
}

TEST(Medit, CellsOfOrder2) {
  const TemporaryFolder folder;
  Context context;
  const std::filesystem::path file = folder / "a.mesh";
  writeText(file, cubeOfOrder2(kNodesOfOrder2, ""));
  ASSERT_TRUE(holdsLagrangeCells(file, context));
  const LagrangeMesh cube = readLagrangeMesh(file, context);
  expectItsCube(cube);
  EXPECT_EQ(cube.features.quads, (std::vector<FeatureQuad>{{{0, 3, 2, 1}, 5}}));
  const Failure straight = failureOf([&] { static_cast<void>(readHexMesh(file)); });
  EXPECT_NE(straight.sentence.find("it holds 1 hexahedron with 27 nodes. Cells of order 2"),
            std::string::npos)
      << straight.sentence;
  // Programs order nodes as they like, and say how.
  Places turned = kNodesOfOrder2;
  std::reverse(turned.begin(), turned.end());
  const std::string ordering = "HexahedraQ2Ordering\n27\n" + listed(turned, "\n");
  expectItsCube(readBytes<Medit::readCurved>(cubeOfOrder2(turned, ordering), "a.mesh", context));
  for (const auto& [from, to] : {std::pair("2 2 2\n", "2 2 3\n"), std::pair("2 2 2\n", "0 0 0\n"),
                                 std::pair("g\n27\n", "g\n26\n")}) {
    const std::string wrong = cubeOfOrder2(turned, replaced(ordering, from, to));
    const Failure failure = failureOf(
        [&] { static_cast<void>(readBytes<Medit::readCurved>(wrong, "a.mesh", context)); });
    EXPECT_EQ(failure.code, ErrorCode::FileSyntax) << failure.sentence;
  }
}

TEST(Medit, CellsOfOrder2ComeBack) {
  const TemporaryFolder folder;
  Context context;
  LagrangeMesh mesh =
      readBytes<Medit::readCurved>(cubeOfOrder2(kNodesOfOrder2, ""), "a.mesh", context);
  mesh.features.edges = {{{0, 1}, 4}};
  mesh.features.vertices = {{5, 3}};
  for (const char* const name : {"mesh", "meshb"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path file = folder / (std::string("b.") + name);
    writeLagrangeMesh(mesh, file, {.format = name}, context);
    ASSERT_TRUE(holdsLagrangeCells(file, context));
    const LagrangeMesh read = readLagrangeMesh(file, context);
    expectItsCube(read);
    expectSameBits(read.points, mesh.points);
    EXPECT_EQ(read.features.vertices, mesh.features.vertices);
    ASSERT_EQ(read.features.quads.size(), 1U);
    EXPECT_EQ(read.features.quads[0].tag, 5);
    if (std::string(name) == "meshb") {
      EXPECT_EQ(read.features.edges, mesh.features.edges);
    }
    // As cut off by a full disk.
    const std::string bytes = contentOf(file);
    for (std::size_t size = 0; size + 40 < bytes.size(); size += 31) {
      const std::string part = bytes.substr(0, size);
      const auto readPart = [&, text = std::string(name) == "mesh"] {
        return text ? readBytes<Medit::readCurved>(part, "b", context)
                    : readBytes<Meshb::readCurved>(part, "b", context);
      };
      EXPECT_THROW(static_cast<void>(readPart()), Error) << size;
    }
  }
  // .mesh files of higher order are MFEM's, unless MEDIT's are asked for.
  writeLagrangeMesh(mesh, folder / "c.mesh", {}, context);
  EXPECT_TRUE(contentOf(folder / "c.mesh").starts_with("MFEM"));
}

}  // namespace
}  // namespace hexhex::test::meshb
