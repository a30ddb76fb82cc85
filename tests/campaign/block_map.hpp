// Maps of block structures, with the answer that follows from the structure alone.
#pragma once

#include <optional>
#include <string>

#include <hexhex/samples.hpp>

#include "campaign/block_structure.hpp"

namespace hexhex::campaign {

struct DrawnMap {
  std::string kind;
  TetMap map;
  /// At scale 1; absent for blocks that are not manifold: the map must be refused.
  std::optional<SampleAnswer> answer;
};

/// A map that sends every block to a box of cells, whose lengths are drawn. Vertices are moved, in
/// general and in degenerate positions; charts are drawn; elements may be tagged.
[[nodiscard]] DrawnMap drawBlockMap(Random& random);

}  // namespace hexhex::campaign
