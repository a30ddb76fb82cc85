// Where charts of a map must differ: tets in common charts, cut along as few triangles as that
// takes.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <lattice/rotation.hpp>

namespace hexhex {

/// The edges of a tet mesh, each with the tets around it.
class EdgeFans {
 public:
  /// @param topology  with stars; must outlive this
  explicit EdgeFans(const TetTopology& topology);

  [[nodiscard]] std::size_t size() const noexcept { return begin_.size() - 1; }
  [[nodiscard]] std::span<const EdgeCorner> operator()(std::size_t edge) const noexcept {
    return std::span(corners_).subspan(begin_[edge], begin_[edge + 1] - begin_[edge]);
  }
  /// The edge of two corners of a tet.
  [[nodiscard]] Index edgeOf(Index tet, CornerMask ends) const noexcept;
  [[nodiscard]] bool isBoundary(std::size_t edge) const noexcept {
    return boundaryFacesAt(topology_, (*this)(edge)) != 0;
  }

 private:
  const TetTopology& topology_;
  std::vector<std::size_t> begin_ = {0};
  std::vector<EdgeCorner> corners_;
  std::vector<std::array<Index, 6>> edges_;  ///< per tet
};

/// A seamless map in charts that agree across all triangles but those of a cut.
struct CutGraph {
  std::vector<TetParameters> parameters;  ///< per tet, in the common charts
  std::vector<Rotation> rotations;        ///< per half-face, from here to the neighbour
  std::vector<bool> isCut;                ///< per half-face
  std::vector<Index> sectors;             ///< per corner: a number for all that are not cut apart
  std::size_t sectorCount = 0;
};

/// Moves charts along a tree of tets, cuts all other triangles, then mends the cut where it ends:
/// across the last triangle of the cut at an inner edge charts agree, unless the edge is singular.
/// @param rotations  per half-face, between the charts given
[[nodiscard]] CutGraph cutOpen(const TetTopology& topology, const EdgeFans& edges,
                               std::span<const TetParameters> parameters,
                               std::span<const Rotation> rotations);

/// Calls visit(half-face) for the triangles of the tet at an edge.
template <class Visit>
void forEachFaceAt(const EdgeCorner& at, const Visit& visit) {
  for (int face = 0; face < 4; ++face) {
    if (face != at.corner0 && face != at.corner1) visit(halfFaceOf(at.tet, face));
  }
}

/// The cut that bounds, beyond `halfFace`, the tets at an edge that are not cut apart: the
/// half-face on its near side; or kNone if that is the boundary of the mesh.
[[nodiscard]] HalfFace nextCutAround(const TetTopology& topology, const CutGraph& graph,
                                     CornerMask edge, HalfFace halfFace);

}  // namespace hexhex
