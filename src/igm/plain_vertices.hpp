// Tells the many vertices around which nothing happens from the few that need a closer look.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <igm/local_parameters.hpp>
#include <igm/passage.hpp>

namespace hexhex {

/// On which side of the faces of a tet a certain direction in general position leads, as seen from
/// anywhere: bit f if it leads inward from face f.
using TetSides = std::uint8_t;

[[nodiscard]] constexpr unsigned leadsInward(TetSides sides, int face) noexcept {
  return (static_cast<unsigned>(sides) >> face) & 1U;
}
/// Of a tet that may not be positive, or in which the direction may not be in general position.
inline constexpr TetSides kUncertainSides = 0;

/// A vertex is plain if its star is embedded in one chart, and is cut off by one axis-parallel
/// plane if it is on the boundary. That is: its tets agree on the parameters of their common
/// corners, all are positive, its boundary faces, if any, are in a plane through the vertex, and
/// the tets, together with their mirror images at this plane, cover the directions around the
/// vertex once. From this follows that
/// - the star is a ball, and each edge at the vertex has one fan (but its other end may be special
///   and be joined to the vertex by another edge, which then shows there),
/// - all edges at the vertex are regular,
/// - sanitization rounds the vertex to the lattice, in its plane, and does nothing else.
///
/// Why once is enough: the opposite triangles, glued to their mirror images along the boundary,
/// form closed oriented surfaces, which radial projection from the vertex maps to the sphere of
/// directions, as a covering branched at most at edges. The number of tets and images in any
/// general direction is the sum of the surfaces' degrees; if it is one, there is one surface, and
/// its projection is one-to-one. Images need not be made: the mirrored direction does as well.
///
/// Where the star is on one side of its plane at all boundary faces, one direction is enough, which
/// leads to that side: across the plane the number of tets in a direction changes by that of the
/// boundary faces there, at least one, so if it is one on this side, it is none on the other.
struct PlainVertices {
  Array<std::uint8_t> special;  ///< per vertex: 1 if it is not plain (and not isolated)
  Array<std::uint8_t> plane;    ///< per plain vertex: bit k on a boundary plane across axis k, or 0

  /// What `special` turns into if the vertex is special only because charts differ
  /// (flat_stars.hpp).
  static constexpr std::uint8_t kFlat = 2;

  /// What `plane` turns into then, if there is a plane, as each chart sees it otherwise; and what
  /// it turns into at other special vertices: in both cases, corners are not to be rounded each on
  /// its own.
  static constexpr std::uint8_t kPlaneOfStar = 8;
  static constexpr std::uint8_t kDecidedByStar = 16;

  /// Inner triangles on whose corners' parameters their tets do not agree, by the larger half-face,
  /// ascending; in one list per block of kBlock tets.
  std::vector<Array<HalfFace>> unequalFaces;
  std::uint64_t innerFaces = 0;

  /// A boundary face, and the axis along which it is constant, or nearly so.
  struct BoundaryFace {
    HalfFace halfFace;
    std::uint16_t axis;
    std::uint8_t constantAxes;  ///< along which it is exactly constant: bit k for axis k
    bool isAbove;               ///< whether the tet is on the larger side of it along the axis
  };
  /// By half-face, ascending; in one list per block of kBlock tets.
  std::vector<Array<BoundaryFace>> boundaryFaces;

  /// Per tet: what its part in the fan of an edge is.
  Array<TetSides> sides;

  /// Per half-face. Rough are all of a tet with uncertain sides; and those between tets that do not
  /// agree, until their transitions are known.
  Array<Passage> passages;

  static constexpr std::size_t kBlock = 1024;
};

/// All decisions are safe: a vertex where rounding could matter counts as special.
[[nodiscard]] PlainVertices findPlainVertices(const TetTopology& topology,
                                              const LocalParameters& parameters, Stage& stage);

/// In general position with respect to all that maps are made of: powers of the plastic number.
inline constexpr Vec3 kGeneralDirection = {1, 0.7548776662466927, 0.5698402909980532};

/// The corner from which the direction leads into a tet: the one whose opposite face is the only
/// one from which the direction leads outward. 4 if there is none.
[[nodiscard]] constexpr std::size_t coneCorner(TetSides sides) noexcept {
  constexpr std::array<std::uint8_t, 16> kCorners = [] {
    std::array<std::uint8_t, 16> corners{};
    corners.fill(4);
    for (std::uint8_t corner = 0; corner < 4; ++corner) corners[faceMask(corner)] = corner;
    return corners;
  }();
  return kCorners[sides];
}

/// The sides of a tet, if the tet is positive and the direction in general position, so far as
/// floating point can tell; otherwise kUncertainSides.
[[nodiscard]] TetSides computeSides(const TetParameters& u) noexcept;

/// The same for the direction mirrored along an axis.
[[nodiscard]] TetSides computeMirroredSides(const TetParameters& u, std::size_t axis) noexcept;

}  // namespace hexhex
