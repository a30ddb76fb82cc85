#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/abaqus_format.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kLongestNumber = 20;
constexpr std::size_t kNamesPerLine = 16;

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

class AbaqusWriter {
 public:
  AbaqusWriter(OutputFile& output, const HexMesh& mesh, Stage& stage, int threads)
      : output_(output), lines_(output, threads), mesh_(mesh), stage_(stage) {}

  void write(const MeshGroups& groups) {
    output_.write("*HEADING\nhexahedral mesh by hexhex\n");
    writeNodes();
    writeElements();
    // The set of all elements is there in any case.
    for (const ElementGroup& group : groups.cells.groups) {
      if (group.name == "hexahedra") continue;
      writeSet("*ELSET, ELSET=E_", group, group.end - group.begin,
               [&](std::size_t i) { return groups.cells.at(group.begin + i); });
    }
    writeNodeSets(groups.quads);
    writeNodeSets(groups.edges);
    writeNodeSets(groups.vertices);
    for (const ElementGroup& group : groups.quads.groups) writeSurface(groups.quads, group);
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

  template <class Groups>
  void writeNodeSets(const Groups& groups) {
    for (const ElementGroup& group : groups.groups) {
      const Array<Index> vertices = verticesOf(groups, group);
      writeSet("*NSET, NSET=N_", group, vertices.size(),
               [&](std::size_t i) { return vertices[i]; });
    }
  }

  /// @param indexAt  of the i-th of n members
  template <class F>
  void writeSet(std::string_view keyword, const ElementGroup& group, std::size_t n,
                const F& indexAt) {
    output_.write(keyword).write(upperCase(group.name)).write('\n');
    const auto entry = [&](char* place, std::size_t i) {
      const bool ends = i + 1 == n || (i + 1) % kNamesPerLine == 0;
      return put(put(place, std::uint64_t{indexAt(i)} + 1), ends ? "\n" : ", ");
    };
    lines_.write(n, kNumberRoom + 2, entry, nullptr);
  }

  /// Quads inside the mesh are on no surface.
  void writeSurface(const QuadGroups& quads, const ElementGroup& group) {
    const std::size_t count = quads.boundaryEnd(group) - group.begin;
    if (count == 0) return;
    output_.write("*SURFACE, TYPE=ELEMENT, NAME=S_").write(upperCase(group.name)).write('\n');
    const auto face = [&quads, &group](char* place, std::size_t i) {
      const std::uint64_t side = quads.places[group.begin + i];
      place = put(put(place, side / 8 + 1), ", S");
      return put(put(place, kAbaqusFaces[side % 8]), '\n');
    };
    lines_.write(count, kNumberRoom + 5, face, nullptr);
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
  const MeshGroups groups(mesh, options.patchAngle, stage);
  AbaqusWriter(output, mesh, stage, context.threads()).write(groups);
  output.commit();
}

}  // namespace hexhex::io
