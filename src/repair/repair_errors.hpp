// Explains why a map cannot be repaired.
#pragma once

#include <string>
#include <vector>

#include <igm/defects.hpp>
#include <repair/patch_charts.hpp>
#include <repair/patch_problem.hpp>

namespace hexhex::repairs {

/// Maximum move of --round.
inline constexpr double kRoundingLimit = 0.1;

/// For a build without a solver.
/// @param defects  not empty
[[noreturn]] void throwWithoutSolver(const igm::DefectCollector& defects);

/// For conditions violated away from bad tets. Names transitions first, since their errors show up
/// elsewhere, too.
/// @param rounds  whether rounding was requested
[[noreturn]] void throwHopeless(const igm::DefectCollector& hopeless, std::size_t badTets,
                                bool rounds);

/// For charts around an edge that no integer-grid map has.
[[noreturn]] void throwImpossible(const PatchEdge& edge);

/// @throws Error SingularityOffLattice, BoundaryOffLattice if a vertex is further than the limit
///         from integers
void refuseOffLattice(const std::vector<PatchVertex>& vertices, double limit, bool rounds);

}  // namespace hexhex::repairs
