// Repair as called by the extraction.
#pragma once

#include <hexhex/repair.hpp>

namespace hexhex::repairs {

/// As repair(), for calls inside withThreads().
[[nodiscard]] TetMap repairInArena(const TetMapView& map, const RepairOptions& options,
                                   Context& context, RepairReport& report);

}  // namespace hexhex::repairs
