#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_data_set.hpp>

namespace hexhex::io {

namespace {

bool isPolyData(const std::filesystem::path& file) { return lowerCaseExtension(file) == ".vtp"; }

/// The vertices of hexahedra and the inner points of arcs.
std::vector<PointPiece> pointsOf(const PiecewiseLinearMesh& mesh) {
  return {{0, mesh.mesh.points, mesh.mesh.generatorTet, mesh.mesh.generatorCorners},
          {0, mesh.arcs.points, mesh.arcs.generatorTet, mesh.arcs.generatorCorners}};
}

/// The simplices that cells lie in.
void addCarriers(VtkDataSet& data, std::span<const Index> tets,
                 std::span<const CornerSet> corners) {
  data.add(VtkSection::CellData, "tet", tets);
  data.add(VtkSection::CellData, "tet_corners", corners);
  data.addComputed<std::uint8_t>(VtkSection::CellData, "tet_kind", corners.size(),
                                 [corners](std::size_t i) { return generatorKind(corners[i]); });
}

/// All cells of one type; PolyData need not be told it.
void addTypes(VtkDataSet& data, std::uint8_t type) {
  if (data.elements != VtkSection::Cells) return;
  data.addComputed<std::uint8_t>(VtkSection::Cells, "types", data.cells,
                                 [type](std::size_t) { return type; });
}

/// Per element of rows with the given beginnings: the row.
Array<std::int32_t> rowOfEach(std::span<const std::uint64_t> begins, std::uint64_t extraPerRow) {
  const std::size_t rows = begins.size() - 1;
  Array<std::int32_t> result(begins.back() + rows * extraPerRow);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t first = begins[row] + row * extraPerRow;
    const std::uint64_t count = begins[row + 1] - begins[row] + extraPerRow;
    std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(first), count,
                static_cast<std::int32_t>(row));
  }
  return result;
}

/// Both ends of all segments.
Array<std::int32_t> segmentEnds(const PiecewiseLinearMesh& mesh) {
  const Arcs& arcs = mesh.arcs;
  Array<std::int32_t> ends;
  ends.reserve(2 * arcs.segmentTet.size());
  const auto firstPoint = static_cast<std::int32_t>(mesh.mesh.points.size());
  for (std::size_t e = 0; e < arcs.count(); ++e) {
    ends.push_back(static_cast<std::int32_t>(arcs.ends[e][0]));
    for (std::uint64_t i = arcs.pointBegin[e]; i < arcs.pointBegin[e + 1]; ++i) {
      const std::int32_t point = firstPoint + static_cast<std::int32_t>(i);
      ends.push_back(point);  // of one segment, and of the next
      ends.push_back(point);
    }
    ends.push_back(static_cast<std::int32_t>(arcs.ends[e][1]));
  }
  return ends;
}

}  // namespace

void writeArcsVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                  Context& context) {
  Stage stage(context, "write arcs");
  OutputFile output(path);  // first, so that a folder that is not writable shows at once
  const Arcs& arcs = mesh.arcs;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t segments = arcs.segmentTet.size();
  const std::vector<PointPiece> points = pointsOf(mesh);
  VtkDataSet data(vertices + arcs.points.size(), segments,
                  isPolyData(path) ? VtkSection::Lines : VtkSection::Cells);
  data.curved = true;
  addPoints(data, points);
  data.addComputed<std::int32_t>(
      VtkSection::PointData, "hex_edge", data.points,
      [vertices, arcOfPoint = rowOfEach(arcs.pointBegin, 0)](std::size_t i) {
        return i < vertices ? -1 : arcOfPoint[i - vertices];
      });
  data.addComputed<double>(VtkSection::PointData, "parameter", data.points,
                           [vertices, &arcs](std::size_t i) {
                             return i < vertices ? 0.0 : arcs.parameters[i - vertices];
                           });
  data.addOwn(VtkSection::CellData, "hex_edge", rowOfEach(arcs.pointBegin, 1));
  addCarriers(data, arcs.segmentTet, arcs.segmentCorners);
  data.addOwn(data.elements, "connectivity", segmentEnds(mesh));
  data.addComputed<std::int64_t>(data.elements, "offsets", segments,
                                 [](std::size_t i) { return 2 * (i + 1); });
  addTypes(data, kVtkLine);
  writeVtkXml(output, data, false, stage);
}

void writePatchesVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                     Context& context) {
  Stage stage(context, "write patches");
  OutputFile output(path);
  const Patches& patches = mesh.patches;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t shared = vertices + mesh.arcs.points.size();
  const std::size_t polygons = patches.polygonTet.size();
  std::vector<PointPiece> points = pointsOf(mesh);
  points.push_back({0, patches.points, patches.generatorTet, patches.generatorCorners});
  VtkDataSet data(shared + patches.points.size(), polygons,
                  isPolyData(path) ? VtkSection::Polys : VtkSection::Cells);
  data.curved = true;
  addPoints(data, points);
  data.addComputed<std::uint8_t>(
      VtkSection::PointData, "point_kind", data.points,
      [vertices, shared](std::size_t i) { return i < vertices ? 0 : (i < shared ? 1 : 2); });
  data.addOwn(VtkSection::CellData, "hex_face", rowOfEach(patches.polygonBegin, 0));
  addCarriers(data, patches.polygonTet, patches.polygonCorners);
  data.add(VtkSection::FieldData, "corner_uv",
           std::span<const std::array<double, 2>>(patches.parameters));
  data.addComputed<std::int64_t>(data.elements, "connectivity", patches.corners.size(),
                                 [&patches](std::size_t i) { return patches.corners[i]; });
  data.addComputed<std::int64_t>(data.elements, "offsets", polygons,
                                 [&patches](std::size_t i) { return patches.cornerBegin[i + 1]; });
  addTypes(data, kVtkPolygon);
  writeVtkXml(output, data, false, stage);
}

}  // namespace hexhex::io
