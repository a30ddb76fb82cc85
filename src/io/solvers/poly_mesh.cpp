#include <functional>

#include <io/solvers/poly_mesh.hpp>

namespace hexhex::io {

OutputFile& PolyMeshWriter::begin(std::string_view kind, std::string_view object,
                                  std::string_view note) {
  files_.push_back(std::make_unique<OutputFile>(folder_ / object));
  OutputFile& output = *files_.back();
  output.write("FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       ");
  output.write(kind).write(";\n").write(note).write("    location    \"constant/polyMesh\";\n");
  output.write("    object      ").write(object).write(";\n}\n\n");
  return output;
}

template <class Format>
void PolyMeshWriter::list(std::string_view kind, std::string_view object, std::size_t n,
                          std::size_t room, std::string_view note, LoopProgress& progress,
                          const Format& format) {
  OutputFile& output = begin(kind, object, note);
  output.write(n).write("\n(\n");
  LineWriter(output, threads_).write(n, room, format, &progress);
  output.write(")\n");
}

void PolyMeshWriter::write(const HexMesh& mesh, const PolyMesh& poly, Stage& stage) {
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
}

void PolyMeshWriter::writeZones(const CellGroups& cells) {
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

void PolyMeshWriter::writeLabels(std::string_view object, std::size_t n, Stage& stage,
                                 const std::function<char*(char*, std::size_t)>& labelOf) {
  LoopProgress progress(stage, n);
  list("labelList", object, n, kNumberRoom + 1, "", progress,
       [&](char* place, std::size_t i) { return put(labelOf(place, i), '\n'); });
}

void PolyMeshWriter::writeBoundary(const std::vector<PolyMesh::Patch>& patches) {
  OutputFile& output = begin("polyBoundaryMesh", "boundary", "");
  output.write(patches.size()).write("\n(\n");
  for (const PolyMesh::Patch& patch : patches) {
    output.write("    ").write(patch.name).write("\n    {\n");
    output.write(patch.entries.empty() ? "        type            patch;\n" : patch.entries);
    output.write("        nFaces          ").write(patch.end - patch.begin).write(";\n");
    output.write("        startFace       ").write(patch.begin).write(";\n    }\n");
  }
  output.write(")\n");
}

}  // namespace hexhex::io
