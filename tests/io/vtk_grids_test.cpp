// Structured grids of VTK, whose cells files imply: XML and legacy, by hand and as VTK writes them.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/mesh.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/core/registry.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>
#include <io/other_programs.hpp>

namespace hexhex::test::vtk_grids {

using namespace io;
namespace {

std::string xml(const std::string& type, const std::string& grid, const std::string& piece) {
  return "<VTKFile type=\"" + type + "\" version=\"1.0\" byte_order=\"LittleEndian\"><" + type +
         grid +
         "><Piece Extent=\"3 5 0 1 -1 0\"><CellData><DataArray type=\"Int32\" Name=\"region\" "
         "format=\"ascii\">5 6</DataArray></CellData>" +
         piece + "</Piece></" + type + "></VTKFile>";
}
std::string array(const std::string& numbers) {
  return "<DataArray type=\"Float64\" format=\"ascii\">" + numbers + "</DataArray>";
}

const std::string kPoints =
    "2 0 1 4 0 1 6 0 1 2 3 1 4 3 1 6 3 1 2 0 1.5 4 0 1.5 6 0 1.5 2 3 1.5 4 3 1.5 6 3 1.5";
const std::string kImage =
    xml("ImageData", " WholeExtent=\"3 5 0 1 -1 0\" Origin=\"-4 0 1.5\" Spacing=\"2 3 .5\"", "");
const std::string kTurned =
    xml("ImageData", " Origin=\"2 6 1.5\" Spacing=\"3 2 .5\" Direction=\"0 1 0 1 0 0 0 0 1\"", "");
const std::string kRectilinear =
    xml("RectilinearGrid", "",
        "<Coordinates>" + array("2 4 6") + array("0 3") + array("1 1.5") + "</Coordinates>");
const std::string kCurved =
    xml("StructuredGrid", "",
        "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + kPoints +
            "</DataArray></Points>");

const std::string kHead = "# vtk DataFile Version 3.0\nany\nASCII\nDATASET ";
const std::string kRegions = "CELL_DATA 2\nSCALARS region int 1\nLOOKUP_TABLE default\n5 6\n";
const std::string kOldImage =
    kHead + "STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nASPECT_RATIO 2 3 .5\nORIGIN 2 0 1\n" + kRegions;
const std::string kOldRectilinear =
    kHead +
    "RECTILINEAR_GRID\nFIELD FieldData 1\nTIME 1 1 double\n7\nDIMENSIONS 3 2 2\n"
    "X_COORDINATES 3 float\n2 4 6\nY_COORDINATES 2 int\n0 3\nZ_COORDINATES 2 double\n1 1.5\n" +
    kRegions;
const std::string kOldCurved =
    kHead + "STRUCTURED_GRID\nDIMENSIONS 3 2 2\nPOINTS 12 double\n" + kPoints + "\n" + kRegions;

HexMesh readFile(const std::string& text, const std::string& name) {
  const TemporaryFolder folder;
  writeText(folder / name, text);
  return readHexMesh(folder / name);
}

TEST(VtkGrids, AreHexahedraWithRegions) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {kImage, "a.vti"},    {kRectilinear, "a.vtr"},    {kCurved, "a.vts"},
      {kOldImage, "a.vtk"}, {kOldRectilinear, "b.vtk"}, {kOldCurved, "c.vtk"}};
  const HexMesh truth = readFile(kCurved, "a.vts");
  ASSERT_EQ(truth.points.size(), 12U);
  EXPECT_EQ(truth.points[10], (Vec3{4, 3, 1.5}));
  EXPECT_EQ(truth.cells, (Array<Hex>{{0, 1, 4, 3, 6, 7, 10, 9}, {1, 2, 5, 4, 7, 8, 11, 10}}));
  EXPECT_EQ(truth.regions, (Array<std::int32_t>{5, 6}));
  for (const auto& [text, name] : files) {
    SCOPED_TRACE(name + text.substr(0, 80));
    const HexMesh mesh = readFile(text, name);
    EXPECT_EQ(mesh.points, truth.points);
    EXPECT_EQ(mesh.cells, truth.cells);
    EXPECT_EQ(mesh.regions, truth.regions);
  }
  const HexMesh turned = readFile(kTurned, "a.vti");
  EXPECT_EQ(turned.points[1], (Vec3{2, 18, 1}));
  EXPECT_EQ(turned.points[3], (Vec3{4, 15, 1}));
}

TEST(VtkGrids, ArriveInPieces) {
  const TemporaryFolder folder;
  writeText(folder / "a.vti", kImage);
  Context context;
  readHexMeshTo(*openMeshSink(folder / "b.vtu", context), folder / "a.vti", context);
  const HexMesh whole = readHexMesh(folder / "a.vti");
  const HexMesh streamed = readHexMesh(folder / "b.vtu");
  EXPECT_EQ(streamed.points, whole.points);
  EXPECT_EQ(streamed.cells, whole.cells);
}

TEST(VtkGrids, SayWhatIsWrong) {
  struct Broken {
    std::string text;
    std::string from;
    std::string to;
    ErrorCode code;
    std::string words;
  };
  const std::string extent = "Piece Extent=\"3 5 0 1 -1 0\"";
  const std::vector<Broken> all = {
      {kImage, extent, "Piece Extent=\"3 5 0 0 -1 0\"", ErrorCode::FileUnsupported,
       "3 x 1 x 2 points has a single layer"},
      {kImage, extent, "Piece Extent=\"0 999 0 999 0 999\"", ErrorCode::TooLarge,
       "1000 x 1000 x 1000 points is larger"},
      {kImage, extent, "Piece Extent=\"3 5 0 1\"", ErrorCode::FileSyntax, "6 numbers as Extent"},
      {kImage, "2 3 .5", "2 x .5", ErrorCode::FileSyntax, "3 numbers as Spacing"},
      {kImage, "2 3 .5", "1e308 3 .5", ErrorCode::NotFinite, "not finite"},
      {kImage, "</Piece>", "</Piece><Piece/>", ErrorCode::FileUnsupported, "save it as one piece"},
      {kImage, "5 6", "5", ErrorCode::FileSyntax, "room for 1"},
      {kImage, "\"ImageData\"", "\"HyperTreeGrid\"", ErrorCode::FileUnsupported, "HyperTreeGrid"},
      {kRectilinear, array("1 1.5"), "", ErrorCode::FileSyntax, "has 2 arrays of coordinates"},
      {kRectilinear, "2 4 6", "2 4", ErrorCode::FileSyntax, "number"},
      {kCurved, "<Points>", "<Dots>", ErrorCode::FileSyntax, "no array of points"},
      {kOldImage, "3 2 2", "3 1 2", ErrorCode::FileUnsupported, "3 x 1 x 2 points"},
      {kOldImage, "3 2 2", "3 -2 2", ErrorCode::FileUnsupported, "3 x 0 x 2 points"},
      {kOldImage, "3 2 2", "3 99999 99999", ErrorCode::TooLarge, "points is larger"},
      {kOldImage, "DIMENSIONS 3 2 2", "", ErrorCode::FileUnsupported, "0 x 0 x 0 points"},
      {kOldImage, "DIMENSIONS 3", "DIMENSIONS -3", ErrorCode::FileUnsupported, "0 x 2 x 2 points"},
      {kOldImage, "CELL_DATA", "CELLS", ErrorCode::FileSyntax, "line 8: expected a section"},
      {kOldRectilinear, "DIMENSIONS 3", "DIMENSIONS 4", ErrorCode::FileSyntax,
       "announces 4 points or coordinates, but there are 3"},
      {kOldCurved, "DIMENSIONS 3", "DIMENSIONS 4", ErrorCode::FileSyntax,
       "announces 16 points or coordinates, but there are 12"}};
  for (const Broken& each : all) {
    SCOPED_TRACE(each.words);
    const Failure found = failureOf([&] {
      const bool legacy = each.text[0] == '#';
      Context context;
      const std::string text = replaced(each.text, each.from, each.to);
      if (!legacy) return static_cast<void>(readBytes<readVtu>(text, "a.vti", context));
      static_cast<void>(readBytes<readVtkLegacy>(text, "a.vtk", context));
    });
    EXPECT_EQ(found.code, each.code) << found.sentence;
    EXPECT_NE(found.sentence.find(each.words), std::string::npos) << found.sentence;
  }
}

TEST(VtkGrids, AreReadAsVtkWritesThem) {
  const TemporaryFolder folder;
  const std::filesystem::path written = folder / "written";
  std::filesystem::create_directory(written);
  const int code =
      runScript("grids_with.py", "'" + written.string() + "'", (folder / "errors").string());
  if (isMissing(code)) GTEST_SKIP() << "VTK for " << interpreter() << " is not installed";
  ASSERT_EQ(code, 0) << contentOf(folder / "errors");
  std::size_t grids = 0;
  std::size_t surfaces = 0;
  Context context;
  for (const auto& entry : std::filesystem::directory_iterator(written)) {
    const std::filesystem::path& file = entry.path();
    const std::string name = file.filename().string();
    SCOPED_TRACE(name);
    if (file.extension() == ".vtu" || (!hasZlib() && name.find("ZLib") != std::string::npos))
      continue;
    const std::string kind = name.substr(0, name.find('_'));
    if (kind == "cube") {
      EXPECT_TRUE(holdsSurface(file, context));
      const TriangleMesh cube = readTriangleMesh(file, context);
      EXPECT_EQ(cube.points.size(), 8U);
      EXPECT_EQ(cube.triangles.size(), 12U);
      ++surfaces;
      continue;
    }
    const HexMesh mesh = readHexMesh(file);
    const HexMesh truth = readHexMesh(written / (kind + ".vtu"));
    EXPECT_EQ(mesh.cells, truth.cells);
    if (file.extension() != ".vtk") {
      EXPECT_EQ(mesh.regions, truth.regions);
    }
    ASSERT_EQ(mesh.points.size(), truth.points.size());
    // Of turned images, the last bit depends on the order of products.
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mesh.points[i][k], truth.points[i][k], 1e-14);
    }
    ++grids;
  }
  EXPECT_GE(grids, 18U);
  EXPECT_GE(surfaces, 5U);
}

}  // namespace
}  // namespace hexhex::test::vtk_grids
