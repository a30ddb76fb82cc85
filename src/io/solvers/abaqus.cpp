#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <span>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/abaqus.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kLongestNumber = 20;
constexpr std::size_t kNamesPerLine = 16;

/// Abaqus' numbers of the faces of kHexFaces.
constexpr std::array<char, 6> kFaceNumbers = {'6', '4', '3', '5', '1', '2'};

/// Puts a number of at most 20 characters.
char* putShort(char* place, double number) {
  char* end = put(place, number);
  // 13 digits always fit: sign, digit, point, 12 digits, and an exponent like "e-308".
  for (int digits = 16; static_cast<std::size_t>(end - place) > kLongestNumber; --digits) {
    end = std::to_chars(place, place + kNumberRoom, number, std::chars_format::general, digits).ptr;
  }
  return end;
}

std::string upperCase(std::string name) {
  for (char& c : name) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return name;
}

/// The different vertices of elements, in order.
template <class Elements>
Array<Index> verticesOf(const Elements& elements) {
  Array<Index> vertices;
  for (const auto& element : elements) {
    vertices.insert(vertices.end(), element.begin(), element.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

class AbaqusWriter {
 public:
  AbaqusWriter(OutputFile& output, const HexMesh& mesh, Stage& stage, int threads)
      : output_(output), lines_(output, threads), mesh_(mesh), stage_(stage) {}

  void write(const VertexGroups& vertices, const EdgeGroups& edges, const QuadGroups& quads) {
    output_.write("*HEADING\nhexahedral mesh by hexhex\n");
    writeNodes();
    writeElements();
    writeElementSets();
    writeNodeSets(quads);
    writeNodeSets(edges);
    writeNodeSets(vertices);
    for (const ElementGroup& group : quads.groups) writeSurface(quads, group);
  }

 private:
  void writeNodes() {
    LoopProgress progress(stage_, mesh_.points.size());
    output_.write("*NODE\n");
    const auto node = [this](char* place, std::size_t i) {
      place = put(place, std::uint64_t{i} + 1);
      for (const double coordinate : mesh_.points[i]) {
        place = putShort(put(place, ", "), coordinate);
      }
      return put(place, '\n');
    };
    lines_.write(mesh_.points.size(), 4 * (kNumberRoom + 2), node, &progress);
  }

  void writeElements() {
    LoopProgress progress(stage_, mesh_.cells.size());
    output_.write("*ELEMENT, TYPE=C3D8, ELSET=HEXAHEDRA\n");
    const auto cell = [this](char* place, std::size_t i) {
      place = put(place, std::uint64_t{i} + 1);
      for (const Index vertex : mesh_.cells[i]) {
        place = put(put(place, ", "), std::uint64_t{vertex} + 1);
      }
      return put(place, '\n');
    };
    lines_.write(mesh_.cells.size(), 9 * (kNumberRoom + 2), cell, &progress);
  }

  /// Regions; the set of all elements is there in any case.
  void writeElementSets() {
    if (mesh_.regions.empty()) return;
    const CellGroups cells = groupCells(mesh_);
    for (const ElementGroup& group : cells.groups) {
      const std::size_t size = group.end - group.begin;
      if (group.name == "hexahedra") continue;
      output_.write("*ELSET, ELSET=E_").write(upperCase(group.name)).write('\n');
      const auto entry = [&](char* place, std::size_t i) {
        const bool ends = i + 1 == size || (i + 1) % kNamesPerLine == 0;
        return put(put(place, std::uint64_t{cells.at(group.begin + i)} + 1), ends ? "\n" : ", ");
      };
      lines_.write(size, kNumberRoom + 2, entry, nullptr);
    }
  }

  template <class Groups>
  void writeNodeSets(const Groups& groups) {
    for (const ElementGroup& group : groups.groups) {
      const std::span elements(groups.elements);
      writeNodeSet("N_" + upperCase(group.name),
                   verticesOf(elements.subspan(group.begin, group.end - group.begin)));
    }
  }

  void writeNodeSet(const std::string& name, const Array<Index>& vertices) {
    output_.write("*NSET, NSET=").write(name).write('\n');
    const auto entry = [&vertices](char* place, std::size_t i) {
      const bool ends = i + 1 == vertices.size() || (i + 1) % kNamesPerLine == 0;
      return put(put(place, std::uint64_t{vertices[i]} + 1), ends ? "\n" : ", ");
    };
    lines_.write(vertices.size(), kNumberRoom + 2, entry, nullptr);
  }

  /// Quads inside the mesh are on no surface.
  void writeSurface(const QuadGroups& quads, const ElementGroup& group) {
    const auto begin = quads.places.begin();
    const auto groupEnd = begin + static_cast<std::ptrdiff_t>(group.end);
    const auto groupBegin = begin + static_cast<std::ptrdiff_t>(group.begin);
    const auto inside = std::find(groupBegin, groupEnd, kNoPlace);  // they come last
    if (inside == groupBegin) return;
    output_.write("*SURFACE, TYPE=ELEMENT, NAME=S_").write(upperCase(group.name)).write('\n');
    const auto face = [&quads, &group](char* place, std::size_t i) {
      const std::uint64_t side = quads.places[group.begin + i];
      place = put(put(place, side / 8 + 1), ", S");
      return put(put(place, kFaceNumbers[side % 8]), '\n');
    };
    lines_.write(static_cast<std::size_t>(inside - groupBegin), kNumberRoom + 5, face, nullptr);
  }

  OutputFile& output_;
  LineWriter lines_;
  const HexMesh& mesh_;
  Stage& stage_;
};

}  // namespace

void writeAbaqus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const VertexGroups vertices = groupVertices(mesh);
  const EdgeGroups edges = groupEdges(mesh);
  QuadGroups quads;
  withThreads(context.threads(), [&] { quads = groupQuads(mesh, options.patchAngle, stage); });
  AbaqusWriter(output, mesh, stage, context.threads()).write(vertices, edges, quads);
  output.commit();
}

}  // namespace hexhex
