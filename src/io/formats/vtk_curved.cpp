// Lagrange cells in `.vtu` files, and hexahedra with 20 and 27 nodes in all VTK files.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>
#include <io/formats/vtk_data_set.hpp>
#include <io/formats/vtk_source.hpp>

namespace hexhex::io {

namespace {

/// Lagrange hexahedra with this number of nodes.
CellKind lagrangeCells(std::size_t nodes) {
  return {.corners = nodes,
          .singular = "Lagrange hexahedron",
          .plural = "Lagrange hexahedra",
          .vtkType = kVtkLagrangeHexahedron};
}

/// Order-2 cells with types of their own. The first lacks the last 7 nodes of the second, whose
/// nodes are in the order of Lagrange cells.
constexpr std::array<CellKind, 2> kQuadratic = {kCellKind<20>, kCellKind<27>};

std::size_t countCells(const VtkSource& source, const CellKind& kind) {
  return countVtkCells(source, kind, 0, source.cells);
}

/// The kind of order-2 cells in a file without straight hexahedra; null if there are none.
const CellKind* quadraticKind(const VtkSource& source) {
  if (countCells(source, kCellKind<8>) > 0) return nullptr;
  for (const CellKind& kind : kQuadratic) {
    if (countCells(source, kind) > 0) return &kind;
  }
  return nullptr;
}

/// The order of the cells, which must be equal for all.
int findOrder(const VtkSource& source) {
  Array<std::int64_t> types(source.cells);
  const Array<std::int64_t> places = vtkCellPlaces(source, 0, source.cells);
  source.copy(source.types, 0, types.size(), types.data());
  std::int64_t nodes = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (types[c] != kVtkLagrangeHexahedron) continue;
    const std::int64_t begin = c == 0 ? 0 : places[c];
    const std::int64_t end = places[c + 1];
    // The reader of cells reports invalid places.
    const auto stored = static_cast<std::int64_t>(source.connectivity.count);
    if (begin < 0 || end < begin || end > stored) break;
    const std::int64_t count = end - begin - static_cast<std::int64_t>(source.gap);
    const bool first = nodes == 0;
    if (first && orderOfNodes(static_cast<std::uint64_t>(count)) > 0) nodes = count;
    if (count == nodes) continue;
    source.fail(ErrorCode::FileUnsupported, Place{PlaceKind::Cell, c}, "cell ", c, " has ", count,
                " nodes",
                (first ? ", but Lagrange hexahedra of an order p from 1 to 9, the same in all "
                         "directions, have (p + 1)^3."
                       : concat(", but the cells before it have ", nodes,
                                ". Cells of different orders are not supported.")));
  }
  return nodes == 0 ? 1 : orderOfNodes(static_cast<std::uint64_t>(nodes));
}

/// Converts nodes from VTK's order to that of LagrangeMesh.
void reorderNodes(LagrangeMesh& mesh, VtkEdges upright, Stage& stage) {
  constexpr std::size_t kGrain = std::size_t{1} << 10;
  const std::vector<std::uint32_t> places = vtkNodeOrder(mesh.order, upright);
  parallelBlocks(stage, mesh.cellCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::vector<Index> row(places.size());
                   for (std::size_t c = begin; c < end; ++c) {
                     Index* const nodes = mesh.nodes.data() + c * row.size();
                     std::copy_n(nodes, row.size(), row.begin());
                     for (std::size_t k = 0; k < row.size(); ++k) nodes[places[k]] = row[k];
                   }
                 });
}

/// Renumbers tags of corners; drops others, which are not in the straight mesh.
void renumberFeatures(const std::vector<bool>& isCorner, const Array<Index>& newNumber,
                      HexFeatures& features) {
  const auto isNoCorner = [&isCorner](Index node) { return !isCorner[node]; };
  std::erase_if(features.vertices,
                [&](const FeatureVertex& feature) { return isNoCorner(feature.vertex); });
  for (FeatureVertex& feature : features.vertices) feature.vertex = newNumber[feature.vertex];
  const auto renumber = [&](auto& elements) {
    std::erase_if(elements, [&](const auto& element) {
      return std::ranges::any_of(element.vertices, isNoCorner);
    });
    for (auto& element : elements) {
      for (Index& vertex : element.vertices) vertex = newNumber[vertex];
    }
  };
  renumber(features.edges);
  renumber(features.quads);
}

/// Extends rows of 20 nodes to rows of 27.
void completeCells(LagrangeMesh& mesh, std::size_t nodesEach, const std::string& fileName) {
  const std::size_t perCell = mesh.nodesPerCell();
  Array<Index> rows(mesh.nodes.size() / nodesEach * perCell);
  std::vector<std::size_t> cells(rows.size() / perCell);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    cells[c] = c;
    std::copy_n(mesh.nodes.data() + nodesEach * c, nodesEach, rows.data() + perCell * c);
  }
  mesh.nodes = std::move(rows);
  addMiddles(mesh.points, mesh.nodes, cells, fileName);
}

}  // namespace

bool holdsVtkLagrange(const VtkSource& source) {
  return countCells(source, lagrangeCells(0)) > 0 || quadraticKind(source) != nullptr;
}

LagrangeMesh readVtkLagrange(const VtkSource& source, Stage& stage) {
  source.requireIndexable();
  LagrangeMesh mesh;
  const bool isLagrange = countCells(source, lagrangeCells(0)) > 0;
  const CellKind* const quadratic = isLagrange ? nullptr : quadraticKind(source);
  mesh.order = quadratic != nullptr ? 2 : findOrder(source);
  const CellKind wanted = quadratic != nullptr ? *quadratic : lagrangeCells(mesh.nodesPerCell());
  if (source.cells == 0) failWithoutVtkCells(source, wanted);
  mesh.points.resize(source.points);
  readVtkPoints(source, mesh.points, stage);
  Array<std::size_t> numbers;
  const auto makeRoom = [&](std::size_t cells) {
    mesh.nodes.resize(cells * wanted.corners);
    return mesh.nodes.data();
  };
  readVtkCells(source, wanted, makeRoom, &numbers, stage);
  source.counts->requireOnly(wanted, source.name(), "Give the others a file of their own.");
  if (wanted.corners < mesh.nodesPerCell()) {
    completeCells(mesh, wanted.corners, source.name());  // new nodes have no generators
  } else {
    readVtkGenerators(source, mesh.generatorTet, mesh.generatorCorners);
  }
  mesh.regions = readVtkRegions(source, numbers);
  mesh.features = readVtkHexFeatures(source);
  fromVtkOrder(mesh, stage, isLagrange ? source.uprightEdges : VtkEdges::Around);
  return mesh;
}

void putCornersFirst(LagrangeMesh& mesh) {
  std::vector<bool> isCorner(mesh.points.size(), false);
  const std::vector<std::uint32_t> places = vtkNodeOrder(mesh.order);  // corners come first
  const std::size_t perCell = mesh.nodesPerCell();
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    for (std::size_t k = 0; k < 8; ++k) isCorner[mesh.nodes[c * perCell + places[k]]] = true;
  }
  mesh.vertexCount = static_cast<std::uint64_t>(std::count(isCorner.begin(), isCorner.end(), true));
  Array<Index> newNumber(mesh.points.size());
  Index nextCorner = 0;
  auto nextOther = static_cast<Index>(mesh.vertexCount);
  for (std::size_t v = 0; v < newNumber.size(); ++v) {
    newNumber[v] = isCorner[v] ? nextCorner++ : nextOther++;
  }
  const auto moved = [&newNumber](const auto& from) {
    auto to = from;
    for (std::size_t v = 0; v < from.size(); ++v) to[newNumber[v]] = from[v];
    return to;
  };
  mesh.points = moved(mesh.points);
  mesh.generatorTet = moved(mesh.generatorTet);
  mesh.generatorCorners = moved(mesh.generatorCorners);
  for (Index& node : mesh.nodes) node = newNumber[node];
  renumberFeatures(isCorner, newNumber, mesh.features);
}

void fromVtkOrder(LagrangeMesh& mesh, Stage& stage, VtkEdges upright) {
  reorderNodes(mesh, upright, stage);
  putCornersFirst(mesh);
}

bool holdsLagrangeVtu(const Input& input, Stage& stage) {
  return holdsVtkLagrange(*openVtuFile(input, stage));
}

bool holdsCurvedVtkLegacy(const Input& input, Stage& stage) {
  const auto source = openVtkLegacyFile(input, false, stage);
  return holdsVtkLagrange(*source) && countCells(*source, kCellKind<8>) == 0;
}

LagrangeMesh readCurvedVtkLegacy(const Input& input, Stage& stage) {
  const auto source = openVtkLegacyFile(input, true, stage);
  if (!holdsVtkLagrange(*source)) failWithoutVtkCells(*source, kQuadratic.back());
  return readVtkLagrange(*source, stage);
}

LagrangeMesh readLagrangeVtu(const Input& input, Stage& stage) {
  return readVtkLagrange(*openVtuFile(input, stage), stage);
}

void writeLagrangeVtu(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                      Stage& stage) {
  const std::size_t perCell = mesh.nodesPerCell();
  // Written as version 1.0, which meshio accepts; VTK 9 then converts the order of edges of
  // Lagrange cells. Order 2 uses its own type, which more programs support and whose order VTK 9
  // does not change.
  const bool hasOwnType = mesh.order == 2;
  const auto type =
      static_cast<std::uint8_t>(hasOwnType ? kQuadratic.back().vtkType : kVtkLagrangeHexahedron);
  const std::vector<std::uint32_t> order =
      vtkNodeOrder(mesh.order, hasOwnType ? VtkEdges::Around : VtkEdges::RowByRow);
  const PointPiece nodes = {0, mesh.points, mesh.generatorTet, mesh.generatorCorners};
  VtkDataSet data(mesh.points.size(), mesh.cellCount());
  data.curved = true;
  addPoints(data, std::span(&nodes, 1));
  data.add(VtkSection::CellData, kVtkQuality, options.scaledJacobians);
  addTags(data, mesh.features, mesh.regions);  // vertices are the first nodes
  data.addComputed<std::int64_t>(VtkSection::Cells, "connectivity", mesh.nodes.size(),
                                 [&](std::size_t i) {
                                   const std::size_t cell = i / perCell;
                                   return mesh.nodes[cell * perCell + order[i - cell * perCell]];
                                 });
  data.addComputed<std::int64_t>(VtkSection::Cells, "offsets", data.cells,
                                 [perCell](std::size_t i) { return perCell * (i + 1); });
  data.addComputed<std::uint8_t>(VtkSection::Cells, "types", data.cells,
                                 [type](std::size_t) { return type; });
  writeVtkXml(output, data, Compression::None, stage);
}

}  // namespace hexhex::io
