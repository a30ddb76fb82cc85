// Damaged files: truncated at every byte, and with random bytes changed. Whatever happens, a reader
// returns a consistent mesh or throws an Error, and never asks for memory out of proportion.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <span>
#include <string>

#include <gtest/gtest.h>
#include <support/compressions.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace {
std::atomic<std::size_t> largestAllocation{0};
}  // namespace

// All memory of this program comes from here, so that the largest request is known.
[[gnu::noinline]] void* operator new(std::size_t size) {
  std::size_t largest = largestAllocation.load();
  while (size > largest && !largestAllocation.compare_exchange_weak(largest, size)) {
  }
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// Of the same kin, so that what comes from here also goes back here.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

namespace hexhex::test {

using namespace io;
namespace {

// The files here have a few kilobytes; a reader may want a small multiple of that.
constexpr std::size_t kReasonableAllocation = 1 << 18;

bool isConsistent(const TetMap& map) {
  if (map.parameters.size() != map.tets.size()) return false;
  for (const Tet& tet : map.tets) {
    for (const Index corner : tet) {
      if (corner >= map.points.size()) return false;
    }
  }
  return true;
}

bool isConsistent(const HexMesh& mesh) {
  for (const Hex& cell : mesh.cells) {
    for (const Index corner : cell) {
      if (corner >= mesh.points.size()) return false;
    }
  }
  return true;
}

bool isConsistent(const LagrangeMesh& mesh) {
  return std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
                     [&](Index node) { return node < mesh.points.size(); });
}

template <class Parse>
void expectNoCrash(const std::string& text, const Parse& parse) {
  try {
    Context context;
    EXPECT_TRUE(isConsistent(parse(text, "damaged", context)));
  } catch (const Error& error) {
    EXPECT_NE(error.code(), ErrorCode::Internal) << error.what();
  }
}

/// Replaces, removes or inserts a few bytes, preferring those that mean something in the format.
std::string mutated(std::string text, Random& random) {
  constexpr std::string_view kTelling = "0123456789-+./eE \n\t\"<>=_#xn\0\xff";
  const std::size_t changes = 1 + random.below(4);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t place = random.below(text.size());
    const char byte = random.below(4) == 0 ? static_cast<char>(random.below(256))
                                           : kTelling[random.below(kTelling.size())];
    switch (random.below(4)) {
      case 0:
        text.erase(place, 1 + random.below(3));
        break;
      case 1:
        text.insert(place, 1 + random.below(12), byte);
        break;
      default:
        text[place] = byte;
    }
  }
  return text;
}

template <class Parse>
void damage(const std::string& text, const Parse& parse) {
  largestAllocation = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    expectNoCrash(text.substr(0, size), parse);
  }
  Random random(7);
  for (int i = 0; i < 5000; ++i) expectNoCrash(mutated(text, random), parse);
  EXPECT_LT(largestAllocation.load(), kReasonableAllocation);
}

/// Of readers whose input is a file or bytes.
template <auto& read>
auto parse(std::string_view text, const std::string& fileName, Context& context) {
  return readBytes<read>(text, fileName, context);
}

TEST(DamagedFiles, Hexex) {
  const TemporaryFolder folder;
  writeMap(smallMap(), folder / "a.hexex");
  damage(contentOf(folder / "a.hexex") + "1\n0 1 2 1/3\n1 1 1\n0\n1 2\n1 2 3\n",
         [](std::string_view text, const std::string& fileName, Context& context) {
           return readBytes<readHexex>(text, fileName, context, ReadOptions{.keepWalls = true});
         });
}

TEST(DamagedFiles, Medit) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(2, 2, 1), folder / "a.mesh");
  damage(contentOf(folder / "a.mesh"), parse<Medit::readMesh>);
}

TEST(DamagedFiles, Mfem) {
  const TemporaryFolder folder;
  Context context;
  HexMesh mesh = gridMesh(2, 1, 1);
  mesh.regions = {4, 5};
  WriteOptions options;
  options.format = "mfem";
  writeHexMesh(mesh, folder / "a.mesh", options, context);
  damage(contentOf(folder / "a.mesh"), parse<MfemFormat::readMesh>);
  for (const std::string space : {"H1_3D_P2", "L2_T1_3D_P2", "H1_3D_P3", "L2_T1_3D_P3"}) {
    std::string text =
        "MFEM mesh v1.3\ndimension\n3\nelements\n1\n1 5 0 1 2 3 4 5 6 7\nattribute_sets\n1\n"
        "\"a\" 1 1\nboundary\n0\nvertices\n8\nnodes\nFiniteElementSpace\n"
        "FiniteElementCollection: " +
        space + "\nVDim: 3\nOrdering: 0\n";
    for (int i = 0; i < (space.ends_with('2') ? 81 : 192); ++i) text += std::to_string(i) + '\n';
    damage(text, parse<MfemFormat::readCurved>);
  }
}

TEST(DamagedFiles, AssembliesOfAbaqus) {
  std::string text = "*Part, name=P\n*Node\n";
  for (int i = 1; i <= 8; ++i) {
    text += std::to_string(i) + ", " + std::to_string(i % 4 / 2) + ", " + std::to_string(i / 2 % 2);
    text += ", " + std::to_string(i / 5) + '\n';
  }
  text += "*Element, type=C3D8, elset=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*End Part\n*Assembly\n";
  for (const std::string name : {"A", "B"}) {
    text += "*Instance, name=" + name + ", part=P\n1.\n0, 0, 0, 0, 0, 1, 90.\n*End Instance\n";
  }
  damage(text + "*Nset, nset=N, instance=B\n7\n*Surface, name=S\nB.E, S2\nA.1, S1\n",
         parse<AbaqusFormat::readMesh>);
}

TEST(DamagedFiles, OpenFoam) {
  const TemporaryFolder folder;
  HexMesh mesh = gridMesh(2, 1, 1);
  mesh.regions = {4, 5};
  writeHexMesh(mesh, folder / "a.foam");
  const std::filesystem::path poly = folder / "constant" / "polyMesh";
  Random random(7);
  for (const char* const name :
       {"points", "faces", "owner", "neighbour", "boundary", "cellZones"}) {
    SCOPED_TRACE(name);
    const std::string good = contentOf(poly / name);
    largestAllocation = 0;
    for (int i = 0; i < 100; ++i) {
      writeText(poly / name,
                i % 3 == 0 ? good.substr(0, random.below(good.size())) : mutated(good, random));
      expectNoCrash("", [&](const std::string&, const std::string&, Context& context) {
        return readHexMesh(folder / "a.foam", context);
      });
    }
    EXPECT_LT(largestAllocation.load(), kReasonableAllocation);
    writeText(poly / name, good);
  }
  EXPECT_EQ(readHexMesh(folder / "a.foam").cells.size(), 2U);
}

TEST(DamagedFiles, BlocksOfLz4) {
  // Three letters, then nine more from three places before; a length of 15 goes on.
  const std::string block(
      "\x35"
      "abc\x03\0",
      6);
  std::array<char, 12> bytes{};
  ASSERT_TRUE(decodeLz4Block(block, bytes));
  EXPECT_EQ(std::string(bytes.data(), bytes.size()), "abcabcabcabc");
  EXPECT_FALSE(decodeLz4Block(block, std::span(bytes).first(11)));
  std::array<char, 600> many{};
  const std::string run(
      "\x1f"
      "a\x01\0\xff\xff\x46",
      7);  // 1 + 15 + 4 + 255 + 255 + 70
  ASSERT_TRUE(decodeLz4Block(run, many));
  EXPECT_EQ(std::count(many.begin(), many.end(), 'a'), 600);
  std::size_t complete = 0;
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const std::string changed = mutated(i % 2 == 0 ? block : run, random);
    complete += decodeLz4Block(changed, many) ? 1U : 0U;
    complete += decodeLz4Block(changed, bytes) ? 1U : 0U;
  }
  EXPECT_LT(complete, 20000U);
}

TEST(DamagedFiles, Vtu) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(2, 2, 1), folder / "a.vtu");
  damage(contentOf(folder / "a.vtu"), parse<readVtu>);
}

TEST(DamagedFiles, Gmsh) {
  const TemporaryFolder folder;
  HexMesh mesh = gridMesh(2, 1, 1);
  mesh.features.vertices = {{3, 2}};
  mesh.features.edges = {{{0, 1}, 2}};
  Context context;
  for (const char* format : {"msh", "msh41-ascii", "msh22-ascii"}) {
    WriteOptions options;
    options.format = format;
    writeHexMesh(mesh, folder / "a.msh", options, context);
    damage(contentOf(folder / "a.msh"), parse<GmshFormat::readMesh>);
  }
}

TEST(DamagedFiles, Meshb) {
  const TemporaryFolder folder;
  Context context;
  for (const std::uint32_t version : {2U, 4U}) {
    writeBy(folder / "a.meshb", context, [&](OutputFile& output, Stage& stage) {
      writeMeshbVersion(gridMesh(2, 2, 1), output, version, stage);
    });
    damage(contentOf(folder / "a.meshb"), parse<Meshb::readMesh>);
  }
}

TEST(DamagedFiles, VtkLegacy) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(2, 2, 1), folder / "a.vtk");
  const std::string text = contentOf(folder / "a.vtk");
  damage(text, parse<readVtkLegacy>);
  // The same bytes mean something else.
  std::string binary = text;
  binary.replace(binary.find("ASCII"), 5, "BINARY");
  damage(binary, parse<readVtkLegacy>);
}

TEST(DamagedFiles, MapsInVtkFiles) {
  const TemporaryFolder folder;
  Context context;
  for (const char* format : {"vtk", "vtk-binary"}) {
    WriteOptions options;
    options.format = format;
    writeMap(smallMap(), folder / "a.vtk", options, context);
    damage(contentOf(folder / "a.vtk"),
           [](const std::string& text, const std::string& name, Context& reading) {
             return readBytes<readVtkLegacyMap>(text, name, reading, ReadOptions{});
           });
  }
  for (const Compression compress : compressions()) {
    WriteOptions options;
    options.compress = compress;
    writeMap(smallMap(), folder / "a.vtu", options, context);
    damage(contentOf(folder / "a.vtu"),
           [](const std::string& text, const std::string& name, Context& reading) {
             return readBytes<readVtuMap>(text, name, reading, ReadOptions{});
           });
  }
}

TEST(DamagedFiles, TruncatedAtEveryByteOnDiskToo) {
  const TemporaryFolder folder;
  writeMap(smallMap(), folder / "a.hexex");
  const std::string text = contentOf(folder / "a.hexex");
  std::size_t refused = 0;
  for (std::size_t size = 0; size < text.size(); ++size) {
    writeText(folder / "cut.hexex", text.substr(0, size));
    try {
      EXPECT_TRUE(isConsistent(readMap(folder / "cut.hexex")));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::FileSyntax) << error.what();
      ++refused;
    }
  }
  // Only a cut within or right after the last number goes unnoticed.
  EXPECT_GE(refused + 3, text.size());
}

}  // namespace
}  // namespace hexhex::test
