// Computes the seamless map nearest to a nearly seamless one, the first step of quantization. As in
// Mandad and Campen 2019, "Exact Constraint Satisfaction for Truly Seamless Parametrization",
// constraints that held up to a tolerance then hold exactly.
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
  FaceMotions changes;  ///< per half-face: from its tet's chart to the neighbour's
  /// Edges and inner faces that must stay aligned with axes: aligned features, and singular edges
  /// that charts do not reveal.
  std::vector<adjacency::TetEdge> featureEdges;
  std::vector<adjacency::HalfFace> featureFaces;
  double unit = 1;
  double size = 0;                    ///< maximum extent along an axis from the first corner
  double maxDisplacement = 0;         ///< of a parameter from the given one, along an axis
  Index mostDisplaced = 0;            ///< the tet where that occurs
  std::vector<Index> flippedAsGiven;  ///< tets flipped in the input; empty if only noise, now
                                      ///< removed, flipped them
};

struct SeamlessOptions {
  double tolerance = 0;         ///< of displacements, relative to the map's size
  double featureTolerance = 0;  ///< features aligned within this tolerance become exactly aligned
  std::int32_t wallTag = 0;     ///< as in QuantizeOptions
  /// Planes closer than this fraction of the map's size are joined unless that produces fractions;
  /// this may displace the map as far beyond the tolerance. Planes separated only by noise are
  /// always joined.
  double apart = 0;
};

/// @throws Error if the mesh is not a manifold or the map is not nearly seamless
[[nodiscard]] SeamlessMap makeSeamless(const TetMapView& map, const SeamlessOptions& options,
                                       Context& context);

/// @throws Error FlippedTet if a tet is not positive; reports those flipped in the input first
void requirePositiveTets(const SeamlessMap& map);

/// Volume in unit cubes.
[[nodiscard]] double volumeOf(const SeamlessMap& map);

}  // namespace hexhex::quantization
