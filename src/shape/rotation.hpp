// The rotation of an object that aligns its boundary with axes best (Gregson, Sheffer, Zhang 2011,
// "All-Hex Mesh Generation via Volumetric PolyCube Deformation").
#pragma once

#include <cstdint>

#include <shape/surface.hpp>

namespace hexhex::shape {

/// Minimizes the mean 1-norm of normals; the identity unless another rotation is clearly better.
[[nodiscard]] Rotation bestRotation(const Surface& surface, std::uint64_t seed);

}  // namespace hexhex::shape
