// The exact map. Sanitization: parameters on a dyadic lattice that meet the conditions of an
// integer-grid map, with integers where these demand it (Section 5.1.3).
#pragma once

#include <cstdint>
#include <span>

#include <igm/singularities.hpp>
#include <igm/transitions.hpp>

namespace hexhex::igm {

/// Maps have fewer cells than this, so that 64 bits can count cells, faces and edges.
inline constexpr double kMaxCountedCells = 0x1p60;

/// Parameters as integers, in units of 1 / unit. Transitions carry corners over exactly.
struct ExactMap {
  Array<lattice::LatticeTet> corners;  ///< per tet
  std::int64_t unit = 1;               ///< a power of two
  int scale = 1;  ///< by which scaleMap() has multiplied corners and translations
  Transitions transitions;
  lattice::Int192 sixfoldVolume;  ///< of all tets of a valid map, before scaling, times unit^3
  double maxDisplacement = 0;     ///< largest change of a coordinate, in parameter units
};

/// Makes conditions (IGM1) to (IGM3) hold exactly, and collects the tets that are then not positive
/// (IGM4). Each vertex has one corner as its representative: all constraints of the vertex's star
/// are brought into its chart; a boundary triangle fixes the coordinate along its normal to an
/// integer, a singular edge the two across it, a singular node all three; the other coordinates are
/// rounded to the lattice; then exact transitions carry the value to all other corners. Vertices
/// are independent of each other, so the result depends neither on their order nor on threads.
/// Corners at regular and flat vertices are only rounded.
/// @param vertices  from classifyVertices()
/// @param tolerance  larger displacements are defects
/// @param maxScale   the map is going to be scaled by at most this
[[nodiscard]] ExactMap sanitize(const adjacency::TetTopology& topology,
                                const LocalParameters& parameters, Transitions transitions,
                                const RegularVertices& regular, const VertexKinds& vertices,
                                const Singularities& singularities, double tolerance, int maxScale,
                                Stage& stage, DefectCollector& defects);

/// How far sanitization moved a parameter, along any axis.
/// @param unit  of the lattice
[[nodiscard]] double displacementOf(const Vec3& before, const lattice::LatticePoint& after,
                                    double unit) noexcept;

/// Multiplies all parameters by an integer, exactly.
void scaleMap(ExactMap& map, int scale, Stage& stage);

}  // namespace hexhex::igm
