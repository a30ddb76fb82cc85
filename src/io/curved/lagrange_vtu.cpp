#include <cstdint>
#include <span>
#include <vector>

#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_order.hpp>
#include <io/vtk/vtk_xml_writer.hpp>

namespace hexhex {

void writeLagrangeVtu(const LagrangeMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& options, Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  Array<double> computed;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computed = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  const std::size_t perCell = mesh.nodesPerCell();
  const std::vector<std::uint32_t> order = vtkNodeOrder(mesh.order);
  VtkDataSet data(mesh.points.size(), mesh.cellCount());
  data.curved = true;
  data.add(VtkSection::Points, "Points", std::span<const Vec3>(mesh.points));
  data.add(VtkSection::PointData, kVtkGeneratorTets, std::span<const Index>(mesh.generatorTet));
  data.add(VtkSection::PointData, kVtkGeneratorCorners,
           std::span<const CornerSet>(mesh.generatorCorners));
  data.addComputed<std::uint8_t>(
      VtkSection::PointData, "generator_kind", mesh.generatorCorners.size(),
      [&mesh](std::size_t i) { return generatorKind(mesh.generatorCorners[i]); });
  data.add(VtkSection::CellData, "scaled_jacobian", quality);
  addTags(data, mesh.features, mesh.regions);  // vertices are the first nodes
  data.addComputed<std::int64_t>(VtkSection::Cells, "connectivity", mesh.nodes.size(),
                                 [&](std::size_t i) {
                                   const std::size_t cell = i / perCell;
                                   return mesh.nodes[cell * perCell + order[i - cell * perCell]];
                                 });
  data.addComputed<std::int64_t>(VtkSection::Cells, "offsets", data.cells,
                                 [perCell](std::size_t i) { return perCell * (i + 1); });
  data.addComputed<std::uint8_t>(VtkSection::Cells, "types", data.cells,
                                 [](std::size_t) { return kVtkLagrangeHexahedron; });
  writeVtkXml(output, data, false, stage);
}

}  // namespace hexhex
