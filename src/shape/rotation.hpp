// How an object is turned so that as much of its boundary as possible faces along axes.
#pragma once

#include <cstdint>

#include <shape/surface.hpp>

namespace hexhex::shape {

/// The identity, unless another rotation is better by more than what a turned object costs its
/// user. After Gregson, Sheffer, Zhang (2011), whose measure is that of the 1-norms of normals.
[[nodiscard]] Rotation bestRotation(const Surface& surface, std::uint64_t seed);

}  // namespace hexhex::shape
