#include "conversion.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <hexhex/error.hpp>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkHigherOrderHexahedron.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeUInt32Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

namespace hexhex::paraview {
namespace {

constexpr int kParameterComponents = 12;

template <class Points>
void setPoints(vtkPointSet& to, const Points& from) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), from[i].data());
  }
  to.SetPoints(points);
}

/// Cells of a fixed number of points each, which `vertexOf(cell, k)` tells.
template <class VertexOf>
vtkSmartPointer<vtkCellArray> fixedCells(std::size_t count, std::size_t size,
                                         const VertexOf& vertexOf) {
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(count * size));
  vtkIdType* to = connectivity->GetPointer(0);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t k = 0; k < size; ++k) *to++ = static_cast<vtkIdType>(vertexOf(c, k));
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(static_cast<vtkIdType>(size), connectivity);
  return cells;
}

/// An array of VTK with the values that `valueOf(row, component)` tells.
template <class VtkArray, class ValueOf>
vtkSmartPointer<VtkArray> makeArray(const char* name, std::size_t rows, int components,
                                    const ValueOf& valueOf) {
  auto array = vtkSmartPointer<VtkArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(rows));
  auto* to = array->GetPointer(0);
  using Value = std::remove_reference_t<decltype(*to)>;
  for (std::size_t row = 0; row < rows; ++row) {
    for (int k = 0; k < components; ++k) {
      *to++ = static_cast<Value>(valueOf(row, static_cast<std::size_t>(k)));
    }
  }
  return array;
}

/// Vertices of a feature, one or several.
std::array<std::uint32_t, 1> verticesOf(const FeatureVertex& feature) { return {feature.vertex}; }
template <class Feature>
const auto& verticesOf(const Feature& feature) {
  return feature.vertices;
}

/// Features as an array of rows "vertices, tag" in the field data; nothing if there are none.
template <class Feature>
void putFeatures(vtkDataObject& to, const char* name, const std::vector<Feature>& features) {
  if (features.empty()) return;
  const auto size = verticesOf(features.front()).size();
  to.GetFieldData()->AddArray(makeArray<vtkIdTypeArray>(
      name, features.size(), static_cast<int>(size) + 1, [&](std::size_t row, std::size_t k) {
        return k < size ? static_cast<vtkIdType>(verticesOf(features[row])[k])
                        : static_cast<vtkIdType>(features[row].tag);
      }));
}

template <class Feature>
void takeFeatures(vtkDataObject& from, const char* name, std::vector<Feature>& features) {
  auto* const array = vtkDataArray::SafeDownCast(from.GetFieldData()->GetAbstractArray(name));
  if (array == nullptr) return;
  const auto entry = [array](vtkIdType row, int k) { return array->GetComponent(row, k); };
  for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row) {
    Feature feature;
    int k = 0;
    if constexpr (std::is_same_v<Feature, FeatureVertex>) {
      feature.vertex = static_cast<std::uint32_t>(entry(row, k++));
    } else {
      for (auto& vertex : feature.vertices) vertex = static_cast<std::uint32_t>(entry(row, k++));
    }
    feature.tag = static_cast<std::int32_t>(entry(row, k));
    features.push_back(feature);
  }
}

constexpr const char* kFeatureVertices = "hexhex_feature_vertices";
constexpr const char* kFeatureEdges = "hexhex_feature_edges";
constexpr const char* kFeatureFaces = "hexhex_feature_faces";
constexpr const char* kRegion = "region";
constexpr const char* kGeneratorKind = "generator_kind";
constexpr const char* kGeneratorTet = "generator_tet";
constexpr const char* kGeneratorCorners = "generator_corners";

template <class Regions>
void putRegions(vtkUnstructuredGrid& grid, const Regions& regions) {
  if (regions.empty()) return;
  grid.GetCellData()->AddArray(makeArray<vtkIntArray>(
      kRegion, regions.size(), 1, [&](std::size_t c, std::size_t) { return regions[c]; }));
}

template <class Regions>
void takeRegions(vtkUnstructuredGrid& grid, Regions& regions) {
  vtkDataArray* const array = grid.GetCellData()->GetArray(kRegion);
  if (array == nullptr) return;
  regions.resize(static_cast<std::size_t>(grid.GetNumberOfCells()));
  for (std::size_t c = 0; c < regions.size(); ++c) {
    regions[c] = static_cast<std::int32_t>(array->GetComponent(static_cast<vtkIdType>(c), 0));
  }
}

/// Works for both kinds of meshes with generators.
template <class Mesh>
void putGenerators(vtkUnstructuredGrid& grid, const Mesh& mesh) {
  vtkPointData& data = *grid.GetPointData();
  const auto& corners = mesh.generatorCorners;
  if (corners.empty()) return;
  data.AddArray(makeArray<vtkUnsignedCharArray>(
      kGeneratorKind, corners.size(), 1,
      [&](std::size_t v, std::size_t) { return generatorKind(corners[v]); }));
  data.AddArray(makeArray<vtkUnsignedCharArray>(
      kGeneratorCorners, corners.size(), 1,
      [&](std::size_t v, std::size_t) { return corners[v]; }));
  data.AddArray(makeArray<vtkTypeUInt32Array>(
      kGeneratorTet, corners.size(), 1,
      [&](std::size_t v, std::size_t) { return mesh.generatorTet[v]; }));
}

void putQuality(vtkUnstructuredGrid& grid, const Array<double>& quality) {
  grid.GetCellData()->AddArray(makeArray<vtkDoubleArray>(
      "scaled_jacobian", quality.size(), 1,
      [&](std::size_t c, std::size_t) { return quality[c]; }));
  grid.GetCellData()->SetActiveScalars("scaled_jacobian");
}

template <class Points>
void takePoints(vtkUnstructuredGrid& grid, Points& points) {
  if (grid.GetNumberOfPoints() >= static_cast<vtkIdType>(kNone)) {
    throw Error(ErrorCode::TooLarge, "The grid has 2^32 - 1 points or more.");
  }
  points.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  for (std::size_t v = 0; v < points.size(); ++v) {
    grid.GetPoint(static_cast<vtkIdType>(v), points[v].data());
  }
}

/// The cells of a grid that shall all be of one type.
template <class Cells>
void takeCells(vtkUnstructuredGrid& grid, int type, const char* what, Cells& cells) {
  const vtkIdType count = grid.GetNumberOfCells();
  if (count == 0) throw Error(ErrorCode::EmptyMesh, "The input has no cells.");
  cells.resize(static_cast<std::size_t>(count));
  for (vtkIdType c = 0; c < count; ++c) {
    if (grid.GetCellType(c) != type) {
      throw Error(ErrorCode::InvalidArgument,
                  "Cell " + std::to_string(c) + " of the input is no " + what +
                      ". Extract the cells of that type first.",
                  {PlaceKind::Cell, static_cast<std::uint64_t>(c), 0});
    }
    vtkIdType size = 0;
    const vtkIdType* points = nullptr;
    grid.GetCellPoints(c, size, points);
    auto& cell = cells[static_cast<std::size_t>(c)];
    std::transform(points, points + cell.size(), cell.begin(),
                   [](vtkIdType point) { return static_cast<Index>(point); });
  }
}

/// Puts tags and dimensions into cell arrays, and tagged elements into cells.
template <class Feature>
void addTagged(vtkCellArray& cells, vtkIntArray& tags, vtkIntArray& dimensions,
               const std::vector<Feature>& features) {
  for (const Feature& feature : features) {
    const auto& vertices = verticesOf(feature);
    dimensions.InsertNextValue(static_cast<int>(vertices.size()) - 1);
    cells.InsertNextCell(static_cast<int>(vertices.size()));
    for (const auto vertex : vertices) cells.InsertCellPoint(static_cast<vtkIdType>(vertex));
    tags.InsertNextValue(feature.tag);
  }
}

}  // namespace

void fillGrid(vtkUnstructuredGrid& grid, const TetMap& map) {
  setPoints(grid, map.points);
  grid.SetCells(VTK_TETRA, fixedCells(map.tets.size(), 4, [&](std::size_t t, std::size_t k) {
                  return map.tets[t][k];
                }));
  grid.GetCellData()->AddArray(makeArray<vtkDoubleArray>(
      kParameters, map.tets.size(), kParameterComponents,
      [&](std::size_t t, std::size_t k) { return map.parameters[t][k / 3][k % 3]; }));
  putRegions(grid, map.regions);
  putFeatures(grid, kFeatureVertices, map.features.vertices);
  putFeatures(grid, kFeatureEdges, map.features.edges);
  putFeatures(grid, kFeatureFaces, map.features.faces);
}

TetMesh tetsOf(vtkUnstructuredGrid& grid) {
  TetMesh tets;
  takePoints(grid, tets.points);
  takeCells(grid, VTK_TETRA, "tetrahedron", tets.tets);
  return tets;
}

TetMap mapOf(vtkUnstructuredGrid& grid, vtkDataArray* parameters) {
  if (parameters == nullptr || parameters->GetNumberOfComponents() != kParameterComponents ||
      parameters->GetNumberOfTuples() != grid.GetNumberOfCells()) {
    throw Error(ErrorCode::InvalidArgument,
                "The parameters shall be a cell array of 12 components: u, v, w of the four "
                "corners of each tet. Choose another array.");
  }
  TetMesh tets = tetsOf(grid);
  TetMap map;
  map.points = std::move(tets.points);
  map.tets = std::move(tets.tets);
  map.parameters.resize(map.tets.size());
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::array<double, kParameterComponents> row{};
    parameters->GetTuple(static_cast<vtkIdType>(t), row.data());
    for (std::size_t k = 0; k < row.size(); ++k) map.parameters[t][k / 3][k % 3] = row[k];
  }
  takeRegions(grid, map.regions);
  takeFeatures(grid, kFeatureVertices, map.features.vertices);
  takeFeatures(grid, kFeatureEdges, map.features.edges);
  takeFeatures(grid, kFeatureFaces, map.features.faces);
  return map;
}

void fillFeatures(vtkPolyData& features, const TetMap& map) {
  setPoints(features, map.points);
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkIntArray> tags;  // in the order of poly data: vertices, lines, polygons
  tags->SetName("tag");
  vtkNew<vtkIntArray> dimensions;
  dimensions->SetName("dimension");
  addTagged(*vertices, *tags, *dimensions, map.features.vertices);
  addTagged(*lines, *tags, *dimensions, map.features.edges);
  addTagged(*triangles, *tags, *dimensions, map.features.faces);
  features.SetVerts(vertices);
  features.SetLines(lines);
  features.SetPolys(triangles);
  features.GetCellData()->AddArray(dimensions);
  features.GetCellData()->SetScalars(tags);
}

void fillGrid(vtkUnstructuredGrid& grid, const HexMesh& mesh, const Array<double>& quality) {
  setPoints(grid, mesh.points);
  grid.SetCells(VTK_HEXAHEDRON, fixedCells(mesh.cells.size(), 8, [&](std::size_t c, std::size_t k) {
                  return mesh.cells[c][k];
                }));
  putGenerators(grid, mesh);
  putQuality(grid, quality);
  putRegions(grid, mesh.regions);
  putFeatures(grid, kFeatureVertices, mesh.features.vertices);
  putFeatures(grid, kFeatureEdges, mesh.features.edges);
  putFeatures(grid, kFeatureFaces, mesh.features.quads);
}

void fillGrid(vtkUnstructuredGrid& grid, const LagrangeMesh& mesh, const Array<double>& quality) {
  setPoints(grid, mesh.points);
  // Where VTK has the nodes of the grid.
  const int n = mesh.order + 1;
  const std::array<int, 3> order{mesh.order, mesh.order, mesh.order};
  std::vector<std::size_t> nodeAt(mesh.nodesPerCell());
  std::size_t node = 0;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int place = vtkHigherOrderHexahedron::PointIndexFromIJK(i, j, k, order.data());
        nodeAt[static_cast<std::size_t>(place)] = node++;
      }
    }
  }
  grid.SetCells(VTK_LAGRANGE_HEXAHEDRON,
                fixedCells(mesh.cellCount(), mesh.nodesPerCell(),
                           [&](std::size_t c, std::size_t k) {
                             return mesh.nodes[c * mesh.nodesPerCell() + nodeAt[k]];
                           }));
  putGenerators(grid, mesh);
  putQuality(grid, quality);
}

HexMesh hexesOf(vtkUnstructuredGrid& grid) {
  HexMesh mesh;
  takePoints(grid, mesh.points);
  takeCells(grid, VTK_HEXAHEDRON, "hexahedron", mesh.cells);
  vtkDataArray* const tets = grid.GetPointData()->GetArray(kGeneratorTet);
  vtkDataArray* const corners = grid.GetPointData()->GetArray(kGeneratorCorners);
  if (tets != nullptr && corners != nullptr) {
    mesh.generatorTet.resize(mesh.points.size());
    mesh.generatorCorners.resize(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const auto at = static_cast<vtkIdType>(v);
      mesh.generatorTet[v] = static_cast<Index>(tets->GetComponent(at, 0));
      mesh.generatorCorners[v] = static_cast<CornerSet>(corners->GetComponent(at, 0));
    }
  }
  takeRegions(grid, mesh.regions);
  takeFeatures(grid, kFeatureVertices, mesh.features.vertices);
  takeFeatures(grid, kFeatureEdges, mesh.features.edges);
  takeFeatures(grid, kFeatureFaces, mesh.features.quads);
  return mesh;
}

void fillChartJumps(vtkPolyData& triangles, const TetMap& map, const MapStructure& structure) {
  const auto& jumps = structure.chartJumps;
  setPoints(triangles, map.points);
  triangles.SetPolys(fixedCells(jumps.size(), 3, [&](std::size_t j, std::size_t k) {
    return jumps[j].vertices[k];
  }));
  vtkCellData& data = *triangles.GetCellData();
  data.AddArray(makeArray<vtkIdTypeArray>(
      "tets", jumps.size(), 2, [&](std::size_t j, std::size_t k) { return jumps[j].tets[k]; }));
  data.AddArray(makeArray<vtkIntArray>(
      "rotation", jumps.size(), 9,
      [&](std::size_t j, std::size_t k) { return jumps[j].rotation[k / 3][k % 3]; }));
  data.AddArray(makeArray<vtkDoubleArray>(
      "translation", jumps.size(), 3,
      [&](std::size_t j, std::size_t k) { return jumps[j].translation[k]; }));
}

namespace {

/// Edges with their valences, of tets or hexahedra.
template <class Mesh, class Edges>
void fillEdges(vtkPolyData& lines, const Mesh& mesh, const Edges& edges) {
  setPoints(lines, mesh.points);
  lines.SetLines(fixedCells(edges.size(), 2, [&](std::size_t e, std::size_t k) {
    return k == 0 ? edges[e].vertex0 : edges[e].vertex1;
  }));
  lines.GetCellData()->AddArray(makeArray<vtkIntArray>(
      "valence", edges.size(), 1,
      [&](std::size_t e, std::size_t) { return edges[e].valence; }));
  lines.GetCellData()->AddArray(makeArray<vtkUnsignedCharArray>(
      "boundary", edges.size(), 1,
      [&](std::size_t e, std::size_t) { return edges[e].boundary ? 1 : 0; }));
  lines.GetCellData()->SetActiveScalars("valence");
}

}  // namespace

void fillSingularEdges(vtkPolyData& lines, const TetMap& map, const MapStructure& structure) {
  fillEdges(lines, map, structure.singularEdges);
}

void fillSingularEdges(vtkPolyData& lines, const HexMesh& mesh, const MeshStructure& structure) {
  fillEdges(lines, mesh, structure.singularEdges);
}

namespace {

/// All points of the common numbering.
void setCommonPoints(vtkPolyData& to, const PiecewiseLinearMesh& mesh) {
  Array<Vec3> points(mesh.mesh.points.size() + mesh.arcs.points.size() +
                     mesh.patches.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = mesh.point(i);
  setPoints(to, points);
}

}  // namespace

void fillArcs(vtkPolyData& lines, const PiecewiseLinearMesh& mesh) {
  setCommonPoints(lines, mesh);
  const Arcs& arcs = mesh.arcs;
  const std::uint64_t firstInner = mesh.mesh.points.size();
  vtkNew<vtkCellArray> cells;
  for (std::size_t a = 0; a < arcs.count(); ++a) {
    const std::uint64_t begin = arcs.pointBegin[a];
    const std::uint64_t end = arcs.pointBegin[a + 1];
    cells->InsertNextCell(static_cast<int>(end - begin + 2));
    cells->InsertCellPoint(static_cast<vtkIdType>(arcs.ends[a][0]));
    for (std::uint64_t i = begin; i < end; ++i) {
      cells->InsertCellPoint(static_cast<vtkIdType>(firstInner + i));
    }
    cells->InsertCellPoint(static_cast<vtkIdType>(arcs.ends[a][1]));
  }
  lines.SetLines(cells);
}

void fillPatches(vtkPolyData& polygons, const PiecewiseLinearMesh& mesh) {
  setCommonPoints(polygons, mesh);
  const Patches& patches = mesh.patches;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIdTypeArray> faces;
  faces->SetName("face");
  for (std::size_t f = 0; f < patches.count(); ++f) {
    for (std::uint64_t p = patches.polygonBegin[f]; p < patches.polygonBegin[f + 1]; ++p) {
      const std::uint64_t begin = patches.cornerBegin[p];
      const std::uint64_t end = patches.cornerBegin[p + 1];
      cells->InsertNextCell(static_cast<int>(end - begin));
      for (std::uint64_t i = begin; i < end; ++i) {
        cells->InsertCellPoint(static_cast<vtkIdType>(patches.corners[i]));
      }
      faces->InsertNextValue(static_cast<vtkIdType>(f));
    }
  }
  polygons.SetPolys(cells);
  polygons.GetCellData()->AddArray(faces);
}

}  // namespace hexhex::paraview
