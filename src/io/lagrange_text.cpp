// Gmsh's and MFEM's files of Lagrange cells.
#include <algorithm>
#include <array>
#include <cstdint>

#include <base/parallel.hpp>
#include <io/lagrange_files.hpp>
#include <io/lagrange_order.hpp>
#include <io/line_writer.hpp>
#include <io/mesh_groups.hpp>
#include <io/output_file.hpp>

namespace hexhex {

namespace {

/// Gmsh's types of hexahedra of order 1 to 9.
constexpr std::array<unsigned, kMaxOrder> kGmshTypes = {5, 12, 92, 93, 94, 95, 96, 97, 98};

void writeGmshEntity(OutputFile& output, const Array<Vec3>& points) {
  Vec3 low = points.empty() ? Vec3{} : points.front();
  Vec3 high = low;
  for (const Vec3& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  output.write("$Entities\n0 0 0 1\n1 ");
  for (const Vec3& corner : {low, high}) {
    for (const double coordinate : corner) output.write(coordinate).write(' ');
  }
  output.write("1 1 0\n$EndEntities\n");
}

}  // namespace

void writeLagrangeGmsh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& /*options*/, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  LineWriter lines(output, context.threads());
  const std::size_t nodes = mesh.points.size();
  const std::size_t cells = mesh.cellCount();
  const std::size_t perCell = mesh.nodesPerCell();
  const std::vector<std::uint32_t> order = gmshNodeOrder(mesh.order);
  LoopProgress progress(stage, 2 * nodes + cells);
  output.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"hexahedra\"\n");
  output.write("$EndPhysicalNames\n");
  writeGmshEntity(output, mesh.points);
  output.write("$Nodes\n1 ").write(nodes).write(" 1 ").write(nodes).write("\n3 1 0 ");
  output.write(nodes).write('\n');
  lines.write(
      nodes, kNumberRoom + 1,
      [](char* place, std::size_t i) { return put(put(place, std::uint64_t{i} + 1), '\n'); },
      &progress);
  lines.write(
      nodes, 3 * (kNumberRoom + 1),
      [&mesh](char* place, std::size_t i) { return put(putNumbers(place, mesh.points[i]), '\n'); },
      &progress);
  output.write("$EndNodes\n$Elements\n1 ").write(cells).write(" 1 ").write(cells).write("\n3 1 ");
  output.write(kGmshTypes[static_cast<std::size_t>(mesh.order) - 1]).write(' ').write(cells);
  output.write('\n');
  const auto cell = [&](char* place, std::size_t c) {
    place = put(place, std::uint64_t{c} + 1);
    for (const std::uint32_t at : order) {
      place = put(put(place, ' '), std::uint64_t{mesh.nodes[c * perCell + at]} + 1);
    }
    return put(place, '\n');
  };
  lines.write(cells, (perCell + 1) * (kNumberRoom + 1), cell, &progress);
  output.write("$EndElements\n");
  output.commit();
}

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
