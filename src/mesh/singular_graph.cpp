#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <mesh/singular_graph.hpp>

namespace hexhex::mesh {
namespace {

/// Singular edges by their vertices.
class SingularGraph {
 public:
  SingularGraph(std::size_t vertices, std::span<const SingularHexEdge> edges, Stage& stage)
      : edges_(edges), used_(edges.size(), false), at_(vertices, stage, [edges](const auto& add) {
          for (std::size_t e = 0; e < edges.size(); ++e) {
            add(edges[e].vertex0, static_cast<Index>(e));
            add(edges[e].vertex1, static_cast<Index>(e));
          }
        }) {}

  /// The edges at a vertex.
  [[nodiscard]] std::span<const Index> at(std::size_t vertex) const { return at_(vertex); }

  [[nodiscard]] std::vector<SingularCurve> curves() {
    std::vector<SingularCurve> all;
    for (const bool fromEnds : {true, false}) {  // the remaining curves are closed
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        for (const Index start : {edges_[e].vertex0, edges_[e].vertex1}) {
          if (used_[e] || (fromEnds && !isEnd(start))) continue;
          all.push_back(curveFrom(start, static_cast<Index>(e)));
        }
      }
    }
    return all;
  }

 private:
  /// Whether a curve ends at a vertex on it.
  [[nodiscard]] bool isEnd(Index vertex) const {
    const std::span<const Index> here = at_(vertex);
    if (here.size() != 2) return true;
    const SingularHexEdge& a = edges_[here[0]];
    const SingularHexEdge& b = edges_[here[1]];
    return a.valence != b.valence || a.boundary != b.boundary;
  }

  SingularCurve curveFrom(Index vertex, Index edge) {
    SingularCurve curve{{vertex}, edges_[edge].valence, edges_[edge].boundary};
    while (!used_[edge]) {
      used_[edge] = true;
      vertex = edges_[edge].vertex0 == vertex ? edges_[edge].vertex1 : edges_[edge].vertex0;
      curve.vertices.push_back(vertex);
      if (isEnd(vertex)) break;
      const std::span<const Index> here = at_(vertex);
      edge = here[0] == edge ? here[1] : here[0];
    }
    return curve;
  }

  std::span<const SingularHexEdge> edges_;
  std::vector<bool> used_;
  adjacency::VertexLists<Index, std::uint64_t> at_;
};

}  // namespace

void findSingularGraph(const HexMesh& mesh, std::span<const Index> mates,
                       std::span<const SingularHexEdge> singular, Stage& stage,
                       BaseComplex& result) {
  SingularGraph graph(mesh.points.size(), singular, stage);
  result.curves = graph.curves();
  std::vector<std::uint8_t> onBoundary(mesh.points.size(), 0);
  for (std::size_t h = 0; h < mates.size(); ++h) {
    if (mates[h] != kNone) continue;
    for (const Index v : adjacency::faceVertices(mesh.cells[h / 6], h % 6)) onBoundary[v] = 1;
  }
  using Valences = std::vector<std::uint32_t>;
  std::map<std::tuple<bool, Valences, Valences>, std::vector<Index>> byType;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (graph.at(v).empty()) continue;
    std::array<Valences, 2> valences;  // inside, on the boundary
    for (const Index e : graph.at(v)) {
      valences[singular[e].boundary ? 1 : 0].push_back(singular[e].valence);
    }
    for (Valences& each : valences) std::sort(each.begin(), each.end());
    byType[{onBoundary[v] != 0, valences[0], valences[1]}].push_back(static_cast<Index>(v));
  }
  for (auto& [type, vertices] : byType) {
    result.irregular.push_back(
        {std::get<0>(type), std::get<1>(type), std::get<2>(type), std::move(vertices)});
  }
}

}  // namespace hexhex::mesh
