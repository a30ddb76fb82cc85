// `.msh` files: exact content, what other programs write and ours does not, errors.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/patches.hpp>

#include <io/core/mesh_groups.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

HexMesh parse(const std::string& text) {
  Context context;
  return readBytes<GmshFormat::readMesh>(text, "m.msh", context);
}

Failure failure(const std::string& text) {
  return failureOf([&] { static_cast<void>(parse(text)); });
}

template <class T>
std::string bytes(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

template <class T>
std::string bytesOf(std::initializer_list<T> values) {
  std::string result;
  for (const T value : values) result += bytes(value);
  return result;
}

const std::string kHead22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kNodes22 =
    "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
    "$EndNodes\n";
const std::string kCube22 = "$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n";
constexpr Hex kCubeCell = {0, 1, 2, 3, 4, 5, 6, 7};

TEST(Gmsh, WritesExactlyTheSectionsOfVersion22) {
  const TemporaryFolder folder;
  HexMesh mesh = parse(kHead22 + kNodes22 + kCube22);
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1}));  // the group's number, which has no name
  mesh.regions.clear();
  mesh.features.quads = {{{4, 5, 6, 7}, 2}};
  mesh.features.edges = {{{0, 1}, 9}};
  mesh.features.vertices = {{3, 6}, {0, 6}};
  Context context;
  writeHexMesh(mesh, folder / "a.msh", {.format = "msh22-ascii"}, context);
  EXPECT_EQ(contentOf(folder / "a.msh"),
            kHead22 +
                "$PhysicalNames\n5\n0 6 \"point_6\"\n1 9 \"curve_9\"\n2 2 \"surface_2\"\n"
                "2 3 \"boundary\"\n3 1 \"hexahedra\"\n$EndPhysicalNames\n" +
                kNodes22 +
                "$Elements\n10\n1 15 2 6 1 4\n2 15 2 6 2 1\n3 1 2 9 9 1 2\n4 3 2 2 2 5 6 7 8\n"
                "5 3 2 3 3 1 5 8 4\n6 3 2 3 3 2 3 7 6\n7 3 2 3 3 1 2 6 5\n8 3 2 3 3 4 8 7 3\n"
                "9 3 2 3 3 1 4 3 2\n10 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n");
}

TEST(Gmsh, WritesExactlyTheSectionsOfVersion41) {
  const TemporaryFolder folder;
  HexMesh mesh = parse(kHead22 + kNodes22 + kCube22);
  mesh.regions.clear();
  Context context;
  WriteOptions options;
  options.format = "msh41-ascii";
  options.patchAngle = 0;
  writeHexMesh(mesh, folder / "a.msh", options, context);
  EXPECT_EQ(contentOf(folder / "a.msh"),
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
            "$PhysicalNames\n2\n2 1 \"boundary\"\n3 2 \"hexahedra\"\n$EndPhysicalNames\n"
            "$Entities\n0 0 1 1 \n1 0 0 0 1 1 1 1 1 0 \n2 0 0 0 1 1 1 1 2 0 \n$EndEntities\n"
            "$Nodes\n1 8 1 8 \n3 2 0 8 \n1 \n2 \n3 \n4 \n5 \n6 \n7 \n8 \n"
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n"
            "$Elements\n2 7 1 7 \n2 1 3 6 \n1 1 5 8 4 \n2 2 3 7 6 \n3 1 2 6 5 \n4 4 8 7 3 \n"
            "5 1 4 3 2 \n6 5 6 7 8 \n3 2 5 1 \n7 1 2 3 4 5 6 7 8 \n$EndElements\n");
}

TEST(Gmsh, NamesOfGroupsHaveOneSign) {
  EXPECT_EQ(tagInGroupName("curve_m12"), -12);
  EXPECT_EQ(tagInGroupName("point_m2147483648"), std::numeric_limits<std::int32_t>::min());
  for (const char* name : {"point_m-9223372036854775808", "point_m-1", "point_m", "region_1x"}) {
    EXPECT_EQ(tagInGroupName(name), std::nullopt) << name;
  }
}

/// The tags and names of the bottom and the top of a cube, groups 21 and 22 with these names.
std::vector<std::pair<std::int32_t, std::string>> groupsNamed(const std::string& bottom,
                                                              const std::string& top) {
  const HexMesh mesh =
      parse(kHead22 + "$PhysicalNames\n2\n2 21 \"" + bottom + "\"\n2 22 \"" + top +
            "\"\n$EndPhysicalNames\n" + kNodes22 +
            "$Elements\n3\n1 3 2 21 1 1 2 3 4\n2 3 2 22 2 5 6 7 8\n3 5 2 1 1 1 2 3 4 5 6 7 8\n"
            "$EndElements\n");
  std::vector<std::pair<std::int32_t, std::string>> groups;
  for (const FeatureQuad& quad : mesh.features.quads) {
    std::string& name = groups.emplace_back(quad.tag, "").second;
    for (const TagName& each : mesh.features.names) {
      if (each.dimension == 2 && each.tag == quad.tag) name = each.name;
    }
  }
  return groups;
}

TEST(Gmsh, NamesDoNotMergeGroups) {
  using Groups = std::vector<std::pair<std::int32_t, std::string>>;
  EXPECT_EQ(groupsNamed("surface_7", "outlet"), (Groups{{7, ""}, {22, "outlet"}}));
  EXPECT_EQ(groupsNamed("surface_22", "surface_21"), (Groups{{22, ""}, {21, ""}}));
  EXPECT_EQ(groupsNamed("surface_22", "outlet"), (Groups{{21, ""}, {22, "outlet"}}));
  EXPECT_EQ(groupsNamed("surface_7", "surface_7"), (Groups{{21, ""}, {22, ""}}));
  // Only hexhex's own names of quads say a tag, or that there is none.
  EXPECT_EQ(groupsNamed("surface_0", "region_22"), (Groups{{21, "surface_0"}, {22, "region_22"}}));
  EXPECT_EQ(groupsNamed("patch_antenna", "point_21"),
            (Groups{{21, "patch_antenna"}, {22, "point_21"}}));
  EXPECT_EQ(groupsNamed("patch_3", "boundary"), Groups{});
}

TEST(Gmsh, ElementsOfTwoGroupsAreReadOnce) {
  std::string nodes = replaced(kNodes22, "$Nodes\n8", "$Nodes\n12");
  nodes = replaced(nodes, "$EndNodes", "9 0 0 2\n10 1 0 2\n11 1 1 2\n12 0 1 2\n$EndNodes");
  const HexMesh mesh =
      parse(kHead22 + nodes +
            "$Elements\n9\n1 15 2 4 1 1\n2 15 2 3 1 1\n3 1 2 9 1 1 2\n4 1 2 8 1 1 2\n"
            "5 3 2 21 1 1 2 3 4\n6 3 2 2 1 1 2 3 4\n7 5 2 11 1 1 2 3 4 5 6 7 8\n"
            "8 5 2 1 1 1 2 3 4 5 6 7 8\n9 5 2 1 1 5 6 7 8 9 10 11 12\n$EndElements\n");
  EXPECT_EQ(mesh.cells, (Array<Hex>{kCubeCell, {4, 5, 6, 7, 8, 9, 10, 11}}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{11, 1}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);
  EXPECT_EQ(mesh.features.quads[0].tag, 21);
  ASSERT_EQ(mesh.features.edges.size(), 1U);
  EXPECT_EQ(mesh.features.edges[0].tag, 9);
  ASSERT_EQ(mesh.features.vertices.size(), 1U);
  EXPECT_EQ(mesh.features.vertices[0].tag, 4);
}

TEST(Gmsh, TagsOfNodesAreFree) {
  std::string nodes = kNodes22;
  nodes = replaced(nodes, "\n1 0 0 0", "\n900000000 0 0 0");
  const HexMesh mesh =
      parse(kHead22 + nodes + replaced(kCube22, " 1 2 3 4 5", " 900000000 2 3 4 5"));
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  EXPECT_NE(failure(kHead22 + replaced(nodes, "\n2 1 0", "\n900000000 1 0") + kCube22)
                .sentence.find("two nodes have the number 900000000"),
            std::string::npos);
}

TEST(Gmsh, OtherElementsAndSectionsAreIgnored) {
  const HexMesh mesh = parse(kHead22 + "$Comments\n$Nodes are next\n$EndComments\n" + kNodes22 +
                             "$Elements\n4\n1 15 0 1\n2 3 3 1 1 5 1 2 3 4\n"
                             "3 5 2 1 1 1 2 3 4 5 6 7 8\n4 4 0 1 2 3 4\n$EndElements\n");
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  const Failure tets = failure(kHead22 + kNodes22 + "$Elements\n1\n4 4 0 1 2 3 4\n$EndElements\n");
  EXPECT_EQ(tets.code, ErrorCode::FileUnsupported);
}

TEST(Gmsh, BlocksOfVersion41InAnyNumber) {
  const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  const std::string nodes =
      "$Nodes\n3 8 1 20\n2 5 1 2\n20\n3\n0 0 0 0.5 0.25\n1 0 0 0.5 0.75\n1 1 0 0\n"
      "3 1 0 6\n5\n6\n7\n8\n9\n10\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n";
  const std::string elements =
      "$Elements\n3 4 1 4\n3 1 5 1\n1 20 3 5 6 7 8 9 10\n2 5 3 1\n2 20 3 5 6\n"
      "3 2 5 2\n3 20 3 5 6 7 8 9 10\n4 3 20 5 6 7 8 9 10\n$EndElements\n";
  const HexMesh mesh = parse(head + nodes + elements);
  EXPECT_EQ(mesh.points[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.points[7], (Vec3{0, 1, 1}));
  ASSERT_EQ(mesh.cells.size(), 3U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  EXPECT_EQ(mesh.cells[1], kCubeCell);
  EXPECT_EQ(mesh.cells[2], (Hex{1, 0, 2, 3, 4, 5, 6, 7}));
}

TEST(Gmsh, BinaryOfVersion22) {
  std::string text = "$MeshFormat\n2.2 1 8\n" + bytes(1) + "\n$EndMeshFormat\n$Nodes\n8\n";
  const HexMesh cube = parse(kHead22 + kNodes22 + kCube22);
  for (int i = 0; i < 8; ++i) {
    text += bytes(i + 1);
    for (const double coordinate : cube.points[static_cast<std::size_t>(i)]) {
      text += bytes(coordinate);
    }
  }
  text += "\n$EndNodes\n$Elements\n3\n" + bytesOf({3, 1, 2, 1, 7, 7, 1, 2, 3, 4}) +
          bytesOf({5, 2, 2}) + bytesOf({2, 1, 1, 1, 2, 3, 4, 5, 6, 7, 8}) +
          bytesOf({3, 1, 1, 2, 1, 4, 3, 6, 5, 8, 7}) + "\n$EndElements\n";
  const HexMesh mesh = parse(text);
  EXPECT_EQ(mesh.points, cube.points);
  ASSERT_EQ(mesh.cells.size(), 2U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  EXPECT_EQ(mesh.cells[1], (Hex{1, 0, 3, 2, 5, 4, 7, 6}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 1}));
  EXPECT_EQ(mesh.features.quads, (std::vector<FeatureQuad>{{{0, 1, 2, 3}, 7}}));
  text[20] = 0;
  text[23] = 1;
  EXPECT_EQ(failure(text).code, ErrorCode::FileUnsupported);
}

/// Where Gmsh's manual has the nodes of a cell of order 2, in halves: corners, edges, faces,
/// inside.
constexpr std::array<std::array<int, 3>, 27> kNodesOfOrder2 = {
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
     {0, 2, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0},
     {2, 2, 1}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {2, 1, 2}, {1, 2, 2}, {1, 1, 0},
     {1, 0, 1}, {0, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {1, 1, 1}}};

/// A cell of order 2 with 20 or 27 nodes, the quad across z = 0, an edge of it, and a vertex.
struct CubeOfOrder2 {
  int nodes;
  int type = nodes == 20 ? 17 : 12;
  int quadType = nodes == 20 ? 16 : 10;
  std::vector<int> quad = {1, 2, 3, 4, 9, 12, 14, 10, 21};

  explicit CubeOfOrder2(int n) : nodes(n) {
    if (n == 20) quad.pop_back();
  }
  [[nodiscard]] std::string nodesText(bool perLine) const {
    std::string text;
    for (int i = 1; !perLine && i <= nodes; ++i) text += std::to_string(i) + '\n';
    for (int i = 1; i <= nodes; ++i) {
      if (perLine) text += std::to_string(i) + ' ';
      for (const int x : kNodesOfOrder2[static_cast<std::size_t>(i - 1)]) {
        text += std::to_string(x) + ' ';
      }
      text += '\n';
    }
    return text;
  }
  [[nodiscard]] static std::string row(const std::vector<int>& numbers) {
    std::string text;
    for (const int number : numbers) text += std::to_string(number) + ' ';
    return text + '\n';
  }
  [[nodiscard]] std::vector<int> cell() const {
    std::vector<int> all;
    for (int i = 1; i <= nodes; ++i) all.push_back(i);
    return all;
  }
  [[nodiscard]] std::string version22() const {
    const std::string count = std::to_string(nodes);
    return kHead22 + "$Nodes\n" + count + '\n' + nodesText(true) + "$EndNodes\n$Elements\n4\n" +
           "1 15 2 9 1 1\n2 8 2 7 1 1 2 9\n3 " + std::to_string(quadType) + " 2 5 1 " + row(quad) +
           "4 " + std::to_string(type) + " 2 3 1 " + row(cell()) + "$EndElements\n";
  }
  [[nodiscard]] std::string version41() const {
    const std::string count = std::to_string(nodes);
    return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 1 1 1\n1 0 0 0 1 9\n"
           "1 0 0 0 2 0 0 1 7 0\n1 0 0 0 2 2 0 1 5 0\n1 0 0 0 2 2 2 1 3 0\n$EndEntities\n"
           "$Nodes\n1 " +
           count + " 1 " + count + "\n3 1 0 " + count + '\n' + nodesText(false) +
           "$EndNodes\n$Elements\n4 4 1 4\n0 1 15 1\n1 1\n1 1 8 1\n2 1 2 9\n2 1 " +
           std::to_string(quadType) + " 1\n3 " + row(quad) + "3 1 " + std::to_string(type) +
           " 1\n4 " + row(cell()) + "$EndElements\n";
  }
  [[nodiscard]] std::string bytes22() const {
    std::string text = "$MeshFormat\n2.2 1 8\n" + bytes(1) + "\n$EndMeshFormat\n$Nodes\n" +
                       std::to_string(nodes) + '\n';
    for (int i = 1; i <= nodes; ++i) {
      text += bytes(i);
      for (const int x : kNodesOfOrder2[static_cast<std::size_t>(i - 1)])
        text += bytes(static_cast<double>(x));
    }
    text += "\n$EndNodes\n$Elements\n4\n" + bytesOf({15, 1, 2, 1, 9, 1, 1}) +
            bytesOf({8, 1, 2, 2, 7, 1, 1, 2, 9}) + bytesOf({quadType, 1, 2, 3, 5, 1});
    for (const int node : quad) text += bytes(node);
    text += bytesOf({type, 1, 2, 4, 3, 1});
    for (const int node : cell()) text += bytes(node);
    return text + "\n$EndElements\n";
  }
};

TEST(Gmsh, CellsOfOrder2) {
  const TemporaryFolder folder;
  Context context;
  for (const int nodes : {20, 27}) {
    const CubeOfOrder2 cube(nodes);
    for (const std::string& text : {cube.version22(), cube.version41(), cube.bytes22()}) {
      SCOPED_TRACE(text.substr(0, 21) + std::to_string(nodes));
      // From memory and from a file, where it is looked at without the whole of it.
      EXPECT_TRUE(readBytes<GmshFormat::holdsCurved>(text, "m.msh", context));
      writeText(folder / "a.msh", text);
      ASSERT_TRUE(holdsLagrangeCells(folder / "a.msh", context));
      const LagrangeMesh mesh = readLagrangeMesh(folder / "a.msh", context);
      expectCubeOfOrder2(mesh);
      EXPECT_EQ(mesh.regions, (Array<std::int32_t>{3}));
      EXPECT_EQ(mesh.features.quads, (std::vector<FeatureQuad>{{{0, 1, 2, 3}, 5}}));
      EXPECT_EQ(mesh.features.edges, (std::vector<FeatureEdge>{{{0, 1}, 7}}));
      EXPECT_EQ(mesh.features.vertices, (std::vector<FeatureVertex>{{0, 9}}));
      const Failure straight = failure(text);
      EXPECT_NE(straight.sentence.find("it holds 1 hexahedron with " + std::to_string(nodes) +
                                       " nodes. Cells of order 2 and more are curved"),
                std::string::npos)
          << straight.sentence;
      for (std::size_t size = 0; size + 13 < text.size(); size += 7) {
        const std::string part = text.substr(0, size);
        EXPECT_THROW(static_cast<void>(readBytes<GmshFormat::readCurved>(part, "m.msh", context)),
                     Error)
            << size;
      }
    }
  }
}

TEST(Gmsh, CellsOfOrder2AloneAndOfOneType) {
  const TemporaryFolder folder;
  Context context;
  const auto sentence = [&](const std::string& text) {
    return failureOf([&] {
             static_cast<void>(readBytes<GmshFormat::readCurved>(text, "m.msh", context));
           })
        .sentence;
  };
  const std::string good = CubeOfOrder2(27).version22();
  const std::string mixed = replaced(replaced(good, "$Elements\n4\n", "$Elements\n5\n"),
                                     "$EndElements", "5 5 2 3 1 1 2 3 4 5 6 7 8\n$EndElements");
  EXPECT_NE(
      sentence(mixed).find("of one order; it holds 1 hexahedron and 1 hexahedron with 27 nodes"),
      std::string::npos)
      << sentence(mixed);
  EXPECT_NE(sentence(replaced(good, " 26 27 \n", " 26 28 \n")).find("names node 28"),
            std::string::npos);
  const std::string straight = kHead22 + kNodes22 + kCube22;
  EXPECT_NE(sentence(straight).find("of one order; it holds 1 hexahedron."), std::string::npos)
      << sentence(straight);
  writeText(folder / "a.msh", straight);
  EXPECT_FALSE(holdsLagrangeCells(folder / "a.msh", context));
  EXPECT_FALSE(readBytes<GmshFormat::holdsCurved>(straight, "m.msh", context));
}

/// The groups of a file: "dimension name" by number, which no two have.
std::map<int, std::string> groupsByNumber(const std::filesystem::path& file) {
  std::istringstream lines(contentOf(file));
  std::string line;
  while (line != "$PhysicalNames" && std::getline(lines, line)) {
  }
  std::size_t count = 0;
  lines >> count;
  std::map<int, std::string> groups;
  for (std::size_t i = 0; i < count; ++i) {
    int dimension = 0;
    int number = 0;
    std::string name;
    lines >> dimension >> number >> name;
    groups[number] = std::to_string(dimension) + " " + name;
  }
  EXPECT_EQ(groups.size(), count) << "groups share numbers";
  return groups;
}

// meshio and GetFEM make one group of those with one number.
TEST(Gmsh, NoTwoGroupsHaveOneNumber) {
  const TemporaryFolder folder;
  Context context;
  HexMesh mesh = gridMesh(2, 1, 1);
  mesh.regions = {7, 3};
  mesh.features.quads = {{{0, 6, 9, 3}, 7}};
  mesh.features.edges = {{{0, 1}, 7}, {{1, 2}, 2}};
  mesh.features.vertices = {{0, 1}};
  for (const char* const format : {"msh", "msh41-ascii", "msh22-ascii"}) {
    SCOPED_TRACE(format);
    writeHexMesh(mesh, folder / "a.msh", {.format = format}, context);
    const std::map<int, std::string> expected = {
        {1, "0 \"point_1\""}, {2, "1 \"curve_2\""},   {3, "3 \"region_3\""}, {4, "3 \"region_7\""},
        {5, "1 \"curve_7\""}, {7, "2 \"surface_7\""}, {8, "2 \"boundary\""}};
    EXPECT_EQ(groupsByNumber(folder / "a.msh"), expected);
    const HexMesh read = readHexMesh(folder / "a.msh");
    EXPECT_EQ(read.features.edges.size(), 2U);
    EXPECT_EQ(read.features.quads, mesh.features.quads);
    Array<std::int32_t> regions = read.regions;
    std::sort(regions.begin(), regions.end());  // cells are in order of their regions
    EXPECT_EQ(regions, (Array<std::int32_t>{3, 7}));
  }
  // Patches, which have no tags, come behind regions, which have.
  mesh.features = {};
  mesh.regions = {1, 2};
  writeHexMesh(mesh, folder / "a.msh");
  const std::map<int, std::string> groups = groupsByNumber(folder / "a.msh");
  EXPECT_EQ(groups.at(1), "3 \"region_1\"");
  EXPECT_EQ(groups.at(3), "2 \"patch_1\"");
  mesh.regions.clear();
  writeHexMesh(mesh, folder / "a.msh");
  EXPECT_EQ(groupsByNumber(folder / "a.msh").at(7), "3 \"hexahedra\"");
}

/// The same file of version 2.2 with bytes for the numbers of nodes and elements, and a block for
/// each element.
std::string inBytes22(const std::string& text) {
  std::istringstream input(text);
  std::string binary;
  std::string line;
  while (std::getline(input, line)) {
    const bool nodes = line == "$Nodes";
    const bool elements = line == "$Elements";
    if (line == "2.2 0 8") line = "2.2 1 8\n" + bytes(1);
    binary += line + "\n";
    if (!nodes && !elements) continue;
    std::getline(input, line);
    binary += line + "\n";
    for (int i = std::stoi(line); i > 0; --i) {
      std::getline(input, line);
      std::istringstream numbers(line);
      int number = 0;
      numbers >> number;
      std::string record = bytes(number);
      int type = 0;
      int tags = 0;
      if (elements) {
        numbers >> type >> tags;
        binary += bytes(type) + bytes(1) + bytes(tags);
      }
      for (double value = 0; numbers >> value;) {
        record += nodes ? bytes(value) : bytes(static_cast<int>(value));
      }
      binary += record;
    }
    binary += "\n";
  }
  return binary;
}

TEST(Gmsh, BinaryOfVersion22HasTheTagsOfTheText) {
  const std::string names =
      "$PhysicalNames\n3\n0 2 \"point_m4\"\n2 9 \"inlet\"\n3 8 \"region_70\"\n"
      "$EndPhysicalNames\n";
  // Numbers with a sign, without a tag, with three of them, with the group 0, without a name.
  const std::string text =
      kHead22 + names + kNodes22 +
      "$Elements\n10\n1 15 2 2 1 4\n2 15 0 5\n3 1 1 -6 1 2\n"
      "4 3 3 9 1 1 5 6 7 8\n5 3 2 0 1 1 2 6 5\n6 4 2 8 8 1 2 3 5\n7 5 0 1 2 3 4 5 6 7 8\n"
      "8 5 1 -8 2 3 4 1 6 7 8 5\n9 5 3 8 1 1 3 4 1 2 7 8 5 6\n"
      "10 5 2 5 5 4 1 2 3 8 5 6 7\n$EndElements\n";
  for (const std::string& file : {text, inBytes22(text)}) {
    const HexMesh mesh = parse(file);
    EXPECT_EQ(mesh.cells.size(), 4U);
    EXPECT_EQ(mesh.regions, (Array<std::int32_t>{0, 70, 70, 5}));
    EXPECT_EQ(mesh.features.vertices, (std::vector<FeatureVertex>{{3, -4}}));
    EXPECT_EQ(mesh.features.edges, (std::vector<FeatureEdge>{{{0, 1}, 6}}));
    EXPECT_EQ(mesh.features.quads, (std::vector<FeatureQuad>{{{4, 5, 6, 7}, 9}}));
  }
  const std::string wrong = replaced(text, "1 -6 1 2\n", "1 -6 1 20\n");
  EXPECT_EQ(failure(wrong).code, ErrorCode::IndexOutOfRange);
  EXPECT_EQ(failure(inBytes22(wrong)).code, ErrorCode::IndexOutOfRange);
}

TEST(Gmsh, BinaryOfVersion22HasTheTagsThatWereWritten) {
  const TemporaryFolder folder;
  Context context;
  HexMesh mesh = gridMesh(3, 2, 2);
  mesh.features.vertices = {{5, 3}};
  mesh.features.edges = {{{0, 1}, 12}};
  mesh.features.quads = {{boundaryPatches(mesh, 40, context)[0].vertices, 4}};
  mesh.regions.assign(mesh.cells.size(), 0);
  std::fill_n(mesh.regions.begin(), 5, 6);
  writeHexMesh(mesh, folder / "a.msh", {.format = "msh22-ascii"}, context);
  const HexMesh read = parse(inBytes22(contentOf(folder / "a.msh")));
  expectSameBits(read.points, mesh.points);
  EXPECT_EQ(read.cells, mesh.cells);
  EXPECT_EQ(read.features, mesh.features);
  EXPECT_EQ(read.regions, mesh.regions);
}

const std::string kGood22 = kHead22 + kNodes22 + kCube22;

/// The good file with one change must fail with this in the sentence.
void expectFailure(const std::string& from, const std::string& to, const std::string& fragment) {
  const Failure found = failure(replaced(kGood22, from, to));
  EXPECT_NE(found.sentence.find(fragment), std::string::npos) << found.sentence;
}

TEST(Gmsh, ErrorsTellTheLine) {
  expectFailure("$MeshFormat", "$Meshformat", "m.msh, line 1:");
  expectFailure("2.2", "3.7", "\"3.7\" of the format is not supported");
  expectFailure("\n3 1 1 0", "\n3 1 x 0", "line 8: expected a coordinate");
  expectFailure("$Nodes\n8", "$Nodes\n900000000", "has room for at most");
  expectFailure("$Nodes\n8", "$Nodes\n7", "expected \"$EndNodes\", found \"8\"");
  expectFailure("7 8\n$EndE", "7 9\n$EndE", "m.msh, line 17: hexahedron 0");
}

TEST(Gmsh, SectionsThatAreMissingOrInTheWrongOrder) {
  EXPECT_EQ(failure(kHead22 + kCube22 + kNodes22).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failure(kHead22 + kNodes22).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failure(kHead22 + kNodes22 + kNodes22 + kCube22).code, ErrorCode::FileSyntax);
}

TEST(Gmsh, FirstErrorInBytesWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(20, 20, 20), folder / "a.msh");
  std::string binary = contentOf(folder / "a.msh");
  const std::size_t place = binary.rfind("\n$EndElements") - 72 * 50 + 8;
  binary[place + 6] = 1;
  binary[place + 72 * 9] = binary[place + 72 * 9 + 1] = '\xff';
  for (const int threads : {1, 4}) {
    Context context(threads);
    const Failure wrong = failureOf(
        [&] { static_cast<void>(readBytes<GmshFormat::readMesh>(binary, "m.msh", context)); });
    EXPECT_EQ(wrong.code, ErrorCode::IndexOutOfRange);
    EXPECT_EQ(toString(wrong.place), "cell 7950");
    EXPECT_NE(wrong.sentence.find("byte " + std::to_string(place + 8)), std::string::npos)
        << wrong.sentence;
  }
}

}  // namespace
}  // namespace hexhex::test
