#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <io/core/mesh_groups.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_order.hpp>
#include <io/vtk/vtk_xml.hpp>
#include <io/vtk/vtu_tags.hpp>

namespace hexhex {

namespace {

/// Rows of vertices and a tag. Vertices are the first nodes, so these are numbers of points.
void addRows(VtkXmlFile& file, std::string_view name, std::size_t components,
             const std::vector<std::int64_t>& rows) {
  if (rows.empty()) return;
  file.add("FieldData", std::string(name), "Int64", components, rows.size() / components,
           components * sizeof(std::int64_t), [&rows](OutputFile& output) {
             output.writeBytes(rows.data(), rows.size() * sizeof(std::int64_t));
           });
}

}  // namespace

void writeLagrangeVtu(const LagrangeMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& options, Context& context) {
  constexpr std::array<std::string_view, 4> kSections = {"PointData", "CellData", "Points",
                                                         "Cells"};
  constexpr std::uint8_t kVtkLagrangeHexahedron = 72;
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  Array<double> computed;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computed = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  const std::size_t cells = mesh.cellCount();
  const std::size_t perCell = mesh.nodesPerCell();
  const std::vector<std::uint32_t> order = vtkNodeOrder(mesh.order);
  VtkXmlFile vtk;
  vtk.add("Points", "Points", std::span<const Vec3>(mesh.points));
  vtk.add("PointData", "generator_tet", std::span<const Index>(mesh.generatorTet));
  vtk.add("PointData", "generator_corners", std::span<const CornerSet>(mesh.generatorCorners));
  vtk.addComputed<std::uint8_t>(
      "PointData", "generator_kind", mesh.generatorCorners.size(),
      [&mesh](std::size_t i) { return generatorKind(mesh.generatorCorners[i]); });
  const Array<std::int32_t> vertices = vertexTags(mesh.features.vertices, mesh.points.size());
  const std::vector<std::int64_t> edges = rowsOf(mesh.features.edges);
  const std::vector<std::int64_t> quads = rowsOf(mesh.features.quads);
  addRows(vtk, kVtuEdgeTags, 3, edges);
  addRows(vtk, kVtuQuadTags, 5, quads);
  if (!vertices.empty()) {
    vtk.add("PointData", std::string(kVtuVertexTags), std::span<const std::int32_t>(vertices));
  }
  vtk.add("CellData", "scaled_jacobian", quality);
  if (!mesh.regions.empty()) {
    vtk.add("CellData", std::string(kVtuRegions), std::span<const std::int32_t>(mesh.regions));
  }
  vtk.addComputed<std::int64_t>("Cells", "connectivity", mesh.nodes.size(), [&](std::size_t i) {
    const std::size_t cell = i / perCell;
    return mesh.nodes[cell * perCell + order[i - cell * perCell]];
  });
  vtk.addComputed<std::int64_t>("Cells", "offsets", cells,
                                [perCell](std::size_t i) { return perCell * (i + 1); });
  vtk.addComputed<std::uint8_t>("Cells", "types", cells,
                                [](std::size_t) { return kVtkLagrangeHexahedron; });
  vtk.write(output, "UnstructuredGrid",
            "NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
                std::to_string(cells) + "\"",
            kSections, stage);
}

}  // namespace hexhex
