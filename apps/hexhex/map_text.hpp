// What people are told of maps: a CheckReport, an Expectation, a RepairReport.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <hexhex/check.hpp>
#include <hexhex/repair.hpp>

namespace hexhex::command {

/// Prints what the map consists of.
void printMap(const CheckReport& report);

/// Prints what is wrong with it, and where most.
void printDefects(const CheckReport& report);

/// Prints the numbers that a mesh can be compared with.
void printExpectation(const Expectation& expected);

/// "The map had 21 flipped or flat tets in 3 places. It was repaired: ..."
[[nodiscard]] std::string repairNotice(const RepairReport& report);

/// One line per region, on the standard output.
void printRegions(const RepairReport& report);

/// docs/user/report.md explains the keys; null if nothing was changed.
[[nodiscard]] nlohmann::ordered_json repairAsJson(const RepairReport& report);

}  // namespace hexhex::command
