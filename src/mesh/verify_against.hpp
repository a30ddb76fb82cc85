// Verification against expectations that are given: the part of verify() that does not examine the
// map's combinatorics.
#pragma once

#include <hexhex/check.hpp>
#include <hexhex/verify.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Compares a mesh with what is expected of it. The mesh may be anything, even have corners out of
/// range.
/// @param map  valid; its tets and parameters tell where lattice points are in space
[[nodiscard]] VerifyReport verifyAgainst(const Expectation& expected, const TetMapView& map,
                                         const HexMesh& mesh, const VerifyOptions& options,
                                         Stage& stage);

}  // namespace hexhex
