#include <algorithm>
#include <cmath>

#include <repair/freedom.hpp>

namespace hexhex {

namespace {

/// Transitions from the chart of the first corner to all others, along the walk through the star.
void unfold(const std::vector<VertexStar::Member>& star, const PatchCharts& charts,
            PatchVertex& vertex) {
  vertex.corners.resize(star.size());
  vertex.corners[0] = {star[0].corner, {}};
  std::size_t reached = 1;
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index neighbour = star[i].neighbour[k];
      if (neighbour == kNone) {
        vertex.boundary = true;
        continue;
      }
      if (neighbour != reached) continue;
      ++reached;
      vertex.corners[neighbour] = {
          star[neighbour].corner, charts.across(star[i].halfFace(k)) * vertex.corners[i].fromFirst};
    }
  }
}

/// The edges at a vertex, among all edges of the patch.
template <class Visit>
void forEachEdgeAt(const Patch& patch, const PatchCharts& charts, const Visit& visit) {
  for (const PatchEdge& edge : charts.edges()) {
    for (const Index v : {edge.vertex0, edge.vertex1}) {
      const auto found = std::lower_bound(patch.vertices.begin(), patch.vertices.end(), v);
      if (found == patch.vertices.end() || *found != v) continue;
      visit(static_cast<std::size_t>(found - patch.vertices.begin()), edge);
    }
  }
}

AxisSet boundaryAxes(const std::vector<VertexStar::Member>& star, const PatchCharts& charts,
                     const PatchVertex& vertex) {
  AxisSet fixed = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (star[i].neighbour[k] != kNone) continue;
      fixed |= imageOf(1U << charts.boundaryAxis(star[i].halfFace(k)),
                       vertex.corners[i].fromFirst.rotation.inverse());
    }
  }
  return fixed;
}

}  // namespace

std::vector<PatchVertex> findFreedom(const LocalParameters& parameters, const Patch& patch,
                                     const PatchCharts& charts) {
  std::vector<PatchVertex> vertices(patch.vertices.size());
  std::vector<int> degrees(vertices.size(), 0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PatchVertex& vertex = vertices[i];
    vertex.vertex = patch.vertices[i];
    unfold(patch.stars[i], charts, vertex);
    vertex.fixed = boundaryAxes(patch.stars[i], charts, vertex);
  }
  forEachEdgeAt(patch, charts, [&](std::size_t i, const PatchEdge& edge) {
    if (!edge.singular) return;
    PatchVertex& vertex = vertices[i];
    vertex.singular = true;
    ++degrees[i];
    const auto copy =
        std::find_if(vertex.corners.begin(), vertex.corners.end(),
                     [&](const PatchVertex::Copy& c) { return tetOf(c.corner) == edge.tet; });
    vertex.fixed |= imageOf(kAllAxes & ~(1U << edge.axis), copy->fromFirst.rotation.inverse());
  });
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PatchVertex& vertex = vertices[i];
    // A singular vertex has other than zero or two singular edges. (Section 3.2)
    if (degrees[i] != 0 && degrees[i] != 2) vertex.fixed = kAllAxes;
    const CornerIndex first = vertex.corners.front().corner;
    vertex.parameter = parameters(tetOf(first), localOf(first));
    for (std::size_t k = 0; k < 3; ++k) {
      if (((vertex.fixed >> k) & 1U) == 0) continue;
      const double integer = std::nearbyint(vertex.parameter[k]);
      vertex.off = std::max(vertex.off, std::abs(vertex.parameter[k] - integer));
      vertex.parameter[k] = integer;
    }
  }
  return vertices;
}

}  // namespace hexhex
