// `.hexex` files: lossless round trips, tolerance, and an error with its line for everything else.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::hexex {

using namespace io;
namespace {

// Lines 1 to 6: four vertices; line 7: one tet.
const std::string kPoints = "4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string kTet = "0 1 2 3  0 0 0  1 0 0  0 1 0  0 0 1\n";
const std::string kOneTet = kPoints + "1\n" + kTet;

TetMap parse(const std::string& text, const ReadOptions& options = {}) {
  Context context;
  return readBytes<readHexex>(text, "m.hexex", context, options);
}

void expectSame(const TetMap& a, const TetMap& b) {
  expectSameBits(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    expectSameBits(a.parameters[i], b.parameters[i]);
  }
}

TEST(Hexex, RoundTripIsLossless) {
  const TemporaryFolder folder;
  TetMap map = smallMap();
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    map.points.push_back({random.anyDouble(), random.anyDouble(), random.anyDouble()});
    map.tets.push_back({0, 1, 2, static_cast<Index>(map.points.size() - 1)});
    map.parameters.push_back(map.parameters.front());
    map.parameters.back()[3] = {random.anyDouble(), random.anyDouble(), random.anyDouble()};
  }
  writeMap(map, folder / "map.hexex");
  expectSame(map, readMap(folder / "map.hexex"));
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(Hexex, WritesWhatOthersRead) {
  const TemporaryFolder folder;
  TetMap map = parse(kOneTet);
  map.points[1][0] = 0.1;
  writeMap(map, folder / "map.hexex");
  EXPECT_EQ(contentOf(folder / "map.hexex"),
            "4\n0 0 0\n0.1 0 0\n0 1 0\n0 0 1\n1\n0 1 2 3 0 0 0 1 0 0 0 1 0 0 0 1\n");
}

TEST(Hexex, AnyWhiteSpaceWillDo) {
  std::string spaced = kOneTet;
  for (char& c : spaced) {
    if (c == '\n') c = '\t';
  }
  expectSame(parse(spaced), parse(kOneTet));
  std::string windows;
  for (const char c : kOneTet) windows += c == '\n' ? std::string("\r\n\r\n") : std::string(1, c);
  expectSame(parse(windows), parse(kOneTet));
  EXPECT_EQ(parse(kOneTet.substr(0, kOneTet.size() - 1)).tets.size(), 1U);
}

TEST(Hexex, RationalsAndSigns) {
  const TetMap map = parse(kPoints + "1\n0 1 2 +3  1/3 -2/6 0  +1 -0 .5  1 0 0/5  1e2 3/-4 7\n");
  EXPECT_EQ(map.parameters[0][0], (Vec3{1.0 / 3, -1.0 / 3, 0}));
  EXPECT_EQ(map.parameters[0][1], (Vec3{1, 0, 0.5}));
  EXPECT_EQ(map.parameters[0][3], (Vec3{100, -0.75, 7}));
}

TEST(Hexex, EmptyMapsAreReadable) { EXPECT_TRUE(parse("0\n0\n").tets.empty()); }

TEST(Hexex, TrailingSectionsAreTolerated) {
  const std::string features = "1 2 1\n3\n0 1\n1 2\n0 1 2\n";
  const std::string walls = "2\n0 1 2 0.5\n1 2 3 1/2\n";
  for (const std::string& rest :
       {features, walls, walls + features, std::string("0\n"), std::string("0 0 0\n"),
        std::string("\n\n \n") + walls + "\n" + features, walls + "0 0 0"}) {
    EXPECT_EQ(parse(kOneTet + rest).tets.size(), 1U) << rest;
  }
}

TEST(Hexex, TrailingSectionsBecomeFeatures) {
  const TetMap map = parse(kOneTet + "2\n2 0 1 0.5\n1 2 3 1/2\n1 2 1\n3\n0 1\n1 2\n0 1 2\n");
  EXPECT_EQ(map.features.vertices, (std::vector<FeatureVertex>{{3, 1}}));
  EXPECT_EQ(map.features.edges, (std::vector<FeatureEdge>{{{0, 1}, 1}, {{1, 2}, 1}}));
  // Walls are none, but the first wall is a feature, too.
  EXPECT_EQ(map.features.faces, (std::vector<FeatureFace>{{{0, 1, 2}, 1}}));
  EXPECT_TRUE(parse(kOneTet + "0\n0 0 0\n").features.empty());
  // What is listed twice is kept once.
  const Features once = parse(kOneTet + "2 2 2\n3\n3\n0 1\n1 0\n0 1 2\n1 2 0\n").features;
  EXPECT_EQ(once.vertices.size(), 1U);
  EXPECT_EQ(once.edges, (std::vector<FeatureEdge>{{{0, 1}, 1}}));
  EXPECT_EQ(once.faces.size(), 1U);
}

// Two tets; the triangle between them is 1 2 3.
const std::string kTwoTets =
    "5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n2\n" + kTet + "1 2 3 4  1 0 0  0 1 0  0 0 1  1 1 1\n";
const std::string kBoundary = "0 1 2\n0 3 1\n2 3 0\n4 1 2\n1 3 4\n2 4 3\n";

TEST(Hexex, WallsAreNoFeaturesUnlessTheyAreKept) {
  std::string walls = "7\n3 1 2 0.5\n";
  for (std::size_t i = 0; i < kBoundary.size(); i += 6) walls += kBoundary.substr(i, 5) + " 0\n";
  EXPECT_TRUE(parse(kTwoTets + walls).features.empty());
  const auto kept = [&](const std::string& features) {
    return parse(kTwoTets + walls + features, {.keepWalls = true}).features.faces;
  };
  // Only that inside.
  EXPECT_EQ(kept(""), (std::vector<FeatureFace>{{{3, 1, 2}, 2}}));
  // Features come first.
  EXPECT_EQ(kept("0 0 2\n0 1 2\n1 2 3\n"),
            (std::vector<FeatureFace>{{{0, 1, 2}, 1}, {{1, 2, 3}, 1}}));
  EXPECT_EQ(kept("0 0 1\n0 1 2\n"), (std::vector<FeatureFace>{{{0, 1, 2}, 1}, {{3, 1, 2}, 2}}));
}

TEST(Hexex, AListOfAllOfTheBoundarySaysNothing) {
  const auto facesOf = [](const std::string& features) {
    return parse(kTwoTets + features).features.faces;
  };
  EXPECT_TRUE(facesOf("0 0 6\n" + kBoundary).empty());
  EXPECT_TRUE(facesOf("0 0 7\n" + kBoundary + "2 1 0\n").empty());
  // What is inside stays, and so does a part of the boundary.
  EXPECT_EQ(facesOf("0 0 7\n1 2 3\n" + kBoundary), (std::vector<FeatureFace>{{{1, 2, 3}, 1}}));
  EXPECT_EQ(facesOf("0 0 5\n" + kBoundary.substr(0, 30)).size(), 5U);
  EXPECT_EQ(facesOf("0 0 6\n" + kBoundary.substr(0, 30) + "1 2 3\n").size(), 6U);
  const Features features = parse(kTwoTets + "1 1 6\n4\n0 1\n" + kBoundary).features;
  EXPECT_EQ(features.vertices, (std::vector<FeatureVertex>{{4, 1}}));
  EXPECT_EQ(features.edges, (std::vector<FeatureEdge>{{{0, 1}, 1}}));
}

TEST(Hexex, FeaturesAreWrittenWithoutTags) {
  const TemporaryFolder folder;
  TetMap map = parse(kOneTet);
  map.features.vertices = {{2, 7}, {1, 0}, {0, 1}};
  map.features.edges = {{{1, 0}, -3}};
  map.features.faces = {{{3, 1, 2}, 9}, {{0, 1, 2}, 0}};
  writeMap(map, folder / "a.hexex");
  const TetMap read = readMap(folder / "a.hexex");
  expectSame(read, map);
  EXPECT_EQ(read.features.vertices, (std::vector<FeatureVertex>{{2, 1}, {0, 1}}));
  EXPECT_EQ(read.features.edges, (std::vector<FeatureEdge>{{{1, 0}, 1}}));
  EXPECT_EQ(read.features.faces, (std::vector<FeatureFace>{{{3, 1, 2}, 1}}));
  map.features.edges[0].vertices[0] = 4;
  EXPECT_EQ(failureOf([&] { writeMap(map, folder / "b.hexex"); }).code, ErrorCode::InvalidArgument);
}

struct BadFile {
  std::string text;
  ErrorCode code;
  std::uint64_t line;
  std::string words;  ///< part of the sentence
};

TEST(Hexex, EveryDefectIsNamedWithItsLine) {
  const std::vector<BadFile> files = {
      {"", ErrorCode::FileSyntax, 1, "found the end of the file"},
      {" \n\n", ErrorCode::FileSyntax, 1, "found the end of the file"},
      {"\x7f"
       "ELF\x02\x01",
       ErrorCode::FileSyntax, 1, "the number of vertices, found \"?ELF??\""},
      {"-4\n", ErrorCode::FileSyntax, 1, "negative"},
      {"4.0\n", ErrorCode::FileSyntax, 1, "not a whole number"},
      {"1000000000000\n0 0 0\n", ErrorCode::FileSyntax, 1, "room for at most 1:"},
      {"99999999999999999999999\n0 0 0\n", ErrorCode::FileSyntax, 1, "room"},
      {"2\n0.1234567 0 0\n", ErrorCode::FileSyntax, 2, "ends after 1 of 2 vertices"},
      {"2\n0.1234567 0 0\n1", ErrorCode::FileSyntax, 3, "of vertex 1, found the end of the file"},
      {"2\n0 0 0\n1 x 0\n1\n", ErrorCode::FileSyntax, 3, "of vertex 1, found \"x\""},
      {"1\n0 inf 0\n0\n", ErrorCode::NotFinite, 2, "not finite"},
      {"1\n0 nan 0\n0\n", ErrorCode::NotFinite, 2, "not finite"},
      {"1\n0 1e999 0\n0\n", ErrorCode::NotFinite, 2, "exceeds"},
      {"1\n0 1/0 0\n0\n", ErrorCode::FileSyntax, 2, "divides by zero"},
      {"1\n0 0 1.2.3\n0\n", ErrorCode::FileSyntax, 2, "not a number"},
      {kPoints, ErrorCode::FileSyntax, 5, "the number of tets, found the end"},
      {kPoints + "2\n" + kTet, ErrorCode::FileSyntax, 6, "room for at most 1:"},
      {kPoints + "2\n" + kTet + std::string(40, ' '), ErrorCode::FileSyntax, 7, "1 of 2 tets"},
      {kPoints + "1\n0 1 2 3.5" + std::string(40, ' '), ErrorCode::FileSyntax, 7, "\"3.5\""},
      {kPoints + "1\n0 1 2 3 0 0 0 1 0 0 0 1 0 0 0 /", ErrorCode::FileSyntax, 7, "\"/\""},
      {kPoints + "1\n0 1 2 3 0 0 0 1 0 0 0 1 0 0 0    ", ErrorCode::FileSyntax, 7, "the end"},
      {kOneTet + "tail\n", ErrorCode::FileSyntax, 8, "\"tail\""},
      {kOneTet + "1 2\n", ErrorCode::FileSyntax, 8, "expected the end of the file"},
      {kOneTet + "2\n0 1 2 0.5\n", ErrorCode::FileSyntax, 8, "room"},
      {kOneTet + "1\n0 1 2 x   \n", ErrorCode::FileSyntax, 9, "distance"},
      {kOneTet + "1 0 0\n3\n4\n", ErrorCode::FileSyntax, 10, "expected the end of the file"},
      {kOneTet + "1 0 0\n", ErrorCode::FileSyntax, 8, "a feature vertex, found the end"},
      {kOneTet + "1 0 0\n4\n", ErrorCode::IndexOutOfRange, 9, "a feature vertex is 4"},
      {kOneTet + "0 1 0\n-1 2\n", ErrorCode::IndexOutOfRange, 9, "numbered from 0"},
      {kOneTet + "1\n0 1 9 0.25\n", ErrorCode::IndexOutOfRange, 9, "a vertex of a wall is 9"},
      {kOneTet + "0 0 999999999\n", ErrorCode::FileSyntax, 8, "room"},
  };
  for (const BadFile& file : files) {
    const Failure failure = failureOf([&] { static_cast<void>(parse(file.text)); });
    const std::string where = "m.hexex, line " + std::to_string(file.line) + ": ";
    EXPECT_EQ(name(failure.code), name(file.code)) << failure.sentence;
    EXPECT_TRUE(failure.sentence.starts_with(where)) << where << " | " << failure.sentence;
    EXPECT_NE(failure.sentence.find(file.words), std::string::npos)
        << file.words << " | " << failure.sentence;
    EXPECT_EQ(failure.place.kind, PlaceKind::Line);
    EXPECT_EQ(failure.place.index, file.line);
  }
}

TEST(Hexex, VerticesOutOfRangeAreNamedWithTetAndLine) {
  for (const char* vertex : {"4", "-1", "4294967295", "99999999999999999999999"}) {
    const std::string text = kPoints + "2\n" + kTet + "0 1 " + vertex + kTet.substr(5);
    const Failure failure = failureOf([&] { static_cast<void>(parse(text)); });
    EXPECT_EQ(failure.code, ErrorCode::IndexOutOfRange);
    EXPECT_NE(failure.sentence.find("m.hexex, line 8: tet 1 names vertex " + std::string(vertex)),
              std::string::npos)
        << failure.sentence;
    EXPECT_EQ(toString(failure.place), "tet 1");
  }
}

TEST(Hexex, CancellationEndsReading) {
  Context context;
  context.cancel();
  EXPECT_EQ(failureOf([&] {
              static_cast<void>(readBytes<readHexex>(kOneTet, "m", context, ReadOptions{}));
            }).code,
            ErrorCode::Cancelled);
}

TEST(Hexex, WriterRefusesWhatCannotBeReadBack) {
  const TemporaryFolder folder;
  TetMap map = smallMap();
  map.parameters.pop_back();
  EXPECT_EQ(failureOf([&] { writeMap(map, folder / "m.hexex"); }).code, ErrorCode::InvalidArgument);
  map = smallMap();
  map.parameters[1][2][0] = std::numeric_limits<double>::quiet_NaN();
  const Failure failure = failureOf([&] { writeMap(map, folder / "m.hexex"); });
  EXPECT_EQ(failure.code, ErrorCode::NotFinite);
  EXPECT_EQ(toString(failure.place), "tet 1");
  map = smallMap();
  map.points[2][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(toString(failureOf([&] { writeMap(map, folder / "m.hexex"); }).place), "vertex 2");
  EXPECT_EQ(folder.fileCount(), 0U);
}

}  // namespace
}  // namespace hexhex::test::hexex
