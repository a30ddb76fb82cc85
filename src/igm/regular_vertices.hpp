// Separates the many vertices that are certainly regular from the few that need a closer look
// (Section 5.1.2). Also lists boundary faces, and faces whose tets have different charts.
#pragma once

#include <cstdint>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <igm/tet_sides.hpp>

namespace hexhex::igm {

/// A vertex is regular if its star is embedded in one chart, and is cut off by one axis-parallel
/// plane if it is on the boundary. That is: its tets agree on the parameters of their common
/// corners, all are positive, its boundary faces, if any, are in a plane through the vertex, and
/// the tets, together with their mirror images at this plane, cover the directions around the
/// vertex once. It follows that
/// - the star is a ball, and each edge at the vertex has one fan (but its other end may be
///   irregular and be joined to the vertex by another edge, which then shows there),
/// - all edges at the vertex are regular,
/// - sanitization rounds the vertex to the lattice, in its plane, and does nothing else.
///
/// Why once is enough: the opposite triangles, glued to their mirror images along the boundary,
/// form closed oriented surfaces, which radial projection from the vertex maps to the sphere of
/// directions, as a covering branched at most at edges. The number of tets and images in any
/// general direction is the sum of the surfaces' degrees; if it is one, there is one surface, and
/// its projection is one-to-one. Images need not be made: the mirrored direction does as well.
///
/// If the star is on one side of its plane at all boundary faces, one direction to that side is
/// enough: across the plane the number of tets in a direction changes by that of the boundary faces
/// there, at least one, so if it is one on this side, it is none on the other.
struct RegularVertices {
  Array<std::uint8_t> isIrregular;  ///< per vertex: 1 unless it is certainly regular, or isolated
  Array<std::uint8_t> plane;  ///< per regular vertex: bit k if on a boundary plane across axis k

  /// Inner triangles whose two tets do not agree on the corners' parameters, by the larger
  /// half-face, ascending; one list per block of kBlock tets.
  std::vector<Array<adjacency::HalfFace>> unequalFaces;
  std::uint64_t innerFaces = 0;

  /// A boundary face, and the axis along which it is constant, or nearly so.
  struct BoundaryFace {
    adjacency::HalfFace halfFace;
    std::uint16_t axis;
    std::uint8_t constantAxes;  ///< along which it is exactly constant: bit k for axis k
    bool isAbove;               ///< whether the tet is on its larger side along the axis
  };
  /// By half-face, ascending; one list per block of kBlock tets.
  std::vector<Array<BoundaryFace>> boundaryFaces;

  /// Per tet: where kGeneralDirection leads.
  Array<TetSides> sides;

  static constexpr std::size_t kBlock = 1024;
};

/// All decisions are conservative: a vertex where rounding could matter counts as irregular.
[[nodiscard]] RegularVertices findRegularVertices(const adjacency::TetTopology& topology,
                                                  const LocalParameters& parameters, Stage& stage);

}  // namespace hexhex::igm
