// Readers against arbitrary bytes, with libFuzzer: whatever a file holds, a reader returns a mesh
// or throws Error, soon, and without asking for much more memory than the file takes.
//
//     read_fuzz --reader=vtu build/fuzz/corpus/vtu -runs=100000
//
// Sanitizers find what is read or computed wrongly; meshes that come back are checked here.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>

#include <sanitizer/allocator_interface.h>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_counts.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>

#include "mutators.hpp"

extern "C" std::size_t LLVMFuzzerMutate(unsigned char* data, std::size_t size, std::size_t most);

namespace {

using namespace hexhex;
using namespace hexhex::io;

/// What one allocation may take. The constants hold tables and buffers of fixed size; the factor,
/// the widest element over its shortest spelling: 96 bytes of a tet's parameters over 32.
constexpr std::size_t kConstant = std::size_t{4} << 20;
constexpr std::size_t kFactor = 64;
/// What is set aside for HDF5 whenever it is used, in place of kConstant.
constexpr std::size_t kHdf5Constant = std::size_t{17} << 20;
/// For the cells that a grid implies: 32 bytes for each point that a file may have without data.
constexpr std::size_t kGridConstant = std::size_t{32} << 22;
// A compressed file takes up to kLargestLzmaRatio times as much.
constexpr std::string_view kCompressed = "DataCompressor";

std::atomic<std::size_t> allowed{static_cast<std::size_t>(-1)};

void onAllocation(const volatile void* /*memory*/, std::size_t size) {
  if (size <= allowed.load(std::memory_order_relaxed)) return;
  std::fprintf(stderr, "A reader asked for %zu bytes at once.\n", size);
  std::abort();
}

void onRelease(const volatile void* /*memory*/) {}

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "A reader returned a wrong mesh: %s.\n", what);
  std::abort();
}

template <class Vertices>
void requireVertices(const Vertices& vertices, std::size_t points) {
  for (const Index vertex : vertices) require(vertex < points, "a vertex does not exist");
}

void examine(const HexMesh& mesh) {
  const std::size_t points = mesh.points.size();
  for (const Hex& cell : mesh.cells) requireVertices(cell, points);
  for (const FeatureVertex& each : mesh.features.vertices) {
    requireVertices(std::array<Index, 1>{each.vertex}, points);
  }
  for (const FeatureEdge& each : mesh.features.edges) requireVertices(each.vertices, points);
  for (const FeatureQuad& each : mesh.features.quads) requireVertices(each.vertices, points);
}

void examine(const TetCells& tets) {
  for (const Tet& tet : tets.cells) requireVertices(tet, tets.points.size());
}

void examine(const TetMap& map) {
  const std::size_t points = map.points.size();
  for (const Tet& tet : map.tets) requireVertices(tet, points);
  require(map.parameters.size() == map.tets.size(), "parameters are missing");
  for (const FeatureVertex& each : map.features.vertices) {
    requireVertices(std::array<Index, 1>{each.vertex}, points);
  }
  for (const FeatureEdge& each : map.features.edges) requireVertices(each.vertices, points);
  for (const FeatureFace& each : map.features.faces) requireVertices(each.vertices, points);
}

void examine(const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) requireVertices(triangle, mesh.points.size());
  const TriangleMesh joined = welded(mesh);
  for (const auto& triangle : joined.triangles) requireVertices(triangle, joined.points.size());
}

void examine(const LagrangeMesh& mesh) {
  requireVertices(mesh.nodes, mesh.points.size());
  require(mesh.vertexCount <= mesh.points.size(), "there are fewer points than vertices");
}

template <auto parse>
void read(std::string_view text) {
  Context context(1);
  examine(parse(text, "input", context));
}

/// Of readers whose input is a file or bytes. Maps are in arrays of the usual name.
template <auto readInput>
auto parse(std::string_view text, const std::string& fileName, Context& context) {
  return inStage(context, "read", [&](Stage& stage) {
    if constexpr (std::is_same_v<decltype(readInput), ReadMap*>) {
      return readInput({text, fileName}, {.keepWalls = true}, stage);
    } else {
      return readInput({text, fileName}, stage);
    }
  });
}

/// What a compressed file holds, read as the format of most text.
HexMesh parseGzip(std::string_view text, const std::string& fileName, Context& context) {
  const Array<char> bytes = inflateGzip(text, fileName);
  return parse<GmshFormat::readMesh>(asText(bytes), fileName, context);
}

/// All files in one: '=' is between points, faces and tets.
TetCells parseTetgenFiles(std::string_view text, const std::string& fileName, Context& context) {
  const auto take = [&text] {
    const std::size_t end = std::min(text.find('='), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
  };
  const TetgenText points{take(), "points"};
  const TetgenText faces{take(), "faces"};
  Stage stage(context, "read tets");
  return parseTetgen(points, faces, {text, fileName}, stage);
}

/// Changes a file such that it keeps its structure.
using Change = std::string (*)(const std::string& file, fuzz::Dice& dice,
                               const fuzz::ChangeBytes& change);

std::string changeText(const std::string& file, fuzz::Dice& dice,
                       const fuzz::ChangeBytes& /*change*/) {
  return fuzz::changeText(file, dice);
}

struct Reader {
  std::string_view name;
  void (*read)(std::string_view text);
  Change change = changeText;
};

constexpr std::array kReaders = {
    Reader{"hexex", read<parse<readHexex>>},
    Reader{"mesh", read<parse<Medit::readMesh>>},
    Reader{"mesh-tets", read<parse<Medit::readTets>>},
    Reader{"meshb", read<parse<Meshb::readMesh>>, fuzz::changeMeshb},
    Reader{"meshb-tets", read<parse<Meshb::readTets>>, fuzz::changeMeshb},
    Reader{"msh", read<parse<GmshFormat::readMesh>>},
    Reader{"msh-tets", read<parse<GmshFormat::readTets>>},
    Reader{"msh-curved", read<parse<GmshFormat::readCurved>>},
    Reader{"vtk", read<parse<readVtkLegacy>>},
    Reader{"vtu", read<parse<readVtu>>, fuzz::changeAppended},
    Reader{"vtk-map", read<parse<readVtkLegacyMap>>},
    Reader{"vtk-tets", read<parse<readVtkLegacyTets>>},
    Reader{"vtu-map", read<parse<readVtuMap>>, fuzz::changeAppended},
    Reader{"vtu-tets", read<parse<readVtuTets>>, fuzz::changeAppended},
    Reader{"vtu-lagrange", read<parse<readLagrangeVtu>>, fuzz::changeAppended},
    Reader{"vtk-curved", read<parse<readCurvedVtkLegacy>>},
    Reader{"inp", read<parse<AbaqusFormat::readMesh>>},
    Reader{"inp-curved", read<parse<AbaqusFormat::readCurved>>},
    Reader{"exodus", read<parse<ExodusFormat::readMesh>>},
    Reader{"exodus-curved", read<parse<ExodusFormat::readCurved>>},
    Reader{"mfem", read<parse<MfemFormat::readMesh>>},
    Reader{"mfem-curved", read<parse<MfemFormat::readCurved>>},
    Reader{"unv", read<parse<UnvFormat::readMesh>>},
    Reader{"unv-curved", read<parse<UnvFormat::readCurved>>},
    Reader{"tetgen", read<parseTetgenFiles>},
    Reader{"stl", read<parse<readStl>>},
    Reader{"obj", read<parse<readObj>>},
    Reader{"off", read<parse<readOff>>},
    Reader{"ply", read<parse<readPly>>},
    Reader{"vtk-surface", read<parse<readVtkLegacySurface>>},
    Reader{"vtp", read<parse<readVtp>>, fuzz::changeAppended},
    Reader{"gzip", read<parseGzip>},
    Reader{"ovm-map", read<parse<OvmText::readMap>>},
    Reader{"ovm-tets", read<parse<OvmText::readTets>>},
    Reader{"ovm", read<parse<OvmText::readMesh>>},
    Reader{"ovmb-map", read<parse<OvmBinary::readMap>>, fuzz::changeOvmb},
    Reader{"ovmb-tets", read<parse<OvmBinary::readTets>>, fuzz::changeOvmb},
    Reader{"ovmb", read<parse<OvmBinary::readMesh>>, fuzz::changeOvmb}};

const Reader* underTest = nullptr;

bool takesHdf5() { return underTest->name.starts_with("exodus"); }

}  // namespace

/// Takes the argument --reader=NAME.
extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kOption = "--reader=";
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (!argument.starts_with(kOption)) continue;
    for (const Reader& reader : kReaders) {
      if (reader.name == argument.substr(kOption.size())) underTest = &reader;
    }
  }
  if (underTest == nullptr) {
    std::fprintf(stderr, "Choose a reader with --reader=NAME:");
    for (const Reader& reader : kReaders) std::fprintf(stderr, " %s", reader.name.data());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  try {
    if (takesHdf5())
      hexhex::io::requireHdf5("seed");  // the memory that loading it takes is no reader's
  } catch (const hexhex::Error&) {
    // Readers say so, too.
  }
  __sanitizer_install_malloc_and_free_hooks(onAllocation, onRelease);
  return 0;
}

/// Half of the changes are libFuzzer's own; the others keep the structure of the reader's format.
extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  fuzz::Dice dice(seed);
  if (dice.below(2) == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string file(reinterpret_cast<const char*>(data), size);
  const std::string changed = underTest->change(file, dice, [most](const std::string& bytes) {
    std::string buffer = bytes;
    buffer.resize(std::max(bytes.size(), most));
    buffer.resize(LLVMFuzzerMutate(reinterpret_cast<unsigned char*>(buffer.data()), bytes.size(),
                                   buffer.size()));
    return buffer;
  });
  if (changed == file || changed.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::copy(changed.begin(), changed.end(), data);
  return changed.size();
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const bool compressed = text.find(kCompressed) != std::string_view::npos;
  const std::string words = lowerCase(text);
  const bool implied = words.find("dimensions") != words.npos || words.find("extent") != words.npos;
  allowed = (takesHdf5() ? kHdf5Constant : (implied ? kGridConstant : kConstant)) +
            kFactor * (compressed ? kLargestLzmaRatio : 1) * size;
  try {
    underTest->read(text);
  } catch (const hexhex::Error&) {
    // What most files deserve.
  }
  allowed = static_cast<std::size_t>(-1);
  return 0;
}
