// The repair as the extraction calls it.
#pragma once

#include <hexhex/repair.hpp>

namespace hexhex::repairs {

/// As repair(), inside of withThreads().
[[nodiscard]] TetMap repairInArena(const TetMapView& map, const RepairOptions& options,
                                   Context& context, RepairReport& report);

}  // namespace hexhex::repairs
