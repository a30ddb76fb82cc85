// Maps as arrays of VTK's files: both forms, all encodings, and what is said if there is none.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::map_arrays {

using namespace io;
namespace {

TetMap vtu(const std::string& text, std::string_view array = "igm") {
  Context context;
  ReadOptions options;
  options.mapArray = array;
  return readBytes<readVtuMap>(text, "m.vtu", context, options);
}

TetMap vtk(const std::string& text, std::string_view array = "igm") {
  Context context;
  ReadOptions options;
  options.mapArray = array;
  return readBytes<readVtkLegacyMap>(text, "m.vtk", context, options);
}

// A hexahedron between two tets, so that tets and cells have different numbers.
const std::string kCells =
    "CELLS 3 19\n4 0 1 2 3\n8 0 1 2 3 4 4 4 4\n4 1 2 3 4\nCELL_TYPES 3\n10\n12\n10\n";
const std::string kHead =
    "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
    "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\n";

TEST(VtkMaps, CellArrayBesideOtherArraysAndCells) {
  const TetMap map = vtk(kHead + "METADATA\nINFORMATION 0\n\n" + kCells +
                         "POINT_DATA 5\nSCALARS igm double\nLOOKUP_TABLE default\n1 2 3 4 5\n"
                         "VECTORS v float\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15\n"
                         "CELL_DATA 3\nSCALARS region int 1\nLOOKUP_TABLE mine\n7 8 9\n"
                         "LOOKUP_TABLE mine 1\n0 0 0 1\nFIELD FieldData 2\nid 1 3 int\n1 2 3\n"
                         "METADATA\nINFORMATION 0\n\n"
                         "igm 12 3 double\n0 0 0 1 0 0 0 1 0 0 0 1\n9 9 9 9 9 9 9 9 9 9 9 9\n"
                         "1 2 3 4 5 6 7 8 9 10 11 0.1\n");
  ASSERT_EQ(map.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(map.parameters[0][1], (Vec3{1, 0, 0}));
  EXPECT_EQ(map.parameters[1],
            (TetParameters{Vec3{1, 2, 3}, Vec3{4, 5, 6}, Vec3{7, 8, 9}, Vec3{10, 11, 0.1}}));
}

TEST(VtkMaps, PointArrayOfAnyName) {
  const std::string text = kHead + kCells + "CELL_DATA 3\nTENSORS t double\n" +
                           "1 1 1 1 1 1 1 1 1 2 2 2 2 2 2 2 2 2 3 3 3 3 3 3 3 3 3\n" +
                           "POINT_DATA 5\nVECTORS u%20v%25 double\n" +
                           "0 0 0 2 0 0 0 2 0 0 0 2 2 2 2\n";
  const TetMap map = vtk(text, "u v%");
  EXPECT_EQ(map.parameters[1][3], (Vec3{2, 2, 2}));
  const Failure failure = failureOf([&] { static_cast<void>(vtk(text)); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  for (const char* const words : {"2 tets", "no map", "\"igm\"", "\"t\" (cells, 9 components)",
                                  "\"u%20v%25\" (points, 3 components)", "--map-array"}) {
    EXPECT_NE(failure.sentence.find(words), std::string::npos) << words << failure.sentence;
  }
}

TEST(VtkMaps, WrongArraysSaySo) {
  const std::string good =
      kHead + kCells + "POINT_DATA 5\nVECTORS igm double\n0 0 0 2 0 0 0 2 0 0 0 2 2 2 2\n";
  EXPECT_NO_THROW(static_cast<void>(vtk(good)));
  const auto code = [](const std::string& text) {
    return failureOf([&] { static_cast<void>(vtk(text)); }).code;
  };
  EXPECT_EQ(code(replaced(good, "double", "int")), ErrorCode::FileUnsupported);
  EXPECT_EQ(code(replaced(good, "POINT_DATA 5", "POINT_DATA 4")), ErrorCode::FileSyntax);
  EXPECT_EQ(code(replaced(good, "POINT_DATA", "EDGE_DATA")), ErrorCode::FileSyntax);
  EXPECT_EQ(code(replaced(good, "2 2 2\n", "2 2\n")), ErrorCode::FileSyntax);
  EXPECT_EQ(code(replaced(good, "2 2 2\n", "2 2 nan\n")), ErrorCode::NotFinite);
  EXPECT_EQ(code(kHead + kCells), ErrorCode::FileUnsupported);
  EXPECT_EQ(code(kHead + "CELLS 0 0\nCELL_TYPES 0\n"), ErrorCode::FileUnsupported);
}

TEST(VtkMaps, NamesAreEncoded) {
  const TemporaryFolder folder;
  Context context;
  WriteOptions writing;
  writing.mapArray = "my map, 100%";
  writeMap(smallMap(), folder / "a.vtk", writing, context);
  EXPECT_NE(contentOf(folder / "a.vtk").find("my%20map,%20100%25 12"), std::string::npos);
  ReadOptions reading;
  reading.mapArray = writing.mapArray;
  EXPECT_EQ(readMap(folder / "a.vtk", reading, context).tets, smallMap().tets);
  writing.mapArray = "\"><script>";
  EXPECT_EQ(failureOf([&] { writeMap(smallMap(), folder / "b.vtu", writing, context); }).code,
            ErrorCode::InvalidArgument);
  writing.mapArray = "";
  EXPECT_EQ(failureOf([&] { writeMap(smallMap(), folder / "b.vtk", writing, context); }).code,
            ErrorCode::InvalidArgument);
  EXPECT_EQ(folder.fileCount(), 1U);
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[(bits >> (18 - 6 * k)) & 63U];
    }
  }
  return text;
}

template <class T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// How a file stores its arrays.
struct Storage {
  bool appended = false;
  bool compressed = false;
  bool wide = false;            ///< lengths of 64 bits
  bool joined = false;          ///< the length is one base64 text with the data
  std::size_t blockBytes = 40;  ///< of compressed blocks
};

/// Writes one `.vtu` file as other programs do.
class VtuComposer {
 public:
  explicit VtuComposer(const Storage& storage) : storage_(storage) {}

  template <class T>
  std::string array(const std::string& attributes, const std::vector<T>& values) {
    const std::string encoded = encode(bytesOf(values));
    const std::string tag = "<DataArray " + attributes;
    if (!storage_.appended) return tag + " format=\"binary\">\n  " + encoded + "\n</DataArray>\n";
    const std::string offset = std::to_string(appended_.size());
    appended_ += encoded;
    return tag + " format=\"appended\" offset=\"" + offset + "\"/>\n";
  }

  [[nodiscard]] std::string file(const std::string& piece) const {
    std::string text = "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"";
    text += storage_.wide ? " header_type=\"UInt64\"" : " header_type=\"UInt32\"";
    if (storage_.compressed) text += " compressor=\"vtkZLibDataCompressor\"";
    text += "><UnstructuredGrid>" + piece + "</UnstructuredGrid>";
    if (storage_.appended) {
      text += "<AppendedData encoding=\"base64\"> _" + appended_ + "</AppendedData>";
    }
    return text + "</VTKFile>";
  }

 private:
  [[nodiscard]] std::string lengths(const std::vector<std::uint64_t>& values) const {
    if (storage_.wide) return bytesOf(values);
    return bytesOf(std::vector<std::uint32_t>(values.begin(), values.end()));
  }
  [[nodiscard]] std::string encode(const std::string& bytes) const {
    if (!storage_.compressed) {
      const std::string head = lengths({bytes.size()});
      return storage_.joined ? base64(head + bytes) : base64(head) + base64(bytes);
    }
    std::vector<std::uint64_t> head = {0, storage_.blockBytes, bytes.size() % storage_.blockBytes};
    Array<char> blocks;
    for (std::size_t begin = 0; begin < bytes.size(); begin += storage_.blockBytes) {
      const std::size_t before = blocks.size();
      const std::size_t size = std::min(storage_.blockBytes, bytes.size() - begin);
      deflateBlock({bytes.data() + begin, size}, blocks);
      head.push_back(blocks.size() - before);
      ++head[0];
    }
    return base64(lengths(head)) + base64({blocks.begin(), blocks.end()});
  }

  Storage storage_;
  std::string appended_;
};

std::string fileWithMap(const Storage& storage) {
  VtuComposer composer(storage);
  const TetMap map = smallMap();
  std::vector<double> points;
  for (const Vec3& point : map.points) points.insert(points.end(), point.begin(), point.end());
  std::vector<double> igm;
  for (const TetParameters& tet : map.parameters) {
    for (const Vec3& corner : tet) igm.insert(igm.end(), corner.begin(), corner.end());
  }
  std::vector<std::int64_t> corners;
  for (const Tet& tet : map.tets) corners.insert(corners.end(), tet.begin(), tet.end());
  std::string piece = "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><CellData>";
  piece += composer.array("type=\"Float64\" Name=\"igm\" NumberOfComponents=\"12\"", igm);
  piece += "</CellData><Points>";
  piece += composer.array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points);
  piece += "</Points><Cells>";
  piece += composer.array("type=\"Int64\" Name=\"connectivity\"", corners);
  piece += composer.array("type=\"Int64\" Name=\"offsets\"", std::vector<std::int64_t>{4, 8});
  piece += composer.array("type=\"UInt8\" Name=\"types\"", std::vector<std::uint8_t>{10, 10});
  return composer.file(piece + "</Cells></Piece>");
}

std::vector<Storage> storages() {
  std::vector<Storage> all;
  for (unsigned bits = 0; bits < 16; ++bits) {
    const Storage storage{(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0, (bits & 8U) != 0};
    if (storage.compressed && (storage.joined || !hasZlib())) continue;
    all.push_back(storage);
  }
  // A last block that is as long as the others.
  if (hasZlib()) all.push_back({true, true, true, false, 8});
  return all;
}

TEST(VtuMaps, AllEncodings) {
  const TetMap expected = smallMap();
  for (const Storage& storage : storages()) {
    const TetMap map = vtu(fileWithMap(storage));
    expectSameBits(map.points, expected.points);
    EXPECT_EQ(map.tets, expected.tets);
    for (std::size_t t = 0; t < 2; ++t) {
      expectSameBits(map.parameters.at(t), expected.parameters[t]);
    }
  }
}

TEST(VtuMaps, DamagedEncodingsAreRefused) {
  Random random(11);
  for (const Storage& storage : storages()) {
    const std::string good = fileWithMap(storage);
    std::size_t refused = 0;
    for (int i = 0; i < 400; ++i) {
      std::string text = good;
      const std::size_t begin = storage.appended ? text.find('_', text.find("<Appended")) : 0;
      text[begin + random.below(text.size() - begin)] = "A=/z9<"[random.below(6)];
      try {
        const TetMap map = vtu(text);
        EXPECT_EQ(map.parameters.size(), map.tets.size());
      } catch (const Error& error) {
        EXPECT_NE(error.code(), ErrorCode::Internal) << error.what();
        ++refused;
      }
    }
    EXPECT_GT(refused, 30U);
  }
}

TEST(VtuMaps, HugeLengthsAreNotBelieved) {
  if (!hasZlib()) GTEST_SKIP() << "built without zlib";
  Storage storage;
  storage.compressed = storage.wide = true;
  for (const std::uint64_t length : {std::uint64_t{1} << 62U, ~std::uint64_t{0}}) {
    // The first array of all: number of blocks, bytes of a block, bytes of the last one.
    for (std::size_t number = 0; number < 3; ++number) {
      std::string text = fileWithMap(storage);
      const std::size_t place = text.find("format=\"binary\">\n  ") + 19;
      std::vector<std::uint64_t> head = {1, 8, 0, 16};
      head[number] = length;
      text.replace(place, text.find('\n', place) - place, base64(bytesOf(head)) + base64("abcd"));
      EXPECT_EQ(failureOf([&] { static_cast<void>(vtu(text)); }).code, ErrorCode::FileSyntax);
    }
  }
}

TEST(VtuMaps, PointArrayAndOtherArrays) {
  const std::string text =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<PointData>\n"
      "<DataArray type=\"Float32\" Name=\"uvw\" NumberOfComponents=\"3\" format=\"ascii\">"
      "0 0 0 1 0 0 0 1 0 0 0 1.5</DataArray></PointData>\n"
      "<CellData><DataArray type=\"Int32\" Name=\"igm\" format=\"ascii\">5</DataArray></CellData>"
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
      "0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>"
      "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">3 1 2 0</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  EXPECT_EQ(vtu(text, "uvw").parameters.at(0)[0], (Vec3{0, 0, 1.5}));
  const Failure failure = failureOf([&] { static_cast<void>(vtu(text)); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("\"igm\" (cells, 1 component)"), std::string::npos)
      << failure.sentence;
  EXPECT_EQ(failureOf([&] { static_cast<void>(vtu(replaced(text, ">10<", ">12<"), "uvw")); }).code,
            ErrorCode::FileUnsupported);
}

}  // namespace
}  // namespace hexhex::test::map_arrays
