// Nodes of Lagrange cells and of their edges and faces, in the orders of the formats.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// A cell, and the slot of an edge or face in it.
struct ElementPlace {
  std::uint64_t cell;
  std::size_t slot;
};

/// Locates a few elements in the cells that have them.
class ElementFinder {
 public:
  ElementFinder(const HexMesh& mesh, Stage& stage) : mesh_(mesh), stage_(stage) {}

  /// The first location of an element.
  /// @param corners  per slot: the cell corners of its element
  /// @param what  for the message
  /// @throws Error InvalidArgument if the element belongs to no cell
  template <std::size_t n, std::size_t slots>
  ElementPlace find(const std::array<Index, n>& element,
                    const std::array<std::array<std::uint8_t, n>, slots>& corners,
                    const char* what) {
    if (around_.empty()) around_ = adjacency::cellsAroundVertices(mesh_, stage_);
    for (const Index cell : around_(element[0])) {
      for (std::size_t slot = 0; slot < slots; ++slot) {
        std::array<Index, n> vertices{};
        for (std::size_t i = 0; i < n; ++i) vertices[i] = mesh_.cells[cell][corners[slot][i]];
        if (std::is_permutation(vertices.begin(), vertices.end(), element.begin())) {
          return {cell, slot};
        }
      }
    }
    std::string text = concat("The tagged ", what);
    for (const Index vertex : element) text.append(1, ' ').append(std::to_string(vertex));
    throw Error(ErrorCode::InvalidArgument, text + " belongs to no cell of the mesh.");
  }

 private:
  const HexMesh& mesh_;
  Stage& stage_;
  adjacency::VertexCells around_;  ///< built on first use
};

/// Appends the nodes from + i * stepI + j * stepJ of a cell, for all (i, j, 0) of a list. The steps
/// lead from one corner towards two others.
/// @param corners  the first corner and the two others
void appendNodes(const LagrangeMesh& mesh, std::uint64_t cell,
                 const std::array<std::size_t, 3>& corners, const std::vector<Node>& list,
                 Array<Index>& nodes) {
  const Index* const ofCell = mesh.nodes.data() + cell * mesh.nodesPerCell();
  const int from = nodePlace(corner(corners[0], 0, mesh.order), mesh.order);
  const auto stepTo = [&](std::size_t other) {
    return (nodePlace(corner(other, 0, mesh.order), mesh.order) - from) / mesh.order;
  };
  const int stepI = stepTo(corners[1]);
  const int stepJ = stepTo(corners[2]);
  for (const Node& n : list) nodes.push_back(ofCell[from + n[0] * stepI + n[1] * stepJ]);
}

/// The nodes of tagged edges, order + 1 each.
Array<Index> edgeNodes(const LagrangeMesh& mesh, const HexMesh& straight, const EdgeGroups& edges,
                       ElementFinder& finder) {
  std::vector<Node> list = {{0, 0, 0}, {mesh.order, 0, 0}};
  append(list, between(list[0], list[1], mesh.order - 1));
  Array<Index> nodes;
  nodes.reserve(edges.elements.size() * list.size());
  for (const std::array<Index, 2>& edge : edges.elements) {
    const auto [cell, slot] = finder.find(edge, adjacency::kHexEdges, "edge");
    auto [a, b] = adjacency::kHexEdges[slot];
    if (straight.cells[cell][a] != edge[0]) std::swap(a, b);
    appendNodes(mesh, cell, {a, b, b}, list, nodes);
  }
  return nodes;
}

/// The nodes of quads, (order + 1)^2 each.
Array<Index> quadNodes(const LagrangeMesh& mesh, const QuadGroups& quads, ElementFinder& finder) {
  const int p = mesh.order;
  std::vector<Node> list;
  appendQuad(list, {{{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}}}, p);
  Array<Index> nodes;
  nodes.reserve(quads.elements.size() * list.size());
  for (std::size_t i = 0; i < quads.elements.size(); ++i) {
    const std::uint64_t place = quads.places[i];
    const auto [cell, face] = place == kNoPlace
                                  ? finder.find(quads.elements[i], adjacency::kHexFaces, "quad")
                                  : ElementPlace{place / 8, static_cast<std::size_t>(place % 8)};
    const auto& corners = adjacency::kHexFaces[face];
    appendNodes(mesh, cell, {corners[0], corners[1], corners[3]}, list, nodes);
  }
  return nodes;
}

}  // namespace

void appendQuad(std::vector<Node>& nodes, std::array<Node, 4> corners, int order) {
  if (order < 0) return;
  if (order == 0) {
    nodes.push_back(corners[0]);
    return;
  }
  nodes.insert(nodes.end(), corners.begin(), corners.end());
  for (std::size_t i = 0; i < 4; ++i) {
    append(nodes, between(corners[i], corners[(i + 1) % 4], order - 1));
  }
  std::array<Node, 4> inner{};
  for (std::size_t i = 0; i < 4; ++i) {
    // One step towards the opposite corner.
    const Node& opposite = corners[(i + 2) % 4];
    inner[i] = between(corners[i], opposite, 1)[0];
  }
  appendQuad(nodes, inner, order - 2);
}

std::vector<std::uint32_t> vtkNodeOrder(int order, VtkEdges upright) {
  auto edges = adjacency::kHexEdges;
  if (upright == VtkEdges::Around) std::swap(edges[10], edges[11]);
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < 8; ++i) nodes.push_back(corner(i, 0, order));
  for (const auto& [a, b] : edges) {
    append(nodes, between(corner(a, 0, order), corner(b, 0, order), order - 1));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = axis == 0 ? 1 : 0;
    const std::size_t second = axis == 2 ? 1 : 2;
    for (const int side : {0, order}) {
      for (int j = 1; j < order; ++j) {
        for (int i = 1; i < order; ++i) {
          Node node{};
          node[axis] = side;
          node[first] = i;
          node[second] = j;
          nodes.push_back(node);
        }
      }
    }
  }
  for (int k = 1; k < order; ++k) {
    for (int j = 1; j < order; ++j) {
      for (int i = 1; i < order; ++i) nodes.push_back({i, j, k});
    }
  }
  return placesOf(nodes, order);
}

std::vector<std::uint32_t> quadraticOrder(const std::array<std::uint8_t, 27>& places) {
  const std::vector<std::uint32_t> ofVtk = vtkNodeOrder(2);
  std::vector<std::uint32_t> order(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) order[places[k]] = ofVtk[k];
  return order;
}

GroupNodes nodesOfGroups(const LagrangeMesh& mesh, const HexMesh& straight, const EdgeGroups& edges,
                         const QuadGroups& quads, Stage& stage) {
  GroupNodes nodes;
  withThreads(stage.context().threads(), [&] {
    ElementFinder finder(straight, stage);
    nodes = {edgeNodes(mesh, straight, edges, finder), quadNodes(mesh, quads, finder)};
  });
  return nodes;
}

}  // namespace hexhex::io
