// MFEM's files of Lagrange cells.
#include <cstdint>

#include <base/parallel.hpp>
#include <io/lagrange_files.hpp>
#include <io/line_writer.hpp>
#include <io/mesh_groups.hpp>
#include <io/output_file.hpp>

namespace hexhex {

void writeLagrangeMfem(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);
  const HexMesh straight = straightMesh(mesh);
  QuadGroups quads;
  withThreads(context.threads(), [&] { quads = groupQuads(straight, options.patchAngle, stage); });
  const Array<std::uint32_t> attributes = groupNumbers(quads.groups);
  const Array<std::uint32_t> regions = cellReferences(straight);
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, straight.cells.size() + quads.elements.size() + mesh.nodes.size());
  output.write("MFEM mesh v1.0\n\ndimension\n3\n\nelements\n").write(straight.cells.size());
  output.write('\n');
  const auto cell = [&](char* place, std::size_t i) {
    place = put(put(place, regions.empty() ? 1U : regions[i]), " 5 ");  // 5: a cube
    return put(putNumbers(place, straight.cells[i]), '\n');
  };
  lines.write(straight.cells.size(), 10 * (kNumberRoom + 1), cell, &progress);
  output.write("\nboundary\n").write(quads.elements.size()).write('\n');
  const auto quad = [&](char* place, std::size_t i) {
    place = put(put(place, attributes[i]), " 3 ");  // 3: a square
    return put(putNumbers(place, quads.elements[i]), '\n');
  };
  lines.write(quads.elements.size(), 6 * (kNumberRoom + 1), quad, &progress);
  // L2_T4: polynomials on each cell, given by their values at equidistant nodes, x first: the order
  // of LagrangeMesh. Ordering 1: all coordinates of one node together.
  output.write("\nvertices\n").write(straight.points.size());
  output.write("\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_3D_P");
  output.write(static_cast<unsigned>(mesh.order)).write("\nVDim: 3\nOrdering: 1\n\n");
  const auto node = [&mesh](char* place, std::size_t i) {
    return put(putNumbers(place, mesh.points[mesh.nodes[i]]), '\n');
  };
  lines.write(mesh.nodes.size(), 3 * (kNumberRoom + 1), node, &progress);
  output.commit();
}

}  // namespace hexhex
