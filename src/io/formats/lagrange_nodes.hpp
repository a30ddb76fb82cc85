// Nodes of Lagrange hexahedra, for the orders in which formats list them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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

// Entry k is the place of the node that a format lists at place k.

/// Corners, edges, faces, inside; edges along x and y around the bottom, then around the top, then
/// those along z, counter-clockwise (since VTK 9); faces across x, y, z, the lower of each pair
/// first.
[[nodiscard]] std::vector<std::uint32_t> vtkNodeOrder(int order);
/// Corners, edges, faces, inside, which is a smaller cell. The first 20 of order 2 are those of
/// cells with 20 nodes.
[[nodiscard]] std::vector<std::uint32_t> gmshNodeOrder(int order);

}  // namespace hexhex::io
