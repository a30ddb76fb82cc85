// Checks conditions (IGM2) to (IGM4) of Section 3.2, up to the tolerance. Other violations are
// found while the map is sanitized (Section 5.1.3).
#pragma once

#include <base/vector3.hpp>
#include <igm/sanitization.hpp>

namespace hexhex::igm {

/// The axis along which a singular edge runs, in the chart of its tet.
[[nodiscard]] std::size_t edgeAxis(const LocalParameters& parameters,
                                   const SingularEdge& edge) noexcept;

/// (IGM2) up to the tolerance, within which snapping may repair it.
void checkBoundary(const RegularVertices& regular, const LocalParameters& parameters,
                   double tolerance, Stage& stage, DefectCollector& defects);

/// (IGM3) up to the tolerance, for edges; nodes are checked when they are snapped.
void checkSingularities(const Singularities& singularities, const LocalParameters& parameters,
                        double tolerance, DefectCollector& defects);

/// A tet with a larger determinant is certainly positive, although the determinant is computed in
/// floating point, from exact edges. In lattice units; valid unless corners have moved by more than
/// half a parameter unit.
[[nodiscard]] double leastCertainDeterminant(const LocalParameters& parameters,
                                             double unit) noexcept;

/// Whether a tet's floating-point determinant exceeds this.
/// @param corners  in lattice units
[[nodiscard]] inline bool isPositive(const TetParameters& corners,
                                     double leastDeterminant) noexcept {
  return tripleProduct(minus(corners[1], corners[0]), minus(corners[2], corners[0]),
                       minus(corners[3], corners[0])) > leastDeterminant;
}

/// (IGM4) for the tets of all lists.
void checkOrientations(std::span<const std::vector<Index>> tets, const LocalParameters& parameters,
                       Stage& stage, DefectCollector& defects, const ExactMap& map);

}  // namespace hexhex::igm
