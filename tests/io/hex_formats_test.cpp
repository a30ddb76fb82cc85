// What all formats of hexahedral meshes have in common, and the exact text of those for
// simulations: `.vtk`, `.inp`, MFEM.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>

#include <io/core/mesh_groups.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

void write(const HexMesh& mesh, const std::filesystem::path& file, std::string_view format = {},
           int threads = 1, double patchAngle = 0) {
  Context context(threads);
  WriteOptions options;
  options.patchAngle = patchAngle;
  options.format = format;
  writeHexMesh(mesh, file, options, context);
}

/// A cube with the corners 0 and 1 only.
HexMesh cube() {
  HexMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  return mesh;
}

struct Format {
  const char* name;
  const char* file;
};

/// Formats that are read and written without loss.
constexpr std::array<Format, 6> kLossless = {{{"msh", "a.msh"},
                                              {"msh41-ascii", "b.msh"},
                                              {"msh22-ascii", "c.msh"},
                                              {"meshb", "a.meshb"},
                                              {"mfem", "d.mesh"},
                                              {"vtk", "a.vtk"}}};

void expectRoundTrip(const HexMesh& original, const std::filesystem::path& file,
                     std::string_view format) {
  write(original, file, format);
  const std::string bytes = contentOf(file);
  write(original, file, format, 4);
  EXPECT_TRUE(contentOf(file) == bytes) << format;
  for (const int threads : {1, 4}) {
    Context context(threads);
    const HexMesh read = readHexMesh(file, context);
    expectSameBits(original.points, read.points);
    EXPECT_EQ(original.cells, read.cells) << format;
  }
}

TEST(HexFormats, RoundTripIsLosslessWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  HexMesh original = gridMesh(17, 11, 13);
  Random random(11);
  for (std::size_t i = 0; i < 200; ++i) {
    original.points[i] = {random.anyDouble(), -0.0, 5e-324 * static_cast<double>(i)};
  }
  for (const Format& format : kLossless) {
    expectRoundTrip(original, folder / format.file, format.name);
  }
}

TEST(HexFormats, FeaturesDoNotChangeTheMesh) {
  const TemporaryFolder folder;
  HexMesh original = gridMesh(2, 2, 2);
  original.features.vertices = {{0, 4}, {2, -1}};
  original.features.edges = {{{0, 1}, 2}, {{1, 2}, -7}};
  original.features.quads = {{{0, 1, 4, 3}, 6}, {{1, 4, 13, 10}, 2}};
  for (const Format& format : kLossless) {
    write(original, folder / format.file, format.name);
    const HexMesh read = readHexMesh(folder / format.file);
    expectSameBits(original.points, read.points);
    EXPECT_EQ(original.cells, read.cells) << format.name;
  }
}

TEST(HexFormats, EmptyMeshes) {
  const TemporaryFolder folder;
  for (const Format& format : kLossless) {
    write(HexMesh{}, folder / format.file, format.name);
    EXPECT_TRUE(readHexMesh(folder / format.file).points.empty()) << format.name;
  }
  write(HexMesh{}, folder / "a.inp");
}

TEST(HexFormats, NamesOverrideExtensions) {
  const TemporaryFolder folder;
  write(cube(), folder / "a.mesh", "mfem");
  EXPECT_TRUE(contentOf(folder / "a.mesh").starts_with("MFEM mesh v1.0\n"));
  write(cube(), folder / "noextension", "vtk");
  EXPECT_TRUE(contentOf(folder / "noextension").starts_with("# vtk DataFile Version 2.0\n"));
  EXPECT_EQ(folder.fileCount(), 2U);
}

TEST(HexFormats, UnknownNamesAreRefused) {
  const TemporaryFolder folder;
  const Failure unknown = failureOf([&] { write(cube(), folder / "b.mesh", "nastran"); });
  EXPECT_EQ(unknown.code, ErrorCode::FileUnsupported);
  EXPECT_NE(unknown.sentence.find("msh41-ascii"), std::string::npos) << unknown.sentence;
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(HexFormats, NamesAreCheckedBeforeLongWork) {
  EXPECT_NO_THROW(requireHexMeshFormat("a", "mfem"));
  EXPECT_EQ(failureOf([] { requireHexMeshFormat("a.mesh", "nastran"); }).code,
            ErrorCode::FileUnsupported);
}

TEST(HexFormats, FeaturesWithVerticesThatDoNotExistAreRefused) {
  const TemporaryFolder folder;
  for (const char* format : {"msh", "msh41-ascii", "msh22-ascii", "meshb", "inp", "mfem"}) {
    HexMesh mesh = cube();
    mesh.features.quads = {{{0, 1, 2, 8}, 1}};
    EXPECT_EQ(failureOf([&] { write(mesh, folder / "a", format); }).code,
              ErrorCode::InvalidArgument)
        << format;
  }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(HexFormats, NothingIsLeftOfAFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  for (const char* format : {"msh", "msh41-ascii", "msh22-ascii", "meshb", "vtk", "inp", "mfem"}) {
    EXPECT_EQ(failureOf([&] { write(cube(), folder / "no/such/folder", format); }).code,
              ErrorCode::FileWrite)
        << format;
  }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(MeshGroups, TagsAreNumbersOnlyIfAllArePositive) {
  HexMesh mesh = cube();
  const auto numbersOf = [&mesh] {
    Context context;
    Stage stage(context, "test");
    std::string result;
    for (const ElementGroup& group : groupQuads(mesh, 0, stage).groups) {
      result += group.name + ":" + std::to_string(group.number) + ":" +
                std::to_string(group.end - group.begin) + " ";
    }
    return result;
  };
  EXPECT_EQ(numbersOf(), "boundary:1:6 ");
  mesh.features.quads = {{{4, 5, 6, 7}, 9}, {{3, 2, 1, 0}, 4}, {{2, 3, 7, 6}, 0}};
  EXPECT_EQ(numbersOf(), "surface_4:4:1 surface_9:9:1 boundary:10:4 ");
  mesh.features.quads[0].tag = -5;
  EXPECT_EQ(numbersOf(), "surface_m5:1:1 surface_4:2:1 boundary:3:4 ");
  mesh.features.quads[0].tag = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(numbersOf(), "surface_4:1:1 surface_2147483647:2:1 boundary:3:4 ");
}

TEST(MeshGroups, PatchesNameABoundaryWithoutTags) {
  HexMesh mesh = gridMesh(3, 2, 1);
  Context context;
  Stage stage(context, "test");
  const QuadGroups patches = groupQuads(mesh, 40, stage);
  ASSERT_EQ(patches.groups.size(), 6U);
  std::size_t size = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const ElementGroup& group = patches.groups[i];
    EXPECT_EQ(group.name, "patch_" + std::to_string(i + 1));
    EXPECT_EQ(group.number, i + 1);
    size += group.end - group.begin;
    for (std::size_t k = group.begin; k < group.end; ++k) {
      const std::uint64_t place = patches.places[k];
      EXPECT_EQ(place % 8, patches.places[group.begin] % 8) << "a grid's patches are its sides";
    }
  }
  EXPECT_EQ(size, 22U);
  EXPECT_EQ(groupQuads(mesh, 0, stage).groups.size(), 1U);
  EXPECT_EQ(groupQuads(mesh, 100, stage).groups[0].name, "boundary");
  mesh.features.quads = {{{0, 4, 16, 12}, 3}};  // tagged quads are all that counts then
  EXPECT_EQ(groupQuads(mesh, 40, stage).groups.size(), 2U);
  mesh.features.quads = {{{1, 5, 17, 13}, 3}};  // not if they are inside
  const QuadGroups both = groupQuads(mesh, 40, stage);
  ASSERT_EQ(both.groups.size(), 7U);
  EXPECT_EQ(both.groups[0].name, "surface_3");
  EXPECT_EQ(both.groups[1].name, "patch_1");
  EXPECT_EQ(both.groups[1].number, 4U);
  EXPECT_EQ(both.groups[6].name, "patch_6");
  mesh.features.quads[0].tag = std::numeric_limits<std::int32_t>::max() - 3;  // no room for numbers
  EXPECT_EQ(groupQuads(mesh, 40, stage).groups.back().name, "boundary");
  mesh.features.quads[0].tag = 0;
  EXPECT_EQ(groupQuads(mesh, 40, stage).groups.size(), 6U);
}

TEST(HexFormats, AnglesOutOfRangeAreRefused) {
  const TemporaryFolder folder;
  for (const double angle : {-1.0, 181.0, std::nan("")}) {
    EXPECT_EQ(failureOf([&] { write(cube(), folder / "a.msh", {}, 1, angle); }).code,
              ErrorCode::InvalidArgument);
  }
}

/// Two cubes side by side in different regions.
HexMesh twoRegions() {
  HexMesh mesh = gridMesh(2, 1, 1);
  mesh.regions = {7, -2};
  return mesh;
}

TEST(MeshGroups, CellsByRegion) {
  HexMesh mesh = twoRegions();
  const CellGroups groups = groupCells(mesh);
  ASSERT_EQ(groups.groups.size(), 2U);
  EXPECT_EQ(groups.groups[0].name, "region_m2");
  EXPECT_EQ(groups.groups[1].name, "region_7");
  EXPECT_EQ(groups.at(0), 1U);
  EXPECT_EQ(groups.at(1), 0U);
  EXPECT_EQ(cellReferences(mesh), (Array<std::uint32_t>{2, 1}));
  mesh.regions = {7, 0};
  EXPECT_EQ(cellReferences(mesh), (Array<std::uint32_t>{7, 8}));
  EXPECT_EQ(groupCells(mesh).groups[1].name, "hexahedra");
  mesh.regions = {};
  EXPECT_EQ(groupCells(mesh).groups[0].name, "hexahedra");
  EXPECT_TRUE(cellReferences(mesh).empty());
}

TEST(HexFormats, RegionsInAllFormats) {
  const TemporaryFolder folder;
  HexMesh mesh = twoRegions();
  mesh.regions = {7, 3};
  const auto textOf = [&](const char* format) {
    write(mesh, folder / "a", format);
    return contentOf(folder / "a");
  };
  const auto expectIn = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  };
  expectIn(textOf("mfem"), "elements\n2\n7 5 0 1 4 3 6 7 10 9\n3 5 1 2 5 4 7 8 11 10\n");
  expectIn(textOf("mesh"), "Hexahedra\n2\n1 2 5 4 7 8 11 10 7\n2 3 6 5 8 9 12 11 3\n");
  expectIn(textOf("vtk"), "CELL_DATA 2\nSCALARS region int 1\nLOOKUP_TABLE default\n7\n3\n");
  expectIn(textOf("inp"), "*ELSET, ELSET=E_REGION_3\n2\n*ELSET, ELSET=E_REGION_7\n1\n");
  const std::string msh = textOf("msh22-ascii");
  expectIn(msh, "3 3 \"region_3\"\n3 7 \"region_7\"\n");
  expectIn(msh, "11 5 2 3 3 2 3 6 5 8 9 12 11\n12 5 2 7 7 1 2 5 4 7 8 11 10\n");
  mesh.regions = {1};
  for (const char* format : {"mfem", "mesh", "meshb", "vtk", "vtu", "inp", "msh", "ovm", "ovmb"}) {
    EXPECT_EQ(failureOf([&] { write(mesh, folder / "b", format); }).code,
              ErrorCode::InvalidArgument)
        << format;
  }
}

const std::string kPointLines = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";

TEST(VtkLegacy, WritesExactlyTheNarrowForm) {
  const TemporaryFolder folder;
  write(cube(), folder / "a.vtk");
  EXPECT_EQ(contentOf(folder / "a.vtk"),
            "# vtk DataFile Version 2.0\nhexahedral mesh by hexhex\nASCII\n"
            "DATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n" +
                kPointLines + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n");
}

TEST(Mfem, WritesAttributesOfTheBoundary) {
  const TemporaryFolder folder;
  HexMesh mesh = cube();
  mesh.features.quads = {{{4, 5, 6, 7}, 2}};
  write(mesh, folder / "a.mesh", "mfem");
  EXPECT_EQ(contentOf(folder / "a.mesh"),
            "MFEM mesh v1.0\n\ndimension\n3\n\nelements\n1\n1 5 0 1 2 3 4 5 6 7\n\nboundary\n6\n"
            "2 3 4 5 6 7\n3 3 0 4 7 3\n3 3 1 2 6 5\n3 3 0 1 5 4\n3 3 3 7 6 2\n3 3 0 3 2 1\n"
            "\nvertices\n8\n3\n" +
                kPointLines);
}

TEST(Abaqus, WritesSetsAndSurfaces) {
  const TemporaryFolder folder;
  HexMesh mesh = cube();
  mesh.features.quads = {{{4, 5, 6, 7}, 2}};
  mesh.features.vertices = {{6, -3}};
  write(mesh, folder / "a.inp");
  const std::string text = contentOf(folder / "a.inp");
  EXPECT_TRUE(text.starts_with("*HEADING\nhexahedral mesh by hexhex\n*NODE\n1, 0, 0, 0\n"));
  const std::string tail =
      "*ELEMENT, TYPE=C3D8, ELSET=HEXAHEDRA\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
      "*NSET, NSET=N_SURFACE_2\n5, 6, 7, 8\n*NSET, NSET=N_BOUNDARY\n1, 2, 3, 4, 5, 6, 7, 8\n"
      "*NSET, NSET=N_POINT_M3\n7\n*SURFACE, TYPE=ELEMENT, NAME=S_SURFACE_2\n1, S2\n"
      "*SURFACE, TYPE=ELEMENT, NAME=S_BOUNDARY\n1, S6\n1, S4\n1, S3\n1, S5\n1, S1\n";
  EXPECT_EQ(text.substr(text.find("*ELEMENT")), tail);
}

/// A straight cell of order 2 in the box from 0 to (2, 4, 6).
LagrangeMesh boxOfOrder2() {
  LagrangeMesh mesh;
  mesh.order = 2;
  mesh.vertexCount = 8;
  mesh.points.resize(8);
  mesh.nodes.resize(27);
  for (Index i = 0; i < 27; ++i) {
    const std::array<Index, 3> at = {i % 3, i / 3 % 3, i / 9};
    const Vec3 point = {1.0 * at[0], 2.0 * at[1], 3.0 * at[2]};
    const bool isCorner = at[0] != 1 && at[1] != 1 && at[2] != 1;
    const Index node = isCorner ? at[0] / 2 + 2 * (at[1] / 2) + 4 * (at[2] / 2)
                                : static_cast<Index>(mesh.points.size());
    if (!isCorner) mesh.points.push_back({});
    mesh.points[node] = point;
    mesh.nodes[i] = node;
  }
  return mesh;
}

TEST(Abaqus, CellsOfOrder2HaveTwentyNodes) {
  const TemporaryFolder folder;
  Context context;
  LagrangeMesh mesh = boxOfOrder2();
  mesh.features.quads = {{{4, 5, 7, 6}, 2}};
  writeLagrangeMesh(mesh, folder / "a.inp", {}, context);
  const LagrangeMesh read = readLagrangeMesh(folder / "a.inp", context);
  ASSERT_EQ(read.cellCount(), 1U);
  for (std::size_t i = 0; i < 27; ++i) {  // what is left out is where a straight cell has it
    EXPECT_EQ(read.points[read.nodes[i]], mesh.points[mesh.nodes[i]]) << i;
  }
  EXPECT_EQ(read.features.quads.size(), 1U);
  const std::string text = contentOf(folder / "a.inp");
  std::string line;
  std::istringstream set(text.substr(text.find("*NSET, NSET=N_SURFACE_2")));
  std::getline(set, line);
  std::getline(set, line);  // at z = 6: four corners, and four in the middle of edges
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
  EXPECT_TRUE(line.starts_with("5, 6, 7, 8, ")) << line;
  EXPECT_NE(text.find("*SURFACE, TYPE=ELEMENT, NAME=S_SURFACE_2\n1, S2\n"), std::string::npos);
  mesh.order = 1;
  mesh.nodes = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh.points.resize(8);
  EXPECT_EQ(failureOf([&] { writeLagrangeMesh(mesh, folder / "b.inp", {}, context); }).code,
            ErrorCode::FileUnsupported);
}

TEST(HexFormats, SolversChooseTheirs) {
  const TemporaryFolder folder;
  Context context;
  writeHexMesh(cube(), folder / "a.msh", {.format = "dealii"}, context);
  EXPECT_TRUE(contentOf(folder / "a.msh").starts_with("$MeshFormat\n2.2 0"));
  for (const SolverFormat& solver : solverFormats()) {
    SCOPED_TRACE(solver.name);
    const std::filesystem::path file = folder / ("a" + std::string(solver.extension));
    EXPECT_EQ(findSolver(solver.name)->program, solver.program);
    EXPECT_NO_THROW(writeHexMesh(cube(), file, {.format = solver.name}, context));
    const auto writeCurved = [&] {
      writeLagrangeMesh(boxOfOrder2(), file, {.format = solver.name}, context);
    };
    if (solver.curved.empty()) {
      EXPECT_NE(failureOf(writeCurved).sentence.find(std::string(solver.program)),
                std::string::npos);
    } else {
      EXPECT_NO_THROW(writeCurved());
    }
  }
  EXPECT_EQ(findSolver("vtu"), nullptr);
}

TEST(Abaqus, FacesHaveAbaqusNumbers) {
  // From the documentation of C3D8: S1 is 1-2-3-4, S2 5-8-7-6, S3 1-5-6-2, S4 2-6-7-3, S5 3-7-8-4,
  // S6 4-8-5-1.
  constexpr std::array<Quad, 6> kFaces = {
      {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
  const TemporaryFolder folder;
  for (std::size_t face = 0; face < 6; ++face) {
    HexMesh mesh = cube();
    mesh.features.quads = {{kFaces[face], 1}};
    write(mesh, folder / "a.inp");
    EXPECT_NE(contentOf(folder / "a.inp").find("NAME=S_SURFACE_1\n1, S" + std::to_string(face + 1)),
              std::string::npos)
        << face;
  }
}

/// A line "number, x, y, z" of a node.
void expectNode(const std::string& line, std::size_t number, const Vec3& point, double tolerance) {
  std::istringstream fields(line);
  std::string field;
  std::getline(fields, field, ',');
  EXPECT_EQ(field, std::to_string(number));
  for (const double expected : point) {
    std::getline(fields, field, ',');
    EXPECT_LE(field.size(), 21U) << field;  // with the space in front
    const double found = std::strtod(field.c_str(), nullptr);
    EXPECT_LE(std::abs(found - expected), tolerance * std::abs(expected)) << field;
  }
}

TEST(Abaqus, NumbersHaveAtMostTwentyCharacters) {
  const TemporaryFolder folder;
  HexMesh mesh = cube();
  Random random(3);
  while (mesh.points.size() < 3000) {
    mesh.points.push_back({random.anyDouble(), random.anyDouble(), -1.2345678901234567e-308});
  }
  mesh.points[0] = {0.012345678901234567, -1.0 / 3, -0.1};
  write(mesh, folder / "a.inp");
  std::istringstream lines(contentOf(folder / "a.inp"));
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(lines, line);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    expectNode(line, i + 1, mesh.points[i], i < 8 ? 0 : 1e-12);
  }
}

}  // namespace
}  // namespace hexhex::test
