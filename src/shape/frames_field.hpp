// A smooth field of frames, aligned with the boundary and its features.
//
// Frames are harmonic quartics (frames_tensor). The smoothest field of tensors that meets the
// conditions of the boundary is a linear problem; its projection to frames is a start. From there
// tensors diffuse and are projected, in turns, over shorter and shorter times: a fine scale alone
// would keep the singular curves of the start where they are.
//
// D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame Fields", ACM
// Transactions on Graphics 39 (2020).
#pragma once

#include <vector>

#include <shape/frames_tets.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// One frame per tet. Of tets with a boundary triangle, an axis is its normal; of tets with a
/// feature, an axis is its direction.
/// @param tets  with room
[[nodiscard]] std::vector<Frame> frameField(const FrameTets& tets, Stage& stage);

}  // namespace hexhex::shape
