// Searches for integers that a seamless map can be bent onto.
#pragma once

#include <quantize/bend/bend.hpp>
#include <quantize/seamless/seamless_map.hpp>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

/// A bent map with a report on the search.
struct FoundMap {
  BentMap bent;
  IrregularEdges irregularEdges;  ///< of the seamless map
  QuantizeReport report;          ///< without the distortions
};

/// Cuts a map into blocks, and tries integers for them until the map can be bent onto some.
/// @param map  the original of the seamless map; its parameters are not used
/// @throws Error with the reason why tets stay flipped, and a number of cells that works
[[nodiscard]] FoundMap findBentMap(SeamlessMap seamless, const TetMapView& map,
                                   const QuantizeOptions& options, Context& context);

}  // namespace hexhex::quantization
