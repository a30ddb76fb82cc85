#include <algorithm>

#include <io/parts/piece_data.hpp>

namespace hexhex::io {

VtkDataSet partDataSet(const MeshPart& part, const PartsInfo& info, VtkPiece& piece) {
  const HexMesh& mesh = part.mesh;
  const std::size_t points = mesh.points.size();
  const std::size_t cells = mesh.cells.size();
  piece.vertices = {0, mesh.points, mesh.generatorTet, mesh.generatorCorners};
  piece.setCells(0, std::span<const Hex>(mesh.cells));
  VtkDataSet data = meshDataSet(piece, points, cells, std::tuple_size_v<Hex>, kVtkHexahedron);
  constexpr VtkSection kPoints = VtkSection::PointData;
  constexpr VtkSection kCells = VtkSection::CellData;
  if (mesh.generatorCorners.empty()) {
    data.addOwn(kPoints, "generator_kind", std::vector<std::uint8_t>(points, 0));
    data.addOwn(kPoints, kVtkGeneratorCorners, std::vector<std::uint8_t>(points, 0));
    data.addOwn(kPoints, kVtkGeneratorTets, std::vector<std::uint32_t>(points, 0));
  }
  addTags(data, mesh.features, {});
  if (!info.vertexTags.empty() && mesh.features.vertices.empty()) {
    data.addOwn(kPoints, kVtkVertexTags, std::vector<std::int32_t>(points, 0));
  }
  if (!info.regions.empty()) {
    data.add(kCells, kVtkRegions, std::span<const std::int32_t>(mesh.regions));
  }
  const auto number = [&data](VtkSection section, std::string_view name,
                              const Array<std::uint64_t>& numbers) {
    data.addComputed<std::int64_t>(section, name, numbers.size(),
                                   [&numbers](std::size_t i) { return numbers[i]; });
  };
  number(kPoints, kVtkGlobalPoints, part.globalPoints);
  number(kCells, kVtkGlobalCells, part.globalCells);
  if (info.ghostLayers == 0) return data;
  data.addComputed<std::uint8_t>(kPoints, kVtkGhosts, points, [&part](std::size_t i) {
    return part.pointOwners[i] == part.part ? 0 : kVtkDuplicate;
  });
  data.addComputed<std::uint8_t>(kCells, kVtkGhosts, cells, [&part](std::size_t i) {
    return i < part.ownCells ? 0 : kVtkDuplicate;
  });
  return data;
}

}  // namespace hexhex::io
