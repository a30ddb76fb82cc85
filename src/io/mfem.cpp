#include <cstdint>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/line_writer.hpp>
#include <io/mesh_groups.hpp>
#include <io/mfem.hpp>
#include <io/output_file.hpp>

namespace hexhex {

void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  QuadGroups quads;
  withThreads(context.threads(), [&] { quads = groupQuads(mesh, options.patchAngle, stage); });
  const Array<std::uint32_t> attributes = groupNumbers(quads.groups);
  const Array<std::uint32_t> regions = cellReferences(mesh);
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, mesh.cells.size() + quads.elements.size() + mesh.points.size());
  output.write("MFEM mesh v1.0\n\ndimension\n3\n\nelements\n").write(mesh.cells.size()).write('\n');
  const auto cell = [&](char* place, std::size_t i) {
    place = put(put(place, regions.empty() ? 1U : regions[i]), " 5 ");  // 5: a cube
    return put(putNumbers(place, mesh.cells[i]), '\n');
  };
  lines.write(mesh.cells.size(), 10 * (kNumberRoom + 1), cell, &progress);
  output.write("\nboundary\n").write(quads.elements.size()).write('\n');
  const auto quad = [&](char* place, std::size_t i) {
    place = put(put(place, attributes[i]), " 3 ");  // 3: a square
    return put(putNumbers(place, quads.elements[i]), '\n');
  };
  lines.write(quads.elements.size(), 6 * (kNumberRoom + 1), quad, &progress);
  output.write("\nvertices\n").write(mesh.points.size()).write("\n3\n");
  const auto point = [&mesh](char* place, std::size_t i) {
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 3 * (kNumberRoom + 1), point, &progress);
  output.commit();
}

}  // namespace hexhex
