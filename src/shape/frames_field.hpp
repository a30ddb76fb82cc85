// A smooth field of frames that is aligned with the boundary and its features.
//
// Frames are harmonic quartics (frames_tensor.hpp). The smoothest field of tensors under the
// boundary conditions is a linear problem; its projection to frames is the initial field. Then
// diffusion and projection alternate, with decreasing diffusion times: starting with a short time
// would leave the singular curves where they are.
//
// D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame Fields", ACM
// Transactions on Graphics 39 (2020).
#pragma once

#include <vector>

#include <shape/frames_tets.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// Computes one frame per tet. If the tet has a boundary triangle, one axis is its normal; if it
/// has a feature edge, one axis is its direction.
/// @param tets  after makeRoom()
[[nodiscard]] std::vector<Frame> frameField(const FrameTets& tets, Stage& stage);

}  // namespace hexhex::shape
