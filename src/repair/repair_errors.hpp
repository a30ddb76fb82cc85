// Why a map cannot be repaired, in sentences.
#pragma once

#include <string>
#include <vector>

#include <igm/defects.hpp>
#include <repair/patch_charts.hpp>
#include <repair/patch_problem.hpp>

namespace hexhex::repairs {

/// What --round may move.
inline constexpr double kRoundingLimit = 0.1;

/// This build has no solver. @param defects  not empty
[[noreturn]] void throwWithoutSolver(const igm::DefectCollector& defects);

/// Conditions are violated where no bad tet is near. Names transitions first, since what they are
/// off shows elsewhere, too.
/// @param rounds  whether rounding was asked for
[[noreturn]] void throwHopeless(const igm::DefectCollector& hopeless, std::size_t badTets,
                                bool rounds);

/// No integer-grid map has such charts around an edge.
[[noreturn]] void throwImpossible(const PatchEdge& edge);

/// @throws Error SingularityOffLattice, BoundaryOffLattice if a vertex is off integers by more than
///         the limit
void refuseOffLattice(const std::vector<PatchVertex>& vertices, double limit, bool rounds);

}  // namespace hexhex::repairs
