// Meshes in parts.
#include <nanobind/stl/string.h>

#include "part_arrays.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

template <class T>
auto listOf(Array<T>&& values) {
  const std::size_t size = values.size();
  return ownedArray<T, 1>(std::move(values), std::array<std::size_t, 1>{size});
}

/// (part, vertices, faces): faces as rows of cell, side and the other cell.
nb::tuple neighbourTuple(PartNeighbour&& neighbour) {
  Array<std::uint64_t> rows;
  rows.reserve(3 * neighbour.faces.size());
  for (const PartFace& face : neighbour.faces) {
    rows.push_back(face.cell);
    rows.push_back(face.side);
    rows.push_back(face.otherCell);
  }
  const std::size_t faces = neighbour.faces.size();
  return nb::make_tuple(
      neighbour.part, listOf(std::move(neighbour.vertices)),
      ownedArray<std::uint64_t, 2>(std::move(rows), std::array<std::size_t, 2>{faces, 3}));
}

}  // namespace

PartOptions partOptions(std::uint32_t parts, std::uint32_t ghosts, const std::string& partition,
                        bool verify) {
  PartOptions options{parts, ghosts};
  options.verify = verify;
  if (partition == "metis") options.method = PartitionMethod::Metis;
  if (partition == "scotch") options.method = PartitionMethod::Scotch;
  return options;
}

nb::tuple partTuple(MeshPart&& part) {
  nb::list neighbours;
  for (PartNeighbour& neighbour : part.neighbours) {
    neighbours.append(neighbourTuple(std::move(neighbour)));
  }
  return nb::make_tuple(std::move(part.mesh), part.part, part.ownPoints, part.ownCells,
                        listOf(std::move(part.globalPoints)), listOf(std::move(part.globalCells)),
                        listOf(std::move(part.pointOwners)), listOf(std::move(part.ghostParts)),
                        listOf(std::move(part.ghostLayers)), neighbours);
}

Dict partsDict(const PartsSummary& summary) {
  Dict d;
  d["cells"] = summary.cells;
  d["vertices"] = summary.vertices;
  d["largest"] = summary.largest;
  d["smallest"] = summary.smallest;
  d["empty"] = summary.empty;
  d["shared_vertices"] = summary.sharedVertices;
  d["shared_faces"] = summary.sharedFaces;
  d["most_neighbours"] = summary.mostNeighbours;
  return d;
}

namespace {

nb::list extractAll(const ArrayMap& map, std::uint32_t parts, std::uint32_t ghosts,
                    const std::string& partition, bool verify, const Options& options, int threads,
                    const Progress& progress) {
  std::vector<MeshPart> made = run(threads, progress, [&](Context& context) {
    return extractParts(map.view(), options.get(), partOptions(parts, ghosts, partition, verify),
                        context);
  });
  nb::list list;
  for (MeshPart& part : made) list.append(partTuple(std::move(part)));
  return list;
}

Dict extractIntoFiles(const std::string& file, const ArrayMap& map, std::uint32_t parts,
                      std::uint32_t ghosts, const std::string& partition, bool verify,
                      const Options& options, const std::string& format, int threads,
                      const Progress& progress) {
  return partsDict(run(threads, progress, [&](Context& context) {
    WriteOptions writing;
    writing.format = format;
    const std::unique_ptr<PartSink> sink = openPartSink(file, writing, context);
    PartSurvey survey(*sink);
    extractParts(survey, map.view(), options.get(), partOptions(parts, ghosts, partition, verify),
                 context);
    return survey.result();
  }));
}

}  // namespace

void bindParts(nb::module_& module) {
  module.def("extract_parts", &extractAll, "map"_a, "parts"_a, "ghosts"_a, "partition"_a,
             "verify"_a, "options"_a, "threads"_a, "progress"_a.none());
  module.def("extract_parts_to_file", &extractIntoFiles, "file"_a, "map"_a, "parts"_a, "ghosts"_a,
             "partition"_a, "verify"_a, "options"_a, "format"_a, "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
