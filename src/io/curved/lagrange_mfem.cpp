// MFEM's files of Lagrange cells.
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/solvers/mfem.hpp>

namespace hexhex {

void writeLagrangeMfem(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);
  const HexMesh straight = straightMesh(mesh);
  const MfemElements elements(straight, options.patchAngle, stage, context.threads());
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, elements.count() + mesh.nodes.size());
  elements.write(output, lines, progress);
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
