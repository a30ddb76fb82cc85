// Kinds of files that other programs write and this library does not: each made here by the
// format's documentation; and public files, where there are some.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/summary.hpp>

#include <base/vector3.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>
#include <io/formats/netcdf.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::foreign_files {

using namespace io;
namespace {

constexpr Hex kCell = {0, 1, 2, 3, 4, 5, 6, 7};

HexMesh gmsh(const std::string& text) {
  Context context;
  return readBytes<GmshFormat::readMesh>(text, "m.msh", context);
}

/// What versions 1 and 4.0 call a cube of region 5 with a quad of tag 7 on it.
void expectTaggedCube(const HexMesh& mesh) {
  EXPECT_EQ(mesh.cells, Array<Hex>{kCell});
  ASSERT_EQ(mesh.points.size(), 8U);
  EXPECT_EQ(mesh.points[6], (Vec3{1, 1, 1}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{5}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);
  EXPECT_EQ(mesh.features.quads[0].vertices, (Quad{0, 1, 2, 3}));
  EXPECT_EQ(mesh.features.quads[0].tag, 7);
}

const std::string kNodes =
    "8\n11 0 0 0\n12 1 0 0\n13 1 1 0\n14 0 1 0\n15 0 0 1\n16 1 0 1\n17 1 1 1\n18 0 1 1\n";

TEST(ForeignFiles, GmshOfVersion1) {
  const std::string nodes = "$NOD\n" + kNodes + "$ENDNOD\n";
  const std::string elements =
      "$ELM\n2\n1 3 7 1 4 11 12 13 14\n9 5 5 2 8 11 12 13 14 15 16 17 18\n$ENDELM\n";
  expectTaggedCube(gmsh(nodes + elements));
  expectTaggedCube(gmsh("# by hand\n$Comments\nfrom $NOD on\n$EndComments\n" + nodes + elements));
  const Failure wrong = failureOf(
      [&] { static_cast<void>(gmsh(nodes + replaced(elements, "9 5 5 2 8", "9 5 5 2 7"))); });
  EXPECT_EQ(wrong.code, ErrorCode::FileSyntax);
  EXPECT_NE(wrong.sentence.find("line 15: an element of type 5 has 8 nodes, found 7"),
            std::string::npos)
      << wrong.sentence;
}

TEST(ForeignFiles, GmshWithComments) {
  const std::string comment = "$Comments\n$Nodes are below, by XYZ\n$EndComments\n";
  expectTaggedCube(gmsh(comment + "$MeshFormat\n2.0 0 8\n$EndMeshFormat\n" + comment + "$Nodes\n" +
                        kNodes + "$EndNodes\n" + comment +
                        "$Elements\n2\n1 3 2 7 1 11 12 13 14\n9 5 2 5 2 11 12 13 14 15 16 17 "
                        "18\n$EndElements\n"));
}

const std::string kText40 =
    "$MeshFormat\n4 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 3 \"surface_7\"\n"
    "$EndPhysicalNames\n$Entities\n1 0 1 1\n1 0 0 0 0 0 0 0\n6 0 0 0 1 1 0 1 3 1 -4\n"
    "1000 0 0 0 1 1 1 1 5 2 6 8\n$EndEntities\n$Nodes\n2 8\n"
    "6 2 1 4\n11 0 0 0 .1 .2\n12 1 0 0 .1 .2\n13 1 1 0 .1 .2\n14 0 1 0 .1 .2\n"
    "1000 3 0 4\n15 0 0 1\n16 1 0 1\n17 1 1 1\n18 0 1 1\n$EndNodes\n"
    "$Elements\n2 2\n6 2 3 1\n1 11 12 13 14\n1000 3 5 1\n2 11 12 13 14 15 16 17 18\n$EndElements\n";

/// Numbers as bytes, one after the other.
class Bytes {
 public:
  Bytes& sizes(std::initializer_list<std::uint64_t> values) { return add(values); }
  Bytes& integers(std::initializer_list<std::int32_t> values) { return add(values); }
  Bytes& reals(std::initializer_list<double> values) { return add(values); }
  Bytes& text(const std::string& words) {
    bytes += words;
    return *this;
  }
  std::string bytes;

 private:
  template <class T>
  Bytes& add(std::initializer_list<T> values) {
    for (const T value : values) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    return *this;
  }
};

TEST(ForeignFiles, GmshOfVersion40) {
  expectTaggedCube(gmsh(kText40));
  Bytes file;
  file.text("$MeshFormat\n4 1 8\n").integers({1}).text("\n$EndMeshFormat\n$PhysicalNames\n1\n");
  file.text("2 3 \"surface_7\"\n$EndPhysicalNames\n$Entities\n").sizes({1, 0, 1, 1});
  file.integers({1}).reals({0, 0, 0, 0, 0, 0}).sizes({0});
  file.integers({6}).reals({0, 0, 0, 1, 1, 0}).sizes({1}).integers({3}).sizes({1}).integers({-4});
  file.integers({1000}).reals({0, 0, 0, 1, 1, 1}).sizes({1}).integers({5});
  file.sizes({2}).integers({6, 8}).text("\n$EndEntities\n$Nodes\n").sizes({2, 8});
  file.integers({6, 2, 1}).sizes({4});
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (std::int32_t i = 0; i < 8; ++i) {
    if (i == 4) file.integers({1000, 3, 0}).sizes({4});
    const Vec3& point = points[static_cast<std::size_t>(i)];
    file.integers({11 + i}).reals({point[0], point[1], point[2]});
    if (i < 4) file.reals({.1, .2});
  }
  file.text("\n$EndNodes\n$Elements\n").sizes({2, 2}).integers({6, 2, 3}).sizes({1});
  file.integers({1, 11, 12, 13, 14, 1000, 3, 5}).sizes({1});
  file.integers({2, 11, 12, 13, 14, 15, 16, 17, 18}).text("\n$EndElements\n");
  if constexpr (std::endian::native == std::endian::little) expectTaggedCube(gmsh(file.bytes));
}

TEST(ForeignFiles, ParametricNodesOfGmsh) {
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::string names = "$PhysicalNames\n2\n 2\t7\t\"low\"\n3  5 \"all\"\n$EndPhysicalNames\n";
  const std::string elements =
      "$Elements\n2\n1 3 2 7 1 11 12 13 14\n"
      "9 5 2 5 2 11 12 13 14 15 16 17 18\n$EndElements\n";
  const HexMesh mesh =
      gmsh(head + names +
           "$ParametricNodes\n8\n11 0 0 0 0 1\n12 1 0 0 1 4 .5\n13 1 1 0 2 6 .1 .2\n"
           "14 0 1 0 3 1\n15 0 0 1 0 5\n16 1 0 1 0 6\n17 1 1 1 0 7\n18 0 1 1 0 8\n"
           "$EndParametricNodes\n" +
           elements);
  expectTaggedCube(mesh);
  ASSERT_EQ(mesh.features.names.size(), 2U);
  EXPECT_EQ(mesh.features.names[0].name, "low");
  Bytes file;
  file.text(replaced(head, "0 8", "1 8").substr(0, 20)).integers({1});
  file.text("\n$EndMeshFormat\n$ParametricNodes\n8\n");
  for (std::int32_t i = 0; i < 8; ++i) {
    const Vec3& point = mesh.points[static_cast<std::size_t>(i)];
    file.integers({11 + i}).reals({point[0], point[1], point[2]}).integers({i % 3, 1});
    for (int k = 0; k < i % 3; ++k) file.reals({.5});
  }
  file.text("\n$EndParametricNodes\n$Elements\n2\n").integers({3, 1, 2, 1, 7, 1, 11, 12, 13, 14});
  file.integers({5, 1, 2, 9, 5, 2, 11, 12, 13, 14, 15, 16, 17, 18}).text("\n$EndElements\n");
  if constexpr (std::endian::native == std::endian::little) expectTaggedCube(gmsh(file.bytes));
}

TEST(ForeignFiles, PartitionedEntitiesOfGmsh) {
  const std::string box = "0 0 0 1 1 1 ";
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 3 \"surface_7\"\n"
      "$EndPhysicalNames\n$Entities\n0 0 1 1\n6 " +
      box + "1 3 0\n1000 " + box +
      "1 5 0\n$EndEntities\n$PartitionedEntities\n2\n1\n9 1\n0 0 1 1\n16 2 6 2 1 2 " + box +
      "1 -3 0\n1010 3 1000 1 1 " + box +
      "2 5 8 1 -16\n$EndPartitionedEntities\n$Nodes\n1 8 11 18\n3 1010 0 8\n11\n12\n13\n14\n15\n"
      "16\n17\n18\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n$Elements\n"
      "2 2 1 2\n2 16 3 1\n1 11 12 13 14\n3 1010 5 1\n2 11 12 13 14 15 16 17 18\n$EndElements\n";
  expectTaggedCube(gmsh(text));
  const Failure failure =
      failureOf([&] { static_cast<void>(gmsh(replaced(text, "\n1\n9 1", "\n900\n9 1"))); });
  EXPECT_EQ(failure.code, ErrorCode::FileSyntax);
}

TEST(ForeignFiles, PartitionedEntitiesOfGmsh40) {
  std::string text = replaced(kText40, "$EndEntities\n",
                              "$EndEntities\n$PartitionedEntities\n2\n1\n9 1\n0 0 1 1\n"
                              "16 2 6 2 1 2 0 0 0 1 1 0 1 3 0\n1010 3 1000 1 1 0 0 0 1 1 1 1 5 0\n"
                              "$EndPartitionedEntities\n");
  text = replaced(replaced(text, "\n6 2 3 1", "\n16 2 3 1"), "\n1000 3 5 1", "\n1010 3 5 1");
  expectTaggedCube(gmsh(text));
}

/// A text in gzip's form without compression: one stored block.
std::string gzipOf(const std::string& text) {
  std::uint32_t sum = 0xffffffffU;
  for (const char c : text) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) * 0xedb88320U);
  }
  const auto little = [](std::uint32_t value, int bytes) {
    std::string result;
    for (int i = 0; i < bytes; ++i, value >>= 8U) result += static_cast<char>(value & 0xffU);
    return result;
  };
  const auto size = static_cast<std::uint32_t>(text.size());
  return std::string("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10) + '\1' + little(size, 2) +
         little(~size & 0xffffU, 2) + text + little(~sum, 4) + little(size, 4);
}

TEST(ForeignFiles, CompressedFilesOfAnyFormat) {
  if (!hasZlib()) GTEST_SKIP() << "built without zlib";
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(3, 2, 2);
  Context context;
  for (const char* const name : {"m.mesh", "m.vtk", "m.msh", "m.vtu", "m.ovm", "m.meshb"}) {
    SCOPED_TRACE(name);
    writeHexMesh(mesh, folder / name);
    const auto file = folder / (std::string(name) + ".gz");
    const std::string plain = contentOf(folder / name);
    // Two members, as `cat a.gz b.gz` makes them.
    writeText(file, gzipOf(plain.substr(0, 100)) + gzipOf(plain.substr(100)));
    const HexMesh read = readHexMesh(file);
    EXPECT_EQ(read.cells, mesh.cells);
    expectSameBits(read.points, mesh.points);
    EXPECT_EQ(summarizeFile(file, context).cells, mesh.cells.size());

    const std::string packed = gzipOf(plain);
    std::string other = packed;
    other[packed.size() - 6] = static_cast<char>(other[packed.size() - 6] ^ 1);  // of the checksum
    for (const std::string& wrong :
         {packed.substr(0, packed.size() / 2), other, packed + "x", std::string(), plain}) {
      writeText(file, wrong);
      EXPECT_EQ(failureOf([&] { static_cast<void>(readHexMesh(file)); }).code,
                ErrorCode::FileSyntax);
    }
  }
  HexMesh zoned = mesh;
  zoned.regions.assign(mesh.cells.size(), 4);
  zoned.regions.front() = 5;
  const auto poly = folder / "constant/polyMesh";
  writeHexMesh(zoned, folder / "a.foam");
  for (const char* const name : {"points", "faces", "owner", "neighbour", "cellZones"}) {
    writeText(poly / (std::string(name) + ".gz"), gzipOf(contentOf(poly / name)));
    std::filesystem::remove(poly / name);
  }
  EXPECT_EQ(readHexMesh(folder / "a.foam").regions, zoned.regions);
  std::filesystem::create_directory(folder / "processor0");
  std::filesystem::rename(folder / "constant", folder / "processor0" / "constant");
  const auto decomposed = [&] { static_cast<void>(readHexMesh(folder / "a.foam")); };
  EXPECT_NE(failureOf(decomposed).sentence.find("reconstructParMesh"), std::string::npos);

  const Failure failure = failureOf([&] { writeHexMesh(mesh, folder / "n.mesh.gz"); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("read, but not written"), std::string::npos);
}

constexpr std::array<Vec3, 8> kCorners = {
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}}};
constexpr std::array<Vec3, 4> kBottom = {{{1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}}};
constexpr std::array<Vec3, 4> kTop = {{{1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}}};
constexpr std::array<Vec3, 4> kUpright = {{{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};

/// Where the nodes of a cube with sides of length 2 are, in an order of its edges.
std::vector<Vec3> cubeOf20(std::initializer_list<std::array<Vec3, 4>> edges) {
  std::vector<Vec3> nodes(kCorners.begin(), kCorners.end());
  for (const std::array<Vec3, 4>& four : edges) nodes.insert(nodes.end(), four.begin(), four.end());
  return nodes;
}

std::string listed(const std::vector<Vec3>& points, bool numbered) {
  std::ostringstream text;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z] = points[i];
    if (numbered) text << 10 * (i + 1) << ", " << x << ", " << y << ", " << z << '\n';
    if (!numbered) text << x << ' ' << y << ' ' << z << '\n';
  }
  return text.str();
}

HexMesh abaqus(const std::string& text) {
  Context context;
  return readBytes<AbaqusFormat::readMesh>(text, "m.inp", context);
}

const std::string kInpNodes =
    "** a comment\n*Heading\n two words\n*NODE, NSET=All\n5, 0., 0., 0.\n4, 1.0D+00\n3, 1, 1.,\n"
    "2,0,1\n1,0,0,1\n9, 1,0,1\n8,1,1,1.E0\n7,0,1,1\n** stacked\n*node\n11,0,0,2\n12,1,0,2\n"
    "13,1,1,2\n14,0,1,2\n20,9,9,9\n";
const std::string kInpCells =
    "*ELEMENT,\nTYPE = C3D8R, ELSET=\"Left\"\n3, 5,4,3,2,\n1,9,8,7\n"
    "*Element, type=S4, elset=skin\n90, 5,4,3,2\n*Element, type=c3d8i\n4, 1,9,8,7,11,12,13,14\n";

void expectFailureOf(HexMesh (*read)(const std::string&), const std::string& text, ErrorCode code,
                     const std::string& part) {
  const Failure failure = failureOf([&] { static_cast<void>(read(text)); });
  EXPECT_EQ(failure.code, code) << failure.sentence;
  EXPECT_NE(failure.sentence.find(part), std::string::npos) << failure.sentence;
}

TEST(ForeignFiles, AbaqusByOtherPrograms) {
  const HexMesh mesh =
      abaqus(kInpNodes + kInpCells +
             "*elset, elset=upper, generate\n4, 4\n*elset, elset=both\n LEFT, upper\n"
             "*elset, elset=outside\n skin, left\n"
             "*Solid Section, elset=upper, material=steel\n1.,\n"
             "*surface, name=low, type=element\nleft, S1\n*surface, name=around\nboth, s3\n3, S6\n"
             "*surface, type=node, name=n\nALL, 1.\n*nset, nset=here\n14\n*Step\n*Static\n1, 2\n"
             "*Node Output\nU\n*Element Output\nS\n");
  EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 6, 7, 8, 9, 10, 11}}));
  ASSERT_EQ(mesh.points.size(), 13U);
  EXPECT_EQ(mesh.points[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.points[2], (Vec3{1, 1, 0}));
  EXPECT_EQ(mesh.points[6], (Vec3{1, 1, 1}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 2}));  // left and upper; skin has no cells
  // S1 is nodes 1-2-3-4 of the element, S3 is 1-5-6-2, S6 is 4-8-5-1: any order and beginning.
  std::vector<std::pair<std::set<Index>, std::int32_t>> quads;
  for (const FeatureQuad& quad : mesh.features.quads) {
    quads.push_back({{quad.vertices.begin(), quad.vertices.end()}, quad.tag});
  }
  EXPECT_EQ(quads,
            (std::vector<std::pair<std::set<Index>, std::int32_t>>{
                {{0, 1, 2, 3}, 1}, {{0, 1, 4, 5}, 2}, {{4, 5, 8, 9}, 2}, {{0, 3, 4, 7}, 2}}));
  ASSERT_EQ(mesh.features.vertices.size(), 1U);  // the set of all nodes tags none
  EXPECT_EQ(mesh.features.vertices[0].vertex, 11U);
}

TEST(ForeignFiles, InstancesOfAbaqusAreWhereTheyArePut) {
  const std::string part = "*Part, name=P\n" + kInpNodes + kInpCells + "*End Part\n*Assembly\n";
  const std::string end = "*End Instance\n*Node\n30, 5., 5., 5.\n*End Assembly\n";
  const HexMesh moved = abaqus(part + "*Instance, name=P-1, part=P\n10., , 1.\n" + end);
  EXPECT_EQ(moved.points[6], (Vec3{11, 1, 2}));
  EXPECT_EQ(moved.points[13], (Vec3{5, 5, 5}));  // a node of the assembly
  // A quarter turn about the line x = 10, y = 0, upwards, which leaves the first node where it is.
  const std::string turn = "*Instance, name=P-1, part=P\n10.\n10., 0., 0., 10., 0., 3., 90.\n";
  const HexMesh turned = abaqus(part + turn + end);
  const std::array<std::pair<std::size_t, Vec3>, 3> expected = {
      {{0, {10, 0, 0}}, {1, {10, 1, 0}}, {6, {9, 1, 1}}}};
  for (const auto& [i, place] : expected) {
    EXPECT_LT(length(minus(turned.points[i], place)), 1e-12) << i;
  }
  expectFailureOf(abaqus, part + replaced(turn, "10., 0., 3.", "10., 0., 0.") + end,
                  ErrorCode::FileSyntax, "no direction");
}

TEST(ForeignFiles, AssembliesOfAbaqusHaveReferencePoints) {
  const std::string file =
      "*Part, name=P\n" + kInpNodes + kInpCells +
      "*End Part\n*Assembly\n*Instance, name=P-1, part=P\n*End Instance\n*Node\n5, 5., 5., 5.\n"
      "*Nset, nset=RP\n5\n*Nset, nset=in, instance=P-1\n4\n*Nset, nset=dot\nP-1.3\n"
      "*Element, type=MASS\n1, 5\n*Surface, name=s\nP-1.left, S2\n*End Assembly\n";
  const HexMesh mesh = abaqus(file);
  EXPECT_EQ(mesh.points[13], (Vec3{5, 5, 5}));
  std::map<std::string, Index> named;
  for (const FeatureVertex& vertex : mesh.features.vertices) {
    for (const TagName& name : mesh.features.names) {
      if (name.dimension == 0 && name.tag == vertex.tag) named[name.name] = vertex.vertex;
    }
  }
  EXPECT_EQ(named, (std::map<std::string, Index>{{"dot", 2}, {"in", 1}, {"rp", 13}}));
  EXPECT_EQ(mesh.features.quads.size(), 2U);
  expectFailureOf(abaqus, replaced(file, "MASS\n1, 5", "C3D4\n1, 5, 5, 5, 5"),
                  ErrorCode::FileUnsupported, "elements of its own");
}

/// Two instances of a part, one of them turned, and one of another, whose nodes and elements have
/// the same numbers.
TEST(ForeignFiles, AbaqusInstancesOfSeveralParts) {
  const std::string cube =
      "*Element, type=C3D8\n3, 5, 4, 3, 2, 1, 9, 8, 7\n*Elset, elset=body\n3\n"
      "*Solid section, elset=body, material=m\n";
  const std::string file =
      "*Part, name=P\n" + kInpNodes + kInpCells + "*Surface, name=low\nleft, S1\n*End Part\n" +
      "*Part, name=Q\n" + kInpNodes + cube +
      "*End Part\n*Part, name=Unused\n*Node\n1, 0., 0., 0.\n" +
      "*End Part\n*Assembly\n*Instance, name=P-1, part=P\n*End Instance\n" +
      "*Instance, name=Q-1, part=Q\n0., 0., 7.\n*End Instance\n" +
      "*Instance, name=P-2, part=P\n10.\n10., 0., 0., 10., 0., 3., 90.\n*End Instance\n" +
      "*Node\n5, 5., 5., 5.\n*Nset, nset=RP\n5\n*Nset, nset=one, instance=P-2\n4\n" +
      "*Nset, nset=two\nQ-1.4\n*Elset, elset=face, instance=P-2\n4\n*Elset, "
      "elset=face\nP-1.left\n" +
      "*Surface, name=top\nface, S2\n*Surface, name=side\nQ-1.3, S3\n*End Assembly\n";
  const HexMesh mesh = abaqus(file);
  const std::size_t each = 13;
  ASSERT_EQ(mesh.points.size(), 3 * each + 1);  // nothing is merged
  ASSERT_EQ(mesh.cells.size(), 5U);
  for (std::size_t i = 0; i < each; ++i) {
    const Vec3& p = mesh.points[i];
    EXPECT_EQ(mesh.points[each + i], plus(p, {0, 0, 7}));
    EXPECT_LT(length(minus(mesh.points[2 * each + i], {10 - p[1], p[0], p[2]})), 1e-12);
  }
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(mesh.cells[2][k], mesh.cells[0][k] + each);
    EXPECT_EQ(mesh.cells[3][k], mesh.cells[0][k] + 2 * each);
  }
  const auto nameOf = [&](int dimension, std::int32_t tag) {
    for (const TagName& name : mesh.features.names) {
      if (name.dimension == dimension && name.tag == tag) return name.name;
    }
    return std::string("-");
  };
  std::string regions;
  for (const std::int32_t region : mesh.regions) regions += nameOf(3, region) + ' ';
  EXPECT_EQ(regions, "p-1.left - body p-2.left - ");  // those of P need their instance
  std::multiset<std::string> faces;
  for (const FeatureQuad& quad : mesh.features.quads) {
    const Index v = *std::min_element(quad.vertices.begin(), quad.vertices.end());
    faces.insert(nameOf(2, quad.tag) + concat(' ', v));
  }
  EXPECT_EQ(faces,
            (std::multiset<std::string>{"p-1.low 0", "p-2.low 26", "side 13", "top 34", "top 4"}));
  std::set<std::string> vertices;
  for (const FeatureVertex& vertex : mesh.features.vertices) {
    vertices.insert(nameOf(0, vertex.tag) + concat(' ', vertex.vertex));
  }
  EXPECT_EQ(vertices, (std::set<std::string>{"one 27", "rp 39", "two 14"}));
  expectFailureOf(abaqus, replaced(file, "name=P-2", "name=P-1"), ErrorCode::FileSyntax,
                  "two instances");
  expectFailureOf(abaqus, replaced(file, "P-2, part=P", "P-2, part=R"), ErrorCode::FileSyntax,
                  "no part above");
  expectFailureOf(abaqus, replaced(file, "instance=P-2\n4\n*Nset", "instance=P-3\n4\n*Nset"),
                  ErrorCode::FileSyntax, "no instance \"p-3\"");
  expectFailureOf(abaqus, replaced(file, "3, 5, 4, 3, 2, 1", "3, 99, 4, 3, 2, 1"),
                  ErrorCode::IndexOutOfRange, "element 3 names node 99");
  std::string many = file.substr(0, file.find("*Node\n5"));
  for (int i = 0; i < 1000; ++i)
    many += concat("*Instance, name=x", i, ", part=P\n*End Instance\n");
  EXPECT_EQ(abaqus(many).cells.size(), 2005U);
  many = "*Part, name=P\n" + std::string(100000, '*') + "\n*Node\n1, 0., 0., 0.\n*End Part\n";
  for (int i = 0; i < 200; ++i) many += concat("*Instance, name=x", i, ", part=P\n*End Instance\n");
  expectFailureOf(abaqus, many, ErrorCode::TooLarge, "128 times the size");
}

TEST(ForeignFiles, PartsOfAbaqusWithoutInstancesAreReadWhereTheyStand) {
  const std::string part = "*Part, name=P\n" + kInpNodes + kInpCells + "*End Part\n";
  const HexMesh mesh = abaqus(part + "*Surface, name=top\nleft, S2\n");
  EXPECT_EQ(mesh.cells.size(), 2U);
  EXPECT_GT(mesh.features.quads.size(), abaqus(part).features.quads.size());
  const std::string assembly = "*Assembly\n*Instance, name=P-1, part=P\n*End Instance\n";
  EXPECT_EQ(abaqus(part + assembly).cells.size(), 2U);
  const auto fails = [&](const std::string& file, const std::string& sentence) {
    expectFailureOf(abaqus, file, ErrorCode::FileSyntax, sentence);
  };
  fails(replaced(part, "*End Part", "*Instance, name=P-1, part=P\n*End Instance\n*End Part") +
            assembly,
        "\"*instance\" cannot be in a part");
  fails(part + "*Instance, name=P-1, part=P\n", "*END INSTANCE is missing");
  fails(
      part + assembly + "*Elset, elset=far, instance=P-1, generate\n1099511627776, 1099511627776\n",
      "must be below 1099511627776");
}

/// As Abaqus/CAE and preprocessors lay them out: a file per part.
TEST(ForeignFiles, InstancesOfAbaqusReadIncludedFilesOnce) {
  const TemporaryFolder folder;
  writeText(folder / "part.inc", kInpNodes + kInpCells);
  std::string file = "*Part, name=P\n*Include, input=part.inc\n*End Part\n*Assembly\n";
  for (int i = 0; i < 1100; ++i) {
    file += concat("*Instance, name=P-", i, ", part=P\n*End Instance\n");
  }
  writeText(folder / "a.inp", file + "*End Assembly\n");
  EXPECT_EQ(readHexMesh(folder / "a.inp").cells.size(), 2200U);
  writeText(folder / "part.inc", "*Include, input=part.inc\n");
  EXPECT_NE(failureOf([&] {
              static_cast<void>(readHexMesh(folder / "a.inp"));
            }).sentence.find("without end"),
            std::string::npos);
}

/// Parts and assemblies both call their first set "Set-1" where nobody names it.
TEST(ForeignFiles, SetsOfAbaqusWithOneNameInPartAndAssembly) {
  const HexMesh mesh =
      abaqus("*Part, name=P\n" + kInpNodes + kInpCells +
             "*Nset, nset=Set-1\n4\n*Elset, elset=E\n3\n*Solid section, elset=E\n*End Part\n"
             "*Assembly\n*Instance, name=P-1, part=P\n*End Instance\n*Node\n5, 5., 5., 5.\n"
             "*Nset, nset=Set-1\n5\n*Elset, elset=E, instance=P-1\n4\n"
             "*Surface, name=s\nP-1.E, S1\n*Surface, name=t\nE, S2\n*End Assembly\n");
  std::vector<Index> tagged;
  for (const FeatureVertex& vertex : mesh.features.vertices) tagged.push_back(vertex.vertex);
  EXPECT_EQ(tagged, (std::vector<Index>{1, 13}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{2, 0}));  // a section counts more than "Left"
  EXPECT_EQ(mesh.features.quads.size(), 2U);
}

TEST(ForeignFiles, NodesBeyondThoseOfAnElementOfAbaqus) {
  const auto ending = [](const std::string& end) {
    return kInpNodes + replaced(kInpCells, "11,12,13,14", "11,12,13,14" + end);
  };
  EXPECT_EQ(abaqus(ending(", ,")).cells.size(), 2U);
  expectFailureOf(abaqus, ending(",20"), ErrorCode::FileSyntax, "more nodes than the 8");
  EXPECT_EQ(abaqus(replaced(ending(",20,20,20,20"), "c3d8i", "COH3D8P")).cells.size(), 2U);
  expectFailureOf(abaqus, replaced(ending(""), "c3d8i", "coh3d8, offset=20"),
                  ErrorCode::FileUnsupported, "OFFSET");
}

TEST(ForeignFiles, AbaqusAsOthersTypeIt) {
  const auto typed = [](const std::string& type) {
    return abaqus(kInpNodes + replaced(kInpCells, "c3d8i", type)).cells.size();
  };
  for (const char* const type : {"COH3D8", "Q3D8R", "F3D8", "CSS8", "DC3D8"}) {
    EXPECT_EQ(typed(type), 2U) << type;
  }
  for (const char* const type : {"M3D4", "R3D4", "T3D2", "CONN3D2", "F3D4"})
    EXPECT_EQ(typed(type), 1U);
  std::string indented = "*node\n" + kInpNodes + kInpCells;
  for (std::size_t i = 0; (i = indented.find('\n', i)) + 1 < indented.size(); ++i) {
    indented.insert(i + 1, indented[i + 1] == '*' ? "  " : " \t");
  }
  EXPECT_EQ(abaqus(replaced(indented, "*NODE", "* NODE")).cells.size(), 2U);
}

TEST(ForeignFiles, SetsOfAbaqusWithoutSectionsAreRegions) {
  const auto regions = [](const std::string& sets) {
    const HexMesh mesh = abaqus(kInpNodes + kInpCells + sets);
    std::vector<std::string> names;
    for (const std::int32_t region : mesh.regions) {
      for (const TagName& name : mesh.features.names) {
        if (name.dimension == 3 && name.tag == region) names.push_back(name.name);
      }
    }
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(regions("*elset, elset=steel\n3\n*elset, elset=rubber\n4\n"),
            (Names{"steel", "rubber"}));
  EXPECT_EQ(regions("*elset, elset=rubber\n4\n*elset, elset=all\n3, 4\n"),
            (Names{"all", "rubber"}));  // the smaller one
  EXPECT_EQ(regions("*elset, elset=skins\n4, 90\n*elset, elset=s, internal\n4\n"), Names{"left"});
  EXPECT_EQ(regions("*elset, elset=load\n3\n*elset, elset=up\n4\n*solid section, elset=up\n"),
            (Names{"left", "up"}));
}

TEST(ForeignFiles, ShellsOfAbaqusTagQuads) {
  const HexMesh mesh = abaqus(kInpNodes + kInpCells +
                              "*Element, type=CPS4, elset=sheet\n91, 11,12,13,14\n92, 5,4,9,1\n"
                              "*elset, elset=top\n91\n*elset, elset=all\n91, 3\n");
  ASSERT_EQ(mesh.features.quads.size(), 3U);  // with that of kInpCells
  std::vector<std::pair<Quad, std::string>> named;
  for (const FeatureQuad& quad : mesh.features.quads) {
    for (const TagName& name : mesh.features.names) {
      if (name.dimension == 2 && name.tag == quad.tag) named.emplace_back(quad.vertices, name.name);
    }
  }
  EXPECT_EQ(named, (std::vector<std::pair<Quad, std::string>>{
                       {{0, 1, 2, 3}, "skin"}, {{8, 9, 10, 11}, "top"}, {{0, 1, 5, 4}, "sheet"}}));
}

TEST(ForeignFiles, AbaqusMistakesAreToldWithTheirLine) {
  const auto expectFailure = [](const std::string& text, ErrorCode code, const std::string& part) {
    expectFailureOf(abaqus, text, code, part);
  };
  const std::string good = kInpNodes + kInpCells;
  expectFailure("1, 2\n" + good, ErrorCode::FileSyntax, "m.inp, line 1: a file of Abaqus begins");
  expectFailure(replaced(good, "3, 1, 1.", "3, 1, x"), ErrorCode::FileSyntax,
                "line 7: expected a coordinate of a node, found \"x\"");
  expectFailure(replaced(good, "12,1,0,2", "12,inf,0,2"), ErrorCode::NotFinite, "line 16");
  expectFailure(replaced(good, "12,1,0,2", "13,1,0,2"), ErrorCode::FileSyntax,
                "two nodes have the number 13");
  expectFailure(replaced(good, "11,12,13,14", "11,12,13,15"), ErrorCode::IndexOutOfRange,
                "element 4 names node 15");
  expectFailure(replaced(good, ",13,14\n", "\n"), ErrorCode::FileSyntax, "nodes of element 4");
  expectFailure(replaced(good, "13,14\n", "13,14,11\n"), ErrorCode::FileSyntax,
                "line 27: more nodes than the 8 of element 4");
  expectFailure(good + "*ngen\n1, 2, 1\n", ErrorCode::FileUnsupported, "line 28: the keyword");
  expectFailure(good + "*include, input=a.inp\n", ErrorCode::FileUnsupported, "cannot include");
  expectFailure(good + "*node, input=a.inp\n", ErrorCode::FileUnsupported, "INPUT=...");
  expectFailure(good + "*nset,nset=a,generate\n1,900000000000\n", ErrorCode::TooLarge, "line 29");
  expectFailure(good + "*elset,elset=a\nnone\n", ErrorCode::FileSyntax, "\"none\", which is no");
  expectFailure(kInpNodes + "*element, type=C3D6\n3, 5,4,3,1,9,8\n4, 1,9,8,11,12,13\n",
                ErrorCode::FileUnsupported, "it holds 2 prisms");
}

/// Writes meshes as pieces of a file without global numbers.
void writePieces(const TemporaryFolder& folder, const std::vector<HexMesh>& pieces) {
  std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>\n";
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string name = "piece" + std::to_string(i) + ".vtu";
    writeHexMesh(pieces[i], folder / name);
    index += "<Piece Source=\"" + name + "\"/>\n";
  }
  writeText(folder / "a.pvtu", index + "</PUnstructuredGrid></VTKFile>\n");
}

TEST(ForeignFiles, PiecesWithoutGlobalNumbersAreJoinedByPositions) {
  const TemporaryFolder folder;
  HexMesh left = gridMesh(1, 1, 1);
  for (Vec3& point : left.points) {
    for (double& x : point) x = x > 0 ? 1 : 0;
  }
  HexMesh right = left;
  for (Vec3& point : right.points) point[0] += 1;
  left.regions = {4};
  right.regions = {5};
  right.features.quads = {{{0, 2, 6, 4}, 8}};
  writePieces(folder, {left, right});
  const HexMesh mesh = readHexMesh(folder / "a.pvtu");
  EXPECT_EQ(mesh.points.size(), 12U);
  ASSERT_EQ(mesh.cells.size(), 2U);
  EXPECT_EQ(mesh.cells[0], left.cells[0]);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(mesh.points[mesh.cells[1][k]], right.points[right.cells[0][k]]) << k;
  }
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{4, 5}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);  // by the numbers that its points have now
  for (const Index v : mesh.features.quads[0].vertices) EXPECT_EQ(mesh.points[v][0], 1);

  // A slit between cells of one piece is its own affair, but not where another piece goes on.
  HexMesh slit = left;
  slit.points.insert(slit.points.end(), right.points.begin(), right.points.end());
  slit.cells.push_back({});
  for (std::size_t k = 0; k < 8; ++k) slit.cells[1][k] = right.cells[0][k] + 8;
  slit.regions = {4, 4};
  HexMesh apart = left;
  for (Vec3& point : apart.points) point[1] += 5;
  writePieces(folder, {slit, apart});
  EXPECT_EQ(readHexMesh(folder / "a.pvtu").points.size(), 24U);
  for (Vec3& point : apart.points) point[1] -= 4;
  writePieces(folder, {slit, apart});
  const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(folder / "a.pvtu")); });
  EXPECT_EQ(failure.code, ErrorCode::FileSyntax);
  EXPECT_NE(failure.sentence.find("at the point (1.0"), std::string::npos) << failure.sentence;
}

TEST(ForeignFiles, AbaqusIncludes) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "parts");
  writeText(folder / "parts/Nodes.inp", kInpNodes);
  writeText(folder / "a.inp", "*Include, input=parts/Nodes.inp\n" + kInpCells);
  EXPECT_EQ(readHexMesh(folder / "a.inp").cells.size(), 2U);
  writeText(folder / "b.inp", kInpNodes + "*INCLUDE, INPUT=b.inp\n");
  writeText(folder / "c.inp", "*INCLUDE, INPUT=parts/nodes.txt\n");
  const auto sentence = [&](const char* name) {
    return failureOf([&] { static_cast<void>(readHexMesh(folder / name)); }).sentence;
  };
  EXPECT_NE(sentence("b.inp").find("without end"), std::string::npos) << sentence("b.inp");
  EXPECT_NE(sentence("c.inp").find("line 1: there is no file"), std::string::npos);
}

/// Tags of all kinds, and regions.
HexMesh taggedGrid() {
  HexMesh mesh = gridMesh(3, 2, 2);
  mesh.features.vertices = {{0, 4}, {3, 9}};
  mesh.features.edges = {{{0, 1}, 5}, {{1, 2}, 5}, {{0, 4}, 6}};
  for (Index x = 0; x < 3; ++x) mesh.features.quads.push_back({{x, x + 4, x + 5, x + 1}, 3});
  mesh.regions.assign(mesh.cells.size(), 2);
  mesh.regions.back() = 7;
  return mesh;
}

TEST(ForeignFiles, SolversFilesComeBackWithTagsAndRegions) {
  const TemporaryFolder folder;
  const HexMesh mesh = taggedGrid();
  for (const char* const name : {"a.inp", "a.exo", "a.e", "a.cgns"}) {
    SCOPED_TRACE(name);
    try {
      writeHexMesh(mesh, folder / name);
    } catch (const Error& error) {  // in builds without HDF5
      EXPECT_NE(std::string(error.what()).find("HDF5"), std::string::npos) << error.what();
      continue;
    }
    const HexMesh read = readHexMesh(folder / name);
    expectSameBits(read.points, mesh.points);
    EXPECT_EQ(read.cells, mesh.cells);
    EXPECT_EQ(read.regions, mesh.regions);
    ASSERT_EQ(read.features.vertices.size(), 2U);
    EXPECT_EQ(read.features.vertices[1].vertex, 3U);
    EXPECT_EQ(read.features.vertices[1].tag, 9);
    std::vector<std::pair<std::array<Index, 2>, std::int32_t>> edges;
    for (const FeatureEdge& edge : read.features.edges) edges.push_back({edge.vertices, edge.tag});
    EXPECT_EQ(edges, (std::vector<std::pair<std::array<Index, 2>, std::int32_t>>{
                         {{0, 1}, 5}, {{1, 2}, 5}, {{0, 4}, 6}}));
    ASSERT_EQ(read.features.quads.size(), 3U);
    for (const FeatureQuad& quad : read.features.quads) EXPECT_EQ(quad.tag, 3);
  }
}

TEST(ForeignFiles, CubeOf27NodesOfAbaqus) {
  std::vector<Vec3> nodes = cubeOf20({kBottom, kTop, kUpright});
  for (const Vec3& node : {Vec3{1, 1, 1}, Vec3{1, 1, 0}, Vec3{1, 1, 2}, Vec3{1, 0, 1},
                           Vec3{2, 1, 1}, Vec3{1, 2, 1}, Vec3{0, 1, 1}}) {
    nodes.push_back(node);  // the middle, and faces S1 to S6
  }
  std::string cell = "1";
  for (int k = 1; k <= 27; ++k) cell += (k % 12 == 0 ? ",\n" : ", ") + std::to_string(10 * k);
  Context context;
  expectCubeOfOrder2(readBytes<AbaqusFormat::readCurved>(
      "*NODE\n" + listed(nodes, true) + "*ELEMENT, TYPE=C3D27\n" + cell + "\n", "m.inp", context));
}

TEST(ForeignFiles, CubesOf20NodesOfAbaqusAndVtk) {
  const TemporaryFolder folder;
  Context context;
  const std::vector<Vec3> nodes = cubeOf20({kBottom, kTop, kUpright});
  writeText(folder / "a.inp", "*NODE\n" + listed(nodes, true) +
                                  "*ELEMENT, TYPE=C3D20R\n1, 10, 20, 30, 40, 50, 60, 70, 80, 90,"
                                  "\n100, 110, 120, 130, 140, 150, 160, 170, 180, 190, 200\n");
  writeText(folder / "a.vtk",
            "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 20 double\n" +
                listed(nodes, false) +
                "CELLS 1 21\n20 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19\n"
                "CELL_TYPES 1\n25\n");
  for (const char* const name : {"a.inp", "a.vtk"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(holdsLagrangeCells(folder / name, context));
    expectCubeOfOrder2(readLagrangeMesh(folder / name, context));
    const Failure failure =
        failureOf([&, file = folder / name] { static_cast<void>(readHexMesh(file)); });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
    EXPECT_NE(failure.sentence.find("it holds 1 hexahedron with 20 nodes. Cells of order 2"),
              std::string::npos)
        << failure.sentence;
    writeLagrangeMesh(readLagrangeMesh(folder / name, context), folder / "b.vtu", {}, context);
    expectCubeOfOrder2(readLagrangeMesh(folder / "b.vtu", context));
  }
}

/// A universal file: nodes of a cube with sides of length 2, and elements.
std::string unvOf(const std::vector<Vec3>& nodes, const std::string& elements,
                  const std::string& groups) {
  std::ostringstream text;
  text << "    -1\n   164\n         1  SI: -1 Meter         2\n 1.0D+0 1.0D+0\n    -1\n    -1\n  "
          "2411\n";
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [x, y, z] = nodes[i];
    text << 10 * (i + 1) << " 1 1 11\n   " << x << ".0D+00 " << y << ".0000E+00   " << z << '\n';
  }
  text << "    -1\n    -1\n  2412\n" << elements << "    -1\n" << groups;
  return text.str();
}

const std::string kUnvElements =
    "1 11 2 1 7 2\n0 1 1\n10 20\n2 44 2 1 7 4\n10 20 30 40\n9 115 2 1 7 8\n"
    "10 20 30 40 50 60 70 80\n";
const std::string kUnvGroups =
    "    -1\n  2467\n 5 0 0 0 0 0 0 1\nSolid with a name\n 8 9 0 0\n 6 0 0 0 0 0 0 2\nsurface_3\n"
    " 8 1 0 0 8 2 0 0\n 4 0 0 0 0 0 0 1\nhere\n 7 70 0 0\n    -1\n";

HexMesh unv(const std::string& text) {
  Context context;
  return readBytes<UnvFormat::readMesh>(text, "m.unv", context);
}

TEST(ForeignFiles, UniversalFilesWithGroups) {
  const HexMesh mesh = unv(unvOf({kCorners.begin(), kCorners.end()}, kUnvElements, kUnvGroups));
  EXPECT_EQ(mesh.cells, Array<Hex>{kCell});
  EXPECT_EQ(mesh.points[6], (Vec3{2, 2, 2}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{5}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);
  EXPECT_EQ(mesh.features.quads[0].vertices, (Quad{0, 1, 2, 3}));
  EXPECT_EQ(mesh.features.quads[0].tag, 3);
  ASSERT_EQ(mesh.features.edges.size(), 1U);
  EXPECT_EQ(mesh.features.edges[0].vertices, (std::array<Index, 2>{0, 1}));
  ASSERT_EQ(mesh.features.vertices.size(), 1U);
  EXPECT_EQ(mesh.features.vertices[0].vertex, 6U);
  EXPECT_EQ(mesh.features.vertices[0].tag, 4);
  std::set<std::string> names;
  for (const TagName& name : mesh.features.names) names.insert(name.name);
  EXPECT_TRUE(names.contains("Solid with a name"));
}

TEST(ForeignFiles, MistakesInUniversalFilesAreToldWithTheirLine) {
  const std::string good = unvOf({kCorners.begin(), kCorners.end()}, kUnvElements, kUnvGroups);
  const auto expectFailure = [](const std::string& text, ErrorCode code, const std::string& part) {
    expectFailureOf(unv, text, code, part);
  };
  expectFailure("solid\n" + good, ErrorCode::FileSyntax, "m.unv, line 1: expected \"-1\"");
  expectFailure(replaced(good, " 8 9 0 0", " 8 x 0 0"), ErrorCode::FileSyntax,
                "expected a member of a group, found \"x\"");
  expectFailure(replaced(good, "2.0D+00", "2.0D+400"), ErrorCode::NotFinite, "line 11");
  expectFailure(replaced(good, "70 80", "70 90"), ErrorCode::IndexOutOfRange,
                "element 9 names node 90, which is in no data set of nodes");
  expectFailure(replaced(good, "80 1 1 11", "70 1 1 11"), ErrorCode::FileSyntax,
                "two nodes have the number 70");
  std::string nodes27;
  for (int i = 0; i < 27; ++i) nodes27 += " 10";
  expectFailure(replaced(good, "115 2 1 7 8\n10 20 30 40 50 60 70 80", "115 2 1 7 27\n" + nodes27),
                ErrorCode::FileUnsupported, "type 115 with 27 nodes are not known");
  expectFailure(replaced(good, "9 115 2 1 7 8", "9 115 2 1 7 99"), ErrorCode::FileSyntax,
                "element 9 has 99 nodes");
  expectFailure(replaced(good, "9 115 2 1 7 8", "9 115 2 1 7 7"), ErrorCode::FileUnsupported,
                "type 115 with 7 nodes are not known");
  expectFailure(replaced(good, "2411", "15"), ErrorCode::FileUnsupported, "no data set 2411");
  expectFailure(good.substr(0, good.find("60 70 80")), ErrorCode::FileSyntax, "end of the file");
  expectFailure(replaced(replaced(good, "115 2 1 7 8", "112 2 1 7 6"), "60 70 80", "60"),
                ErrorCode::FileUnsupported, "it holds 1 prism");
}

TEST(ForeignFiles, CubeOf20NodesInAUniversalFile) {
  const TemporaryFolder folder;
  Context context;
  // All around the bottom, corners and edges in turn; upright edges; all around the top.
  std::vector<Vec3> nodes;
  for (std::size_t k = 0; k < 4; ++k) nodes.insert(nodes.end(), {kCorners[k], kBottom[k]});
  nodes.insert(nodes.end(), kUpright.begin(), kUpright.end());
  for (std::size_t k = 0; k < 4; ++k) nodes.insert(nodes.end(), {kCorners[4 + k], kTop[k]});
  std::string cell = "1 116 2 1 7 20\n";
  for (int k = 1; k <= 20; ++k) cell += std::to_string(10 * k) + (k % 8 == 0 ? "\n" : " ");
  writeText(folder / "a.unv", unvOf(nodes, cell + '\n', ""));
  ASSERT_TRUE(holdsLagrangeCells(folder / "a.unv", context));
  expectCubeOfOrder2(readLagrangeMesh(folder / "a.unv", context));
}

const std::string kMfemHead = "MFEM mesh v1.3\n# by hand\n\ndimension\n3\n\nelements\n";
const std::string kMfemCube = "5 5 0 1 2 3 4 5 6 7\n";
const std::string kMfemQuads =
    "attribute_sets\n2\n\"a solid\" 1 5\n\"all\" 2 5 6\n\nboundary\n2\n7 3 0 1 2 3\n1 2 0 1 5\n"
    "bdr_attribute_sets\n1\n\"bottom\" 1 7\n";
const std::string kMfemVertices =
    "vertices\n8\n3\n" + listed({kCorners.begin(), kCorners.end()}, false);

HexMesh mfem(const std::string& text) {
  Context context;
  return readBytes<Medit::readMesh>(text, "m.mesh", context);
}

TEST(ForeignFiles, MeshesOfMfem) {
  const std::string good = kMfemHead + "1\n" + kMfemCube + kMfemQuads + kMfemVertices;
  const HexMesh mesh = mfem(good);
  EXPECT_EQ(mesh.cells, Array<Hex>{kCell});
  EXPECT_EQ(mesh.points[6], (Vec3{2, 2, 2}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{5}));
  ASSERT_EQ(mesh.features.quads.size(), 1U);
  EXPECT_EQ(mesh.features.quads[0].vertices, (Quad{0, 1, 2, 3}));
  EXPECT_EQ(mesh.features.quads[0].tag, 7);
  ASSERT_EQ(mesh.features.names.size(), 2U);
  EXPECT_EQ(mesh.features.names[0].name, "a solid");
  EXPECT_EQ(mesh.features.names[0].tag, 5);
  EXPECT_EQ(mesh.features.names[1].name, "bottom");
  EXPECT_EQ(mesh.features.names[1].dimension, 2);
  // Version 4.10 of MFEM writes the numbers on lines of their own.
  const HexMesh lines = mfem(replaced(replaced(good, "solid\" 1 5\n", "solid\"\n1\n5\n"),
                                      "\"all\" 2 5 6", "\"all\"\n2\n5 6"));
  EXPECT_EQ(lines.features.names, mesh.features.names);
  // Attributes that are all 1 say nothing.
  const HexMesh plain = mfem(replaced(replaced(replaced(good, "5 5 0", "1 5 0"), "7 3 0", "1 3 0"),
                                      "dimension", "# x\ndimension"));
  EXPECT_TRUE(plain.regions.empty());
  EXPECT_TRUE(plain.features.quads.empty());
  const auto expectFailure = [](const std::string& text, ErrorCode code, const std::string& part) {
    expectFailureOf(mfem, text, code, part);
  };
  expectFailure(replaced(good, "5 6 7\n", "5 6 8\n"), ErrorCode::IndexOutOfRange, "names vertex 8");
  expectFailure(replaced(good, "5 6 7\n", "5 6 -7\n"), ErrorCode::IndexOutOfRange, "vertex -7");
  expectFailure(replaced(good, "5 5 0", "5 9 0"), ErrorCode::FileSyntax,
                "line 9: there is no geometry 9");
  expectFailure(replaced(good, "5 5 0 1 2 3 4 5 6 7", "5 7 0 1 2 3 4"), ErrorCode::FileUnsupported,
                "it holds 1 pyramid");
  expectFailure(replaced(good, "\n3\n\nelem", "\n2\n\nelem"), ErrorCode::FileUnsupported,
                "dimension");
  expectFailure(replaced(good, "mesh v1.3", "NURBS mesh v1.0"), ErrorCode::FileUnsupported,
                "NURBS");
  expectFailure(replaced(good, "vertices\n8", "vertices\n800"), ErrorCode::FileSyntax, "800");
  expectFailure(replaced(good, "vertices", "vortices"), ErrorCode::FileSyntax, "\"vortices\"");
  expectFailure(good + "boundary\n0\n", ErrorCode::FileSyntax, "out of order");
  expectFailure(good.substr(0, good.find("vertices")), ErrorCode::FileSyntax, "\"vertices\"");
}

/// A mesh of MFEM with nodes.
std::string mfemWithNodes(const std::string& cells, const std::string& space,
                          const std::vector<Vec3>& nodes, std::size_t vertices) {
  return kMfemHead + cells + "boundary\n0\nvertices\n" + std::to_string(vertices) +
         "\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: " + space +
         "\nVDim: 3\nOrdering: 1\n\n" + listed(nodes, false);
}

TEST(ForeignFiles, NodesOfMfem) {
  Context context;
  std::vector<Vec3> nodes = cubeOf20({kBottom, kTop, kUpright});
  for (const Vec3& node : {Vec3{1, 1, 0}, Vec3{1, 0, 1}, Vec3{2, 1, 1}, Vec3{1, 2, 1},
                           Vec3{0, 1, 1}, Vec3{1, 1, 2}, Vec3{1, 1, 1}}) {
    nodes.push_back(node);
  }
  const std::string one = "1\n" + kMfemCube;
  const std::string curved = mfemWithNodes(one, "H1_3D_P2", nodes, 8);
  expectCubeOfOrder2(readBytes<MfemFormat::readCurved>(curved, "m.mesh", context));
  EXPECT_TRUE(readBytes<MfemFormat::holdsCurved>(curved, "m.mesh", context));
  const std::vector<Vec3> corners(kCorners.begin(), kCorners.end());
  for (const std::string space : {"Linear", "H1_3D_P1"}) {
    EXPECT_EQ(mfem(mfemWithNodes(one, space, corners, 8)).points[6], (Vec3{2, 2, 2}));
  }
  // Two cells that meet, each with nodes of its own; and two that do not, as in periodic meshes.
  std::vector<Vec3> rows;
  for (const double x : {0.0, 1.0}) {
    for (std::size_t i = 0; i < 8; ++i) {
      rows.push_back({x + static_cast<double>(i % 2), static_cast<double>(i / 2 % 2),
                      static_cast<double>(i / 4)});
    }
  }
  const std::string two = "2\n1 5 0 1 2 3 4 5 6 7\n1 5 1 8 9 2 5 10 11 6\n";
  const HexMesh mesh = mfem(mfemWithNodes(two, "L2_T1_3D_P1", rows, 12));
  EXPECT_EQ(mesh.points[9], (Vec3{2, 1, 0}));
  EXPECT_EQ(mesh.points[2], (Vec3{1, 1, 0}));
  rows[8][0] = 0.5;
  expectFailureOf(mfem, mfemWithNodes(two, "L2_T1_3D_P1", rows, 12), ErrorCode::FileUnsupported,
                  "periodic");
  expectFailureOf(mfem, mfemWithNodes(one, "H1_3D_P3", nodes, 8), ErrorCode::FileSyntax, "64");
  for (const std::string space : {"Cubic", "H1_3D_P0", "H1_3D_P10", "L2_3D_P2", "H1Pos_3D_P2"}) {
    expectFailureOf(mfem, mfemWithNodes(one, space, nodes, 8), ErrorCode::FileUnsupported,
                    "\"" + space + "\"");
  }
  nodes.pop_back();
  expectFailureOf(mfem, mfemWithNodes(one, "H1_3D_P2", nodes, 8), ErrorCode::FileSyntax, "27");
  expectFailureOf(mfem, mfemWithNodes("1\n1 6 0 1 2 3 4 5\n", "H1_3D_P2", nodes, 6),
                  ErrorCode::FileUnsupported, "a file of their own");
}

/// The nodes of a cube of order 3 at the points of Gauss and Lobatto, as MFEM lists them: of
/// vertices, of edges from their smaller vertex on, of faces, and inside.
std::vector<Vec3> lobattoCube() {
  std::vector<Vec3> nodes(kCorners.begin(), kCorners.end());
  const std::array<double, 2> places = {(1 - 1 / std::sqrt(5.0)) / 2, (1 + 1 / std::sqrt(5.0)) / 2};
  const auto add = [&](std::size_t from, std::size_t to, double s, std::size_t side, double t) {
    Vec3& node = nodes.emplace_back(kCorners[from]);
    for (std::size_t k = 0; k < 3; ++k) {
      node[k] +=
          s * (kCorners[to][k] - kCorners[from][k]) + t * (kCorners[side][k] - kCorners[from][k]);
    }
  };
  const std::array<std::array<std::size_t, 2>, 12> edges = {{{0, 1},
                                                             {1, 2},
                                                             {2, 3},
                                                             {0, 3},
                                                             {4, 5},
                                                             {5, 6},
                                                             {6, 7},
                                                             {4, 7},
                                                             {0, 4},
                                                             {1, 5},
                                                             {2, 6},
                                                             {3, 7}}};
  for (const auto& [from, to] : edges) {
    for (const double s : places) add(from, to, s, from, 0);
  }
  const std::array<std::array<std::size_t, 3>, 6> faces = {
      {{3, 2, 0}, {0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}, {4, 5, 7}}};
  for (const auto& [from, to, side] : faces) {
    for (const double t : places) {
      for (const double s : places) add(from, to, s, side, t);
    }
  }
  for (const double z : places) {
    for (const double y : places) {
      for (const double x : places) nodes.push_back({2 * x, 2 * y, 2 * z});
    }
  }
  return nodes;
}

TEST(ForeignFiles, NodesOfMfemOfHigherOrder) {
  Context context;
  std::vector<Vec3> nodes = lobattoCube();
  std::vector<Vec3> rows;  // of the cell alone, x fastest
  const std::array<double, 4> places = {0, nodes[8][0], 2 - nodes[8][0], 2};
  for (const double z : places) {
    for (const double y : places) {
      for (const double x : places) rows.push_back({x, y, z});
    }
  }
  const std::string one = "1\n" + kMfemCube;
  for (const std::string& text :
       {mfemWithNodes(one, "H1_3D_P3", nodes, 8), mfemWithNodes(one, "L2_T1_3D_P3", rows, 8)}) {
    EXPECT_TRUE(readBytes<MfemFormat::holdsCurved>(text, "m.mesh", context));
    const LagrangeMesh mesh = readBytes<MfemFormat::readCurved>(text, "m.mesh", context);
    ASSERT_EQ(mesh.order, 3);
    ASSERT_EQ(mesh.points.size(), 64U);
    for (std::size_t i = 0; i < 64; ++i) {
      const std::array<std::size_t, 3> place = {i % 4, i / 4 % 4, i / 16};
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(mesh.points[mesh.nodes[i]][k], 2 * static_cast<double>(place[k]) / 3,
                    1e-5)  // texts have six digits
            << i;
      }
    }
    EXPECT_EQ(mesh.points[mesh.nodes[63]], (Vec3{2, 2, 2}));
  }
  // A second cell with the vertices of a face, but other edges.
  const std::string crossed = "2\n" + kMfemCube + "1 5 1 5 6 2 8 9 10 11\n";
  const std::string bent = replaced(crossed, "1 5 6 2", "1 6 5 2");
  nodes.resize(112);
  EXPECT_EQ(readBytes<MfemFormat::readCurved>(mfemWithNodes(crossed, "H1_3D_P3", nodes, 12),
                                              "m.mesh", context)
                .points.size(),
            112U);
  expectFailureOf(mfem, mfemWithNodes(bent, "H1_3D_P3", nodes, 12), ErrorCode::FileSyntax,
                  "not its edges");
}

TEST(ForeignFiles, SectionsOfMeditThatGoOn) {
  const std::string nodes =
      "MeshVersionFormatted 2\nDimension 3\nVertices 8\n0 0 0 0\n1 0 0 0\n1 1 0 0\n"
      "0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n";
  const std::string cell = "Hexahedra\n1\n1 2 3 4 5 6 7 8 1\n";
  EXPECT_EQ(mfem(nodes + cell + "End").cells.size(), 1U);
  EXPECT_EQ(mfem(nodes + cell).cells.size(), 1U);
  // Gmsh writes cells of order 2 so.
  expectFailureOf(mfem, nodes + replaced(cell, " 8 1", " 8 2 3 4 1") + "End", ErrorCode::FileSyntax,
                  "line 14: the section goes on with \"3\" after the hexahedra");
}

TEST(ForeignFiles, ElementTypesOfAbaqus) {
  const TemporaryFolder folder;
  Context context;
  const HexMesh mesh = gridMesh(2, 1, 1);
  WriteOptions options;
  for (const char* const type : {"C3D8", "C3D8R", "C3D8I"}) {
    options.elementType = type;
    writeHexMesh(mesh, folder / "a.inp", options, context);
    EXPECT_NE(contentOf(folder / "a.inp").find(concat("*ELEMENT, TYPE=", type, ", ELSET")),
              std::string::npos);
    EXPECT_EQ(readHexMesh(folder / "a.inp").cells, mesh.cells);
  }
  EXPECT_EQ(failureOf([&] { writeHexMesh(mesh, folder / "a.vtu", options, context); }).code,
            ErrorCode::FileUnsupported);
  options.elementType = "C3D6";
  EXPECT_EQ(failureOf([&] { writeHexMesh(mesh, folder / "b.inp", options, context); }).code,
            ErrorCode::FileUnsupported);
}

TEST(ForeignFiles, TetsOfTetgen) {
  const TemporaryFolder folder;
  Context context;
  const auto read = [&] { return readTetMesh(folder / "a.1.ele", {}, context); };
  const std::string points =
      "# by hand\n5 3 1 1\n 1 0 0 0 7.5 1\n 2 1 0 0 7 1 # an edge\n\n 3 0 1 0 7 0\n"
      " 4 0 0 1 7 0\n 5 1 1 1 7 0\n# end\n";
  const std::string tets = "2 4 1\n1 1 2 3 4 9\n2 2 3 4 5 8\n";
  writeText(folder / "a.1.node", points);
  writeText(folder / "a.1.ele", tets);
  EXPECT_EQ(read().tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(read().points[4], (Vec3{1, 1, 1}));
  EXPECT_EQ(read().regions, (std::vector<std::int32_t>{9, 8}));
  EXPECT_TRUE(read().features.faces.empty());
  writeText(folder / "a.1.face", "3 1\n1 1 2 3 7\n2 2 3 4 0\n3 3 4 5 -2\n");
  ASSERT_EQ(read().features.faces.size(), 2U);
  EXPECT_EQ(read().features.faces[1].vertices, (std::array<Index, 3>{2, 3, 4}));
  EXPECT_EQ(read().features.faces[1].tag, -2);
  writeText(folder / "a.1.face", "2 1\n1 1 2 3 -1\n2 2 3 4 -1\n");  // as TetGen marks them
  EXPECT_TRUE(read().features.faces.empty());
  std::filesystem::remove(folder / "a.1.face");
  writeText(folder / "a.1.node", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  writeText(folder / "a.1.ele", "1 4 0\n0 0 1 2 3\n");
  EXPECT_EQ(read().tets, (std::vector<Tet>{{0, 1, 2, 3}}));

  const auto expectFailure = [&](const std::string& nodes, const std::string& cells, ErrorCode code,
                                 const std::string& part) {
    writeText(folder / "a.1.node", nodes);
    writeText(folder / "a.1.ele", cells);
    const Failure failure = failureOf([&] { static_cast<void>(read()); });
    EXPECT_EQ(failure.code, code) << failure.sentence;
    EXPECT_NE(failure.sentence.find(part), std::string::npos) << failure.sentence;
  };
  expectFailure(points, replaced(tets, "4 5 8", "4 6 8"), ErrorCode::IndexOutOfRange,
                "a.1.ele, line 3: there is no point 6 in the .node file");
  expectFailure(points, replaced(tets, "2 2 3", "3 2 3"), ErrorCode::FileSyntax,
                "line 3: rows are numbered one after the other, from 0 or 1; found 3.");
  expectFailure(points, "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n", ErrorCode::FileUnsupported,
                "it holds 1 tetrahedron with 10 nodes");
  expectFailure(points, "900 4 0\n", ErrorCode::FileSyntax, "900");
  expectFailure(replaced(points, "5 3", "5 2"), tets, ErrorCode::FileUnsupported, "3 coordinates");
  expectFailure(replaced(points, "1 0 0 7 1", "1 x 0 7 1"), tets, ErrorCode::FileSyntax,
                "a.1.node, line 4: expected a coordinate of point 1, found \"x\"");
  std::filesystem::remove(folder / "a.1.node");
  EXPECT_EQ(failureOf([&] { static_cast<void>(read()); }).code, ErrorCode::FileNotFound);
}

std::string vtuArray(const std::string& type, const std::string& name, const std::string& numbers,
                     int components = 1) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + numbers + "</DataArray>\n";
}

/// A piece of cubes beside each other: of unit cubes from x = `first` on.
std::string vtuPiece(int first, int cubes, const std::string& ghosts, const std::string& tags) {
  std::ostringstream points;
  std::ostringstream corners;
  std::ostringstream offsets;
  std::string types;
  std::string regions;
  for (int x = first; x <= first + cubes; ++x) {
    points << x << " 0 0 " << x << " 1 0 " << x << " 1 1 " << x << " 0 1\n";
  }
  for (int c = 0; c < cubes; ++c) {
    for (int k = 0; k < 8; ++k) corners << 4 * c + k << ' ';
    offsets << 8 * (c + 1) << ' ';
    types += "12 ";
    regions += std::to_string(first + c + 1) + ' ';
  }
  return "<Piece NumberOfPoints=\"" + std::to_string(4 * (cubes + 1)) + "\" NumberOfCells=\"" +
         std::to_string(cubes) + "\">\n<PointData>" + vtuArray("Int32", "feature_vertex", tags) +
         "</PointData><CellData>" + vtuArray("Int32", "region", regions) +
         (ghosts.empty() ? "" : vtuArray("UInt8", "vtkGhostType", ghosts)) + "</CellData><Points>" +
         vtuArray("Float32", "p", points.str(), 3) + "</Points><Cells>" +
         vtuArray("Int64", "connectivity", corners.str()) +
         vtuArray("Int32", "offsets", offsets.str()) + vtuArray("UInt8", "types", types) +
         "</Cells></Piece>\n";
}

HexMesh vtuOf(const std::string& pieces) {
  Context context;
  const std::string text = "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>\n" + pieces +
                           "</UnstructuredGrid></VTKFile>\n";
  return readBytes<readVtu>(text, "m.vtu", context);
}

TEST(ForeignFiles, PiecesOfVtuBecomeOneMesh) {
  const std::string first = vtuPiece(0, 2, "0 0", "0 0 0 0 0 0 0 0 0 6 0 0");
  const std::string second = vtuPiece(2, 1, "0", "0 6 0 0 0 0 0 8");
  const HexMesh mesh = vtuOf(first + second);
  ASSERT_EQ(mesh.points.size(), 16U);
  EXPECT_EQ(mesh.points[15], (Vec3{3, 0, 1}));
  EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7},
                                    {4, 5, 6, 7, 8, 9, 10, 11},
                                    {8, 9, 10, 11, 12, 13, 14, 15}}));
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{1, 2, 3}));
  ASSERT_EQ(mesh.features.vertices.size(), 2U);
  EXPECT_EQ(mesh.features.vertices[0].vertex, 9U);
  EXPECT_EQ(mesh.features.vertices[1].vertex, 15U);
  EXPECT_EQ(mesh.features.vertices[1].tag, 8);
  // A piece with a ghost, which is the cell of another one, and one with nothing in it.
  const HexMesh ghosts = vtuOf(vtuPiece(0, 3, "0 0 1", "0 0 0 0 0 0 0 0 0 6 0 0 0 0 0 8") + second +
                               "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>\n");
  EXPECT_EQ(ghosts.points.size(), 16U);
  EXPECT_EQ(ghosts.cells, mesh.cells);
}

TEST(ForeignFiles, MistakesInPiecesOfVtu) {
  const std::string first = vtuPiece(0, 1, "", "0 0 0 0 0 0 0 0");
  const std::string second = vtuPiece(1, 1, "", "0 0 0 0 0 0 0 0");
  const Failure beyond =
      failureOf([&] { static_cast<void>(vtuOf(replaced(first, "6 7 <", "6 8 <") + second)); });
  EXPECT_EQ(beyond.code, ErrorCode::IndexOutOfRange);
  EXPECT_NE(beyond.sentence.find("m.vtu, line 2: a cell of this piece names point 8"),
            std::string::npos)
      << beyond.sentence;
  const Failure missing =
      failureOf([&] { static_cast<void>(vtuOf(first + replaced(second, "offsets", "other"))); });
  EXPECT_NE(missing.sentence.find("no array of cell offsets"), std::string::npos);
}

TEST(ForeignFiles, CubeOf27NodesOfVtk) {
  const TemporaryFolder folder;
  Context context;
  std::vector<Vec3> nodes = cubeOf20({kBottom, kTop, kUpright});
  for (const Vec3& node : {Vec3{0, 1, 1}, Vec3{2, 1, 1}, Vec3{1, 0, 1}, Vec3{1, 2, 1},
                           Vec3{1, 1, 0}, Vec3{1, 1, 2}, Vec3{1, 1, 1}}) {
    nodes.push_back(node);
  }
  std::string cell = "27";
  for (int i = 0; i < 27; ++i) cell += ' ' + std::to_string(i);
  writeText(folder / "a.vtk",
            "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 double\n" +
                listed(nodes, false) + "CELLS 1 28\n" + cell + "\nCELL_TYPES 1\n29\n");
  expectCubeOfOrder2(readLagrangeMesh(folder / "a.vtk", context));
}

TEST(ForeignFiles, LagrangeCellsOfLegacyVtk) {
  constexpr std::array<std::pair<const char*, VtkEdges>, 3> kVersions = {
      {{"5.1", VtkEdges::Around}, {"5.0", VtkEdges::RowByRow}, {"3.0", VtkEdges::RowByRow}}};
  for (const auto& [version, edges] : kVersions) {
    SCOPED_TRACE(version);
    std::vector<Vec3> nodes;
    nodes.reserve(64);
    std::string cell;
    for (const std::uint32_t k : vtkNodeOrder(3, edges)) {
      nodes.push_back({double(k % 4), double(k / 4 % 4), double(k / 16)});
      cell += ' ' + std::to_string(nodes.size() - 1);
    }
    const bool isNew = edges == VtkEdges::Around;
    const std::string text =
        concat("# vtk DataFile Version ", version,
               "\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 64 double\n", listed(nodes, false),
               isNew ? "CELLS 2 64\nOFFSETS vtktypeint64\n0 64\nCONNECTIVITY vtktypeint64\n"
                     : "CELLS 1 65\n64",
               cell, "\nCELL_TYPES 1\n72\n");
    Context context;
    const LagrangeMesh mesh = readBytes<readCurvedVtkLegacy>(text, "a.vtk", context);
    ASSERT_EQ(mesh.order, 3);
    for (std::size_t k = 0; k < 64; ++k) {
      EXPECT_EQ(mesh.points[mesh.nodes[k]],
                (Vec3{double(k % 4), double(k / 4 % 4), double(k / 16)}));
    }
  }
  // Where there are straight cells, these are the mesh.
  const auto holdsCurved = [](const char* first) {
    const std::string text =
        concat("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n",
               "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 2 18\n",
               "8 0 1 2 3 4 5 6 7\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n", first, "\n72\n");
    Context context;
    return readBytes<holdsCurvedVtkLegacy>(text, "a.vtk", context);
  };
  EXPECT_TRUE(holdsCurved("72"));
  EXPECT_FALSE(holdsCurved("12"));
}

/// An Exodus file of one cell, by NetCDF's writer.
void writeExodusCube(const std::vector<Vec3>& nodes, const std::string& type, bool together,
                     const std::filesystem::path& path) {
  NetcdfFile file;
  file.dimensions = {{"num_nodes", nodes.size()}, {"num_el_blk", 1}, {"one", 1}, {"num_dim", 3}};
  const auto reals = [&nodes](std::size_t first, std::size_t axes) {
    return [&nodes, first, axes](LineWriter& values) {
      const auto put = [&](char* place, std::size_t i) {
        return putBigBytes(place, nodes[i % nodes.size()][first + i / nodes.size()]);
      };
      values.write(axes * nodes.size(), sizeof(double), put, nullptr);
    };
  };
  const auto integers = [](std::size_t count, std::int32_t first) {
    return [count, first](LineWriter& values) {
      const auto put = [&](char* place, std::size_t i) {
        return putBigBytes(place, first + static_cast<std::int32_t>(i));
      };
      values.write(count, sizeof(std::int32_t), put, nullptr);
    };
  };
  if (together) file.variables.push_back({"coord", NetcdfType::Double, {3, 0}, {}, reals(0, 3)});
  for (std::size_t axis = 0; axis < (together ? 0U : 3U); ++axis) {
    file.variables.push_back(
        {std::string("coord") + "xyz" [axis], NetcdfType::Double, { 0 }, {}, reals(axis, 1)});
  }
  file.variables.push_back({"eb_prop1", NetcdfType::Int, {1}, {}, integers(1, 44)});
  file.variables.push_back(
      {"connect1", NetcdfType::Int, {2, 0}, {{"elem_type", type}}, integers(nodes.size(), 1)});
  OutputFile output(path);
  file.write(output, 1, kMostExodusBytes);
  output.commit();
}

TEST(ForeignFiles, CubesOfExodus) {
  const TemporaryFolder folder;
  Context context;
  std::vector<Vec3> nodes = cubeOf20({kBottom, kUpright, kTop});
  writeExodusCube(nodes, "HEX", false, folder / "a.e");
  ASSERT_TRUE(holdsLagrangeCells(folder / "a.e", context));
  expectCubeOfOrder2(readLagrangeMesh(folder / "a.e", context));
  for (const Vec3& node : {Vec3{1, 1, 1}, Vec3{1, 1, 0}, Vec3{1, 1, 2}, Vec3{0, 1, 1},
                           Vec3{2, 1, 1}, Vec3{1, 0, 1}, Vec3{1, 2, 1}}) {
    nodes.push_back(node);
  }
  writeExodusCube(nodes, "HEX27", true, folder / "b.e");
  expectCubeOfOrder2(readLagrangeMesh(folder / "b.e", context));
  EXPECT_EQ(readLagrangeMesh(folder / "b.e", context).regions, (Array<std::int32_t>{44}));
  nodes.resize(8);
  writeExodusCube(nodes, "hex8", true, folder / "c.e");
  EXPECT_EQ(readHexMesh(folder / "c.e").cells, Array<Hex>{kCell});
  const auto sentence = [&](const char* type) {
    writeExodusCube(nodes, type, false, folder / "d.e");
    return failureOf([&] { static_cast<void>(readHexMesh(folder / "d.e")); }).sentence;
  };
  EXPECT_NE(sentence("SHELL8").find("holds no hexahedra with 8 nodes, but points, lines"),
            std::string::npos);
  EXPECT_NE(sentence("BEX_HEX").find("it holds 1 Bezier hexahedron."), std::string::npos);
  EXPECT_NE(sentence("LATTICE").find("\"lattice\" are not supported"), std::string::npos);
  writeText(folder / "d.e", replaced(contentOf(folder / "c.e"), "connect1", "facconn1"));
  EXPECT_NE(failureOf([&] {
              static_cast<void>(readHexMesh(folder / "d.e"));
            }).sentence.find("\"nfaced\" are not supported"),
            std::string::npos);
}

TEST(ForeignFiles, ExodusFilesThatAreCutOffOrChanged) {
  const TemporaryFolder folder;
  writeHexMesh(taggedGrid(), folder / "a.e");
  const std::string good = contentOf(folder / "a.e");
  Context context;
  Random random(7);
  std::size_t refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    if (i % 2 == 0) bytes.resize(random.below(good.size()));
    if (i % 2 == 1) bytes[random.below(good.size())] = static_cast<char>(random.below(256));
    try {
      static_cast<void>(readBytes<ExodusFormat::readMesh>(bytes, "a.e", context));
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, 200U);
  const Failure hdf = failureOf([&] {
    static_cast<void>(
        readBytes<ExodusFormat::readMesh>("\x89HDF\r\n\x1a\n........", "a.e", context));
  });
  EXPECT_NE(hdf.sentence.find("HDF5"), std::string::npos) << hdf.sentence;
  // An element that is not there: behind a variable's name, its head tells where it begins.
  const std::size_t head = good.find("elem_ss1") + 32;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < (good[3] == 1 ? 4U : 8U); ++i) {
    begin = 256 * begin + static_cast<unsigned char>(good[head + i]);
  }
  std::string wrong = good;
  wrong.at(begin) = 1;
  const Failure beyond = failureOf(
      [&] { static_cast<void>(readBytes<ExodusFormat::readMesh>(wrong, "a.e", context)); });
  EXPECT_NE(beyond.sentence.find("side set 1 names side"), std::string::npos) << beyond.sentence;
}

TEST(ForeignFiles, PublicOnes) {
  const char* const chosen = std::getenv("HEXHEX_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "files";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "there is no " << folder;
  Context context;
  const std::vector<std::pair<const char*, std::size_t>> straight = {
      {"automesh_cube_1_10.exo", 365},
      {"automesh_letter_f_3d.inp", 39},
      {"dealii_grid_in_msh_01.3d_neg.v4.msh", 1},
      {"dealii_grids_abaqus_3d_3d_CC_cubit_new.inp", 16},
      {"dealii_grids_grid_in_msh_01.3da.v41.msh", 200},
      {"dealii_grid_in_unv_3d_salome_cube.unv", 125},
      {"libmesh_read_exodus_HEX8.e", 8},
      {"libmesh_tensile_sample_test1.inp.gz", 728}};
  for (const auto& [name, cells] : straight) {
    if (std::string(name).ends_with(".gz") && !hasZlib()) continue;
    EXPECT_EQ(readHexMesh(folder / name).cells.size(), cells) << name;
  }
  for (const auto& [name, cells] :
       {std::pair("libmesh_read_exodus_HEX20.e", 8), std::pair("libmesh_read_exodus_HEX27.e", 8),
        std::pair("mfem_fichera-q2.vtk", 7)}) {
    ASSERT_TRUE(holdsLagrangeCells(folder / name, context)) << name;
    const LagrangeMesh mesh = readLagrangeMesh(folder / name, context);
    EXPECT_EQ(mesh.cellCount(), static_cast<std::size_t>(cells)) << name;
    // Nodes in the wrong order would turn some part of a cell over.
    EXPECT_TRUE(certify(mesh, context).allPositive()) << name;
  }
  ReadOptions hexesOnly;
  hexesOnly.hexesOnly = true;
  EXPECT_EQ(readHexMesh(folder / "vtkdata_uGridEx.vtk", hexesOnly, context).cells.size(), 2U);
  const std::string surface = "points, lines, triangles or quads only: a surface, not a volume.";
  const std::vector<std::pair<const char*, std::string>> refused = {
      {"dealii_grid_in_msh_version_1_input_v1.msh", surface},
      {"dealii_grid_in_msh_version_2_hole81_commented.msh", surface},
      {"mfemdata_gmsh_v40_surfaces_in_3d.asc.v40.msh", surface},
      {"mfemdata_gmsh_v40_surfaces_in_3d.bin.v40.msh", surface},
      {"libmesh_Cube_With_Sidesets.e", "it holds 27 Bezier hexahedra."},
      {"mfem_fichera-mixed-p2.vtk", "Give the others a file of their own."},
      {"vtkdata_polyhedron2pieces.vtu", "it holds 2 polyhedra and 2 pyramids."}};
  for (const auto& [name, sentence] : refused) {
    const Failure failure =
        failureOf([&, file = folder / name] { static_cast<void>(readHexMesh(file)); });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported) << name;
    EXPECT_NE(failure.sentence.find(sentence), std::string::npos) << failure.sentence;
  }
}

TEST(ForeignFiles, PublicCgns) {
  const char* const chosen = std::getenv("HEXHEX_TEST_DATA");
  const std::filesystem::path file =
      std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "files" /
      "scorec_8hexs.cgns";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
  if (!hasHdf5()) GTEST_SKIP() << "built without HDF5, or it cannot be loaded";
  const HexMesh mesh = readHexMesh(file);
  EXPECT_EQ(mesh.cells.size(), 8U);
  EXPECT_EQ(mesh.points.size(), 27U);
  EXPECT_EQ(mesh.features.quads.size(), 24U);
  EXPECT_EQ(mesh.features.edges.size(), 8U);
}

}  // namespace
}  // namespace hexhex::test::foreign_files
