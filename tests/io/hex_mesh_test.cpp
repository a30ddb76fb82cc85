// `.mesh` and `.vtu` files: lossless round trips, tolerance, errors.
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::hex_mesh {

using namespace io;
namespace {

HexMesh mesh(const std::string& text) {
  Context context;
  return readBytes<Medit::readMesh>(text, "m.mesh", context);
}

HexMesh vtu(const std::string& text) {
  Context context;
  return readBytes<readVtu>(text, "m.vtu", context);
}

const std::string kHead = "MeshVersionFormatted 2\nDimension 3\n";
const std::string kCorners =
    "Vertices\n8\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n";
const std::string kCube = "Hexahedra\n1\n1 2 3 4 5 6 7 8 0\nEnd\n";

TEST(HexMeshFiles, RoundTripIsLossless) {
  const TemporaryFolder folder;
  HexMesh original = gridMesh(7, 5, 3);
  Random random(5);
  for (std::size_t i = 0; i < 20; ++i) original.points[i] = {random.anyDouble(), -0.0, 5e-324};
  for (const char* name : {"a.mesh", "a.vtu", "B.MESH", "B.Vtu"}) {
    writeHexMesh(original, folder / name);
    const HexMesh read = readHexMesh(folder / name);
    expectSameBits(original.points, read.points);
    EXPECT_EQ(original.cells, read.cells);
  }
  EXPECT_EQ(folder.fileCount(), 4U);
  EXPECT_EQ(contentOf(folder / "a.vtu"), contentOf(folder / "B.Vtu"));
}

TEST(HexMeshFiles, EmptyMeshes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.mesh", "a.vtu"}) {
    writeHexMesh(HexMesh{}, folder / name);
    EXPECT_TRUE(readHexMesh(folder / name).cells.empty());
  }
}

TEST(HexMeshFiles, WriterRefusesInconsistentMeshes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.mesh", "a.vtu"}) {
    HexMesh broken = gridMesh(2, 1, 1);
    broken.cells[1][3] = 12;
    const Failure failure = failureOf([&] { writeHexMesh(broken, folder / name); });
    EXPECT_EQ(failure.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(toString(failure.place), "cell 1");
    broken = gridMesh(2, 1, 1);
    broken.generatorCorners.resize(3, 15);
    EXPECT_EQ(failureOf([&] { writeHexMesh(broken, folder / name); }).code,
              ErrorCode::InvalidArgument);
    broken = gridMesh(2, 1, 1);
    broken.points[5][2] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(toString(failureOf([&] { writeHexMesh(broken, folder / name); }).place), "vertex 5");
  }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(HexMeshFiles, UnknownExtensionsNameTheKnownOnes) {
  for (const char* name : {"a.stl", "a", "a.", ".mesh", "a.hexex"}) {
    const Failure failure = failureOf([&] { requireHexMeshFormat(name); });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
    EXPECT_NE(failure.sentence.find(".mesh, .meshb, .vtu"), std::string::npos) << failure.sentence;
    EXPECT_EQ(failureOf([&] { writeHexMesh(HexMesh{}, name); }).code, ErrorCode::FileUnsupported);
    EXPECT_EQ(failureOf([&] { static_cast<void>(readHexMesh(name)); }).code,
              ErrorCode::FileUnsupported);
  }
  EXPECT_NO_THROW(requireHexMeshFormat("some.folder/a.b.MESH"));
  const Failure failure = failureOf([] { static_cast<void>(readMap("a.msh")); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find(".hexex"), std::string::npos);
  EXPECT_EQ(failureOf([] { writeMap(TetMap{}, "a.mesh"); }).code, ErrorCode::FileUnsupported);
}

TEST(HexMeshFiles, MissingFilesAndFolders) {
  const TemporaryFolder folder;
  for (const char* name : {"a.mesh", "a.vtu", "a.hexex"}) {
    const auto read = [&](const std::filesystem::path& file) {
      return failureOf([&] {
        if (file.extension() == ".hexex") {
          static_cast<void>(readMap(file));
        } else {
          static_cast<void>(readHexMesh(file));
        }
      });
    };
    const Failure missing = read(folder / name);
    EXPECT_EQ(missing.code, ErrorCode::FileNotFound);
    EXPECT_NE(missing.sentence.find("No such file"), std::string::npos) << missing.sentence;
    std::filesystem::create_directory(folder / name);
    const Failure directory = read(folder / name);
    EXPECT_EQ(directory.code, ErrorCode::FileNotFound);
    EXPECT_NE(directory.sentence.find("folder"), std::string::npos) << directory.sentence;
  }
}

TEST(Medit, WritesExactlyTheSectionsOfTheFormat) {
  const TemporaryFolder folder;
  writeHexMesh(mesh(kHead + kCorners + kCube), folder / "a.mesh");
  EXPECT_EQ(contentOf(folder / "a.mesh"),
            "MeshVersionFormatted 2\nDimension 3\n" + kCorners +
                "Quadrilaterals\n6\n1 5 8 4 1\n2 3 7 6 2\n1 2 6 5 3\n4 8 7 3 4\n1 4 3 2 5\n"
                "5 6 7 8 6\nHexahedra\n1\n1 2 3 4 5 6 7 8 1\nEnd\n");
}

TEST(Medit, BoundaryQuadsOnly) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(4, 3, 2), folder / "a.mesh");
  EXPECT_NE(contentOf(folder / "a.mesh").find("\nQuadrilaterals\n52\n"), std::string::npos);
}

TEST(Medit, OtherSectionsAndCommentsAreIgnored) {
  const std::string text =
      "# a comment\nMeshVersionFormatted\n1 # why not\n\nDimension\n3\nCorners 2 1 2\n" + kCorners +
      "Triangles\n1\n1 2 3 7\nNormals\n1\n-.5 0 1e-3\nRequiredVertices 0\n" + kCube + "garbage 12";
  const HexMesh read = mesh(text);
  EXPECT_EQ(read.points.size(), 8U);
  EXPECT_EQ(read.cells.at(0), (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(mesh(kHead + kCorners + kCube.substr(0, kCube.find("End"))).cells.size(), 1U);
}

struct BadFile {
  std::string text;
  ErrorCode code;
  std::uint64_t line;
  std::string words;
};

TEST(Medit, EveryDefectIsNamedWithItsLine) {
  const std::vector<BadFile> files = {
      {"", ErrorCode::FileSyntax, 1, "MeshVersionFormatted"},
      {"solid x\n", ErrorCode::FileSyntax, 1, "found \"solid\""},
      {"MeshVersionFormatted x\n", ErrorCode::FileSyntax, 1, "version"},
      {"MeshVersionFormatted 2\nDimension 2\n", ErrorCode::FileUnsupported, 2, "must be 3"},
      {"MeshVersionFormatted 2\nDimension\nthree\n", ErrorCode::FileSyntax, 3, "\"three\""},
      {kHead + "Vertices\n1000\n", ErrorCode::FileSyntax, 4, "room"},
      {kHead + "Vertices\n2\n0.123 0.123 0.123 0\n", ErrorCode::FileSyntax, 5, "1 of 2 vertices"},
      {kHead + "Vertices\n1\n0 0 z 0\n", ErrorCode::FileSyntax, 5, "coordinate of vertex 1"},
      {kHead + "Vertices\n1\n0 0 nan 0\n", ErrorCode::NotFinite, 5, "not finite"},
      {kHead + "Vertices\n1\n0 0 0 0.5\n", ErrorCode::FileSyntax, 5, "reference"},
      {kHead + kCorners + kCorners, ErrorCode::FileSyntax, 13, "second time"},
      {kHead + kCube, ErrorCode::FileUnsupported, 3, "before the section Vertices"},
      {kHead + kCorners + "Hexahedra\n-1\n", ErrorCode::FileSyntax, 14, "negative"},
      {kHead + kCorners + "Hexahedra\n9\n" + kCube, ErrorCode::FileSyntax, 14, "room"},
      {kHead + kCorners + "Hexahedra\n1\n1 2 3 4 5 6 7 8       ", ErrorCode::FileSyntax, 15, "end"},
      {kHead + kCorners + "Hexahedra\n1\n1 2 3 4 5 6 7 End 0", ErrorCode::FileSyntax, 15,
       "\"End\""},
  };
  for (const BadFile& file : files) {
    const Failure failure = failureOf([&] { static_cast<void>(mesh(file.text)); });
    EXPECT_EQ(name(failure.code), name(file.code)) << failure.sentence;
    EXPECT_TRUE(failure.sentence.starts_with("m.mesh, line " + std::to_string(file.line) + ": "))
        << failure.sentence;
    EXPECT_NE(failure.sentence.find(file.words), std::string::npos)
        << file.words << " | " << failure.sentence;
  }
}

TEST(Medit, VerticesOutOfRangeAndMissingSections) {
  for (const char* vertex : {"0", "9", "-3"}) {
    const Failure failure = failureOf(
        [&] { static_cast<void>(mesh(kHead + kCorners + replaced(kCube, "7", vertex))); });
    EXPECT_EQ(failure.code, ErrorCode::IndexOutOfRange);
    EXPECT_EQ(toString(failure.place), "cell 0");
    EXPECT_NE(failure.sentence.find("line 15"), std::string::npos);
  }
  EXPECT_EQ(failureOf([] { static_cast<void>(mesh(kHead + kCorners + "End\n")); }).code,
            ErrorCode::FileUnsupported);
}

/// A file with one hexahedron and one tetrahedron, all data as text.
std::string asciiVtu() {
  return R"(<?xml version="1.0"?>
<!-- a comment with <DataArray> in it -->
<VTKFile type='UnstructuredGrid' version="0.1" byte_order="LittleEndian">
  <UnstructuredGrid><FieldData><DataArray Name="a > b" format="ascii">1</DataArray></FieldData>
    <Piece NumberOfPoints="9" NumberOfCells="2">
      <Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
        0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 .5 .5 2
      </DataArray></Points>
      <Cells>
    <DataArray type="Int64" Name="connectivity" format="ascii">4 5 6 8 0 1 2 3 4 5 6 7</DataArray>
        <DataArray type="Int64" Name="offsets" format="ascii">4 12</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">10 12</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)";
}

TEST(Vtu, AsciiFilesAndOtherCells) {
  const HexMesh read = vtu(asciiVtu());
  ASSERT_EQ(read.points.size(), 9U);
  EXPECT_EQ(read.points[8], (Vec3{0.5, 0.5, 2}));
  ASSERT_EQ(read.cells.size(), 1U);
  EXPECT_EQ(read.cells[0], (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Vtu, HoldsGeneratorsAndQuality) {
  const TemporaryFolder folder;
  HexMesh grid = gridMesh(2, 1, 1);
  writeHexMesh(grid, folder / "a.vtu");
  EXPECT_EQ(contentOf(folder / "a.vtu").find("generator_kind"), std::string::npos);
  grid.generatorCorners.resize(grid.points.size(), 7);
  writeHexMesh(grid, folder / "a.vtu");
  const std::string text = contentOf(folder / "a.vtu");
  EXPECT_NE(text.find("<DataArray type=\"UInt8\" Name=\"generator_kind\" "
                      "format=\"appended\" offset=\"0\"/>"),
            std::string::npos);
  EXPECT_NE(text.find("Name=\"scaled_jacobian\""), std::string::npos);
  EXPECT_EQ(arrayOf(text, "generator_kind"), std::string(12, '\2'));
  EXPECT_EQ(arrayOf(text, "generator_corners"), std::string(12, '\7'));
  EXPECT_EQ(text.find("generator_tet"), std::string::npos);
  const std::vector<double> quality = numbersOf<double>(text, "scaled_jacobian");  // perfect boxes
  ASSERT_EQ(quality.size(), 2U);
  EXPECT_NEAR(quality[0], 1, 1e-12);
  EXPECT_NEAR(quality[1], 1, 1e-12);
  EXPECT_EQ(readHexMesh(folder / "a.vtu").cells, grid.cells);
}

TEST(Vtu, HoldsWhereVerticesComeFrom) {
  const TemporaryFolder folder;
  HexMesh grid = gridMesh(1, 1, 1);
  grid.generatorTet = {0, 1, 2, 3, 4, 5, 6, 4'000'000'000};
  grid.generatorCorners = {1, 2, 3, 7, 8, 12, 15, 4};
  writeHexMesh(grid, folder / "a.vtu");
  const std::string text = contentOf(folder / "a.vtu");
  EXPECT_EQ(numbersOf<std::uint32_t>(text, "generator_tet"),
            std::vector<std::uint32_t>(grid.generatorTet.begin(), grid.generatorTet.end()));
  EXPECT_EQ(numbersOf<std::uint8_t>(text, "generator_corners"),
            (std::vector<std::uint8_t>{1, 2, 3, 7, 8, 12, 15, 4}));
  EXPECT_EQ(numbersOf<std::uint8_t>(text, "generator_kind"),
            (std::vector<std::uint8_t>{0, 0, 1, 2, 0, 1, 3, 0}));
  grid.generatorTet.pop_back();
  EXPECT_EQ(failureOf([&] { writeHexMesh(grid, folder / "b.vtu"); }).code,
            ErrorCode::InvalidArgument);
}

TEST(Vtu, QualityOfTheCallerIsWrittenAndNotComputed) {
  const TemporaryFolder folder;
  const HexMesh grid = gridMesh(2, 1, 1);
  const std::vector<double> quality = {0.25, -0.5};
  Context context;
  writeHexMesh(grid, folder / "a.vtu", {quality}, context);
  EXPECT_EQ(numbersOf<double>(contentOf(folder / "a.vtu"), "scaled_jacobian"), quality);
  for (const StageTime& time : context.stageTimes()) EXPECT_NE(time.stage, "quality");
  const std::vector<double> tooMany(3);
  EXPECT_EQ(failureOf([&] { writeHexMesh(grid, folder / "b.vtu", {tooMany}, context); }).code,
            ErrorCode::InvalidArgument);
  EXPECT_EQ(folder.fileCount(), 1U);
}

/// The order of arrays is part of the bytes of a file, which do not change.
TEST(Vtu, QualityComesBeforeRegions) {
  const TemporaryFolder folder;
  HexMesh grid = gridMesh(2, 1, 1);
  grid.regions = {3, 4};
  Context context;
  const std::vector<double> quality = {0.25, -0.5};
  writeHexMesh(grid, folder / "a.vtu", {quality}, context);
  const std::string text = contentOf(folder / "a.vtu");
  const std::size_t regions = text.find("Name=\"region\"");
  ASSERT_NE(regions, std::string::npos);
  EXPECT_LT(text.find("Name=\"scaled_jacobian\""), regions);
}

/// A raw file with 32-bit headers, coordinates in Float32 and unsigned corners.
TEST(Vtu, OtherNumberTypes) {
  if (std::endian::native != std::endian::little) GTEST_SKIP();
  std::string data;
  const auto append = [&data]<class T>(const std::vector<T>& values) {
    const std::string offset = std::to_string(data.size());
    const auto bytes = static_cast<std::uint32_t>(values.size() * sizeof(T));
    data.append(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
    data.append(reinterpret_cast<const char*>(values.data()), bytes);
    return "format=\"appended\" offset=\"" + offset + "\"/>\n";
  };
  std::string xml =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"8\" NumberOfCells=\"1\">\n<Points><DataArray type=\"Float32\" ";
  xml += append(std::vector<float>(24, 0.25F)) + "</Points><Cells>";
  xml += "<DataArray Name=\"types\" type=\"UInt64\" " + append(std::vector<std::uint64_t>{12});
  xml += "<DataArray Name=\"offsets\" type=\"Int16\" " + append(std::vector<std::int16_t>{8});
  xml += "<DataArray Name=\"connectivity\" type=\"UInt8\" " +
         append(std::vector<std::uint8_t>{7, 6, 5, 4, 3, 2, 1, 0});
  xml += "</Cells></Piece></UnstructuredGrid><AppendedData encoding='raw'>_" + data;
  const HexMesh read = vtu(xml + "</AppendedData></VTKFile>");
  EXPECT_EQ(read.points[7], (Vec3{0.25, 0.25, 0.25}));
  EXPECT_EQ(read.cells.at(0), (Hex{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(Vtu, UnsupportedAndBrokenFilesSaySo) {
  const std::string good = asciiVtu();
  const std::vector<BadFile> files = {
      {"", ErrorCode::FileSyntax, 0, "no tag VTKFile"},
      {"<html><VTKFile>", ErrorCode::FileSyntax, 0, "no tag VTKFile"},
      {"<VTKFile type=\"Unstr", ErrorCode::FileSyntax, 1, "ends inside of the tag"},
      {"<!-- ", ErrorCode::FileSyntax, 1, "ends inside"},
      {good.substr(0, good.find("<Piece")), ErrorCode::FileSyntax, 0, "no tag Piece"},
      {replaced(good, "'UnstructuredGrid'", "'HyperTreeGrid'"), ErrorCode::FileUnsupported, 3,
       "\"HyperTreeGrid\""},
      {replaced(good, "version=\"0.1\"", "compressor=\"vtkBrotliDataCompressor\""),
       ErrorCode::FileUnsupported, 3, "none of VTK's compressors"},
      {replaced(good, "Little", "Middle"), ErrorCode::FileUnsupported, 3, "byte order"},
      {replaced(good, "</Piece>", "</Piece><Piece>"), ErrorCode::FileSyntax, 14, "NumberOfPoints"},
      {replaced(good, "\"9\"", "\"nine\""), ErrorCode::FileSyntax, 5, "\"nine\""},
      {replaced(good, "\"9\"", "\"10\""), ErrorCode::FileSyntax, 7, "found the end"},
      {replaced(good, "\"9\"", "\"8\""), ErrorCode::FileSyntax, 7, "expected the end"},
      {replaced(good, "\"9\"", "\"50\""), ErrorCode::FileSyntax, 6, "room"},
      {replaced(good, "\"9\"", "\"99999999999\""), ErrorCode::FileSyntax, 5, "room"},
      {replaced(good, ".5 .5", ".5 x"), ErrorCode::FileSyntax, 7, "\"x\""},
      {replaced(good, ".5 .5", ".5 nan"), ErrorCode::NotFinite, 7, "not finite"},
      {replaced(good, "\"types\" format=\"ascii\"", "\"types\" format=\"binary\""),
       ErrorCode::FileSyntax, 12, "incomplete"},
      {replaced(good, "\"types\" format=\"ascii\"", "\"types\" format=\"packed\""),
       ErrorCode::FileUnsupported, 12, "\"packed\""},
      {replaced(good, "\"types\"", "\"kinds\""), ErrorCode::FileSyntax, 0,
       "no array of cell types"},
      {replaced(good, "10 12<", "10 41<"), ErrorCode::FileUnsupported, 0, "no hexahedra"},
      {replaced(good, "4 12<", "4 13<"), ErrorCode::FileSyntax, 0, "corners of cell 1"},
      {replaced(good, "4 12<", "5 12<"), ErrorCode::FileSyntax, 0, "with 7 instead of 8"},
      {replaced(good, "4 12<", "4 -1<"), ErrorCode::FileSyntax, 0, "corners of cell 1"},
      {replaced(good, "6 7<", "6 9<"), ErrorCode::IndexOutOfRange, 0, "cell 1 names point 9"},
      {replaced(good, "6 7<", "6 -7<"), ErrorCode::IndexOutOfRange, 0, "cell 1 names point -7"},
      {replaced(good, "6 7<", "6 7.5<"), ErrorCode::FileSyntax, 10, "\"7.5\""},
      {replaced(good, "</VTKFile>", "<AppendedData encoding=\"base65\">_"),
       ErrorCode::FileUnsupported, 16, "base65"},
  };
  for (const BadFile& file : files) {
    const Failure failure = failureOf([&] { static_cast<void>(vtu(file.text)); });
    EXPECT_EQ(name(failure.code), name(file.code)) << failure.sentence;
    const std::string where =
        file.line == 0 ? "m.vtu: " : "m.vtu, line " + std::to_string(file.line) + ": ";
    EXPECT_TRUE(failure.sentence.starts_with(where)) << where << "| " << failure.sentence;
    EXPECT_NE(failure.sentence.find(file.words), std::string::npos)
        << file.words << " | " << failure.sentence;
  }
}

TEST(Vtu, CorruptOffsetsAndSizes) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(3, 2, 1), folder / "a.vtu");
  const std::string good = contentOf(folder / "a.vtu");
  const std::string offset = "offset=\"" + std::to_string(8 + 6 * 8);  // of the points
  for (const std::string& bad :
       {replaced(good, offset, "offset=\"999999"), replaced(good, offset, "offset=\"1"),
        replaced(good, offset, "offset=\"x"), replaced(good, offset, "offset=\"999999999999999999"),
        replaced(good, "\"Float64\" Name=\"Points\"", "\"Float32\" Name=\"Points\"")}) {
    EXPECT_EQ(failureOf([&] { static_cast<void>(vtu(bad)); }).code, ErrorCode::FileSyntax);
  }
  EXPECT_EQ(failureOf([&] {
              static_cast<void>(
                  vtu(replaced(good, "\"Float64\" Name=\"Points\"", "\"Int64\" Name=\"Points\"")));
            }).code,
            ErrorCode::FileUnsupported);
}

}  // namespace
}  // namespace hexhex::test::hex_mesh
