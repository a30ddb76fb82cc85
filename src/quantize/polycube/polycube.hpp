// The seamless map of a polycube, with a bound on what is spent on it.
#pragma once

#include <span>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// As mapFromFlags().
/// @param[in,out] workLeft  steps of the solver times tets, of about half a microsecond each: the
///                          same everywhere, unlike time. Once nothing is left, no more is tried
[[nodiscard]] TetMap mapFromLabels(const TetMesh& tets, std::span<const FaceFlags> flags,
                                   double& workLeft, Context& context);

}  // namespace hexhex::quantization
