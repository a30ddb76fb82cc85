// Files over HDF5 as other programs write them: by the libraries of NetCDF and HDF5, through Python
// and only if they are installed.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/samples.hpp>

#include <io/core/hdf_reader.hpp>
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
  for (const std::string kind : {"cgns", "cgns-mixed", "cgns-gmsh"}) {
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
  for (const std::string kind : {"cgns-zones", "cgns-both"}) {
    SCOPED_TRACE(kind);
    ASSERT_EQ(makeFile(kind, file), "");
    const HexMesh mesh = readHexMesh(file);
    EXPECT_EQ(mesh.points.size(), 12U);
    EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}}));
    EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 2}));
  }
  const auto sentence = [&](const char* kind) {
    EXPECT_EQ(makeFile(kind, file), "");
    return failureOf([&] { static_cast<void>(readHexMesh(file)); }).sentence;
  };
  EXPECT_NE(sentence("cgns-apart").find("nothing says which vertices"), std::string::npos);
  EXPECT_NE(sentence("cgns-beyond").find("names vertex 13, but its zone has 12"),
            std::string::npos);
}

TEST(HdfFiles, StructuredCgns) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.cgns";
  Context context;
  for (const std::string kind : {"cgns-blocks", "cgns-lists", "cgns-once", "cgns-loop"}) {
    SCOPED_TRACE(kind);
    if (const std::string why = makeFile(kind, file); !why.empty()) GTEST_SKIP() << why;
    EXPECT_FALSE(holdsLagrangeCells(file, context));
    const HexMesh mesh = readHexMesh(file);
    EXPECT_EQ(mesh.points.size(), 5U * 3 * 2);
    ASSERT_EQ(mesh.cells.size(), 8U);
    EXPECT_EQ(mesh.cells[1], (Hex{1, 2, 5, 4, 10, 11, 14, 13}));  // i is fastest
    EXPECT_EQ(mesh.cells[4][0], 17U);  // the first of the second zone is one of the first zone
    EXPECT_EQ(mesh.points[17], (Vec3{2, 2, 1}));
    for (const double measure : scaledJacobians(mesh, context)) EXPECT_NEAR(measure, 1, 1e-12);
    EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 1, 1, 1, 2, 2, 2, 2}));
    // Tags exactly the quads on the three sides.
    std::array<std::size_t, 4> counts{};
    for (const FeatureQuad& quad : mesh.features.quads) {
      ++counts.at(static_cast<std::size_t>(quad.tag));
      for (const Index v : quad.vertices) {
        const Vec3& p = mesh.points[v];
        EXPECT_EQ(quad.tag == 1 ? p[0] : quad.tag == 2 ? p[1] - 2 : p[0] - 4, 0);
      }
    }
    EXPECT_EQ(counts, (std::array<std::size_t, 4>{0, 2, 2, 2}));
    ASSERT_EQ(mesh.features.vertices.size(), 1U);
    EXPECT_EQ(mesh.points[mesh.features.vertices[0].vertex], (Vec3{0, 2, 1}));
    std::string names;
    for (const TagName& name : mesh.features.names) names += name.name + ' ';
    EXPECT_EQ(names, "First Second west north east corner ");
  }
  ASSERT_EQ(makeFile("cgns-ring", file), "");
  const HexMesh ring = readHexMesh(file);
  EXPECT_EQ(ring.points.size(), 8U * 3 * 2);
  EXPECT_EQ(ring.cells.size(), 8U * 2);
  EXPECT_TRUE(ring.regions.empty());
  for (const double measure : scaledJacobians(ring, context)) EXPECT_GT(measure, 0.5);
  const auto sentence = [&](const char* kind) {
    EXPECT_EQ(makeFile(kind, file), "");
    return failureOf([&] { static_cast<void>(readHexMesh(file)); }).sentence;
  };
  EXPECT_NE(sentence("cgns-rind").find("has 12 vertices, but its size is 3 x 3 x 2"),
            std::string::npos);
  EXPECT_NE(sentence("cgns-far").find("has 18 vertices, but its size is 3 x 65536 x 32768"),
            std::string::npos);
  EXPECT_NE(sentence("cgns-faces").find("across which axis"), std::string::npos);
  EXPECT_NE(sentence("cgns-many").find("far more members"), std::string::npos);
  EXPECT_NE(sentence("cgns-flat").find("does not have three axes"), std::string::npos);
}

/// Sizes, ranges and axes of structured zones are replaced by others.
TEST(HdfFiles, WrongNumbersOfStructuredZones) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.cgns";
  if (const std::string why = makeFile("cgns-blocks", file); !why.empty()) GTEST_SKIP() << why;
  const std::string good = contentOf(file);
  const std::vector<std::vector<std::int32_t>> lists = {
      {3, 3, 2, 2, 2, 1, 0, 0, 0}, {3, 1, 1, 3, 3, 2}, {3, 2, 1, 1, 1, 1}, {3, -1, -2},
      {1, 1, 1, 1, 3, 2},          {1, 1, 3, 2, 1, 3}};
  std::size_t refused = 0;
  for (const std::vector<std::int32_t>& list : lists) {
    const std::size_t place =
        good.find({reinterpret_cast<const char*>(list.data()), 4 * list.size()});
    ASSERT_NE(place, std::string::npos);
    for (const std::int32_t number : {-2147483647 - 1, -1, 0, 1, 2, 4, 1 << 20, 2147483647}) {
      for (std::size_t i = 0; i < std::min<std::size_t>(list.size(), 6); ++i) {
        std::string bytes = good;
        std::memcpy(bytes.data() + place + 4 * i, &number, 4);
        writeText(file, bytes);
        try {
          const HexMesh read = readHexMesh(file);
          for (const Hex& cell : read.cells) {
            for (const Index corner : cell) EXPECT_LT(corner, read.points.size());
          }
        } catch (const Error& error) {
          EXPECT_NE(error.code(), ErrorCode::Internal) << error.what();
          ++refused;
        }
      }
    }
  }
  EXPECT_GE(refused, 150U);
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
  if (!hasHdf5()) GTEST_SKIP() << "built without HDF5, or it cannot be loaded";
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

/// The bytes of all corners, as a file has them.
/// @param first  number of the first vertex
template <class Number>
std::string cornersOf(const HexMesh& mesh, Number first) {
  std::string bytes;
  for (const Hex& cell : mesh.cells) {
    for (const Index corner : cell) {
      const Number number = static_cast<Number>(corner) + first;
      bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
  }
  return bytes;
}

TEST(HdfFiles, OlderFilesOfCgnsAreToldByName) {
  const TemporaryFolder folder;
  if (!hasHdf5()) GTEST_SKIP() << "built without HDF5, or it cannot be loaded";
  writeText(folder / "a.cgns",
            "\xc0\xa8\xa3\xa9"
            "ADF Database Version A02011>");  // as libcgns does
  const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(folder / "a.cgns")); });
  EXPECT_NE(failure.sentence.find("adf2hdf"), std::string::npos) << failure.sentence;
}

/// Corners of cells and, in VTKHDF, offsets of cells are replaced by wrong numbers.
TEST(HdfFiles, WrongNumbersNameNoVertexBeyondTheMesh) {
  const TemporaryFolder folder;
  if (!hasHdf5()) GTEST_SKIP() << "built without HDF5, or it cannot be loaded";
  const HexMesh mesh = gridMesh(3, 2, 2);
  const std::array<std::int64_t, 8> odd = {-1,      0,          1,          37,
                                           1 << 16, 2147483647, 4294967296, 1LL << 62};
  Random random(7);
  for (const std::string name : {"a.vtkhdf", "a.cgns"}) {
    SCOPED_TRACE(name);
    writeHexMesh(mesh, folder / name);
    const std::string good = contentOf(folder / name);
    const bool wide = name == "a.vtkhdf";
    const std::size_t each = wide ? 8 : 4;
    const std::string corners =
        wide ? cornersOf<std::int64_t>(mesh, 0) : cornersOf<std::int32_t>(mesh, 1);
    std::vector<std::pair<std::size_t, std::size_t>> places = {
        {good.find(corners), corners.size() / each}};
    if (wide) {
      const std::array<std::int64_t, 4> offsets = {0, 8, 16, 24};
      places.emplace_back(good.find({reinterpret_cast<const char*>(offsets.data()), 32}),
                          mesh.cells.size() + 1);
    }
    std::size_t refused = 0;
    for (int i = 0; i < 100; ++i) {
      const auto& [begin, count] = places[random.below(places.size())];
      ASSERT_NE(begin, std::string::npos);
      std::string bytes = good;
      const std::int64_t number = odd[random.below(odd.size())];
      std::memcpy(bytes.data() + begin + each * random.below(count), &number, each);
      writeText(folder / name, bytes);
      try {
        const HexMesh read = readHexMesh(folder / name);
        for (const Hex& cell : read.cells) {
          for (const Index corner : cell) EXPECT_LT(corner, read.points.size()) << i;
        }
      } catch (const Error& error) {
        EXPECT_NE(error.code(), ErrorCode::Internal) << error.what();
        ++refused;
      }
    }
    EXPECT_GE(refused, 40U);
  }
}

}  // namespace
}  // namespace hexhex::test::hdf_files
