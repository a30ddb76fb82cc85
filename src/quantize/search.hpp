// The search for integers that a seamless map can be bent onto.
#pragma once

#include <quantize/bend/bend.hpp>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

/// A map that has been bent, and how it came to that.
struct FoundMap {
  BentMap bent;
  IrregularEdges irregularEdges;  ///< of the map as it was
  QuantizeReport report;          ///< but for the shapes of tets
};

/// Makes the map seamless, cuts it into blocks, and tries integers for these until it can be bent
/// onto some.
/// @param apart  as in SeamlessOptions
/// @throws Error that says what keeps tets flipped, and a number of cells that works
[[nodiscard]] FoundMap findBentMap(const TetMapView& map, const QuantizeOptions& options,
                                   double apart, Context& context);

}  // namespace hexhex::quantization
