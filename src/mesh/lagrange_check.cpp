#include <algorithm>
#include <cstddef>
#include <string>

#include <hexhex/error.hpp>

#include <mesh/lagrange_check.hpp>

namespace hexhex::mesh {

namespace {

[[noreturn]] void refuse(const std::string& what, const Place& place = {}) {
  throw Error(ErrorCode::InvalidArgument, what, place);
}

/// The eight corners of a cell must be hex vertices.
void requireCorners(const LagrangeMesh& mesh, std::size_t cell) {
  const auto p = static_cast<std::size_t>(mesh.order);
  const Index* const nodes = mesh.nodes.data() + cell * mesh.nodesPerCell();
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t i = (corner & 1U) != 0 ? p : 0;
    const std::size_t j = (corner & 2U) != 0 ? p : 0;
    const std::size_t k = (corner & 4U) != 0 ? p : 0;
    if (nodes[i + (p + 1) * (j + (p + 1) * k)] >= mesh.vertexCount) {
      refuse("A corner of cell " + std::to_string(cell) + " is none of the first " +
                 std::to_string(mesh.vertexCount) + " nodes, which are the hex vertices.",
             {PlaceKind::Cell, cell, 0});
    }
  }
}

}  // namespace

void requireConsistent(const LagrangeMesh& mesh) {
  if (mesh.order < 1 || mesh.order > kMaxOrder) {
    refuse("The order of the cells is " + std::to_string(mesh.order) + ". It has to be from 1 to " +
           std::to_string(kMaxOrder) + ".");
  }
  const std::size_t perCell = mesh.nodesPerCell();
  const std::size_t nodes = mesh.points.size();
  if (mesh.nodes.size() % perCell != 0) {
    refuse("Cells of order " + std::to_string(mesh.order) + " have " + std::to_string(perCell) +
           " nodes each, and " + std::to_string(mesh.nodes.size()) + " is no multiple of that.");
  }
  if (mesh.vertexCount > nodes) {
    refuse("There are " + std::to_string(nodes) + " nodes, so that " +
           std::to_string(mesh.vertexCount) + " of them cannot be hex vertices.");
  }
  if (mesh.generatorTet.size() != mesh.generatorCorners.size() ||
      (!mesh.generatorTet.empty() && mesh.generatorTet.size() != nodes)) {
    refuse(
        "The generators are not as many as the nodes. Give one of each for every node, or none.");
  }
  const auto bad = std::find_if(mesh.nodes.begin(), mesh.nodes.end(),
                                [nodes](Index node) { return node >= nodes; });
  if (bad != mesh.nodes.end()) {
    const std::size_t cell = static_cast<std::size_t>(bad - mesh.nodes.begin()) / perCell;
    refuse("Cell " + std::to_string(cell) + " names node " + std::to_string(*bad) +
               ", and there are " + std::to_string(nodes) + ".",
           {PlaceKind::Cell, cell, 0});
  }
  const std::size_t cells = mesh.cellCount();
  if (!mesh.regions.empty() && mesh.regions.size() != cells) {
    refuse("There are " + std::to_string(mesh.regions.size()) + " regions of " +
           std::to_string(cells) + " cells. Give one for each, or none.");
  }
  for (std::size_t cell = 0; cell < cells; ++cell) requireCorners(mesh, cell);
}

}  // namespace hexhex::mesh
