#include <array>

#include <io/curved/lagrange_order.hpp>

namespace hexhex {

namespace {

using Node = std::array<int, 3>;

/// Corners in VTK's order, which Gmsh shares, on a cube from `low` to `high`.
Node corner(std::size_t i, int low, int high) {
  constexpr std::array<std::array<bool, 3>, 8> kHigh = {{{false, false, false},
                                                         {true, false, false},
                                                         {true, true, false},
                                                         {false, true, false},
                                                         {false, false, true},
                                                         {true, false, true},
                                                         {true, true, true},
                                                         {false, true, true}}};
  Node node{};
  for (std::size_t k = 0; k < 3; ++k) node[k] = kHigh[i][k] ? high : low;
  return node;
}

/// Nodes strictly between two corners, from the first on; their steps are of length 1.
std::vector<Node> between(const Node& from, const Node& to, int count) {
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

/// Places in lexicographic order, x first.
std::vector<std::uint32_t> placesOf(const std::vector<Node>& nodes, int order) {
  std::vector<std::uint32_t> places;
  places.reserve(nodes.size());
  for (const Node& n : nodes) {
    places.push_back(static_cast<std::uint32_t>(n[0] + (order + 1) * (n[1] + (order + 1) * n[2])));
  }
  return places;
}

void append(std::vector<Node>& nodes, const std::vector<Node>& more) {
  nodes.insert(nodes.end(), more.begin(), more.end());
}

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
  constexpr std::array<std::array<std::size_t, 2>, 12> kEdges = {{{0, 1},
                                                                  {0, 3},
                                                                  {0, 4},
                                                                  {1, 2},
                                                                  {1, 5},
                                                                  {2, 3},
                                                                  {2, 6},
                                                                  {3, 7},
                                                                  {4, 5},
                                                                  {4, 7},
                                                                  {5, 6},
                                                                  {6, 7}}};
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
      {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}};
  if (low > high) return;
  if (low == high) {
    nodes.push_back(corner(0, low, high));
    return;
  }
  for (std::size_t i = 0; i < 8; ++i) nodes.push_back(corner(i, low, high));
  for (const auto& [a, b] : kEdges) {
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

}  // namespace

/// Corners, edges, faces, inside; edges along x and y around the bottom, then around the top, then
/// those along z, counter-clockwise (since VTK 9); faces across x, y, z, the lower of each pair
/// first.
std::vector<std::uint32_t> vtkNodeOrder(int order) {
  constexpr std::array<std::array<std::size_t, 2>, 12> kEdges = {{{0, 1},
                                                                  {1, 2},
                                                                  {3, 2},
                                                                  {0, 3},
                                                                  {4, 5},
                                                                  {5, 6},
                                                                  {7, 6},
                                                                  {4, 7},
                                                                  {0, 4},
                                                                  {1, 5},
                                                                  {2, 6},
                                                                  {3, 7}}};
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < 8; ++i) nodes.push_back(corner(i, 0, order));
  for (const auto& [a, b] : kEdges) {
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

std::vector<std::uint32_t> gmshEdgeOrder(int order) {
  std::vector<Node> nodes = {{0, 0, 0}, {order, 0, 0}};
  append(nodes, between(nodes[0], nodes[1], order - 1));
  return placesOf(nodes, order);
}

std::vector<std::uint32_t> gmshQuadOrder(int order) {
  std::vector<Node> nodes;
  appendGmshQuad(nodes, {{{0, 0, 0}, {order, 0, 0}, {order, order, 0}, {0, order, 0}}}, order);
  return placesOf(nodes, order);
}

std::vector<std::uint32_t> gmshNodeOrder(int order) {
  std::vector<Node> nodes;
  appendGmshHex(nodes, 0, order);
  return placesOf(nodes, order);
}

}  // namespace hexhex
