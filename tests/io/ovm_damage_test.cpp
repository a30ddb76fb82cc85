// Damaged `.ovm` and `.ovmb` files: cut at every byte, extended, with bytes and numbers changed.
// Whatever happens, a reader returns a consistent mesh or throws an Error, soon, and without asking
// for memory out of proportion.
#include <new>
#include <string>
#include <sys/resource.h>

#include <gtest/gtest.h>
#include <support/status_bytes.hpp>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>

#include "ovm_test_support.hpp"

namespace hexhex::test::ovm_damage {

using namespace io;
namespace {

/// While it lives, the program can take but little more memory: then an allocation out of
/// proportion fails, and std::bad_alloc, which is no Error, fails the test. Sanitizers need their
/// own memory, so with them there is no limit.
class MemoryLimit {
 public:
  MemoryLimit() {
#if !defined(HEXHEX_SANITIZED)
    ::getrlimit(RLIMIT_AS, &before_);
    const std::size_t taken = test::statusBytes("VmSize:");
    constexpr rlim_t kRoom = rlim_t{64}
                             << 20;  // threads' stacks and heaps; files here have kilobytes
    rlimit limit = before_;
    limit.rlim_cur = taken + kRoom;
    if (taken > 0) limited_ = ::setrlimit(RLIMIT_AS, &limit) == 0;
#endif
  }
  ~MemoryLimit() {
    if (limited_) ::setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool limited_ = false;
};

bool inRange(const auto& vertices, std::size_t count) {
  return std::all_of(vertices.begin(), vertices.end(), [&](Index v) { return v < count; });
}

template <class Features_>
bool featuresInRange(const Features_& features, std::size_t count) {
  for (const FeatureVertex& feature : features.vertices) {
    if (feature.vertex >= count) return false;
  }
  for (const FeatureEdge& feature : features.edges) {
    if (!inRange(feature.vertices, count)) return false;
  }
  return true;
}

bool isConsistent(const TetMap& map) {
  const std::size_t count = map.points.size();
  for (const Tet& tet : map.tets) {
    if (!inRange(tet, count)) return false;
  }
  for (const EdgeValence& edge : map.edgeValences) {
    if (edge.vertex0 >= count || edge.vertex1 >= count) return false;
  }
  for (const FeatureFace& feature : map.features.faces) {
    if (!inRange(feature.vertices, count)) return false;
  }
  return map.parameters.size() == map.tets.size() &&
         (map.rotations.empty() || map.rotations.size() == map.tets.size()) &&
         featuresInRange(map.features, count);
}

bool isConsistent(const HexMesh& mesh) {
  const std::size_t count = mesh.points.size();
  for (const Hex& cell : mesh.cells) {
    if (!inRange(cell, count)) return false;
  }
  for (const FeatureQuad& feature : mesh.features.quads) {
    if (!inRange(feature.vertices, count)) return false;
  }
  return featuresInRange(mesh.features, count) &&
         (mesh.generatorTet.empty() || mesh.generatorTet.size() == count) &&
         mesh.generatorCorners.size() == mesh.generatorTet.size();
}

/// Whether the file was refused.
/// @tparam Read  ReadMap or ReadMesh
template <class Read>
bool isRefused(const std::string& bytes, const Read& read) {
  try {
    Context context(1);
    EXPECT_TRUE(isConsistent(inStage(context, "read", [&](Stage& stage) {
      if constexpr (std::is_same_v<Read, ReadMap>) {
        return read({bytes, "damaged"}, {}, stage);
      } else {
        return read({bytes, "damaged"}, stage);
      }
    })));
  } catch (const Error& error) {
    EXPECT_NE(error.code(), ErrorCode::Internal) << error.what();
    EXPECT_TRUE(std::string_view(error.what()).starts_with("damaged")) << error.what();
    return true;
  }
  return false;
}

/// Changes bytes; whole numbers, preferably to extremes; removes, inserts and repeats parts.
std::string mutated(std::string bytes, Random& random) {
  const std::size_t changes = 1 + random.below(3);
  for (std::size_t i = 0; i < changes && bytes.size() > 8; ++i) {
    const std::size_t place = random.below(bytes.size() - 8);
    switch (random.below(7)) {
      case 0:
        bytes.erase(place, 1 + random.below(8));
        break;
      case 1:
        bytes.insert(place, 1 + random.below(8), static_cast<char>(random.below(256)));
        break;
      case 2:
        bytes.insert(random.below(bytes.size()), bytes.substr(place, random.below(64)));
        break;
      case 3: {
        const std::array<std::uint64_t, 6> values = {0,          0x7FFFFFFF,         0xFFFFFFFF,
                                                     1ULL << 40, 0x7FFFFFFFFFFFFFFF, ~0ULL};
        const std::size_t width = std::size_t{1} << random.below(4);
        const std::uint64_t value = values[random.below(values.size())];
        for (std::size_t k = 0; k < width; ++k) {
          bytes[place / width * width + k] = static_cast<char>(value >> (8 * k));
        }
        break;
      }
      case 4:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.below(8)));
        break;
      case 5:
        bytes[place] = "0123456789-+.eE \n#:\""[random.below(20)];
        break;
      default:
        bytes[place] = static_cast<char>(random.below(256));
    }
  }
  return bytes;
}

template <class Read>
void damage(const std::string& bytes, const Read& read, bool endIsMarked) {
  ASSERT_FALSE(isRefused(bytes, read));
  ASSERT_LT(bytes.size(), 16384U);
  const MemoryLimit limit;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const bool refused = isRefused(bytes.substr(0, size), read);
    if (endIsMarked) {
      EXPECT_TRUE(refused) << "cut at " << size;
    }
  }
  if (endIsMarked) {
    for (const char* more : {"x", "EOF ", "EOF \0\0\0\1\0\0\0\0\0\0\0\0"}) {
      EXPECT_TRUE(isRefused(bytes + more, read));
    }
  }
  Random random(11);
  std::size_t refused = 0;
  constexpr std::size_t kCases = 20000;
  for (std::size_t i = 0; i < kCases; ++i) {
    refused += isRefused(mutated(bytes, random), read) ? 1 : 0;
  }
  // Most damage is seen; what is not, changed numbers.
  EXPECT_GT(refused, kCases / 5);
}

TetMap richMap() {
  TetMap map = smallMap();
  Random random(5);
  rotateSome(map, random);
  tagSome(map, random);
  map.features.vertices = {{4, 9}};
  return map;
}

HexMesh richMesh() {
  HexMesh mesh = gridMesh(2, 2, 1);
  std::swap(mesh.cells[0], mesh.cells[1]);
  const Hex& cell = mesh.cells[1];
  mesh.cells[1] = {cell[1], cell[2], cell[3], cell[0], cell[5], cell[6], cell[7], cell[4]};
  mesh.generatorTet.assign(mesh.points.size(), 7);
  mesh.generatorCorners.assign(mesh.points.size(), 3);
  mesh.features.vertices = {{1, 2}};
  mesh.features.edges = {{{0, 1}, 3}};
  mesh.features.quads = {{{0, 1, 4, 3}, 4}};
  return mesh;
}

TEST(DamagedOvm, Maps) {
  const TemporaryFolder folder;
  writeMap(richMap(), folder / "a.ovmb");
  writeMap(richMap(), folder / "a.ovm");
  damage(contentOf(folder / "a.ovmb"), OvmBinary::readMap, true);
  damage(contentOf(folder / "a.ovm") + "VProp string \"s\"\n1:a\n0:\n2:bc\n0:\n0:\n",
         OvmText::readMap, false);
}

TEST(DamagedOvm, HexMeshes) {
  const TemporaryFolder folder;
  writeHexMesh(richMesh(), folder / "a.ovmb");
  writeHexMesh(richMesh(), folder / "a.ovm");
  damage(contentOf(folder / "a.ovmb"), OvmBinary::readMesh, true);
  damage(contentOf(folder / "a.ovm"), OvmText::readMesh, false);
}

#if !defined(HEXHEX_SANITIZED)
TEST(DamagedOvm, MemoryIsLimitedHere) {
  const MemoryLimit limit;
  EXPECT_THROW(Array<char>(std::size_t{1} << 28), std::bad_alloc);
  EXPECT_NO_THROW(Array<char>(std::size_t{1} << 20));
}
#endif

/// Claims without anything behind them.
TEST(DamagedOvm, AbsurdCounts) {
  const MemoryLimit limit;
  const std::uint64_t most = (std::uint64_t{1} << 31) - 1;
  for (const std::uint64_t count : {most, most + 1, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    Bytes entries;
    entries.u8(5).counted("HexHex::Parametrization").counted("3d").counted(std::string(24, '\0'));
    entries.u8(0).counted("AlgoHex::FeatureVertices").counted("i32").counted(std::string(4, '\0'));
    for (std::size_t which = 0; which < 4; ++which) {
      std::array<std::uint64_t, 4> counts{};
      counts[which] = count;
      Bytes file = ovmbHeader(1, counts);
      file.chunk("DIRP", entries);
      file.chunk("VERT", Bytes().span(0, count & 0xFFFFFFFF).u32(2).f64(0));
      file.chunk("TOPO", Bytes().span(0, count & 0xFFFFFFFF).u8(which).u8(3).u8(0).u8(4).u64(0));
      file.chunk("PROP", Bytes().span(0, count & 0xFFFFFFFF).u32(0).f64(0));
      file.chunk("EOF ", {});
      EXPECT_TRUE(isRefused(file.str(), OvmBinary::readMap));
      EXPECT_TRUE(isRefused(file.str(), OvmBinary::readMesh));
      const std::string empty =
          ovmbHeader(1, counts).chunk("DIRP", entries).chunk("EOF ", {}).str();
      EXPECT_TRUE(isRefused(empty, OvmBinary::readMap));
    }
    const std::string number = std::to_string(count);
    EXPECT_TRUE(isRefused("Vertices\n" + number + "\n0 0 0\n", OvmText::readMap));
    EXPECT_TRUE(isRefused("Vertices\n1\n0 0 0\nEdges\n" + number + "\n0 0\n", OvmText::readMap));
    EXPECT_TRUE(isRefused("Vertices\n1\n0 0 0\nEdges\n1\n0 0\nFaces\n1\n" + number + " 0 0 0\n",
                          OvmText::readMap));
  }
}

}  // namespace
}  // namespace hexhex::test::ovm_damage
