// Files over HDF5 as other programs write them: by the libraries of NetCDF and HDF5, through Python
// and only if they are installed.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/samples.hpp>

#include <io/core/hdf5_library.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>
#include <io/other_programs.hpp>

namespace hexhex::test::hdf_files {

using namespace io;
namespace {

/// Has a script of this folder write a file.
/// @return an empty text, or why there is none
std::string makeFile(const std::string& kind, const std::filesystem::path& file) {
  try {
    requireHdf5(file);
  } catch (const Error& error) {
    return error.what();
  }
  const std::string errors = file.string() + ".errors";
  const int code = runScript("hdf_files.py", kind + " '" + file.string() + "'", errors);
  if (isMissing(code)) return "netCDF4 and h5py for " + interpreter() + " are not installed";
  EXPECT_EQ(code, 0) << contentOf(errors);
  return {};
}

void expectExodus(const HexMesh& mesh) {
  EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}}));
  ASSERT_EQ(mesh.points.size(), 12U);
  EXPECT_EQ(mesh.points[9], (Vec3{2, 1, 0}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{30, 7}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);
  EXPECT_EQ(mesh.features.quads[0].tag, 5);
  Quad corners = mesh.features.quads[0].vertices;
  std::sort(corners.begin(), corners.end());
  EXPECT_EQ(corners, (Quad{0, 3, 4, 7}));
  ASSERT_EQ(mesh.features.vertices.size(), 1U);
  EXPECT_EQ(mesh.features.vertices[0].vertex, 6U);
  EXPECT_EQ(mesh.features.vertices[0].tag, 9);
  ASSERT_EQ(mesh.features.names.size(), 2U);
  EXPECT_EQ(mesh.features.names[0].name, "steel");
  EXPECT_EQ(mesh.features.names[0].tag, 30);
  EXPECT_EQ(mesh.features.names[1].name, "inlet");
  EXPECT_EQ(mesh.features.names[1].dimension, 2);
}

TEST(HdfFiles, ExodusOfNetcdf4) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.e";
  if (const std::string why = makeFile("exodus", file); !why.empty()) GTEST_SKIP() << why;
  Context context;
  EXPECT_FALSE(holdsLagrangeCells(file, context));
  expectExodus(readHexMesh(file));
  expectExodus(readBytes<ExodusFormat::readMesh>(contentOf(file), "a.e", context));

  ASSERT_EQ(makeFile("exodus27", file), "");
  ASSERT_TRUE(holdsLagrangeCells(file, context));
  const LagrangeMesh mesh = readLagrangeMesh(file, context);
  EXPECT_EQ(mesh.points.size(), 27U);
  EXPECT_TRUE(certify(mesh, context).allPositive());

  ASSERT_EQ(makeFile("exodus-lies", file), "");
  const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(file)); });
  EXPECT_EQ(failure.code, ErrorCode::FileSyntax);
  EXPECT_NE(failure.sentence.find("\"connect1\" has more values than the file has bytes for"),
            std::string::npos)
      << failure.sentence;
}

TEST(HdfFiles, CutOffFilesAreRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.e";
  if (const std::string why = makeFile("exodus", file); !why.empty()) GTEST_SKIP() << why;
  const std::string good = contentOf(file);
  Context context;
  for (std::size_t size = 8; size < good.size(); size += good.size() / 30) {
    const Failure failure = failureOf([&] {
      static_cast<void>(readBytes<ExodusFormat::readMesh>(good.substr(0, size), "a.e", context));
    });
    EXPECT_EQ(failure.code, ErrorCode::FileSyntax) << size << failure.sentence;
  }
}

TEST(HdfFiles, CgnsWithConditionsAndFamilies) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.cgns";
  for (const std::string kind : {"cgns", "cgns-mixed"}) {
    SCOPED_TRACE(kind);
    if (const std::string why = makeFile(kind, file); !why.empty()) GTEST_SKIP() << why;
    const HexMesh mesh = readHexMesh(file);
    EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}}));
    EXPECT_EQ(mesh.points[9], (Vec3{2, 1, 0}));
    EXPECT_TRUE(mesh.regions.empty());
    ASSERT_EQ(mesh.features.quads.size(), 2U);
    EXPECT_EQ(mesh.features.quads[0].vertices, (Quad{0, 4, 7, 3}));
    EXPECT_EQ(mesh.features.quads[0].tag, 1);
    EXPECT_EQ(mesh.features.quads[1].vertices, (Quad{8, 9, 11, 10}));
    EXPECT_EQ(mesh.features.quads[1].tag, 2);
    ASSERT_EQ(mesh.features.names.size(), 2U);
    EXPECT_EQ(mesh.features.names[0].name, "inflow");  // the family's
    EXPECT_EQ(mesh.features.names[1].name, "BC-2");
  }
}

TEST(HdfFiles, NamesOfOtherFilesAreNotFollowed) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.cgns";
  for (const std::string kind : {"cgns-link", "cgns-raw", "cgns-virtual"}) {
    SCOPED_TRACE(kind);
    if (const std::string why = makeFile(kind, file); !why.empty()) GTEST_SKIP() << why;
    EXPECT_TRUE(std::filesystem::exists(folder / "a.cgns.other"));
    const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(file)); });
    EXPECT_EQ(failure.code, ErrorCode::FileSyntax) << failure.sentence;
  }
}

TEST(HdfFiles, CgnsOfOrder2AndOfSeveralZones) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.cgns";
  Context context;
  for (const std::string kind : {"cgns20", "cgns27"}) {
    SCOPED_TRACE(kind);
    if (const std::string why = makeFile(kind, file); !why.empty()) GTEST_SKIP() << why;
    ASSERT_TRUE(holdsLagrangeCells(file, context));
    const LagrangeMesh mesh = readLagrangeMesh(file, context);
    ASSERT_EQ(mesh.points.size(), 27U);
    EXPECT_TRUE(certify(mesh, context).allPositive());
  }
  ASSERT_EQ(makeFile("cgns-zones", file), "");
  const HexMesh mesh = readHexMesh(file);
  EXPECT_EQ(mesh.points.size(), 12U);
  EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 2}));
  const auto sentence = [&](const char* kind) {
    EXPECT_EQ(makeFile(kind, file), "");
    return failureOf([&] { static_cast<void>(readHexMesh(file)); }).sentence;
  };
  EXPECT_NE(sentence("cgns-apart").find("nothing says which vertices"), std::string::npos);
  EXPECT_NE(sentence("cgns-structured").find("not unstructured"), std::string::npos);
  EXPECT_NE(sentence("cgns-beyond").find("names vertex 13, but its zone has 12"),
            std::string::npos);
}

TEST(HdfFiles, VtkHdfOfOthersOfOneAndOfTwoPartitions) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.vtkhdf";
  for (const std::string kind : {"vtkhdf", "vtkhdf-parts"}) {
    SCOPED_TRACE(kind);
    if (const std::string why = makeFile(kind, file); !why.empty()) GTEST_SKIP() << why;
    const HexMesh mesh = readHexMesh(file);
    EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}}));
    ASSERT_EQ(mesh.points.size(), 12U);
    EXPECT_EQ(mesh.points[9], (Vec3{2, 1, 0}));
    EXPECT_EQ(mesh.regions, (Array<std::int32_t>{4, 5}));
  }
  const auto sentence = [&](const char* kind) {
    EXPECT_EQ(makeFile(kind, file), "");
    return failureOf([&] { static_cast<void>(readHexMesh(file)); }).sentence;
  };
  EXPECT_NE(sentence("vtkhdf-image").find("\"ImageData\", only Unstr"), std::string::npos);
  EXPECT_NE(sentence("vtkhdf-short").find("does not have as many rows"), std::string::npos);
  EXPECT_NE(sentence("vtkhdf-steps").find("several steps"), std::string::npos);
  const std::string good = contentOf(file);
  for (std::size_t size = 8; size < good.size(); size += good.size() / 30) {
    writeText(file, good.substr(0, size));
    EXPECT_THROW(static_cast<void>(readHexMesh(file)), Error) << size;
  }
}

TEST(HdfFiles, VtkHdfComesBackWholeAndFromParts) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.vtkhdf";
  try {
    requireHdf5(file);
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  Context context;
  SampleOptions options;
  options.cells = 2;
  options.features = true;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  const auto expectSame = [](const HexMesh& mesh, const HexMesh& expected) {
    EXPECT_EQ(mesh.points, expected.points);
    EXPECT_EQ(mesh.cells, expected.cells);
    EXPECT_EQ(mesh.generatorTet, expected.generatorTet);
    EXPECT_EQ(mesh.generatorCorners, expected.generatorCorners);
    EXPECT_EQ(mesh.regions, expected.regions);
    EXPECT_EQ(mesh.features, expected.features);
  };
  const HexMesh whole = extract(map);
  writeHexMesh(whole, file);
  expectSame(readHexMesh(file), whole);
  for (const std::uint32_t ghosts : {0U, 1U}) {
    const std::unique_ptr<PartSink> sink = openPartSink(file, {}, context);
    extractParts(*sink, map, {}, {5, ghosts}, context);
    expectSame(readHexMesh(file), whole);
  }
}

}  // namespace
}  // namespace hexhex::test::hdf_files
