// Gmsh's files of Lagrange cells.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_nodes.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/msh41_writer.hpp>

namespace hexhex::io {
namespace {

// Gmsh's types of elements of order 1 to 9.
constexpr std::array<unsigned, kMaxOrder> kLines = {1, 8, 26, 27, 28, 62, 63, 64, 65};
constexpr std::array<unsigned, kMaxOrder> kQuads = {3, 10, 36, 37, 38, 47, 48, 49, 50};
constexpr std::array<unsigned, kMaxOrder> kHexahedra = {5, 12, 92, 93, 94, 95, 96, 97, 98};

/// The nodes of a cell in the order of a file.
struct NodesInOrder {
  const Index* nodes;
  const std::uint32_t* order;

  Index operator[](std::size_t k) const { return nodes[order[k]]; }
};

/// A quadrangle: its corners, sides, and what is inside, which is a smaller one.
void appendGmshQuad(std::vector<Node>& nodes, std::array<Node, 4> corners, int order) {
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
  appendGmshQuad(nodes, inner, order - 2);
}

void appendGmshHex(std::vector<Node>& nodes, int low, int high) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
      {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}};
  if (low > high) return;
  if (low == high) {
    nodes.push_back(corner(0, low, high));
    return;
  }
  for (std::size_t i = 0; i < 8; ++i) nodes.push_back(corner(i, low, high));
  auto edges = adjacency::kHexEdges;  // ascending, from the smaller corner to the larger one
  for (auto& edge : edges) edge = {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges) {
    append(nodes, between(corner(a, low, high), corner(b, low, high), high - low - 1));
  }
  for (const auto& face : kFaces) {
    std::array<Node, 4> inner{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Node from = corner(face[i], low, high);
      inner[i] = between(from, corner(face[(i + 2) % 4], low, high), 1)[0];
    }
    appendGmshQuad(nodes, inner, high - low - 2);
  }
  appendGmshHex(nodes, low + 1, high - 1);
}

/// A cell, and which of its edges or faces an element is.
struct ElementPlace {
  std::uint64_t cell;
  std::size_t slot;
};

/// Finds elements, which are few, in the cells that have them.
class ElementFinder {
 public:
  ElementFinder(const HexMesh& mesh, Stage& stage) : mesh_(mesh), stage_(stage) {}

  /// The first place of an element.
  /// @param corners  of such elements of a cell, by slot
  /// @param what  for the message
  /// @throws Error InvalidArgument for an element that is none of a cell
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
    std::string text = std::string("The tagged ") + what;
    for (const Index vertex : element) text.append(1, ' ').append(std::to_string(vertex));
    throw Error(ErrorCode::InvalidArgument, text + " belongs to no cell of the mesh.");
  }

 private:
  const HexMesh& mesh_;
  Stage& stage_;
  adjacency::VertexCells around_;  ///< found when it is needed
};

/// Appends the nodes from + i * stepI + j * stepJ of a cell, where (i, j, 0) are the nodes of a
/// list. Steps lead from one corner towards two others.
/// @param corners  the one and the two others
void appendNodes(const LagrangeMesh& mesh, std::uint64_t cell,
                 const std::array<std::size_t, 3>& corners, const std::vector<Node>& list,
                 Array<Index>& nodes) {
  const Index* const ofCell = mesh.nodes.data() + cell * mesh.nodesPerCell();
  const std::ptrdiff_t row = mesh.order + 1;
  const auto placeOf = [row](const Node& n) { return n[0] + row * (n[1] + row * n[2]); };
  const std::ptrdiff_t from = placeOf(corner(corners[0], 0, mesh.order));
  const auto stepTo = [&](std::size_t other) {
    return (placeOf(corner(other, 0, mesh.order)) - from) / mesh.order;
  };
  const std::ptrdiff_t stepI = stepTo(corners[1]);
  const std::ptrdiff_t stepJ = stepTo(corners[2]);
  for (const Node& n : list) nodes.push_back(ofCell[from + n[0] * stepI + n[1] * stepJ]);
}

/// Entry k: the place of the node that Gmsh lists at place k.
std::vector<std::uint32_t> gmshNodeOrder(int order) {
  std::vector<Node> nodes;
  appendGmshHex(nodes, 0, order);
  return placesOf(nodes, order);
}

/// The nodes of tagged edges, order + 1 each, in Gmsh's order.
/// @param straight  what straightMesh() returns
Array<Index> gmshEdgeNodes(const LagrangeMesh& mesh, const HexMesh& straight,
                           const EdgeGroups& edges, ElementFinder& finder) {
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

/// The nodes of quads, (order + 1)^2 each, in Gmsh's order; those of the boundary run
/// counter-clockwise seen from outside, those inside the mesh so seen from outside of the first
/// cell that they belong to.
Array<Index> gmshQuadNodes(const LagrangeMesh& mesh, const QuadGroups& quads,
                           ElementFinder& finder) {
  const int p = mesh.order;
  std::vector<Node> list;
  appendGmshQuad(list, {{{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}}}, p);
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

void writeLagrangeGmsh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  Msh41Writer<TextNumbers> writer(file, context.threads());
  HexMesh straight = straightMesh(mesh);
  const GmshGroups groups(MeshGroups(straight, options.patchAngle, stage));
  Array<Index> lines;
  Array<Index> quads;
  withThreads(context.threads(), [&] {
    ElementFinder finder(straight, stage);
    lines = gmshEdgeNodes(mesh, straight, groups.edges, finder);
    quads = gmshQuadNodes(mesh, groups.quads, finder);
  });
  straight = {};

  const std::vector<std::uint32_t> order = gmshNodeOrder(mesh.order);
  const std::size_t perEdge = static_cast<std::size_t>(mesh.order) + 1;
  const std::size_t perQuad = perEdge * perEdge;
  const std::size_t type = perEdge - 2;
  const auto forEachKind = [&](const auto& f) {
    f(GmshKind{0U, kGmshPoint, 1U, [&](std::size_t i) { return groups.vertices.elements[i]; }});
    f(GmshKind{1U, kLines[type], perEdge,
               [&](std::size_t i) { return lines.data() + i * perEdge; }});
    f(GmshKind{2U, kQuads[type], perQuad,
               [&](std::size_t i) { return quads.data() + i * perQuad; }});
    f(GmshKind{
        3U, kHexahedra[type], order.size(), [&](std::size_t i) {
          return NodesInOrder{mesh.nodes.data() + groups.cells.at(i) * order.size(), order.data()};
        }});
  };
  writer.write(mesh.points, groups, forEachKind, stage);
}

}  // namespace hexhex::io
