// Edges too tight for what a boundary, and curves on it, demand of both ends.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <tetmap/cut.hpp>

namespace hexhex::tetmap {

/// The edges of a boundary, and curves on it: features, or borders between labels.
class BoundaryCurves {
 public:
  /// @param edges   of the boundary, ascending
  /// @param curves  some of them, ascending
  BoundaryCurves(std::size_t vertexCount, std::vector<VertexPair> edges,
                 std::vector<VertexPair> curves)
      : edges_(std::move(edges)),
        curves_(std::move(curves)),
        isOuter_(vertexCount),
        isOnCurve_(vertexCount) {
    for (const VertexPair& edge : edges_) isOuter_[edge[0]] = isOuter_[edge[1]] = true;
    for (const VertexPair& edge : curves_) isOnCurve_[edge[0]] = isOnCurve_[edge[1]] = true;
  }

  /// Whether a vertex is on the boundary.
  [[nodiscard]] bool has(Index vertex) const { return isOuter_[vertex]; }
  [[nodiscard]] bool hasAllOf(const Tet& tet) const {
    return std::all_of(tet.begin(), tet.end(), [this](Index v) { return has(v); });
  }
  /// Whether an edge's ends are less free than its midpoint would be: an inner edge between two
  /// vertices of the boundary, or one on no curve between two vertices of curves.
  [[nodiscard]] bool isTight(const VertexPair& edge) const {
    if (!isOuter_[edge[0]] || !isOuter_[edge[1]]) return false;
    if (!std::binary_search(edges_.begin(), edges_.end(), edge)) return true;
    return isOnCurve_[edge[0]] && isOnCurve_[edge[1]] &&
           !std::binary_search(curves_.begin(), curves_.end(), edge);
  }
  /// The tight edges of all tets.
  [[nodiscard]] std::vector<EdgeInTet> tightEdges(const std::vector<Tet>& tets) const {
    std::vector<EdgeInTet> tight;
    for (Index t = 0; t < tets.size(); ++t) {
      forEachEdgeOf(tets[t], [&](const VertexPair& edge, lattice::CornerMask /*corners*/) {
        if (isTight(edge)) tight.push_back({edge, t});
      });
    }
    return tight;
  }

 private:
  std::vector<VertexPair> edges_;
  std::vector<VertexPair> curves_;
  std::vector<bool> isOuter_;    ///< per vertex
  std::vector<bool> isOnCurve_;  ///< per vertex
};

}  // namespace hexhex::tetmap
