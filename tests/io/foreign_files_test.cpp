// Kinds of files that other programs write and this library does not: each made here by the
// format's documentation; and public files, where there are some.
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>
#include <hexhex/survey.hpp>

#include <io/core/zlib_blocks.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::foreign_files {

using namespace io;
namespace {

constexpr Hex kCell = {0, 1, 2, 3, 4, 5, 6, 7};

HexMesh gmsh(const std::string& text) {
  Context context;
  return readGmsh({text, "m.msh"}, context);
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
    EXPECT_EQ(surveyFile(file, context).cells, mesh.cells.size());

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
  const Failure failure = failureOf([&] { writeHexMesh(mesh, folder / "n.mesh.gz"); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("read, but not written"), std::string::npos);
}

}  // namespace
}  // namespace hexhex::test::foreign_files
