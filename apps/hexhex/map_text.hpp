// Text about maps: CheckReport, Expectation, RepairReport.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <hexhex/check.hpp>
#include <hexhex/repair.hpp>

namespace hexhex::command {

/// Prints the contents of the map.
void printMap(const CheckReport& report);

/// Prints its defects, and where most of them are.
void printDefects(const CheckReport& report);

/// Prints expected numbers to compare a mesh with.
void printExpectation(const Expectation& expected);

/// "The map had 21 flipped or flat tets in 3 places. It was repaired: ..."
[[nodiscard]] std::string repairNotice(const RepairReport& report);

/// Prints a line per region.
void printRegions(const RepairReport& report);

/// docs/user/report.md explains the keys; null if nothing was changed.
[[nodiscard]] nlohmann::ordered_json repairAsJson(const RepairReport& report);

}  // namespace hexhex::command
