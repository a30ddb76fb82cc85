// `.ovm` files written by hand: the format's liberties, what is skipped, every mistake with its
// line.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>

#include "io_test_support.hpp"
#include "ovm_test_support.hpp"

namespace hexhex::test {

using namespace io;
namespace {

TetMap map(const std::string& text) {
  Context context;
  return readBytes<OvmText::readMap>(text, "m.ovm", context, ReadOptions{});
}

HexMesh mesh(const std::string& text) {
  Context context;
  return readBytes<OvmText::readMesh>(text, "m.ovm", context);
}

const std::string kGeometry =
    "OVM ASCII\nVertices\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nEdges\n6\n0 1\n0 2\n0 3\n1 2\n1 3\n2 3\n"
    "Faces\n4\n3 0 6 3\n3 2 10 5\n3 4 9 1\n3 8 11 7\nPolyhedra\n1\n4 0 2 4 6\n";
const std::string kMap =
    "HFProp vec3d \"HexHex::Parametrization\"\n0 0 1\n0 0 0\n1 0 0\n0 0 0\n0 1 0\n0 0 0\n0 0 0\n"
    "0 0 0\n";
const std::string kGood = kGeometry + kMap;

void expectTheMap(const TetMap& read) {
  EXPECT_EQ(read.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(read.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  ASSERT_EQ(read.parameters.size(), 1U);
  EXPECT_EQ(read.parameters[0], (TetParameters{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
}

TEST(OvmText, Liberties) {
  expectTheMap(map(kGood));
  expectTheMap(map(replaced(kGood, "OVM ASCII\n", "")));
  expectTheMap(map(replaced(kGood, "OVM ASCII", "ovm ascii")));
  expectTheMap(map(replaced(replaced(kGood, "Vertices", "VERTICES"), "Polyhedra", "polyhedra")));
  expectTheMap(map(replaced(kGood, "HFProp vec3d", "hfprop VEC3D")));
  expectTheMap(map(replaced(kGood, "HFProp vec3d", "\t HFProp   vec3f ")));
  expectTheMap(map(replaced(kGood, "Edges\n", "# a comment\n\n  # another\n\tEdges\t\r\n")));
  expectTheMap(map("\n# before all\n" + kGood));
  expectTheMap(map(replaced(kGood, "\nHFProp", "\n# between\n\nHFProp") + "# at the end"));
  // Values are read one after the other, whatever the lines.
  expectTheMap(map(replaced(kGood, "0 0 1\n0 0 0\n1 0 0", "0\n0 1 0 0 0 1\n\n0 0")));
  std::string crlf;
  for (const char c : kGood) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expectTheMap(map(crlf));
  // Valences need not be alike; a face without a cell, and one of another valence.
  expectTheMap(
      map(replaced(replaced(kGood, "Faces\n4", "Faces\n5"), "Polyhedra", "4 0 6 10 5\nPolyhedra") +
          "0 0 0\nnan inf -1e999\n"));
}

TEST(OvmText, OtherPropertiesAreSkipped) {
  const std::string others =
      "VProp string \"a HFProp int \"quoted\" name\"\n3:a b\n0:\n30:x\nHFProp vec3d \"HexHex::Par\n"
      "1\n\n4:abcd\n"
      "CProp Unknown::Type \"u\"\nwhatever { } # no comment\n\n42\n"
      "HEProp vector_vector_hfh \"v\"\n2\n1\n0\n2\n1\n2\n"
      "EProp uchar \"characters\"\na\n#\n:\n \n\"\nz\n"
      "MProp double \"of the mesh\"\n1.5\n"
      "VProp int \"AlgoHex::FeatureEdges\"\n1 2 3 4\n"
      "CProp vec3d \"HexHex::Parametrization\"\n1 2 3\n"
      "fprop float \"f\"\n1 2 3 4\n";
  // 30 bytes of the third string include line breaks and what looks like a header.
  const std::string exact = replaced(others, "30:x\nHFProp vec3d \"HexHex::Par\n1\n",
                                     "34:x\nHFProp vec3d \"HexHex::Par\n1\n..\n");
  const TetMap read = map(kGeometry + exact + kMap);
  expectTheMap(read);
  EXPECT_TRUE(read.features.empty());
  expectTheMap(map(kGeometry + kMap + exact));
}

TEST(OvmText, PropertiesThatAreKnown) {
  const std::string others =
      "VProp int \"AlgoHex::FeatureVertices\"\n0\n-5\n0\n2147483647\n"
      "EProp bool \"AlgoHex::FeatureEdges\"\n0\n1\n0\n0\n0\n0\n"
      "FProp long \"AlgoHex::FeatureFaces\"\n0\n0\n0\n+3\n"
      "EProp int \"edge_valance\"\n0\n0\n-1\n0\n1\n0\n"
      "HFProp int \"HalffaceTransiton\"\n4\n-7\n5\n0\n6\n0\n7\n99\n";
  const TetMap read = map(kGood + others);
  EXPECT_EQ(read.features.vertices, (std::vector<FeatureVertex>{{1, -5}, {3, 2147483647}}));
  EXPECT_EQ(read.features.edges, (std::vector<FeatureEdge>{{{0, 2}, 1}}));
  EXPECT_EQ(read.features.faces, (std::vector<FeatureFace>{{{1, 3, 2}, 3}}));
  ASSERT_EQ(read.edgeValences.size(), 2U);
  EXPECT_EQ(read.edgeValences[0].vertex1, 3U);
  EXPECT_EQ(read.edgeValences[0].offset, -1);
  EXPECT_EQ(read.rotations, (std::vector<std::array<std::int8_t, 4>>{{7, 5, 6, 4}}));
}

struct BadText {
  std::string text;
  ErrorCode code;
  std::uint64_t line;
  std::string words;
};

TEST(OvmText, EveryDefectIsNamedWithItsLine) {
  const std::vector<BadText> files = {
      {"", ErrorCode::FileSyntax, 1, "expected the section Vertices, found the end of the file"},
      {"OVM BINARY\n", ErrorCode::FileUnsupported, 1, "\"BINARY\""},
      {"OVM x\n", ErrorCode::FileSyntax, 1, "\"OVM ASCII\""},
      {"OVMB\n\r\n\xff", ErrorCode::FileUnsupported, 0, ".ovmb"},
      {"solid x\n", ErrorCode::FileSyntax, 1, "found \"solid\""},
      {replaced(kGood, "4\n0 0 0", "x\n0 0 0"), ErrorCode::FileSyntax, 3, "the number of vertices"},
      {replaced(kGood, "4\n0 0 0", "-4\n0 0 0"), ErrorCode::FileSyntax, 3, "is negative"},
      {replaced(kGood, "4\n0 0 0", "1099511627776\n0 0 0"), ErrorCode::FileSyntax, 3,
       "announces 1099511627776 vertices"},
      {replaced(kGood, "1 0 0\n", "1 0 x\n"), ErrorCode::FileSyntax, 5, "a coordinate of vertex 1"},
      {replaced(kGood, "1 0 0\n", "1 0 inf\n"), ErrorCode::NotFinite, 5, "not finite"},
      {replaced(kGood, "Edges\n6", "Edges\n7"), ErrorCode::FileSyntax, 16, "a vertex of edge 6"},
      {replaced(kGood, "Edges\n6", "Edges\n5"), ErrorCode::FileSyntax, 15, "the section Faces"},
      {replaced(kGood, "0 3\n1 2", "0 4\n1 2"), ErrorCode::IndexOutOfRange, 12,
       "edge 2 names vertex \"4\", but there are 4"},
      {replaced(kGood, "0 3\n1 2", "0 -1\n1 2"), ErrorCode::IndexOutOfRange, 12, "\"-1\""},
      {replaced(kGood, "3 2 10 5", "3 2 12 5"), ErrorCode::IndexOutOfRange, 19,
       "face 1 names half-edge \"12\", but there are 12"},
      {replaced(kGood, "3 2 10 5", "2 2 10"), ErrorCode::FileSyntax, 19, "has the valence 2"},
      {replaced(kGood, "3 2 10 5", "x 2 10 5"), ErrorCode::FileSyntax, 19, "the valence of face 1"},
      {replaced(kGood, "3 2 10 5", "99999999999 2 10"), ErrorCode::FileSyntax, 19, "the valence"},
      {replaced(kGood, "4 0 2 4 6", "4 0 2 4 8"), ErrorCode::IndexOutOfRange, 24,
       "half-face \"8\""},
      {replaced(kGood, "4 0 2 4 6", "4 0 2 4"), ErrorCode::FileSyntax, 25, "a half-face of cell 0"},
      {kGood.substr(0, kGood.find("Polyhedra")), ErrorCode::FileSyntax, 21, "Polyhedra"},
      {kGood.substr(0, kGood.find("4 0 2 4 6")), ErrorCode::FileSyntax, 23, "announces 1 cells"},
      {replaced(kGood, "HFProp", "HGProp"), ErrorCode::FileSyntax, 25, "expected a property"},
      {replaced(kGood, "0 0 1\n0 0 0", "0 0 1\n0 x 0"), ErrorCode::FileSyntax, 27,
       "a parameter of half-face 1"},
      {kGood.substr(0, kGood.size() - 3), ErrorCode::FileSyntax, 33, "a parameter of half-face 7"},
      {kGood + "0 0 0\n", ErrorCode::FileSyntax, 34, "expected a property"},
      {kGood + "EProp int \"edge_valance\"\n0 0 1.5\n", ErrorCode::FileSyntax, 35,
       "a value of the property \"edge_valance\""},
      {kGood + "EProp int \"edge_valance\"\n0 0 2147483648\n", ErrorCode::FileUnsupported, 35,
       "does not fit"},
      {kGood + "VProp string \"s\"\n1:a\n5\n", ErrorCode::FileSyntax, 36, "its length in front"},
      {kGood + "VProp string \"s\"\n99:a\n", ErrorCode::FileSyntax, 35, "its length in front"},
      {kGeometry, ErrorCode::FileUnsupported, 0, "no map"},
      {replaced(kGood, "HFProp vec3d", "HFProp vec2d"), ErrorCode::FileUnsupported, 0,
       "is not one of half-faces"},
      {replaced(kGood, "0 0 1\n0 0 0\n", "0 0 nan\n0 0 0\n"), ErrorCode::NotFinite, 0, "tet 0"},
      {kGood + "CProp int \"hexhex::corner_order\"\n24\n", ErrorCode::FileSyntax, 0,
       "corner order"},
  };
  for (const BadText& file : files) {
    const Failure failure = failureOf([&] { static_cast<void>(map(file.text)); });
    EXPECT_EQ(name(failure.code), name(file.code)) << failure.sentence;
    const std::string where =
        file.line == 0 ? "m.ovm: " : "m.ovm, line " + std::to_string(file.line) + ": ";
    EXPECT_TRUE(failure.sentence.starts_with(where)) << where << "| " << failure.sentence;
    EXPECT_NE(failure.sentence.find(file.words), std::string::npos)
        << file.words << " | " << failure.sentence;
  }
}

TEST(OvmText, HexMeshesOfOtherTools) {
  // As other tools write them: a digit count of their own, generators by index, half-faces outward.
  const std::string text =
      "OVM ASCII\nVertices\n8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "Edges\n12\n0 1\n1 2\n2 3\n3 0\n4 7\n7 6\n6 5\n5 4\n0 4\n1 5\n2 6\n3 7\n"
      "Faces\n6\n4 0 2 4 6\n4 8 10 12 14\n4 16 15 19 1\n4 5 20 11 23\n4 18 13 21 3\n"
      "4 7 22 9 17\nPolyhedra\n1\n6 1 3 5 7 9 11\n"
      "VProp int \"v_tet_generator_type\"\n0 0 0 0 1 1 2 3\n"
      "VProp int \"v_tet_generator_index\"\n0 1 2 3 4 5 6 7\n"
      "FProp int \"AlgoHex::FeatureFaces\"\n5\n0\n0\n0\n0\n0\n";
  const HexMesh read = mesh(text);
  ASSERT_EQ(read.cells.size(), 1U);
  EXPECT_EQ(read.cells[0], (Hex{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_TRUE(read.generatorTet.empty());
  EXPECT_EQ(read.features.quads, (std::vector<FeatureQuad>{{{0, 1, 2, 3}, 5}}));
  EXPECT_EQ(failureOf([&] { static_cast<void>(mesh(kGood)); }).code, ErrorCode::FileUnsupported);
  EXPECT_EQ(failureOf([&] { static_cast<void>(map(text)); }).code, ErrorCode::FileUnsupported);
}

TEST(OvmText, GeneratorsAreChecked) {
  const TemporaryFolder folder;
  HexMesh grid = gridMesh(1, 1, 1);
  grid.generatorTet.assign(8, 3);
  grid.generatorCorners.assign(8, 15);
  writeHexMesh(grid, folder / "a.ovm");
  const std::string text = contentOf(folder / "a.ovm");
  grid.generatorCorners[5] = 0;
  const Failure refused = failureOf([&] { writeHexMesh(grid, folder / "a.ovm"); });
  EXPECT_EQ(refused.code, ErrorCode::InvalidArgument);
  EXPECT_EQ(toString(refused.place), "vertex 5");
  EXPECT_EQ(contentOf(folder / "a.ovm"), text);
  const std::string title = "generator_corners\"\n";
  EXPECT_EQ(
      failureOf([&] { static_cast<void>(mesh(replaced(text, title + "15", title + "16"))); }).code,
      ErrorCode::FileSyntax);
  EXPECT_EQ(failureOf([&] {
              static_cast<void>(mesh(replaced(text, "generator_tet\"\n3", "generator_tet\"\n-2")));
            }).code,
            ErrorCode::FileSyntax);
}

}  // namespace
}  // namespace hexhex::test
