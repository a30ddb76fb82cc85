// Tells the many vertices around which nothing happens from the few that need a closer look.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <map/local_parameters.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

/// A vertex is plain if its star is embedded in one chart: it has no boundary face, its tets agree
/// on the parameters of their common corners, all are positive, and they cover the directions
/// around the vertex once. From this follows that
/// - the star is a ball, and each edge at the vertex has one fan (but its other end may be special
///   and be joined to the vertex by another edge, which then shows there),
/// - all edges at the vertex are regular,
/// - sanitization rounds the vertex to the lattice and does nothing else.
///
/// Why once is enough: the opposite triangles form closed oriented surfaces, which radial
/// projection from the vertex maps to the sphere of directions, as a covering branched at most at
/// edges. The number of tets in any general direction is the sum of the surfaces' degrees; if it is
/// one, there is one surface, and its projection is one-to-one.
struct PlainVertices {
  Array<std::uint8_t> special;  ///< per vertex: 1 if it is not plain (and not isolated)

  /// Inner triangles on whose corners' parameters their tets do not agree, by the smaller
  /// half-face, ascending; in one list per block of kBlock tets.
  std::vector<std::vector<HalfFace>> unequalFaces;
  std::uint64_t innerFaces = 0;

  static constexpr std::size_t kBlock = 1024;
};

/// All decisions are safe: a vertex where rounding could matter counts as special.
[[nodiscard]] PlainVertices findPlainVertices(const TetTopology& topology,
                                              const LocalParameters& parameters, Stage& stage);

/// The corner from which a direction in general position leads into the tet: of a positive tet, at
/// most one.
enum class ConeCorner : std::int8_t { Corner0 = 0, Corner1, Corner2, Corner3, None, Uncertain };

/// @param u  Uncertain if the tet's orientation, or the answer, cannot be told in floating point
[[nodiscard]] ConeCorner coneCorner(const TetParameters& u) noexcept;

}  // namespace hexhex
