// A CheckReport and an Expectation for people and for programs.
#pragma once

#include <string>

#include <hexhex/check.hpp>

namespace hexhex::command {

/// Prints what the map is, what its mesh will be, and what is wrong with it.
void printCheck(const CheckReport& report, int scale);

/// Prints the numbers that a mesh can be compared with.
void printExpectation(const Expectation& expected);

/// The same as JSON text, ending with a line break. docs/report.md explains the keys.
[[nodiscard]] std::string checkAsJson(const CheckReport& report, int scale,
                                      const std::string& kind);

}  // namespace hexhex::command
