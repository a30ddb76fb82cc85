// A CheckReport and an Expectation for people.
#pragma once

#include <string>

#include <hexhex/check.hpp>

namespace hexhex::command {

/// Prints what the map consists of.
void printMap(const CheckReport& report);

/// Prints what is wrong with it, and where most.
void printDefects(const CheckReport& report);

/// Prints the numbers that a mesh can be compared with.
void printExpectation(const Expectation& expected);

}  // namespace hexhex::command
