// The seamless map of a polycube, within a budget of work.
#pragma once

#include <span>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// Like mapFromFlags(), within a budget.
/// @param[in,out] workLeft  solver steps times tets, about half a microsecond each: unlike time,
///                          the same on all machines. No attempt starts once it is used up
[[nodiscard]] TetMap mapFromLabels(const TetMesh& tets, std::span<const FaceFlags> flags,
                                   double& workLeft, Context& context);

}  // namespace hexhex::quantization
