// `.ovmb` files built byte by byte from the description of the format: every encoding, every span,
// every order of chunks, what may be skipped, and every mistake with its place.
#include <cmath>
#include <functional>
#include <rapidcheck.h>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>

#include "ovm_test_support.hpp"

namespace hexhex::test::ovmb_bytes {

using namespace io;
namespace {

TetMap map(const std::string& bytes) {
  Context context;
  return readBytes<OvmBinary::readMap>(bytes, "m.ovmb", context, ReadOptions{});
}

HexMesh mesh(const std::string& bytes) {
  Context context;
  return readBytes<OvmBinary::readMesh>(bytes, "m.ovmb", context);
}

/// Two tets at the face 1 2 3, as lists of the format. Edges 0: 0-1, 1: 0-2, 2: 0-3, 3: 1-2,
/// 4: 1-3, 5: 2-3, 6: 1-4, 7: 2-4, 8: 3-4.
const std::vector<Vec3> kPoints = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
const std::vector<std::vector<std::uint64_t>> kEdges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3},
                                                        {2, 3}, {1, 4}, {2, 4}, {3, 4}};
const std::vector<std::vector<std::uint64_t>> kFaces = {
    {0, 6, 3},     // 0 1 2
    {2, 10, 5},    // 0 2 3
    {4, 9, 1},     // 0 3 1
    {8, 11, 7},    // 1 3 2; reversed: 1 2 3
    {8, 16, 13},   // 1 3 4
    {12, 15, 7},   // 1 4 2
    {10, 16, 15},  // 2 3 4
};
// The other tet is 1 2 3 4: its faces, seen from inside, are 1 2 3, 1 3 4, 1 4 2, 2 4 3.
const std::vector<std::vector<std::uint64_t>> kCells = {{0, 2, 4, 6}, {7, 8, 10, 13}};
const std::array<std::uint64_t, 4> kCounts = {5, 9, 7, 2};

/// How a file is laid out.
struct Layout {
  int handleBytes = 1;
  int valenceBytes = 0;  ///< 0: fixed
  std::uint64_t offset = 0;
  std::size_t spanLength = 1000;
  bool floats = false;
};

/// Lists from number `begin` to `end` as the payload of a TOPO chunk.
Bytes topology(int entity, const std::vector<std::vector<std::uint64_t>>& lists, std::size_t begin,
               std::size_t end, const Layout& layout) {
  const int valenceBytes = entity == 1 ? 0 : layout.valenceBytes;
  const auto valence = static_cast<int>(lists[begin].size());
  std::uint64_t offset = ~std::uint64_t{0};
  for (std::size_t i = begin; i < end; ++i) {
    offset = std::min(offset, *std::min_element(lists[i].begin(), lists[i].end()));
  }
  offset = std::min(offset, layout.offset);
  Bytes payload;
  payload.span(begin, end - begin).integer(static_cast<std::uint8_t>(entity));
  payload.integer(static_cast<std::uint8_t>(valenceBytes > 0 ? 0 : valence));
  payload.integer(static_cast<std::uint8_t>(valenceBytes));
  payload.integer(static_cast<std::uint8_t>(layout.handleBytes)).u64(offset);
  for (std::size_t i = begin; i < end && valenceBytes > 0; ++i) {
    payload.sized(lists[i].size(), valenceBytes);
  }
  for (std::size_t i = begin; i < end; ++i) {
    for (const std::uint64_t handle : lists[i]) payload.sized(handle - offset, layout.handleBytes);
  }
  return payload;
}

void addTopology(Bytes& file, int entity, const std::vector<std::vector<std::uint64_t>>& lists,
                 const Layout& layout) {
  for (std::size_t begin = 0; begin < lists.size(); begin += layout.spanLength) {
    const std::size_t end = std::min(lists.size(), begin + layout.spanLength);
    file.chunk("TOPO", topology(entity, lists, begin, end, layout));
  }
}

void addVertices(Bytes& file, const Layout& layout) {
  for (std::size_t begin = 0; begin < kPoints.size(); begin += layout.spanLength) {
    const std::size_t end = std::min(kPoints.size(), begin + layout.spanLength);
    Bytes payload;
    payload.span(begin, end - begin).u32(layout.floats ? 1 : 2);
    for (std::size_t v = begin; v < end; ++v) {
      for (const double x : kPoints[v]) {
        if (layout.floats) {
          payload.f32(static_cast<float>(x));
        } else {
          payload.f64(x);
        }
      }
    }
    file.chunk("VERT", payload);
  }
}

Bytes geometry(const Layout& layout = {}) {
  Bytes file = ovmbHeader(1, kCounts);
  addVertices(file, layout);
  addTopology(file, 1, kEdges, layout);
  addTopology(file, 2, kFaces, layout);
  addTopology(file, 3, kCells, layout);
  return file;
}

/// The parameters of half-face h: distinct, exact in float32.
double parameter(std::uint64_t halfFace, int k) {
  return static_cast<double>(halfFace) + 0.25 * (k + 1);
}

Bytes directory(const std::string& type = "3d") {
  Bytes entries;
  entries.u8(5).counted("HexHex::Parametrization").counted(type);
  entries.counted(std::string(type == "3d" ? 24 : 12, '\0'));
  return entries;
}

Bytes mapProperty(std::uint64_t number = 0, std::uint64_t begin = 0, std::uint64_t end = 14,
                  bool floats = false) {
  Bytes payload;
  payload.span(begin, end - begin).u32(number);
  for (std::uint64_t h = begin; h < end; ++h) {
    for (int k = 0; k < 3; ++k) {
      if (floats) {
        payload.f32(static_cast<float>(parameter(h, k)));
      } else {
        payload.f64(parameter(h, k));
      }
    }
  }
  return payload;
}

std::string ended(Bytes file) { return file.chunk("EOF ", {}).str(); }

void expectTheMap(const TetMap& read) {
  expectSameBits(read.points, kPoints);
  EXPECT_EQ(read.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  ASSERT_EQ(read.parameters.size(), 2U);
  // The half-face opposite each corner.
  const std::array<std::array<std::uint64_t, 4>, 2> opposite = {{{6, 2, 4, 0}, {13, 8, 10, 7}}};
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(read.parameters[t][i][k], parameter(opposite[t][i], static_cast<int>(k)));
      }
    }
  }
}

TEST(Ovmb, EveryEncodingAndSpan) {
  for (const int handleBytes : {1, 2, 4}) {
    for (const int valenceBytes : {0, 1, 2, 4}) {
      for (const std::uint64_t offset : {0U, 1U, 5U}) {
        for (const std::size_t spanLength : {1U, 2U, 3U, 1000U}) {
          for (const bool floats : {false, true}) {
            const Layout layout{handleBytes, valenceBytes, offset, spanLength, floats};
            Bytes file = geometry(layout);
            file.chunk("DIRP", directory(floats ? "3f" : "3d"));
            for (std::uint64_t h = 0; h < 14; h += spanLength) {
              const std::uint64_t end = std::min<std::uint64_t>(14, h + spanLength);
              file.chunk("PROP", mapProperty(0, h, end, floats));
            }
            expectTheMap(map(ended(file)));
          }
        }
      }
    }
  }
}

TEST(Ovmb, EveryLegalOrderOfChunks) {
  // The directory may stand anywhere before the properties, and properties behind their entities.
  std::vector<std::function<void(Bytes&)>> parts = {
      [](Bytes& file) { addVertices(file, {}); },
      [](Bytes& file) { addTopology(file, 1, kEdges, {}); },
      [](Bytes& file) { addTopology(file, 2, kFaces, {}); },
      [](Bytes& file) { addTopology(file, 3, kCells, {}); }};
  for (std::size_t directoryAt = 0; directoryAt <= 4; ++directoryAt) {
    for (std::size_t propertyAt = std::max<std::size_t>(directoryAt, 3); propertyAt <= 4;
         ++propertyAt) {
      Bytes file = ovmbHeader(0, kCounts);
      for (std::size_t i = 0; i <= 4; ++i) {
        if (i == directoryAt) file.chunk("DIRP", directory());
        if (i == propertyAt) file.chunk("PROP", mapProperty());
        if (i < 4) parts[i](file);
      }
      expectTheMap(map(ended(file)));
    }
  }
}

TEST(Ovmb, UnknownThingsAreSkipped) {
  Bytes entries;
  entries.u8(0).counted("strings").counted("s32").counted(Bytes().u32(0).str());
  entries.u8(1).counted("bits").counted("b").counted(std::string(1, '\1'));
  entries.text(directory().str());
  entries.u8(3).counted("Quaternion").counted("Quaternion").counted("whatever");
  entries.u8(6).counted("of the mesh").counted("d").counted(std::string(8, '\0'));
  entries.u8(3).counted("HexHex::Parametrization").counted("3d").counted(std::string(24, '\0'));
  entries.u8(5).counted("HexHex::Parametrization").counted("3f").counted(std::string(12, '\0'));
  entries.u8(4).counted("").counted("").counted("");
  Bytes file = geometry();
  file.chunk("DIRP", entries);
  file.chunk("JUNK", Bytes().text("optional"), 0);
  file.chunk("VERT", Bytes().text("of a later version, optional"), 0, 7);
  file.chunk("TOPO", Bytes().text("compressed, optional"), 0, 0, 1);
  file.chunk("PROP", Bytes().span(0, 5).u32(0).text("strings"));
  file.chunk("PROP", Bytes().span(1, 8).u32(1).u8(0xFF));
  file.chunk("PROP", Bytes().span(0, 2).u32(3).text("????"));
  file.chunk("PROP", mapProperty(2));
  file.chunk("PROP", Bytes().span(0, 1).u32(4).f64(1));
  expectTheMap(map(ended(file)));
}

TEST(Ovmb, DefaultsFillWhatSpansLeaveOut) {
  Bytes entries;
  entries.u8(5).counted("HexHex::Parametrization").counted("3d");
  entries.counted(Bytes().f64(7).f64(8).f64(9).str());
  entries.u8(1).counted("edge_valance").counted("i32").counted(Bytes().integer(-1).str());
  Bytes file = geometry();
  file.chunk("DIRP", entries);
  file.chunk("PROP", mapProperty(0, 3, 9));
  file.chunk("PROP", Bytes().span(2, 2).u32(1).integer(0).integer(5));
  const TetMap read = map(ended(file));
  EXPECT_EQ(read.parameters[0][0], (Vec3{parameter(6, 0), parameter(6, 1), parameter(6, 2)}));
  EXPECT_EQ(read.parameters[0][1], (Vec3{7, 8, 9}));
  ASSERT_EQ(read.edgeValences.size(), 8U);
  EXPECT_EQ(read.edgeValences[1].offset, -1);
  EXPECT_EQ(read.edgeValences[2].vertex0, 1U);
  EXPECT_EQ(read.edgeValences[2].vertex1, 2U);
  EXPECT_EQ(read.edgeValences[2].offset, 5);
}

template <class Int>
void expectIntegers(const std::string& type) {
  Bytes zero;
  zero.integer(Int{});
  Bytes entries = directory();
  entries.u8(0).counted("AlgoHex::FeatureVertices").counted(type).counted(zero.str());
  entries.u8(2).counted("AlgoHex::FeatureFaces").counted(type).counted(zero.str());
  entries.u8(1).counted("AlgoHex::FeatureEdges").counted(type).counted(zero.str());
  Bytes file = geometry();
  file.chunk("DIRP", entries).chunk("PROP", mapProperty());
  file.chunk("PROP", Bytes().span(3, 1).u32(1).integer(Int{100}));
  file.chunk("PROP", Bytes().span(3, 1).u32(2).integer(Int{3}));
  file.chunk("PROP", Bytes().span(6, 2).u32(3).integer(Int{0}).integer(Int{9}));
  const TetMap read = map(ended(file));
  EXPECT_EQ(read.features.vertices, (std::vector<FeatureVertex>{{3, 100}})) << type;
  EXPECT_EQ(read.features.edges, (std::vector<FeatureEdge>{{{2, 4}, 9}})) << type;
  EXPECT_EQ(read.features.faces, (std::vector<FeatureFace>{{{1, 3, 2}, 3}})) << type;
}

TEST(Ovmb, IntegersOfEveryWidth) {
  expectIntegers<std::uint8_t>("u8");
  expectIntegers<std::uint16_t>("u16");
  expectIntegers<std::uint32_t>("u32");
  expectIntegers<std::uint64_t>("u64");
  expectIntegers<std::int8_t>("i8");
  expectIntegers<std::int16_t>("i16");
  expectIntegers<std::int32_t>("i32");
  expectIntegers<std::int64_t>("i64");
}

TEST(Ovmb, IntegersBeyond32BitsAreRefused) {
  const auto withTag = [](const Bytes& defaultValue, const Bytes& value) {
    Bytes entries = directory();
    entries.u8(0).counted("AlgoHex::FeatureVertices").counted("u64").counted(defaultValue.str());
    Bytes file = geometry();
    file.chunk("DIRP", entries).chunk("PROP", mapProperty());
    file.chunk("PROP", Bytes().span(1, 1).u32(1).text(value.str()));
    return ended(file);
  };
  EXPECT_EQ(map(withTag(Bytes().u64(0), Bytes().u64(0x7FFFFFFF))).features.vertices.at(0).tag,
            0x7FFFFFFF);
  for (const std::string& file : {withTag(Bytes().u64(0), Bytes().u64(0x80000000)),
                                  withTag(Bytes().u64(~std::uint64_t{0}), Bytes().u64(0))}) {
    const Failure failure = failureOf([&] { static_cast<void>(map(file)); });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
    EXPECT_NE(failure.sentence.find("does not fit into 32 bits"), std::string::npos);
  }
}

TEST(Ovmb, BitsCountFromTheLowestAndFromTheSpan) {
  Bytes entries = directory();
  entries.u8(1).counted("AlgoHex::FeatureEdges").counted("b").counted(std::string(1, '\0'));
  Bytes file = geometry();
  file.chunk("DIRP", entries).chunk("PROP", mapProperty());
  // Edges 0 to 8 in one span of two bytes: edges 0, 3, 8.
  Bytes one = file;
  one.chunk("PROP", Bytes().span(0, 9).u32(1).u8(0b00001001).u8(1));
  const auto tagged = [](const TetMap& read) {
    std::vector<std::array<Index, 2>> edges;
    for (const FeatureEdge& edge : read.features.edges) {
      EXPECT_EQ(edge.tag, 1);
      edges.push_back(edge.vertices);
    }
    return edges;
  };
  const std::vector<std::array<Index, 2>> expected = {{0, 1}, {1, 2}, {3, 4}};
  EXPECT_EQ(tagged(map(ended(one))), expected);
  // The same in spans from 0 and from 3: bit 0 of each is the first of its span.
  Bytes two = file;
  two.chunk("PROP", Bytes().span(3, 6).u32(1).u8(0b00100001));
  two.chunk("PROP", Bytes().span(0, 3).u32(1).u8(0b00000001));
  EXPECT_EQ(tagged(map(ended(two))), expected);
}

TEST(Ovmb, RotationsGoToTheFaceOppositeTheCorner) {
  Bytes entries = directory();
  entries.u8(5).counted("HalffaceTransiton").counted("i32").counted(Bytes().integer(0).str());
  Bytes file = geometry();
  file.chunk("DIRP", entries).chunk("PROP", mapProperty());
  Bytes values;
  values.span(0, 14).u32(1);
  // Values out of range mean nothing at the boundary, i.e. everywhere but at half-faces 6 and 7.
  for (int h = 0; h < 14; ++h) values.integer(h == 6 ? 23 : (h == 7 ? -1 : (h == 2 ? 99 : h)));
  const TetMap read = map(ended(Bytes(file).chunk("PROP", values)));
  const std::vector<std::array<std::int8_t, 4>> expected = {{23, -1, 4, 0}, {13, 8, 10, -1}};
  EXPECT_EQ(read.rotations, expected);
  const Failure failure = failureOf([&] {
    static_cast<void>(map(ended(
        Bytes(file).chunk("PROP", values).chunk("PROP", Bytes().span(7, 1).u32(1).integer(24)))));
  });
  EXPECT_EQ(failure.code, ErrorCode::FileSyntax);
  EXPECT_EQ(toString(failure.place), "tet 1");
  EXPECT_NE(failure.sentence.find("half-face 7"), std::string::npos) << failure.sentence;
}

TEST(Ovmb, HalfFacesInAnyOrder) {
  std::vector<std::vector<std::uint64_t>> cells = kCells;
  std::sort(cells[1].begin(), cells[1].end());
  do {
    Bytes file = ovmbHeader(1, kCounts);
    addVertices(file, {});
    addTopology(file, 1, kEdges, {});
    addTopology(file, 2, kFaces, {});
    addTopology(file, 3, cells, {});
    file.chunk("DIRP", directory()).chunk("PROP", mapProperty());
    const TetMap read = map(ended(file));
    // Each corner has the parameters of the half-face opposite it: 1: 13, 2: 8, 3: 10, 4: 7.
    const std::array<std::uint64_t, 5> opposite = {0, 13, 8, 10, 7};
    Tet sorted = read.tets[1];
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, (Tet{1, 2, 3, 4}));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(read.parameters[1][i][0], parameter(opposite[read.tets[1][i]], 0));
    }
    // All orders are even, as the half-faces point inwards.
    const auto& p = read.points;
    const auto edge = [&](std::size_t i, std::size_t k) {
      return p[read.tets[1][i]][k] - p[read.tets[1][0]][k];
    };
    const double determinant = edge(1, 0) * (edge(2, 1) * edge(3, 2) - edge(2, 2) * edge(3, 1)) -
                               edge(1, 1) * (edge(2, 0) * edge(3, 2) - edge(2, 2) * edge(3, 0)) +
                               edge(1, 2) * (edge(2, 0) * edge(3, 1) - edge(2, 1) * edge(3, 0));
    EXPECT_GT(determinant, 0);
  } while (std::next_permutation(cells[1].begin(), cells[1].end()));
}

TEST(Ovmb, MapsThatAreMissingAreNamed) {
  const Failure none = failureOf([] { static_cast<void>(map(ended(geometry()))); });
  EXPECT_EQ(none.code, ErrorCode::FileUnsupported);
  for (const char* words : {"m.ovmb: ", "2 tets", "no map", "HexHex::Parametrization", ".hexex"}) {
    EXPECT_NE(none.sentence.find(words), std::string::npos) << none.sentence;
  }
  // The right name, but on cells; or on half-faces, but of another type.
  for (const int entity : {3, 5}) {
    Bytes entries;
    entries.u8(static_cast<std::uint64_t>(entity)).counted("HexHex::Parametrization");
    entries.counted(entity == 3 ? "3d" : "2d").counted(std::string(24, '\0'));
    const Failure other =
        failureOf([&] { static_cast<void>(map(ended(geometry().chunk("DIRP", entries)))); });
    EXPECT_EQ(other.code, ErrorCode::FileUnsupported);
    EXPECT_NE(other.sentence.find("is not one of half-faces"), std::string::npos) << other.sentence;
  }
}

TEST(Ovmb, ParametersMustBeFiniteWhereTheyMeanSomething) {
  Bytes file = geometry();
  file.chunk("DIRP", directory()).chunk("PROP", mapProperty());
  const auto with = [&](std::uint64_t halfFace) {
    Bytes bad = file;
    bad.chunk("PROP", Bytes().span(halfFace, 1).u32(0).f64(std::nan("")).f64(0).f64(0));
    return ended(bad);
  };
  expectTheMap(map(with(9)));  // has no cell
  const Failure failure = failureOf([&] { static_cast<void>(map(with(10))); });
  EXPECT_EQ(failure.code, ErrorCode::NotFinite);
  EXPECT_EQ(toString(failure.place), "tet 1");
}

struct BadBytes {
  std::string bytes;
  ErrorCode code;
  std::string words;
};

std::string with(std::string bytes, std::size_t place, char byte) {
  bytes[place] = byte;
  return bytes;
}

TEST(Ovmb, EveryDefectIsNamedWithItsPlace) {
  const std::string good =
      ended(geometry().chunk("DIRP", directory()).chunk("PROP", mapProperty()));
  expectTheMap(map(good));
  // The first chunk, VERT, begins at 48; its span at 64, its encoding at 76.
  // Then TOPO of edges: VERT has 16 + 120 bytes, so at 200; its span at 216, its entity at 228.
  const std::size_t topo = 48 + 16 + 136;
  const Layout l;
  const auto header = [](std::array<std::uint64_t, 4> counts) { return ovmbHeader(1, counts); };
  const auto after = [&](const Bytes& chunk, const char* type = "TOPO") {
    Bytes file = header(kCounts);
    addVertices(file, l);
    return ended(file.chunk(type, chunk));
  };
  const auto directoryOf = [&](const Bytes& entries) {
    return ended(geometry().chunk("DIRP", entries));
  };
  const auto propertyOf = [&](const Bytes& payload) {
    return ended(geometry().chunk("DIRP", directory()).chunk("PROP", payload));
  };
  const std::vector<BadBytes> files = {
      {"", ErrorCode::FileSyntax, "byte 0: an .ovmb file begins with"},
      {"OVM ASCII\n", ErrorCode::FileSyntax, ".ovm"},
      {good.substr(0, 30), ErrorCode::FileSyntax, "byte 24: the header needs 8 bytes, but only 6"},
      {with(good, 9, 2), ErrorCode::FileUnsupported, "byte 9: the header has version 2"},
      {with(good, 10, 2), ErrorCode::FileUnsupported, "byte 10: the dimension must be 3"},
      {with(good, 11, 3), ErrorCode::FileSyntax, "byte 11: the kind"},
      {with(good, 13, 1), ErrorCode::FileSyntax, "byte 12: the reserved part"},
      {with(good, 47, 1), ErrorCode::TooLarge, "byte 40: the header announces"},
      {with(good, 16, 6), ErrorCode::FileSyntax, "announces 6 vertices, but the file holds 5"},
      {with(good, 16, 4), ErrorCode::FileSyntax, "byte 64: there are more vertices than the 4"},
      {with(good, 32, 8), ErrorCode::FileSyntax, "announces 8 faces, but the file holds 7"},
      {with(good, 48, 'X'), ErrorCode::FileUnsupported, "byte 48: the chunk \"XERT\""},
      {with(good, 52, 1), ErrorCode::FileUnsupported, "(version 1, compression 0)"},
      {with(good, 54, 1), ErrorCode::FileUnsupported, "(version 0, compression 1)"},
      {with(good, 53, 8), ErrorCode::FileSyntax, "byte 48: the chunk \"VERT\" has an impossible"},
      {with(good, 53, 1), ErrorCode::FileSyntax, "padding"},  // the last byte of a coordinate
      {with(good, 55, 2), ErrorCode::FileSyntax, "byte 48: the chunk \"VERT\" has an impossible"},
      {with(good, 60, 1), ErrorCode::FileSyntax, "byte 64: the chunk \"VERT\" needs"},
      {with(good, 64, 1), ErrorCode::FileSyntax, "byte 64: expected vertices from number 0"},
      {with(good, 72, 4), ErrorCode::FileSyntax, "the VERT chunk is longer"},
      {with(good, 76, 3), ErrorCode::FileSyntax, "byte 76: the encoding of the vertices"},
      {with(good, 77, 1), ErrorCode::FileSyntax, "byte 76: the encoding of the vertices"},
      {with(with(good, 86, '\xf0'), 87, '\x7f'), ErrorCode::NotFinite,
       "byte 80: a coordinate of vertex 0 is not finite"},
      {with(good, topo + 28, 0), ErrorCode::FileSyntax, "byte 228: a TOPO chunk must be about"},
      {with(good, topo + 28, 4), ErrorCode::FileSyntax, "found 4"},
      {with(good, topo + 29, 3), ErrorCode::FileSyntax, "edges must have the valence 2, found 3"},
      {with(good, topo + 30, 1), ErrorCode::FileSyntax, "the encoding of valences"},
      {with(good, topo + 31, 3), ErrorCode::FileSyntax, "the encoding of valences"},
      {with(good, topo + 31, 2), ErrorCode::FileSyntax, "wrong size for its edges"},
      {with(good, topo + 32, 4), ErrorCode::IndexOutOfRange, "names vertex 1 + 4"},
      {with(good, topo + 39, 1), ErrorCode::IndexOutOfRange, "but there are 5"},
      {with(good, topo + 41, 5), ErrorCode::IndexOutOfRange, "byte 241: "},
      {after(Bytes().span(0, 0).u8(1).u8(2).u8(0).u8(1).u64(0)), ErrorCode::FileSyntax, "is empty"},
      {after(Bytes().span(0, 7).u8(2).u8(2).u8(0).u8(1).u64(0).text("abcdefghijklmn")),
       ErrorCode::FileSyntax, "faces of valence 2"},
      {after(Bytes().span(0, 1).u8(2).u8(0).u8(1).u8(1).u64(0).u8(2).u8(0).u8(1)),
       ErrorCode::FileSyntax, "a face has the valence 2"},
      {after(Bytes().span(0, 7).u8(2).u8(0).u8(4).u8(4).u64(0).u32(0xFFFFFFFF)),
       ErrorCode::FileSyntax, "too short for its 7 faces"},
      {after(Bytes().span(0, 1).u8(2).u8(0).u8(4).u8(4).u64(0).u32(0xFFFFFFFF)),
       ErrorCode::FileSyntax, "wrong size for its faces"},
      {good.substr(0, good.size() - 16), ErrorCode::FileSyntax, "without its end chunk"},
      {good + good.substr(good.size() - 16), ErrorCode::FileSyntax, "16 bytes after the end chunk"},
      {good + "x", ErrorCode::FileSyntax, "1 bytes after the end chunk"},
      {geometry().chunk("EOF ", Bytes().u64(0)).str(), ErrorCode::FileSyntax, "is not empty"},
      {directoryOf(Bytes().u8(7)), ErrorCode::FileSyntax, "an entity of kind 7"},
      {directoryOf(Bytes().u8(1).u32(100).text("abc")), ErrorCode::FileSyntax, "needs 100 bytes"},
      {directoryOf(Bytes().u8(5).counted("HexHex::Parametrization").counted("3d").counted("")),
       ErrorCode::FileSyntax, "has 0 bytes instead of 24"},
      {ended(geometry().chunk("DIRP", directory()).chunk("DIRP", directory())),
       ErrorCode::FileSyntax, "second DIRP"},
      {ended(geometry().chunk("PROP", mapProperty())), ErrorCode::FileSyntax,
       "property 0, but only 0 are listed"},
      {propertyOf(mapProperty(1)), ErrorCode::FileSyntax, "property 1, but only 1 are listed"},
      {propertyOf(mapProperty(0, 3, 15)), ErrorCode::FileSyntax, "outside of its 14 elements"},
      {propertyOf(Bytes().span(~std::uint64_t{0}, 1).u32(0)), ErrorCode::FileSyntax, "outside of"},
      {propertyOf(Bytes().span(0, 2).u32(0).f64(1)), ErrorCode::FileSyntax,
       "have 8 bytes instead of 48"},
      {propertyOf(Bytes().span(0, 2)), ErrorCode::FileSyntax, "the header of a PROP chunk"},
  };
  for (const BadBytes& file : files) {
    const Failure failure = failureOf([&] { static_cast<void>(map(file.bytes)); });
    EXPECT_EQ(name(failure.code), name(file.code)) << failure.sentence;
    EXPECT_TRUE(failure.sentence.starts_with("m.ovmb")) << failure.sentence;
    EXPECT_NE(failure.sentence.find(file.words), std::string::npos)
        << file.words << " | " << failure.sentence;
  }
}

TEST(Ovmb, CellsMustBeTets) {
  const auto withCells = [](const std::vector<std::vector<std::uint64_t>>& faces,
                            const std::vector<std::vector<std::uint64_t>>& cells, int valence) {
    Layout layout;
    layout.valenceBytes = valence;
    Bytes file = ovmbHeader(0, {5, 9, faces.size(), cells.size()});
    addVertices(file, layout);
    addTopology(file, 1, kEdges, layout);
    addTopology(file, 2, faces, layout);
    addTopology(file, 3, cells, layout);
    file.chunk("DIRP", directory());
    return failureOf([&] { static_cast<void>(map(ended(file))); });
  };
  EXPECT_EQ(withCells(kFaces, {{0, 2, 4, 6}, {7, 8, 10, 13, 0}}, 1).code,
            ErrorCode::FileUnsupported);
  const auto expectSyntax = [](const Failure& failure, const char* words) {
    EXPECT_EQ(failure.code, ErrorCode::FileSyntax) << failure.sentence;
    EXPECT_NE(failure.sentence.find(words), std::string::npos) << failure.sentence;
  };
  expectSyntax(withCells(kFaces, {{0, 2, 4, 6}, {6, 8, 10, 13}}, 0), "half-face 6");
  expectSyntax(withCells(kFaces, {{0, 2, 4, 4}, {7, 8, 10, 13}}, 0), "half-face 4");
  expectSyntax(withCells(kFaces, {{0, 2, 4, 1}, {7, 8, 10, 13}}, 0), "do not bound a tet");
  expectSyntax(withCells(kFaces, {{0, 2, 4, 8}, {7, 6, 10, 13}}, 0), "do not bound a tet");
  // A half-face that points the other way than the rest of its cell.
  expectSyntax(withCells(kFaces, {{0, 2, 4, 7}, {6, 8, 10, 13}}, 0), "do not bound a tet");
  auto faces = kFaces;
  faces[1] = {2, 10, 4};
  expectSyntax(withCells(faces, kCells, 0), "face 1");
}

/// A cube with its half-faces in the slots of the description.
Bytes cube(const std::vector<std::uint64_t>& slots, bool outward) {
  Bytes file = ovmbHeader(2, {8, 12, 6, 1});
  Bytes points;
  points.span(0, 8).u32(2);
  for (const auto& p : std::vector<std::array<int, 3>>{{0, 0, 0},
                                                       {1, 0, 0},
                                                       {1, 1, 0},
                                                       {0, 1, 0},
                                                       {0, 0, 1},
                                                       {1, 0, 1},
                                                       {1, 1, 1},
                                                       {0, 1, 1}}) {
    for (const int x : p) points.f64(outward ? -x : x);
  }
  file.chunk("VERT", points);
  const std::vector<std::vector<std::uint64_t>> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0},
                                                         {4, 7}, {7, 6}, {6, 5}, {5, 4},
                                                         {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  addTopology(file, 1, edges, {});
  const std::vector<std::vector<std::uint64_t>> faces = {{0, 2, 4, 6},     // 0 1 2 3
                                                         {8, 10, 12, 14},  // 4 7 6 5
                                                         {16, 15, 19, 1},  // 0 4 5 1
                                                         {5, 20, 11, 23},  // 3 2 6 7
                                                         {18, 13, 21, 3},  // 1 5 6 2
                                                         {7, 22, 9, 17}};  // 0 3 7 4
  addTopology(file, 2, faces, {});
  addTopology(file, 3, {slots}, {});
  return file;
}

TEST(Ovmb, HexCellsInSlotsOrInAnyOrder) {
  EXPECT_EQ(mesh(ended(cube({0, 2, 4, 6, 8, 10}, false))).cells.at(0),
            (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
  // Inside out: turned.
  EXPECT_EQ(mesh(ended(cube({0, 2, 4, 6, 8, 10}, true))).cells.at(0),
            (Hex{0, 3, 2, 1, 4, 7, 6, 5}));
  std::vector<std::uint64_t> slots = {0, 2, 4, 6, 8, 10};
  do {
    const Hex cell = mesh(ended(cube(slots, false))).cells.at(0);
    // Corners joined by edges, and the right orientation: of a unit cube, by its bits.
    const HexMesh read = mesh(ended(cube(slots, false)));
    const auto at = [&](std::size_t i) { return read.points[cell[i]]; };
    for (const auto& [i, j] : std::vector<std::pair<std::size_t, std::size_t>>{{0, 1},
                                                                               {1, 2},
                                                                               {2, 3},
                                                                               {3, 0},
                                                                               {4, 5},
                                                                               {5, 6},
                                                                               {6, 7},
                                                                               {7, 4},
                                                                               {0, 4},
                                                                               {1, 5},
                                                                               {2, 6},
                                                                               {3, 7}}) {
      double distance = 0;
      for (std::size_t k = 0; k < 3; ++k) distance += std::abs(at(i)[k] - at(j)[k]);
      EXPECT_EQ(distance, 1);
    }
    const auto edge = [&](std::size_t i, std::size_t k) { return at(i)[k] - at(0)[k]; };
    const double determinant = edge(1, 0) * (edge(3, 1) * edge(4, 2) - edge(3, 2) * edge(4, 1)) -
                               edge(1, 1) * (edge(3, 0) * edge(4, 2) - edge(3, 2) * edge(4, 0)) +
                               edge(1, 2) * (edge(3, 0) * edge(4, 1) - edge(3, 1) * edge(4, 0));
    EXPECT_EQ(determinant, 1);
  } while (std::next_permutation(slots.begin(), slots.end()));
}

TEST(Ovmb, CellsMustBeHexahedra) {
  for (const std::vector<std::uint64_t>& slots : std::vector<std::vector<std::uint64_t>>{
           {0, 2, 4, 6, 8, 11}, {0, 1, 4, 6, 8, 10}, {1, 2, 4, 6, 8, 10}}) {
    const Failure failure = failureOf([&] { static_cast<void>(mesh(ended(cube(slots, false)))); });
    EXPECT_EQ(failure.code, ErrorCode::FileSyntax);
    EXPECT_NE(failure.sentence.find("do not bound a hexahedron"), std::string::npos);
  }
  const Failure tets = failureOf([] { static_cast<void>(mesh(ended(geometry()))); });
  EXPECT_EQ(tets.code, ErrorCode::FileUnsupported);
  EXPECT_NE(tets.sentence.find("cell 0 has 4 faces"), std::string::npos) << tets.sentence;
  const Failure hexes = failureOf([] {
    static_cast<void>(map(ended(cube({0, 2, 4, 6, 8, 10}, false))));
  });
  EXPECT_EQ(hexes.code, ErrorCode::FileUnsupported);
  EXPECT_NE(hexes.sentence.find("tetrahedra"), std::string::npos) << hexes.sentence;
}

TEST(Ovmb, WriterMakesTheBytesOfTheDescription) {
  const TemporaryFolder folder;
  TetMap single;
  single.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  single.tets = {{0, 1, 2, 3}};
  single.parameters = {{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}}}};
  Context context;
  writeMap(single, folder / "a.ovmb", context);
  Bytes expected = ovmbHeader(1, {4, 6, 4, 1});
  expected.chunk("DIRP", directory());
  Bytes points;
  points.span(0, 4).u32(2);
  for (const Vec3& p : single.points) points.f64(p[0]).f64(p[1]).f64(p[2]);
  expected.chunk("VERT", points);
  addTopology(expected, 1, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, {});
  addTopology(expected, 2, {{0, 6, 3}, {2, 10, 5}, {4, 9, 1}, {8, 11, 7}}, {});
  addTopology(expected, 3, {{0, 2, 4, 6}}, {});
  Bytes values;
  values.span(0, 8).u32(0);
  for (const Vec3& p : std::vector<Vec3>{{0, 0, 4}, {2, 0, 0}, {0, 3, 0}, {0, 0, 0}}) {
    values.f64(p[0]).f64(p[1]).f64(p[2]).f64(0).f64(0).f64(0);
  }
  expected.chunk("PROP", values);
  EXPECT_EQ(contentOf(folder / "a.ovmb"), ended(expected));
}

TEST(Ovmb, WriterTakesWiderHandlesForLargerMeshes) {
  const TemporaryFolder folder;
  for (const Index n : {1U, 4U, 30U}) {
    const HexMesh grid = gridMesh(n, n, n);
    writeHexMesh(grid, folder / "a.ovmb");
    const std::string bytes = contentOf(folder / "a.ovmb");
    // The width of handles in the chunk of cells, which is the last with entity 3.
    std::size_t at = 0;
    std::size_t cells = 0;
    while ((at = bytes.find("TOPO", at + 1)) != std::string::npos) cells = at;
    const std::size_t faces = 3 * n * n * (n + 1);
    EXPECT_EQ(bytes[cells + 28], 3);
    EXPECT_EQ(bytes[cells + 31], 2 * faces <= 255 ? 1 : (2 * faces <= 65535 ? 2 : 4));
    expectSameMesh(grid, readHexMesh(folder / "a.ovmb"));
  }
}

}  // namespace
}  // namespace hexhex::test::ovmb_bytes
