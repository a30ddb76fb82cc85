// What every writer of maps refuses.
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Refuses a map that could not be read back.
/// @throws Error InvalidArgument if arrays disagree, IndexOutOfRange, NotFinite
void requireWritable(const TetMap& map, Stage& stage);

}  // namespace hexhex
