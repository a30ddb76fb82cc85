// What a repair did, for people and for reports.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <hexhex/repair.hpp>

namespace hexhex::command {

/// "The map had 21 flipped or flat tets in 3 places. It was repaired: ..."
[[nodiscard]] std::string repairNotice(const RepairReport& report);

/// One line per region, on the standard output.
void printRegions(const RepairReport& report);

/// docs/report.md explains the keys; null if nothing was changed.
[[nodiscard]] nlohmann::ordered_json repairAsJson(const RepairReport& report);

}  // namespace hexhex::command
