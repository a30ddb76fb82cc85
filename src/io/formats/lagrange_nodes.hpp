// Nodes of Lagrange hexahedra, for the orders in which formats list them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex::io {

/// Where a node is in a cell, from 0 to the order along each axis.
using Node = std::array<int, 3>;

/// Corners in VTK's order, which Gmsh shares, on a cube from `low` to `high`.
[[nodiscard]] inline Node corner(std::size_t i, int low, int high) {
  return {i % 4 == 1 || i % 4 == 2 ? high : low, i % 4 >= 2 ? high : low, i >= 4 ? high : low};
}

/// Nodes strictly between two corners, from the first on; their steps are of length 1.
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

/// Places in the order of LagrangeMesh, i + (p + 1) (j + (p + 1) k).
[[nodiscard]] inline std::vector<std::uint32_t> placesOf(const std::vector<Node>& nodes,
                                                         int order) {
  std::vector<std::uint32_t> places;
  places.reserve(nodes.size());
  for (const Node& n : nodes) {
    places.push_back(static_cast<std::uint32_t>(n[0] + (order + 1) * (n[1] + (order + 1) * n[2])));
  }
  return places;
}

inline void append(std::vector<Node>& nodes, const std::vector<Node>& more) {
  nodes.insert(nodes.end(), more.begin(), more.end());
}

/// Appends the nodes of a quadrangle: its corners, sides, and what is inside, which is a smaller
/// one.
void appendQuad(std::vector<Node>& nodes, std::array<Node, 4> corners, int order);

/// How Lagrange cells of VTK list their edges along z: around the cell, or, as before VTK 9 and in
/// its XML files before version 2.1, row by row.
enum class VtkEdges : std::uint8_t { Around, RowByRow };

/// Entry k: the place of the node that VTK lists at place k: corners, edges, faces, inside; edges
/// along x and y around the bottom, then around the top, then those along z; faces across x, y, z,
/// the lower of each pair first.
[[nodiscard]] std::vector<std::uint32_t> vtkNodeOrder(int order,
                                                      VtkEdges upright = VtkEdges::Around);

/// Entry k: the place of the node that Gmsh lists at place k: corners, edges, faces, inside, which
/// is a smaller cell. The first 20 of order 2 are those of cells with 20 nodes.
[[nodiscard]] std::vector<std::uint32_t> gmshNodeOrder(int order);

/// The same of cells of order 2 in another format.
/// @param places  entry k: where the format lists the node that VTK lists at place k
[[nodiscard]] std::vector<std::uint32_t> quadraticOrder(const std::array<std::uint8_t, 27>& places);

/// Such places of CGNS, which lists upright edges before those of the top, and faces from the
/// bottom on around the cell.
inline constexpr std::array<std::uint8_t, 27> kCgnsPlaces = {0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                             9,  10, 11, 16, 17, 18, 19, 12, 13,
                                                             14, 15, 24, 22, 21, 23, 20, 25, 26};

/// Nodes of tagged edges and of quads, order + 1 or (order + 1)^2 each, as Gmsh and CGNS list them:
/// corners, nodes on sides, nodes inside. Boundary quads run counter-clockwise seen from outside,
/// quads inside the mesh so seen from outside of the first cell that they belong to.
struct GroupNodes {
  Array<Index> edges;
  Array<Index> quads;
};
/// @param straight  what straightMesh() returns
/// @throws Error InvalidArgument for an element that is none of a cell
[[nodiscard]] GroupNodes nodesOfGroups(const LagrangeMesh& mesh, const HexMesh& straight,
                                       const EdgeGroups& edges, const QuadGroups& quads,
                                       Stage& stage);

}  // namespace hexhex::io
