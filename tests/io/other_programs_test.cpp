// What other programs understand of our files: meshio, VTK, Gmsh and MFEM, all through Python, and
// each only if it is installed (HEXHEX_PYTHON: another interpreter than python3). Coordinates are
// compared bit for bit, cells corner by corner.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support/compressions.hpp>
#include <support/random.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/samples.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/io_test_support.hpp>
#include <io/other_programs.hpp>

namespace hexhex::test {

using namespace io;
namespace {

struct Check {
  std::string program;
  std::string format;  ///< as in WriteOptions; "-zlib" or "-lz4" behind it: compressed
  std::string file;
  std::string groups;  ///< what the program says of taggedGrid()
};

void PrintTo(const Check& check, std::ostream* stream) {
  *stream << check.program << " reads " << check.format;
}

class OtherPrograms : public testing::TestWithParam<Check> {};

TEST_P(OtherPrograms, ReadWhatWeWrite) {
  const Check& check = GetParam();
  const TemporaryFolder folder;
  const HexMesh mesh = taggedGrid();
  Context context;
  const WriteOptions options = optionsNamed(check.format);
  if (!isThere(options.compress)) GTEST_SKIP() << "the library for it is missing";
  writeHexMesh(mesh, folder / check.file, options, context);

  const std::string output = (folder / "out").string();
  const int code = runScript(
      "read_with.py", check.program + " '" + (folder / check.file).string() + "' '" + output + "'",
      output + ".errors");
  if (isMissing(code)) {
    GTEST_SKIP() << check.program << " for " << interpreter() << " is not installed";
  }
  ASSERT_EQ(code, 0) << contentOf(output + ".errors");

  const std::string points(reinterpret_cast<const char*>(mesh.points.data()),
                           mesh.points.size() * sizeof(Vec3));
  EXPECT_EQ(contentOf(output + ".points"), points);
  std::vector<std::int64_t> corners;
  for (const Hex& cell : mesh.cells) corners.insert(corners.end(), cell.begin(), cell.end());
  const std::string cells(reinterpret_cast<const char*>(corners.data()),
                          corners.size() * sizeof(std::int64_t));
  EXPECT_EQ(contentOf(output + ".cells"), cells);
  EXPECT_EQ(contentOf(output + ".groups"), check.groups);
}

// 32 boundary quads, three of them with a tag, and one tagged quad inside.
const std::string kNamed = "boundary 29\nsurface_3 2\nsurface_7 2\n";
const std::string kNumbered = "3 2\n7 2\n8 29\n";
const std::string kNodeSets =
    "N_BOUNDARY 34\nN_CURVE_5 3\nN_POINT_1 2\nN_POINT_2 1\nN_SURFACE_3 8\nN_SURFACE_7 6\n";

INSTANTIATE_TEST_SUITE_P(
    Formats, OtherPrograms,
    testing::Values(
        Check{"meshio", "msh", "a.msh", kNamed}, Check{"meshio", "msh41-ascii", "a.msh", kNamed},
        Check{"meshio", "msh22-ascii", "a.msh", kNamed}, Check{"gmsh", "msh", "a.msh", kNamed},
        Check{"gmsh", "msh41-ascii", "a.msh", kNamed},
        Check{"gmsh", "msh22-ascii", "a.msh", kNamed},
        Check{"meshio", "meshb", "a.meshb", "0 29\n3 2\n7 2\n"},
        Check{"meshio", "mesh", "a.mesh", "0 29\n3 2\n7 2\n"}, Check{"meshio", "vtk", "a.vtk", ""},
        Check{"meshio", "vtk-binary", "a.vtk", ""}, Check{"vtk", "vtk-binary", "a.vtk", ""},
        Check{"vtk", "vtu", "a.vtu", ""}, Check{"vtk", "vtu-zlib", "a.vtu", ""},
        Check{"vtk", "vtu-lz4", "a.vtu", ""}, Check{"meshio", "vtu", "a.vtu", ""},
        Check{"meshio", "vtu-zlib", "a.vtu", ""}, Check{"vtk", "vtk", "a.vtk", ""},
        Check{"mfem", "vtk", "a.vtk", "1 32\n"}, Check{"meshio", "inp", "a.inp", kNodeSets},
        Check{"mfem", "mfem", "a.mesh", kNumbered}),
    [](const auto& test) {
      std::string name = test.param.program + "_" + test.param.format;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(OtherProgramsAndPieces, GmshReadsWhatIsWrittenInPieces) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(3, 2, 2);
  Context context;
  writeHexMesh(mesh, folder / "a.vtu");
  readHexMeshTo(*openMeshSink(folder / "a.msh", context), folder / "a.vtu", context);
  const std::string output = (folder / "out").string();
  const int code =
      runScript("read_with.py", "gmsh '" + (folder / "a.msh").string() + "' '" + output + "'",
                output + ".errors");
  if (isMissing(code)) GTEST_SKIP() << "Gmsh for " << interpreter() << " is not installed";
  ASSERT_EQ(code, 0) << contentOf(output + ".errors");
  const std::string points(reinterpret_cast<const char*>(mesh.points.data()),
                           mesh.points.size() * sizeof(Vec3));
  EXPECT_EQ(contentOf(output + ".points"), points);
}

/// Maps that were read and written again by another program.
class OtherProgramsAndMaps : public testing::TestWithParam<std::string> {};

TEST_P(OtherProgramsAndMaps, GiveBackWhatTheyGot) {
  const TemporaryFolder folder;
  const std::filesystem::path written = folder / "written";
  std::filesystem::create_directory(written);
  SampleOptions sample;
  sample.charts = ChartStyle::Random;
  sample.jitter = 0.3;
  const TetMap map = generateSample(SampleKind::Sphere, sample).map;
  std::string arguments = GetParam() + " '" + written.string() + "'";
  for (const std::string format : {"vtk", "vtk-binary", "vtu", "vtu-zlib"}) {
    Context context;
    WriteOptions options = optionsNamed(format);
    if (!isThere(options.compress)) options.compress = Compression::None;
    const std::filesystem::path file = folder / (format + "." + format.substr(0, 3));
    writeMap(map, file, options, context);
    arguments += " '" + file.string() + "'";
  }
  const int code = runScript("maps_with.py", arguments, (folder / "errors").string());
  if (isMissing(code)) {
    GTEST_SKIP() << GetParam() << " for " << interpreter() << " is not installed";
  }
  ASSERT_EQ(code, 0) << contentOf(folder / "errors");
  std::size_t files = 0;
  Context context;
  for (const auto& entry : std::filesystem::directory_iterator(written)) {
    const std::filesystem::path& file = entry.path();
    SCOPED_TRACE(file.filename().string());
    ++files;
    if (file.filename().string().starts_with("tets")) {
      const TetMesh tets = readTetMesh(file, {}, context);
      // As text, meshio writes 16 digits.
      if (file.extension() != ".mesh") expectSameBits(tets.points, map.points);
      EXPECT_EQ(tets.tets, map.tets);
      continue;
    }
    const std::string name = file.filename().string();
    const bool isWithoutZlib = name.find("None") != std::string::npos ||
                               name.find("LZ4") != std::string::npos ||
                               name.find("LZMA") != std::string::npos;
    if (!hasZlib() && !isWithoutZlib) continue;
    const TetMap read = readMap(file);
    expectSameBits(read.points, map.points);
    EXPECT_EQ(read.tets, map.tets);
    EXPECT_EQ(read.parameters, map.parameters);
  }
  EXPECT_GE(files, 6U);
}

INSTANTIATE_TEST_SUITE_P(Programs, OtherProgramsAndMaps, testing::Values("vtk", "meshio"),
                         [](const auto& test) { return test.param; });

/// Gmsh writes other formats over their own libraries, such as CGNS.
TEST(HigherOrder, GmshWritesOtherFormats) {
  const TemporaryFolder folder;
  Context context;
  SampleOptions options;
  options.cells = 2;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const int order : {1, 2}) {
    const LagrangeMesh mesh = extractLagrange(map, order, {}, context);
    const std::filesystem::path source = folder / ("a" + std::to_string(order) + ".msh");
    if (order == 1) writeHexMesh(straightMesh(mesh), source);
    if (order > 1) writeLagrangeMesh(mesh, source, {}, context);
    for (const std::string extension : {"cgns", "inp", "vtk", "unv", "mesh"}) {
      if (order == 2 && (extension == "unv" || extension == "mesh")) continue;  // 27 nodes
      SCOPED_TRACE(extension + " of order " + std::to_string(order));
      const std::filesystem::path file = folder / ("b." + extension);
      const std::string errors = (folder / "errors").string();
      const int code = runScript("gmsh_files.py",
                                 "4.1 0 '" + source.string() + "' '" + file.string() + "'", errors);
      if (isMissing(code)) GTEST_SKIP() << "gmsh for " << interpreter() << " is not installed";
      ASSERT_EQ(code, 0) << contentOf(errors);
      if (extension == "cgns" && !hasHdf5()) continue;
      ASSERT_EQ(holdsLagrangeCells(file, context), order == 2);
      const HexMesh straight =
          order == 2 ? straightMesh(readLagrangeMesh(file, context)) : readHexMesh(file);
      EXPECT_EQ(straight.cells.size(), mesh.cellCount());
      EXPECT_EQ(straight.points.size(), mesh.vertexCount);
      if (order == 2) {
        EXPECT_TRUE(certify(readLagrangeMesh(file, context), context).allPositive());
      } else {
        for (const double measure : scaledJacobians(straight, context)) EXPECT_GT(measure, 0);
      }
    }
  }
}

/// Structured zones of CGNS by Gmsh, whose axes are left-handed.
TEST(OtherProgramsAndZones, GmshWritesStructuredZones) {
  if (!hasHdf5()) GTEST_SKIP() << "built without HDF5, or it cannot be loaded";
  const TemporaryFolder folder;
  const std::string file = (folder / "a.cgns").string();
  const std::string errors = (folder / "errors").string();
  const int code = runScript("gmsh_files.py", "boxes '" + file + "'", errors);
  if (isMissing(code)) GTEST_SKIP() << "gmsh for " << interpreter() << " is not installed";
  ASSERT_EQ(code, 0) << contentOf(errors);
  HexMesh mesh = readHexMesh(file);
  EXPECT_EQ(mesh.points.size(), 7U * 4 * 4);
  ASSERT_EQ(mesh.cells.size(), 2U * 27);
  Context context;
  reorient(mesh, context);
  for (const double measure : scaledJacobians(mesh, context)) EXPECT_NEAR(measure, 1, 1e-9);
  const auto& names = mesh.features.names;
  const auto inflow = std::find_if(names.begin(), names.end(),
                                   [](const TagName& name) { return name.name == "inflow"; });
  ASSERT_NE(inflow, names.end());
  std::size_t quads = 0;
  for (const FeatureQuad& quad : mesh.features.quads) {
    if (quad.tag != inflow->tag) continue;
    ++quads;
    for (const Index v : quad.vertices) EXPECT_EQ(mesh.points[v][0], 0);
  }
  EXPECT_EQ(quads, 9U);
  EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 1), 27);
}

/// Turns each cell by one of the 24 rotations.
void turnCells(LagrangeMesh& mesh) {
  const auto n = static_cast<std::size_t>(mesh.order) + 1;
  const std::size_t each = mesh.nodesPerCell();
  Random random(7);
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    for (std::size_t turn = random.below(24); turn > 0; --turn) {
      const std::vector<Index> old(
          mesh.nodes.begin() + static_cast<std::ptrdiff_t>(each * c),
          mesh.nodes.begin() + static_cast<std::ptrdiff_t>(each * (c + 1)));
      for (std::size_t i = 0; i < each; ++i) {
        const std::size_t x = i % n;
        const std::size_t y = i / n % n;
        const std::size_t z = i / n / n;
        mesh.nodes[each * c + i] =
            old[turn % 2 == 0 ? y + n * (z + n * x) : n - 1 - y + n * (x + n * z)];
      }
    }
  }
}

/// Nodes come back from MFEM: by vertices, edges, faces and cells, and cell by cell; as coordinates
/// of each node, or axis by axis; at the points of Gauss and Lobatto, too.
TEST(HigherOrder, MfemNumbersNodesInItsWay) {
  const TemporaryFolder folder;
  Context context;
  SampleOptions options;
  options.cells = 2;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  const std::string errors = (folder / "errors").string();
  const std::array<std::pair<int, std::string>, 9> kinds = {{{2, "H1 0"},
                                                             {2, "H1 1"},
                                                             {2, "L2 0"},
                                                             {2, "L2 1"},
                                                             {3, "H1 1"},
                                                             {3, "L2 0"},

                                                             {3, "H1@U 1"},
                                                             {5, "H1 0"},
                                                             {5, "L2 1"}}};
  for (const auto& [order, kind] : kinds) {
    SCOPED_TRACE(concat(kind, " of order ", order));
    LagrangeMesh mesh = extractLagrange(map, order, {}, context);
    turnCells(mesh);
    writeLagrangeMesh(mesh, folder / "a.mesh", {}, context);
    EXPECT_EQ(readLagrangeMesh(folder / "a.mesh", context).points.size(), mesh.points.size());
    const int code = runScript(
        "mfem_files.py",
        kind + " '" + (folder / "a.mesh").string() + "' '" + (folder / "b.mesh").string() + "'",
        errors);
    if (isMissing(code)) GTEST_SKIP() << "mfem for " << interpreter() << " is not installed";
    ASSERT_EQ(code, 0) << contentOf(errors);
    ASSERT_TRUE(holdsLagrangeCells(folder / "b.mesh", context));
    const LagrangeMesh read = readLagrangeMesh(folder / "b.mesh", context);
    ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
    EXPECT_EQ(read.points.size(), mesh.points.size());
    EXPECT_EQ(read.vertexCount, mesh.vertexCount);
    double farthest = 0;  // MFEM projects nodes
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        farthest = std::max(
            farthest, std::abs(read.points[read.nodes[i]][k] - mesh.points[mesh.nodes[i]][k]));
      }
    }
    EXPECT_LT(farthest, 1e-12);
  }
}

/// Cells of higher order come back from Gmsh, in all its files.
TEST(HigherOrder, GmshRewritesCellsOfHigherOrder) {
  const TemporaryFolder folder;
  Context context;
  const std::array<std::pair<int, std::vector<std::string>>, 2> kinds = {
      {{2, {"2.2 0", "2.2 1", "4 0", "4.1 1"}}, {3, {"4.1 0"}}}};
  SampleOptions options;
  options.cells = 2;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const auto& [order, versions] : kinds) {
    const LagrangeMesh mesh = extractLagrange(map, order, {}, context);
    writeLagrangeMesh(mesh, folder / "a.msh", {}, context);
    for (const std::string& version : versions) {
      SCOPED_TRACE(version + " of order " + std::to_string(order));
      const std::string errors = (folder / "errors").string();
      const int code = runScript(
          "gmsh_files.py",
          version + " '" + (folder / "a.msh").string() + "' '" + (folder / "b.msh").string() + "'",
          errors);
      if (isMissing(code)) GTEST_SKIP() << "gmsh for " << interpreter() << " is not installed";
      ASSERT_EQ(code, 0) << contentOf(errors);
      ASSERT_TRUE(holdsLagrangeCells(folder / "b.msh", context));
      const LagrangeMesh read = readLagrangeMesh(folder / "b.msh", context);
      ASSERT_EQ(read.order, order);
      ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
      EXPECT_EQ(read.vertexCount, mesh.vertexCount);
      double farthest = 0;  // Gmsh writes 16 digits
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          farthest = std::max(
              farthest, std::abs(read.points[read.nodes[i]][k] - mesh.points[mesh.nodes[i]][k]));
        }
      }
      EXPECT_LT(farthest, 1e-14);
    }
  }
}

}  // namespace
}  // namespace hexhex::test
