#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 4096;

/// Faces as OpenFOAM lists them; quads look out of their owners.
struct PolyMesh {
  struct Patch {
    std::string name;
    std::size_t begin;
    std::size_t end;
  };
  Array<Quad> faces;
  Array<Index> owners;      ///< per face
  Array<Index> neighbours;  ///< per inner face
  std::vector<Patch> patches;
};

/// Inner faces: those of each cell with larger neighbours, in order of the neighbours.
void addInnerFaces(const HexMesh& mesh, PolyMesh& poly, Stage& stage) {
  const FaceNeighbours neighbours = findFaceNeighbours(mesh, stage);
  const auto isOwned = [&neighbours](std::size_t cell, std::size_t face) {
    const Index other = neighbours[cell][face];
    return other != kNone && other > cell;
  };
  Array<std::uint64_t> begin(mesh.cells.size() + 1);
  begin[mesh.cells.size()] = 0;
  parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
    begin[c] = 0;
    for (std::size_t face = 0; face < 6; ++face) begin[c] += isOwned(c, face) ? 1 : 0;
  });
  const std::uint64_t count = exclusiveScan(std::span(begin));
  poly.faces.resize(count);
  poly.owners.resize(count);
  poly.neighbours.resize(count);
  parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
    std::array<std::pair<Index, std::size_t>, 6> owned{};  // neighbours and faces, ascending
    std::size_t size = 0;
    for (std::size_t face = 0; face < 6; ++face) {
      if (isOwned(c, face)) owned[size++] = {neighbours[c][face], face};
    }
    std::sort(owned.begin(), owned.begin() + size);
    for (std::size_t i = 0; i < size; ++i) {
      poly.faces[begin[c] + i] = faceVertices(mesh.cells[c], owned[i].second);
      poly.owners[begin[c] + i] = static_cast<Index>(c);
      poly.neighbours[begin[c] + i] = owned[i].first;
    }
  });
}

/// Boundary faces, group by group.
void addPatches(const QuadGroups& quads, PolyMesh& poly) {
  for (const ElementGroup& group : quads.groups) {
    const std::size_t begin = poly.faces.size();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      if (quads.places[i] == kNoPlace) continue;
      poly.faces.push_back(quads.elements[i]);
      poly.owners.push_back(static_cast<Index>(quads.places[i] / 8));
    }
    if (poly.faces.size() > begin) poly.patches.push_back({group.name, begin, poly.faces.size()});
  }
}

/// Writes the files of a mesh; commit() gives them their names.
class PolyMeshWriter {
 public:
  PolyMeshWriter(std::filesystem::path folder, int threads)
      : folder_(std::move(folder)), threads_(threads) {}

  void write(const HexMesh& mesh, const PolyMesh& poly, Stage& stage) {
    LoopProgress progress(stage, mesh.points.size() + 3 * poly.faces.size());
    list("vectorField", "points", mesh.points.size(), 3 * (kNumberRoom + 1) + 3, "", progress,
         [&](char* place, std::size_t i) {
           return put(putNumbers(put(place, '('), mesh.points[i]), ")\n");
         });
    list("faceList", "faces", poly.faces.size(), 4 * (kNumberRoom + 1) + 4, "", progress,
         [&](char* place, std::size_t i) {
           return put(putNumbers(put(place, "4("), poly.faces[i]), ")\n");
         });
    // A note with which OpenFOAM's tools know the sizes without reading everything.
    const std::string note = "    note        \"nPoints:" + std::to_string(mesh.points.size()) +
                             "  nCells:" + std::to_string(mesh.cells.size()) +
                             "  nFaces:" + std::to_string(poly.faces.size()) +
                             "  nInternalFaces:" + std::to_string(poly.neighbours.size()) + "\";\n";
    const auto label = [](const Array<Index>& labels) {
      return [&labels](char* place, std::size_t i) { return put(put(place, labels[i]), '\n'); };
    };
    list("labelList", "owner", poly.owners.size(), kNumberRoom + 1, note, progress,
         label(poly.owners));
    list("labelList", "neighbour", poly.neighbours.size(), kNumberRoom + 1, note, progress,
         label(poly.neighbours));
    writeBoundary(poly);
  }

  void writeZones(const CellGroups& cells) {
    OutputFile& output = begin("regIOobject", "cellZones", "");
    output.write(cells.groups.size()).write("\n(\n");
    LineWriter lines(output, threads_);
    for (const ElementGroup& group : cells.groups) {
      output.write(group.name).write("\n{\n    type cellZone;\ncellLabels      List<label>\n");
      output.write(group.end - group.begin).write("\n(\n");
      lines.write(
          group.end - group.begin, kNumberRoom + 1,
          [&](char* place, std::size_t i) {
            return put(put(place, std::uint64_t{cells.at(group.begin + i)}), '\n');
          },
          nullptr);
      output.write(")\n;\n}\n");
    }
    output.write(")\n");
  }

  void commit() {
    for (const std::unique_ptr<OutputFile>& file : files_) file->commit();
  }

 private:
  OutputFile& begin(std::string_view kind, std::string_view object, std::string_view note) {
    files_.push_back(std::make_unique<OutputFile>(folder_ / object));
    OutputFile& output = *files_.back();
    output.write("FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       ");
    output.write(kind).write(";\n").write(note).write("    location    \"constant/polyMesh\";\n");
    output.write("    object      ").write(object).write(";\n}\n\n");
    return output;
  }

  template <class Format>
  void list(std::string_view kind, std::string_view object, std::size_t n, std::size_t room,
            std::string_view note, LoopProgress& progress, const Format& format) {
    OutputFile& output = begin(kind, object, note);
    output.write(n).write("\n(\n");
    LineWriter(output, threads_).write(n, room, format, &progress);
    output.write(")\n");
  }

  void writeBoundary(const PolyMesh& poly) {
    OutputFile& output = begin("polyBoundaryMesh", "boundary", "");
    output.write(poly.patches.size()).write("\n(\n");
    for (const PolyMesh::Patch& patch : poly.patches) {
      output.write("    ").write(patch.name).write("\n    {\n        type            patch;\n");
      output.write("        nFaces          ").write(patch.end - patch.begin).write(";\n");
      output.write("        startFace       ").write(patch.begin).write(";\n    }\n");
    }
    output.write(")\n");
  }

  std::filesystem::path folder_;
  int threads_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

bool isMarker(const std::filesystem::path& file) { return lowerCaseExtension(file) == ".foam"; }

}  // namespace

void writeOpenFoam(const HexMesh& mesh, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that what is not writable shows at once.
  OutputFolder folder(isMarker(file) ? file.parent_path() / "constant" / "polyMesh" : file);
  std::optional<OutputFile> marker;
  if (isMarker(file)) marker.emplace(file);
  QuadGroups quads;
  PolyMesh poly;
  withThreads(context.threads(), [&] {
    quads = groupQuads(mesh, options.patchAngle, stage);
    addInnerFaces(mesh, poly, stage);
  });
  addPatches(quads, poly);
  requireInt32(mesh.points.size(), "OpenFOAM numbers vertices");
  requireInt32(poly.faces.size(), "OpenFOAM numbers faces");
  try {
    PolyMeshWriter writer(folder.temporary(), context.threads());
    writer.write(mesh, poly, stage);
    // Without regions there are no zones, which has to be said where an earlier mesh had some.
    writer.writeZones(mesh.regions.empty() ? CellGroups{} : groupCells(mesh));
    writer.commit();
  } catch (const Error& error) {
    throw folder.named(error);
  }
  folder.commit();
  if (!marker) return;
  try {
    marker->commit();
  } catch (...) {
    folder.takeBack();
    throw;
  }
}

}  // namespace hexhex
