#include <algorithm>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <view/surface_nodes.hpp>

namespace hexhex {
namespace {

void requireConsistent(const LagrangeMesh& mesh) {
  const bool known = mesh.order >= 1 && mesh.order <= kMaxOrder;
  const auto fits = [&mesh](std::size_t size) { return size == 0 || size == mesh.points.size(); };
  if (!known || mesh.nodes.size() % mesh.nodesPerCell() != 0 ||
      mesh.vertexCount > mesh.points.size() || !fits(mesh.generatorTet.size()) ||
      mesh.generatorTet.size() != mesh.generatorCorners.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "The numbers of nodes, vertices and generators do not fit cells of order " +
                    std::to_string(mesh.order) + ".");
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i] < mesh.points.size()) continue;
    const std::size_t cell = i / mesh.nodesPerCell();
    throw Error(ErrorCode::InvalidArgument,
                "Cell " + std::to_string(cell) + " names node " + std::to_string(mesh.nodes[i]) +
                    ", but there are " + std::to_string(mesh.points.size()) + ".",
                {PlaceKind::Cell, cell, 0});
  }
}

/// Which nodes of a cell are corners, and which are on its faces otherwise.
struct Places {
  std::vector<std::size_t> corners;
  std::vector<std::size_t> faces;
};

Places placesOf(int order) {
  Places places;
  std::size_t place = 0;
  for (int k = 0; k <= order; ++k) {
    for (int j = 0; j <= order; ++j) {
      for (int i = 0; i <= order; ++i, ++place) {
        const auto atEnd = [order](int index) { return index == 0 || index == order ? 1 : 0; };
        const int ends = atEnd(i) + atEnd(j) + atEnd(k);
        if (ends == 3) {
          places.corners.push_back(place);
        } else if (ends > 0) {
          places.faces.push_back(place);
        }
      }
    }
  }
  return places;
}

}  // namespace

SurfaceNodes surfaceNodesOf(const LagrangeMesh& mesh) {
  requireConsistent(mesh);
  const Places places = placesOf(mesh.order);
  SurfaceNodes result;
  result.order = mesh.order;
  result.perCell = places.faces.size();
  result.numbers.resize(mesh.cellCount() * result.perCell);
  Array<Index> numberOf(mesh.points.size());
  std::ranges::fill(numberOf, kNone);
  auto next = static_cast<Index>(mesh.vertexCount);
  auto to = result.numbers.begin();
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    const Index* const nodes = mesh.nodes.data() + c * mesh.nodesPerCell();
    for (const std::size_t corner : places.corners) {
      if (nodes[corner] < mesh.vertexCount) continue;
      throw Error(ErrorCode::InvalidArgument,
                  "A corner of cell " + std::to_string(c) + " is node " +
                      std::to_string(nodes[corner]) + ", but only the first " +
                      std::to_string(mesh.vertexCount) + " nodes are hex vertices.",
                  {PlaceKind::Cell, c, 0});
    }
    for (const std::size_t place : places.faces) {
      Index& number = numberOf[nodes[place]];
      if (number == kNone) {
        number = next++;
        result.points.push_back(mesh.points[nodes[place]]);
      }
      *to++ = number;
    }
  }
  return result;
}

}  // namespace hexhex
