// The seamless map nearest to a nearly seamless one: the start of quantization. As in Mandad and
// Campen 2019, "Exact Constraint Satisfaction for Truly Seamless Parametrization", constraints that
// held up to a tolerance then hold exactly.
//
// A map is seamless if neighbouring charts differ by a rotation of the grid and any translation,
// boundary triangles are perpendicular to an axis, and singular edges are parallel to one. An
// integer-grid map is a seamless map whose translations, planes and lines are integers.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>
#include <quantize/seamless/face_motions.hpp>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <igm/input.hpp>

namespace hexhex::quantization {

/// An exactly seamless map on a dyadic lattice: a coordinate is a parameter times `unit`.
struct SeamlessMap {
  igm::OrientedMap input;                    ///< without parameters
  adjacency::TetTopology topology;           ///< with stars
  std::vector<lattice::LatticeTet> corners;  ///< per tet, in charts that mostly agree
  FaceMotions changes;                       ///< from here to the neighbour's chart
  /// Features that are aligned with axes and must stay so, and whatever else charts do not reveal:
  /// edges, inner faces.
  std::vector<adjacency::TetEdge> featureEdges;
  std::vector<adjacency::HalfFace> featureFaces;
  double unit = 1;
  double size = 0;                    ///< extent from a corner, along the axis where it is longest
  double maxDisplacement = 0;         ///< of a parameter from the given one, along an axis
  Index mostDisplaced = 0;            ///< the tet where that occurs
  std::vector<Index> flippedAsGiven;  ///< tets; none if only noise, now removed, flipped them
};

struct SeamlessOptions {
  double tolerance = 0;         ///< of displacements, relative to the map's size
  double featureTolerance = 0;  ///< features aligned within this tolerance become exactly aligned
  std::int32_t wallTag = 0;     ///< as in QuantizeOptions
  /// Planes closer than this fraction of the map's size are joined where that produces no
  /// fractions; for that, the map may move by as much beyond the tolerance. Planes separated only
  /// by noise are always joined.
  double apart = 0;
};

/// @throws Error if the mesh is not a manifold, or the map is not even nearly seamless
[[nodiscard]] SeamlessMap makeSeamless(const TetMapView& map, const SeamlessOptions& options,
                                       Context& context);

/// @throws Error FlippedTet if a tet is not positive; names tets first that were not positive in
///         the input
void requirePositiveTets(const SeamlessMap& map);

/// Volume in unit cubes.
[[nodiscard]] double volumeOf(const SeamlessMap& map);

}  // namespace hexhex::quantization
