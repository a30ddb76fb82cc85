// The seamless map of an object that has none, along a field of frames.
//
// 1. Tets are split where a frame would have two conditions to meet (frames_tets).
// 2. A smooth field of frames is aligned with the boundary and its features (frames_field).
// 3. Rotations between neighbours make singular curves, which are made proper ones where the field
//    leaves it open (frames_matching, frames_rematch). What is left says at once whether there is a
//    map.
// 4. Edges between singular vertices and the boundary are split, since tets there would be flat.
// 5. All maps with these curves are sums of free unknowns (frames_space). The foldover-free solver
//    finds those of a map whose gradients are near to the frames, and whose tets are positive.
//
// D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame Fields", ACM
// Transactions on Graphics 39 (2020); V. Garanzha et al., "Foldover-free maps in 50 lines of
// code", ACM Transactions on Graphics 40 (2021).
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// Deterministic with any number of threads.
/// @param featureAngleInDegrees  edges of the boundary at which it turns by more are features:
///                               edges of the hexahedra follow them
/// @return an exactly seamless map with parameters in units of space; the given points come first
/// @throws Error TransitionResidual, with the edge, vertex or tet, if the field's singular curves
///               are those of no map; FlippedTet if tets stay flipped; those of broken meshes
[[nodiscard]] TetMap mapFromFrames(const TetMesh& tets, double featureAngleInDegrees, Stage& stage);

}  // namespace hexhex::shape
