// The search for integers that a seamless map can be bent onto.
#pragma once

#include <quantize/bend/bend.hpp>
#include <quantize/seamless/seamless_map.hpp>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

/// A map that has been bent, and how it came to that.
struct FoundMap {
  BentMap bent;
  IrregularEdges irregularEdges;  ///< of the map as it was
  QuantizeReport report;          ///< but for the shapes of tets
};

/// Cuts a map into blocks, and tries integers for these until it can be bent onto some.
/// @param map  that was made seamless; its parameters are not used
/// @throws Error that says what keeps tets flipped, and a number of cells that works
[[nodiscard]] FoundMap findBentMap(SeamlessMap seamless, const TetMapView& map,
                                   const QuantizeOptions& options, Context& context);

}  // namespace hexhex::quantization
