// Nodes of Lagrange hexahedra, in the orders of the formats.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex::io {

/// Position of a node in a cell, from 0 to the order along each axis.
using Node = std::array<int, 3>;

/// Corner i in the order of VTK and Gmsh, on a cube from `low` to `high`.
[[nodiscard]] inline Node corner(std::size_t i, int low, int high) {
  return {i % 4 == 1 || i % 4 == 2 ? high : low, i % 4 >= 2 ? high : low, i >= 4 ? high : low};
}

/// `count` nodes strictly between two corners, starting next to the first, one unit step apart.
[[nodiscard]] inline std::vector<Node> between(const Node& from, const Node& to, int count) {
  std::vector<Node> nodes;
  for (int step = 1; step <= count; ++step) {
    Node node = from;
    for (std::size_t k = 0; k < 3; ++k) {
      node[k] += to[k] > from[k] ? step : (to[k] < from[k] ? -step : 0);
    }
    nodes.push_back(node);
  }
  return nodes;
}

/// The index of a node in the order of LagrangeMesh, i + (p + 1) (j + (p + 1) k).
[[nodiscard]] constexpr int nodePlace(const Node& n, int order) {
  return n[0] + (order + 1) * (n[1] + (order + 1) * n[2]);
}
[[nodiscard]] inline std::vector<std::uint32_t> placesOf(const std::vector<Node>& nodes,
                                                         int order) {
  std::vector<std::uint32_t> places;
  places.reserve(nodes.size());
  for (const Node& n : nodes) places.push_back(static_cast<std::uint32_t>(nodePlace(n, order)));
  return places;
}

/// The number of nodes of a cell, (p + 1)^3.
[[nodiscard]] constexpr std::size_t nodesOfOrder(int order) {
  const auto n = static_cast<std::size_t>(order) + 1;
  return n * n * n;
}
/// The order of cells with so many nodes; 0 if there is none from 1 to 9.
[[nodiscard]] constexpr int orderOfNodes(std::uint64_t nodes) {
  for (int order = 1; order <= kMaxOrder; ++order) {
    if (nodesOfOrder(order) == nodes) return order;
  }
  return 0;
}

inline void append(std::vector<Node>& nodes, const std::vector<Node>& more) {
  nodes.insert(nodes.end(), more.begin(), more.end());
}

/// Appends the nodes of a quadrangle: its corners, sides, and interior, which is a smaller
/// quadrangle.
void appendQuad(std::vector<Node>& nodes, std::array<Node, 4> corners, int order);

/// The order of the vertical edges of VTK's Lagrange cells: around the cell or, before VTK 9 and in
/// XML files before version 2.1, row by row.
enum class VtkEdges : std::uint8_t { Around, RowByRow };

/// Entry k: the LagrangeMesh index of VTK's node k. VTK lists corners, edges, faces, interior:
/// edges around the bottom, around the top, then vertical ones; faces across x, y, z, the lower of
/// each pair first.
[[nodiscard]] std::vector<std::uint32_t> vtkNodeOrder(int order,
                                                      VtkEdges upright = VtkEdges::Around);

// Gmsh's element types.
inline constexpr unsigned kGmshLine = 1;
inline constexpr unsigned kGmshTriangle = 2;
inline constexpr unsigned kGmshQuad = 3;
inline constexpr unsigned kGmshHexahedron = 5;
inline constexpr unsigned kGmshPoint = 15;
// Order 2, without face and interior nodes.
inline constexpr unsigned kGmshQuad8 = 16;
inline constexpr unsigned kGmshHexahedron20 = 17;
// Complete elements of order 1 to 9.
using GmshTypes = std::array<unsigned, kMaxOrder>;
inline constexpr GmshTypes kGmshLines = {kGmshLine, 8, 26, 27, 28, 62, 63, 64, 65};
inline constexpr GmshTypes kGmshQuads = {kGmshQuad, 10, 36, 37, 38, 47, 48, 49, 50};
inline constexpr GmshTypes kGmshHexahedra = {kGmshHexahedron, 12, 92, 93, 94, 95, 96, 97, 98};

/// Entry k: the LagrangeMesh index of Gmsh's node k. Gmsh lists corners, edges, faces, interior,
/// which is a smaller cell. The first 20 of order 2 are those of 20-node hexahedra.
[[nodiscard]] std::vector<std::uint32_t> gmshNodeOrder(int order);

/// The same for cells of order 2 in another format.
/// @param places  entry k: the position in the format of VTK's node k
[[nodiscard]] std::vector<std::uint32_t> quadraticOrder(const std::array<std::uint8_t, 27>& places);

/// Such a table for CGNS, which lists vertical edges before those of the top, and faces from the
/// bottom, around the cell, to the top.
inline constexpr std::array<std::uint8_t, 27> kCgnsPlaces = {0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                             9,  10, 11, 16, 17, 18, 19, 12, 13,
                                                             14, 15, 24, 22, 21, 23, 20, 25, 26};

/// Nodes of tagged edges and of quads, order + 1 or (order + 1)^2 each, in the order of Gmsh and
/// CGNS: corners, side nodes, interior nodes. Boundary quads are counter-clockwise seen from
/// outside; interior quads, seen from outside the first cell that has them.
struct GroupNodes {
  Array<Index> edges;
  Array<Index> quads;
};
/// @param straight  the result of straightMesh()
/// @throws Error InvalidArgument for an element that belongs to no cell
[[nodiscard]] GroupNodes nodesOfGroups(const LagrangeMesh& mesh, const HexMesh& straight,
                                       const EdgeGroups& edges, const QuadGroups& quads,
                                       Stage& stage);

}  // namespace hexhex::io
