// Formats over libraries of others, and OpenFOAM's: what VTK and checkMesh understand of them, if
// they are installed (HEXHEX_PYTHON: another interpreter than python3), and the rules of polyMesh.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/file_size_limit.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>
#include <io/other_programs.hpp>

namespace hexhex::test::optional_formats {

using namespace io;
namespace {

/// With two regions.
HexMesh meshWithTags() {
  HexMesh mesh = taggedGrid();
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) mesh.regions.push_back(c % 3 == 1 ? 2 : 4);
  return mesh;
}

/// The cells in order of their regions, as these formats list them.
Array<Hex> byRegion(const HexMesh& mesh) {
  Array<Hex> cells;
  for (const std::int32_t region :
       std::set<std::int32_t>(mesh.regions.begin(), mesh.regions.end())) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      if (mesh.regions[c] == region) cells.push_back(mesh.cells[c]);
    }
  }
  return cells;
}

bool write(const HexMesh& mesh, const std::filesystem::path& file, std::string_view format = {}) {
  Context context;
  WriteOptions options;
  options.format = format;
  try {
    writeHexMesh(mesh, file, options, context);
    return true;
  } catch (const Error& error) {
    const std::string sentence = error.what();
    if (sentence.find("this build of hexhex cannot") == std::string::npos) throw;
    EXPECT_EQ(error.code(), ErrorCode::FileUnsupported);
    return false;
  }
}

template <class T>
std::string bytesOf(const T* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

/// @param single  were coordinates read as float?
void expectPoints(const std::string& bytes, const HexMesh& mesh, bool single) {
  ASSERT_EQ(bytes.size(), mesh.points.size() * sizeof(Vec3));
  for (std::size_t i = 0; i < 3 * mesh.points.size(); ++i) {
    double found = 0;
    std::memcpy(&found, bytes.data() + i * sizeof(double), sizeof(double));
    const double expected = mesh.points[i / 3][i % 3];
    EXPECT_EQ(found, single ? double{static_cast<float>(expected)} : expected)
        << "vertex " << i / 3;
  }
}

struct Check {
  std::string format;
  std::string file;
  bool sortedByRegion;
  bool sortedCorners;
  std::string groups;
};

void PrintTo(const Check& check, std::ostream* stream) { *stream << check.format; }

/// Has VTK read the file of meshWithTags().
void expectRead(const Check& check, const TemporaryFolder& folder) {
  const HexMesh mesh = meshWithTags();
  const std::string output = (folder / "out").string();
  const int code =
      runScript("read_optional.py",
                check.format + " '" + (folder / check.file).string() + "' '" + output + "'",
                output + ".errors");
  if (isMissing(code)) GTEST_SKIP() << "VTK for Python is not installed";
  ASSERT_EQ(code, 0) << contentOf(output + ".errors");
  expectPoints(contentOf(output + ".points"), mesh, check.format == "openfoam");
  const Array<Hex> cells = check.sortedByRegion ? byRegion(mesh) : mesh.cells;
  std::vector<std::int64_t> corners;
  for (Hex cell : cells) {
    if (check.sortedCorners) std::sort(cell.begin(), cell.end());
    corners.insert(corners.end(), cell.begin(), cell.end());
  }
  EXPECT_EQ(contentOf(output + ".cells"), bytesOf(corners.data(), corners.size()));
  EXPECT_EQ(contentOf(output + ".groups"), check.groups);
}

class OptionalFormats : public testing::TestWithParam<Check> {};

TEST_P(OptionalFormats, VtkReadsWhatWeWrite) {
  const Check& check = GetParam();
  const TemporaryFolder folder;
  if (!write(meshWithTags(), folder / check.file)) {
    GTEST_SKIP() << check.format << " is not built in";
  }
  expectRead(check, folder);
}

// 32 boundary quads, three of them with a tag, and one tagged quad inside.
const char* const kExodusGroups =
    "boundary 29\ncurve_5 3\npoint_1 2\npoint_2 1\nregion_2 4\nregion_4 8\n"
    "surface_3 1\nsurface_7 2\n";
INSTANTIATE_TEST_SUITE_P(
    Formats, OptionalFormats,
    testing::Values(Check{"vtkhdf", "a.vtkhdf", false, false,
                          "region_2 4\nregion_4 8\nsurface_3 2\nsurface_7 2\n"},
                    Check{"exodus", "a.exo", true, false, kExodusGroups},
                    Check{"cgns", "a.cgns", true, false, "patches 3\nquads 32\n"},
                    Check{"openfoam", "a.foam", false, true,
                          "boundary 29\nregion_2 4\nregion_4 8\nsurface_3 1\nsurface_7 2\n"}),
    [](const auto& test) { return test.param.format; });

// The layout of meshes whose arrays take 4 GB, for one that is small.
TEST(Exodus, VtkReadsWideFiles) {
  const TemporaryFolder folder;
  Context context;
  const HexMesh mesh = meshWithTags();
  const std::uint64_t largest = mesh.points.size() * sizeof(double);
  const auto write = [&](std::uint64_t mostBytes) {
    writeBy(folder / "a.exo", context, [&](OutputFile& output, Stage& stage) {
      writeExodus(mesh, output, {}, stage, mostBytes);
    });
  };
  write(largest - 1);
  EXPECT_EQ(contentOf(folder / "a.exo").substr(0, 4), "CDF\5");
  expectRead({"exodus", "a.exo", true, false, kExodusGroups}, folder);
  write(largest);
  EXPECT_EQ(contentOf(folder / "a.exo").substr(0, 4), "CDF\2");
}

TEST(Exodus, BytesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(40, 30, 20);
  std::vector<std::string> bytes;
  for (const int threads : {1, 2, 5}) {
    Context context(threads);
    writeHexMesh(mesh, folder / "a.exo", context);
    bytes.push_back(contentOf(folder / "a.exo"));
  }
  EXPECT_TRUE(bytes[0] == bytes[1] && bytes[0] == bytes[2]);
}

/// The numbers of one file of a polyMesh, without its head.
std::vector<std::int64_t> numbersIn(const std::filesystem::path& file) {
  std::string text = contentOf(file);
  text.erase(0, text.find("}\n\n") + 3);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')'; }, ' ');
  std::istringstream stream(text);
  std::vector<std::int64_t> numbers;
  std::int64_t number = 0;
  stream >> number;  // how many elements follow
  numbers.push_back(number);
  while (stream >> number) numbers.push_back(number);
  return numbers;
}

TEST(OpenFoam, FacesKeepTheRules) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(4, 3, 5);
  write(mesh, folder / "polyMesh", "openfoam");
  const auto faces = numbersIn(folder / "polyMesh" / "faces");
  const auto owner = numbersIn(folder / "polyMesh" / "owner");
  const auto neighbour = numbersIn(folder / "polyMesh" / "neighbour");
  const auto count = static_cast<std::size_t>(faces[0]);
  const auto inner = static_cast<std::size_t>(neighbour[0]);
  ASSERT_EQ(count, 3U * 4 * 3 * 5 + 4 * 3 + 4 * 5 + 3 * 5);
  ASSERT_EQ(inner, count - 2 * (4 * 3 + 4 * 5 + 3 * 5));
  ASSERT_EQ(faces.size(), 1 + 5 * count);
  ASSERT_EQ(owner.size(), 1 + count);
  ASSERT_EQ(neighbour.size(), 1 + inner);
  const auto isFaceOf = [&](std::size_t f, std::int64_t cell, bool reversed) {
    Quad quad{};
    for (std::size_t i = 0; i < 4; ++i) quad[i] = static_cast<Index>(faces[1 + 5 * f + 1 + i]);
    if (reversed) std::reverse(quad.begin(), quad.end());
    for (std::size_t turn = 0; turn < 4; ++turn) {
      std::rotate(quad.begin(), quad.begin() + 1, quad.end());
      for (std::size_t side = 0; side < 6; ++side) {
        if (adjacency::faceVertices(mesh.cells[static_cast<std::size_t>(cell)], side) == quad)
          return true;
      }
    }
    return false;
  };
  std::array<std::int64_t, 2> before = {-1, -1};
  for (std::size_t f = 0; f < count; ++f) {
    EXPECT_EQ(faces[1 + 5 * f], 4);
    EXPECT_TRUE(isFaceOf(f, owner[1 + f], false)) << "faces look out of their owner";
    if (f >= inner) continue;
    EXPECT_TRUE(isFaceOf(f, neighbour[1 + f], true));
    const std::array<std::int64_t, 2> here = {owner[1 + f], neighbour[1 + f]};
    EXPECT_LT(here[0], here[1]);
    EXPECT_LT(before, here) << "upper triangular";
    before = here;
  }
  const std::string boundary = contentOf(folder / "polyMesh" / "boundary");
  EXPECT_NE(boundary.find("\n6\n(\n    patch_1\n"), std::string::npos) << boundary;
  EXPECT_NE(contentOf(folder / "polyMesh" / "cellZones").find("\n0\n(\n)\n"), std::string::npos);
}

TEST(OpenFoam, MeshesComeBackWithPatchesAndZones) {
  const TemporaryFolder folder;
  HexMesh mesh = meshWithTags();
  mesh.regions.assign(mesh.cells.size(), 4);
  mesh.regions[1] = 9;
  write(mesh, folder / "a.foam");
  const HexMesh read = readHexMesh(folder / "a.foam");
  expectSameBits(read.points, mesh.points);
  EXPECT_EQ(read.regions, mesh.regions);
  ASSERT_EQ(read.cells.size(), mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    Hex here = read.cells[c];
    Hex there = mesh.cells[c];
    std::sort(here.begin(), here.end());
    std::sort(there.begin(), there.end());
    EXPECT_EQ(here, there);
  }
  Context context;
  for (const double measure : scaledJacobians(read, context)) EXPECT_GT(measure, 0);
}

TEST(OpenFoam, FilesOfOtherPrograms) {
  const TemporaryFolder folder;
  const std::filesystem::path poly = folder / "constant" / "polyMesh";
  std::filesystem::create_directories(poly);
  const std::string head =
      "/*--- C++ ---*\\\n\\*----*/\nFoamFile\n{\n    version 2.0;\n    format ascii;\n}\n// * * "
      "//\n\n";
  const auto put = [&](const char* name, const std::string& text) {
    std::ofstream(poly / name) << head << text;
  };
  put("points", "8((0 0 0)(1 0 0)(1 1 0)(0 1 0)\n(0 0 1) (1 0 1) (1 1 1) (0 1 1))\n");
  const std::string faces =
      "6\n(\n4(0 3 2 1)\n4(4 5 6 7)\n4(0 1 5 4) // a wall\n4(1 2 6 5)\n4(2 3 7 6)\n4(3 0 4 7)\n)\n";
  put("faces", faces);
  put("owner", "6{0}\n");
  put("neighbour", "0()\n");
  put("boundary",
      "2\n(\n  inlet { type patch; nFaces 1; startFace 0; }\n"
      "  rest\n  {\n    type wall;\n    inGroups 1(wall);\n    nFaces 5;\n"
      "    startFace 1;\n  }\n)\n");
  const auto readIt = [&] { return readHexMesh(folder / "a.foam"); };
  const HexMesh mesh = readIt();
  ASSERT_EQ(mesh.cells.size(), 1U);
  Context context;
  EXPECT_EQ(scaledJacobians(mesh, context)[0], 1);
  ASSERT_EQ(mesh.features.quads.size(), 6U);
  EXPECT_EQ(mesh.features.quads[0].tag, 1);
  EXPECT_EQ(mesh.features.quads[5].tag, 2);
  ASSERT_EQ(mesh.features.names.size(), 2U);
  EXPECT_EQ(mesh.features.names[0].name, "inlet");
  EXPECT_TRUE(mesh.regions.empty());
  const auto expectFailure = [&](ErrorCode code, const std::string& words) {
    const Failure failure = failureOf([&] { static_cast<void>(readIt()); });
    EXPECT_EQ(failure.code, code) << failure.sentence;
    EXPECT_NE(failure.sentence.find(words), std::string::npos) << failure.sentence;
  };
  put("owner", "6(0 0 0 0 0 7)\n");
  expectFailure(ErrorCode::IndexOutOfRange, "cell 7");
  put("owner", "5(0 0 0 0 0)\n");
  expectFailure(ErrorCode::FileSyntax, "6 faces, but 5 owners");
  put("owner", "6(0 0 0 0 0 0)\n");
  put("faces", replaced(faces, "3 0 4 7", "3 0 4 8"));
  expectFailure(ErrorCode::IndexOutOfRange, "faces, line 17: a corner of a face is 8");
  put("faces", replaced(faces, "4(3 0 4 7)", "3(3 0 4)"));
  expectFailure(ErrorCode::FileUnsupported, "it holds 1 polyhedron");
  std::ofstream(poly / "faces") << replaced(head, "ascii", "binary") << faces;
  expectFailure(ErrorCode::FileUnsupported, "foamFormatConvert");
  std::filesystem::remove(poly / "faces");
  expectFailure(ErrorCode::FileNotFound, "polyMesh/faces");
}

TEST(OpenFoam, CheckMeshIsContent) {
  const char* const configured = std::getenv("WM_PROJECT_DIR");
  const std::filesystem::path project =
      configured != nullptr ? configured : "/usr/share/openfoam";  // Debian's
  if (runCommand("command -v checkMesh > /dev/null") != 0 || !std::filesystem::exists(project)) {
    GTEST_SKIP() << "OpenFOAM is not installed";
  }
  const TemporaryFolder folder;
  write(meshWithTags(), folder / "a.foam");
  std::filesystem::create_directory(folder / "system");
  for (const char* name : {"controlDict", "fvSchemes", "fvSolution"}) {
    std::ofstream(folder / "system" / name)
        << "FoamFile { version 2.0; format ascii; class dictionary; object " << name
        << "; }\nstartFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;\n"
           "writeControl timeStep; writeInterval 1;\ngradSchemes {} divSchemes {}\n"
           "laplacianSchemes {} interpolationSchemes {} snGradSchemes {} ddtSchemes {}\n";
  }
  const std::string log = (folder / "log").string();
  EXPECT_EQ(runCommand("WM_PROJECT_DIR='" + project.string() + "' checkMesh -allTopology -case '" +
                       (folder / "").string() + "' > '" + log + "' 2>&1"),
            0);
  EXPECT_NE(contentOf(log).find("\nMesh OK."), std::string::npos) << contentOf(log);
}

TEST(OpenFoam, OtherFilesStayAndFoldersAppear) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "constant" / "polyMesh");
  std::ofstream(folder / "constant" / "polyMesh" / "mine") << "kept";
  write(gridMesh(1, 1, 1), folder / "a.FOAM");
  EXPECT_EQ(contentOf(folder / "constant" / "polyMesh" / "mine"), "kept");
  EXPECT_TRUE(std::filesystem::exists(folder / "constant" / "polyMesh" / "faces"));
  EXPECT_EQ(contentOf(folder / "a.FOAM"), "");
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(failureOf([&] { write(gridMesh(1, 1, 1), folder / "file" / "b.foam"); }).code,
            ErrorCode::FileWrite);
}

TEST(OptionalFormats, FilesAppearCompleteOrNotAtAll) {
  const TemporaryFolder folder;
  const std::array<std::array<const char*, 2>, 4> all = {
      {{"vtkhdf", "a.vtkhdf"}, {"cgns", "a.cgns"}, {"exodus", "a.exo"}, {"exodus", "a.e"}}};
  for (const auto& entry : all) {
    const char* const format = entry[0];
    const char* const name = entry[1];
    const HexMesh mesh = meshWithTags();
    if (!write(mesh, folder / name)) continue;
    const std::size_t files = folder.fileCount();
    const std::string bytes = contentOf(folder / name);
    HexMesh broken = mesh;
    broken.features.vertices[0].vertex = 1000;
    EXPECT_EQ(failureOf([&] { write(broken, folder / name); }).code, ErrorCode::InvalidArgument)
        << name;
    EXPECT_EQ(failureOf([&] { write(mesh, folder / "no/such/folder" / name); }).code,
              ErrorCode::FileWrite);
    // HDF5 writes at any position.
    if (std::string(format) == "exodus") {
      EXPECT_TRUE(write(mesh, "/dev/null", format));
    } else {
      EXPECT_EQ(failureOf([&] { write(mesh, "/dev/null", format); }).code, ErrorCode::FileWrite);
    }
    EXPECT_TRUE(contentOf(folder / name) == bytes) << name;
    EXPECT_EQ(folder.fileCount(), files) << name;
    // Empty meshes are legal, but the CGNS library does not take them.
    if (std::string(format) == "cgns") {
      EXPECT_EQ(failureOf([&] { write(HexMesh{}, folder / name); }).code,
                ErrorCode::InvalidArgument);
    } else {
      EXPECT_TRUE(write(HexMesh{}, folder / name));
    }
  }
}

// A library that could not write crashed when the process ended; see also test_command.py.
TEST(OptionalFormats, FullDiskLeavesNothing) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(20, 20, 20);
  for (const char* name : {"a.vtkhdf", "a.cgns", "a.exo", "a.foam"}) {
    const TemporaryFolder other;
    if (!write(gridMesh(1, 1, 1), other / name)) continue;
    const FileSizeLimit limit(100'000);
    EXPECT_EQ(failureOf([&] { write(mesh, folder / name); }).code, ErrorCode::FileWrite) << name;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
  }
}

TEST(OptionalFormats, TheClockIsNotInTheFile) {
  const TemporaryFolder folder;
  std::vector<std::string> bytes;
  const std::array<const char*, 3> names = {"a.vtkhdf", "a.cgns", "a.exo"};
  for (const char* name : names) {
    bytes.push_back(write(meshWithTags(), folder / name) ? contentOf(folder / name) : "");
  }
  // HDF5 counts whole seconds.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!write(meshWithTags(), folder / names[i])) continue;
    EXPECT_TRUE(contentOf(folder / names[i]) == bytes[i]) << names[i];
  }
}

// Names go through libraries and, in tests, shells: nothing may be executed or created elsewhere.
TEST(OptionalFormats, NamesAreNothingButNames) {
  const TemporaryFolder folder;
  const std::array<std::string, 4> names = {"a b;touch injected", "$(touch injected)",
                                            "`touch injected`\n%s%n", "..'\"<&>"};
  for (const std::string& name : names) {
    for (const char* extension :
         {".vtkhdf", ".cgns", ".exo", ".vtu", ".mesh", ".msh", ".inp", ".vtk", ".ovmb"}) {
      const auto file = folder / (name + extension);
      if (!write(meshWithTags(), file)) continue;
      EXPECT_TRUE(std::filesystem::remove(file)) << file;
    }
  }
  EXPECT_EQ(folder.fileCount(), 0U);
  EXPECT_FALSE(std::filesystem::exists("injected"));
}

}  // namespace
}  // namespace hexhex::test::optional_formats
