// Meshes in parts.
#include <nanobind/stl/string.h>

#include "part_arrays.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// (part, vertices, faces): faces as rows of cell, side and the other cell.
nb::tuple neighbourTuple(PartNeighbour&& neighbour) {
  std::vector<std::array<std::uint64_t, 3>> rows;
  rows.reserve(neighbour.faces.size());
  for (const PartFace& face : neighbour.faces) {
    rows.push_back({face.cell, face.side, face.otherCell});
  }
  return nb::make_tuple(neighbour.part, ownedArray(std::move(neighbour.vertices)),
                        ownedArray(std::move(rows)));
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
  return nb::make_tuple(
      std::move(part.mesh), part.part, part.ownPoints, part.ownCells,
      ownedArray(std::move(part.globalPoints)), ownedArray(std::move(part.globalCells)),
      ownedArray(std::move(part.pointOwners)), ownedArray(std::move(part.ghostParts)),
      ownedArray(std::move(part.ghostLayers)), neighbours);
}

namespace {

nb::list extractAll(const ArrayMap& map, std::uint32_t parts, std::uint32_t ghosts,
                    const std::string& partition, bool verify, const Options& options, int threads,
                    const Progress& progress) {
  std::vector<MeshPart> made = run(threads, progress, [&](Context& context) {
    RepairedMap repaired;
    return extractParts(map.view(), options.get(repaired),
                        partOptions(parts, ghosts, partition, verify), context);
  });
  nb::list list;
  for (MeshPart& part : made) list.append(partTuple(std::move(part)));
  return list;
}

Dict extractIntoFiles(const std::string& file, const ArrayMap& map, std::uint32_t parts,
                      std::uint32_t ghosts, const std::string& partition, bool verify,
                      const Options& options, const std::string& format, int threads,
                      const Progress& progress) {
  return fieldsOf(run(threads, progress, [&](Context& context) {
    WriteOptions writing;
    writing.format = format;
    const std::unique_ptr<PartSink> sink = openPartSink(file, writing, context);
    PartSummarySink checked(*sink);
    RepairedMap repaired;
    extractParts(checked, map.view(), options.get(repaired),
                 partOptions(parts, ghosts, partition, verify), context);
    return checked.result();
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
