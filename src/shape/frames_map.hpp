// The seamless map along a frame field, for an object that has no map.
//
// 1. Tets are split where a frame would have to meet two conditions (frames_tets.hpp).
// 2. A smooth frame field is aligned with the boundary and its features (frames_field.hpp).
// 3. Rotations between neighbours determine singular curves. They are optimized so that these are
//    those of a hexahedral mesh (frames_matching.hpp, frames_rematch.hpp). Remaining defects show
//    that there is no map.
// 4. Edges between singular vertices and the boundary are split, as tets there would be flat.
// 5. Maps with these curves form a linear space (frames_space.hpp). The foldover-free solver finds
//    one with positive tets and gradients close to the frames.
//
// D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame Fields", ACM
// Transactions on Graphics 39 (2020); V. Garanzha et al., "Foldover-free maps in 50 lines of code",
// ACM Transactions on Graphics 40 (2021).
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// Deterministic for any number of threads.
/// @param featureAngleInDegrees  boundary edges with a larger angle between normals are features,
///                               which edges of hexahedra follow
/// @return an exactly seamless map with parameters in units of space; the given points come first
/// @throws Error TransitionResidual, with the edge, vertex or tet, if no map has the field's
///         singular curves; FlippedTet if tets stay flipped; those of broken meshes
[[nodiscard]] TetMap mapFromFrames(const TetMesh& tets, double featureAngleInDegrees, Stage& stage);

}  // namespace hexhex::shape
