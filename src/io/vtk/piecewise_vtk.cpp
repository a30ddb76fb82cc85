#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include <io/vtk/piecewise_vtk.hpp>
#include <io/vtk/vtk_xml.hpp>

namespace hexhex {

namespace {

constexpr std::array<std::string_view, 4> kGridSections = {"PointData", "CellData", "Points",
                                                           "Cells"};
constexpr std::array<std::string_view, 7> kPolySections = {
    "PointData", "CellData", "Points", "Verts", "Lines", "Strips", "Polys"};
constexpr std::uint8_t kVtkLine = 3;
constexpr std::uint8_t kVtkPolygon = 7;

/// An array of the points of several lists, one after the other.
template <class T>
void addJoined(VtkXmlFile& file, const std::string& section, const std::string& name,
               std::string_view type, std::size_t components,
               const std::vector<std::span<const T>>& parts) {
  std::uint64_t count = 0;
  for (const auto& part : parts) count += part.size();
  file.add(section, name, type, components, count, sizeof(T), [parts](OutputFile& output) {
    for (const auto& part : parts) output.writeBytes(part.data(), part.size_bytes());
  });
}

/// Positions and generators of hex vertices, inner points of arcs, and those of patches if wanted.
void addPoints(VtkXmlFile& file, const PiecewiseLinearMesh& mesh, bool patches) {
  const auto join = [&](const auto& ofMesh, const auto& ofArcs, const auto& ofPatches,
                        const std::string& section, const std::string& name, std::string_view type,
                        std::size_t components) {
    using T = typename std::remove_cvref_t<decltype(ofMesh)>::value_type;
    std::vector<std::span<const T>> parts = {ofMesh, ofArcs};
    if (patches) parts.emplace_back(ofPatches);
    addJoined<T>(file, section, name, type, components, parts);
  };
  join(mesh.mesh.points, mesh.arcs.points, mesh.patches.points, "Points", "Points", "Float64", 3);
  join(mesh.mesh.generatorTet, mesh.arcs.generatorTet, mesh.patches.generatorTet, "PointData",
       "generator_tet", "UInt32", 1);
  join(mesh.mesh.generatorCorners, mesh.arcs.generatorCorners, mesh.patches.generatorCorners,
       "PointData", "generator_corners", "UInt8", 1);
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t arcPoints = mesh.arcs.points.size();
  const std::size_t all = vertices + arcPoints + (patches ? mesh.patches.points.size() : 0);
  file.addComputed<std::uint8_t>(
      "PointData", "generator_kind", all, [&mesh, vertices, arcPoints](std::size_t i) {
        if (i < vertices) return generatorKind(mesh.mesh.generatorCorners[i]);
        i -= vertices;
        return generatorKind(i < arcPoints ? mesh.arcs.generatorCorners[i]
                                           : mesh.patches.generatorCorners[i - arcPoints]);
      });
}

std::uint64_t pointCount(const PiecewiseLinearMesh& mesh, bool patches) {
  return mesh.mesh.points.size() + mesh.arcs.points.size() +
         (patches ? mesh.patches.points.size() : 0);
}

/// The simplices that cells lie in.
void addCarriers(VtkXmlFile& file, std::span<const Index> tets,
                 std::span<const CornerSet> corners) {
  file.add("CellData", "tet", tets);
  file.add("CellData", "tet_corners", corners);
  file.addComputed<std::uint8_t>("CellData", "tet_kind", corners.size(),
                                 [corners](std::size_t i) { return generatorKind(corners[i]); });
}

/// Per element of rows with the given beginnings: the row.
Array<std::int32_t> rowsOf(std::span<const std::uint64_t> begins, std::uint64_t extraPerRow) {
  const std::size_t rows = begins.size() - 1;
  Array<std::int32_t> result(begins.back() + rows * extraPerRow);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t first = begins[row] + row * extraPerRow;
    const std::uint64_t end = begins[row + 1] + (row + 1) * extraPerRow;
    std::fill(result.begin() + static_cast<std::ptrdiff_t>(first),
              result.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::int32_t>(row));
  }
  return result;
}

/// Both ends of all segments.
Array<std::array<std::int32_t, 2>> segmentEnds(const PiecewiseLinearMesh& mesh) {
  const Arcs& arcs = mesh.arcs;
  Array<std::array<std::int32_t, 2>> ends;
  ends.reserve(arcs.segmentTet.size());
  const auto firstPoint = static_cast<std::int32_t>(mesh.mesh.points.size());
  for (std::size_t e = 0; e < arcs.count(); ++e) {
    auto from = static_cast<std::int32_t>(arcs.ends[e][0]);
    for (std::uint64_t i = arcs.pointBegin[e]; i < arcs.pointBegin[e + 1]; ++i) {
      const std::int32_t to = firstPoint + static_cast<std::int32_t>(i);
      ends.push_back({from, to});
      from = to;
    }
    ends.push_back({from, static_cast<std::int32_t>(arcs.ends[e][1])});
  }
  return ends;
}

/// @param elements  section of the connectivity
void writeArcsAs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                 const std::string& elements, Context& context) {
  Stage stage(context, "write arcs");
  OutputFile output(path);  // first, so that a folder that is not writable shows at once
  const Arcs& arcs = mesh.arcs;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t segments = arcs.segmentTet.size();
  VtkXmlFile file;
  addPoints(file, mesh, false);
  const Array<std::int32_t> arcOfPoint = rowsOf(arcs.pointBegin, 0);
  file.addComputed<std::int32_t>(
      "PointData", "hex_edge", pointCount(mesh, false),
      [&](std::size_t i) { return i < vertices ? -1 : arcOfPoint[i - vertices]; });
  file.addComputed<double>("PointData", "parameter", pointCount(mesh, false), [&](std::size_t i) {
    return i < vertices ? 0.0 : arcs.parameters[i - vertices];
  });
  const Array<std::int32_t> arcOfSegment = rowsOf(arcs.pointBegin, 1);
  file.add("CellData", "hex_edge", std::span<const std::int32_t>(arcOfSegment));
  addCarriers(file, arcs.segmentTet, arcs.segmentCorners);
  const Array<std::array<std::int32_t, 2>> ends = segmentEnds(mesh);
  file.add(
      elements, "connectivity", "Int32", 1, 2 * segments, sizeof(std::int32_t),
      [&ends](OutputFile& out) { out.writeBytes(ends.data(), ends.size() * sizeof(ends[0])); });
  file.addComputed<std::int64_t>(elements, "offsets", segments,
                                 [](std::size_t i) { return 2 * (i + 1); });
  const std::string points = "NumberOfPoints=\"" + std::to_string(pointCount(mesh, false)) + "\" ";
  if (elements == "Cells") {
    file.addComputed<std::uint8_t>(elements, "types", segments,
                                   [](std::size_t) { return kVtkLine; });
    file.write(output, "UnstructuredGrid",
               points + "NumberOfCells=\"" + std::to_string(segments) + "\"", kGridSections, stage);
  } else {
    file.write(output, "PolyData",
               points + "NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(segments) +
                   "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
               kPolySections, stage);
  }
}

void writePatchesAs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                    const std::string& elements, Context& context) {
  Stage stage(context, "write patches");
  OutputFile output(path);
  const Patches& patches = mesh.patches;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t shared = vertices + mesh.arcs.points.size();
  const std::size_t polygons = patches.polygonTet.size();
  VtkXmlFile file;
  addPoints(file, mesh, true);
  file.addComputed<std::uint8_t>(
      "PointData", "point_kind", pointCount(mesh, true),
      [vertices, shared](std::size_t i) { return i < vertices ? 0 : (i < shared ? 1 : 2); });
  const Array<std::int32_t> faceOfPolygon = rowsOf(patches.polygonBegin, 0);
  file.add("CellData", "hex_face", std::span<const std::int32_t>(faceOfPolygon));
  addCarriers(file, patches.polygonTet, patches.polygonCorners);
  file.add("FieldData", "corner_uv", std::span<const std::array<double, 2>>(patches.parameters));
  file.addComputed<std::int64_t>(elements, "connectivity", patches.corners.size(),
                                 [&patches](std::size_t i) { return patches.corners[i]; });
  file.addComputed<std::int64_t>(elements, "offsets", polygons,
                                 [&patches](std::size_t i) { return patches.cornerBegin[i + 1]; });
  const std::string points = "NumberOfPoints=\"" + std::to_string(pointCount(mesh, true)) + "\" ";
  if (elements == "Cells") {
    file.addComputed<std::uint8_t>(elements, "types", polygons,
                                   [](std::size_t) { return kVtkPolygon; });
    file.write(output, "UnstructuredGrid",
               points + "NumberOfCells=\"" + std::to_string(polygons) + "\"", kGridSections, stage);
  } else {
    file.write(output, "PolyData",
               points +
                   "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                   "NumberOfPolys=\"" +
                   std::to_string(polygons) + "\"",
               kPolySections, stage);
  }
}

}  // namespace

void writeArcsVtu(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context) {
  writeArcsAs(mesh, file, "Cells", context);
}

void writeArcsVtp(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context) {
  writeArcsAs(mesh, file, "Lines", context);
}

void writePatchesVtu(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                     Context& context) {
  writePatchesAs(mesh, file, "Cells", context);
}

void writePatchesVtp(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                     Context& context) {
  writePatchesAs(mesh, file, "Polys", context);
}

}  // namespace hexhex
