// Common charts for the tets of a map, which must differ only across a small cut.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <adjacency/edge_fan.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <lattice/rotation.hpp>

namespace hexhex::quantization {

/// Number of quarter turns around each edge: the sum of its dihedral angles in the map.
/// @tparam Corners  four points each, of any number type
template <class Corners>
[[nodiscard]] std::vector<int> quartersAround(const adjacency::EdgeFans& edges,
                                              std::span<const Corners> map) {
  std::vector<int> quarters(edges.size());
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    double sum = 0;
    for (const adjacency::EdgeCorner& at : edges(edge)) {
      TetParameters u{};
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) u[i][k] = static_cast<double>(map[at.tet][i][k]);
      }
      sum += dihedralAngle(u, at.corner0, at.corner1);
    }
    quarters[edge] = static_cast<int>(std::lround(sum / (std::numbers::pi / 2)));
  }
  return quarters;
}

/// Number of quarter turns around a nonsingular edge.
[[nodiscard]] inline int regularQuarters(const adjacency::EdgeFans& edges, std::size_t edge) {
  return edges.isBoundary(edge) ? 2 : 4;
}

/// Whether an edge is singular although charts agree around it: an interior edge with several full
/// turns, or a boundary edge where the boundary folds back on itself. Charts do not align such an
/// edge with an axis.
[[nodiscard]] inline bool isSingularByTurnsAlone(const adjacency::EdgeFans& edges, std::size_t edge,
                                                 int quarters) {
  const int regular = regularQuarters(edges, edge);
  return quarters != regular && quarters % regular == 0;
}

/// A seamless map in charts that agree across all triangles except those of the cut.
struct CutGraph {
  std::vector<TetParameters> parameters;     ///< per tet, in the common charts
  std::vector<lattice::Rotation> rotations;  ///< per half-face, from here to the neighbour
  std::vector<bool> isCut;                   ///< per half-face
  std::vector<Index> sectors;  ///< per corner: shared by corners not separated by the cut
  std::size_t sectorCount = 0;
};

/// Per half-face, the rotation that brings its triangle closest to the neighbour's.
[[nodiscard]] std::vector<lattice::Rotation> fitRotations(
    const adjacency::TetTopology& topology, std::span<const TetParameters> parameters);

/// Unifies charts along a spanning tree of tets, cuts all other triangles, then removes loose ends
/// of the cut: at an interior edge with one remaining triangle, charts agree across it, unless the
/// edge is singular.
/// @param rotations  per half-face, between the given charts
[[nodiscard]] CutGraph cutOpen(const adjacency::TetTopology& topology,
                               const adjacency::EdgeFans& edges,
                               std::span<const TetParameters> parameters,
                               std::span<const lattice::Rotation> rotations);

/// Calls visit(half-face) for the triangles of the tet at an edge.
template <class Visit>
void forEachFaceAt(const adjacency::EdgeCorner& at, const Visit& visit) {
  for (int face = 0; face < 4; ++face) {
    if (face != at.corner0 && face != at.corner1) visit(adjacency::halfFaceOf(at.tet, face));
  }
}

/// The cut triangle met next when turning around an edge from `halfFace` through its tet: the
/// half-face on the near side, or kNone at the boundary of the mesh.
[[nodiscard]] adjacency::HalfFace nextCutAround(const adjacency::TetTopology& topology,
                                                const CutGraph& graph, lattice::CornerMask edge,
                                                adjacency::HalfFace halfFace);

}  // namespace hexhex::quantization
