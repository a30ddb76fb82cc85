// The seamless map nearest to one that is nearly seamless: what quantization begins with.
//
// A map is seamless if charts of neighbours differ by a rotation of the grid and any translation,
// boundary triangles are perpendicular to an axis, and singular edges parallel to one. An
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
  /// Features that are aligned with axes, and to stay so, and what else charts do not tell of:
  /// edges, inner faces.
  std::vector<adjacency::TetEdge> featureEdges;
  std::vector<adjacency::HalfFace> featureFaces;
  double unit = 1;
  double size = 0;                    ///< extent from a corner, along the axis where it is longest
  double maxDisplacement = 0;         ///< of a parameter from that given, along an axis
  Index mostDisplaced = 0;            ///< a tet
  std::vector<Index> flippedAsGiven;  ///< tets; none if they were so by noise alone, which is gone
};

struct SeamlessOptions {
  double tolerance = 0;         ///< for displacements, as a share of the map's size
  double featureTolerance = 0;  ///< features that are aligned so well, too, become it exactly
  std::int32_t wallTag = 0;     ///< as in QuantizeOptions
  /// Planes that are less apart than this share of the map's size become one, where that makes no
  /// fractions; the map may move so far for that beyond the tolerance. Those that noise keeps apart
  /// always do.
  double apart = 0;
};

/// @throws Error where the mesh is not a manifold, or the map is not even nearly seamless
[[nodiscard]] SeamlessMap makeSeamless(const TetMapView& map, const SeamlessOptions& options,
                                       Context& context);

/// @throws Error FlippedTet if a tet is not positive; those that were not as given are named first
void requirePositiveTets(const SeamlessMap& map);

/// In unit cubes.
[[nodiscard]] double volumeOf(const SeamlessMap& map);

}  // namespace hexhex::quantization
