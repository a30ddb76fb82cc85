// What solvers have in common that are libraries: they are loaded when they are needed, and run in
// a process of their own.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <quantize/integers/integer_program.hpp>

namespace hexhex::quantization {

/// @param name  that stands for the library's binary interface, as the system's loader finds it
/// @param file  where it was when hexhex was built: it may be nowhere where the loader looks
/// @return nullptr if it is not there. Stays loaded
/// @throws Error FileUnsupported if it is there, but cannot be loaded
[[nodiscard]] void* loadSolver(const char* name, const char* file);

/// An integer program as such libraries take it. The first half of the columns are the integers,
/// the other half their distances from the lengths.
struct MixedIntegerProgram {
  explicit MixedIntegerProgram(const IntegerProgram& program);

  [[nodiscard]] int columnCount() const noexcept { return static_cast<int>(least.size()); }
  [[nodiscard]] int rowCount() const noexcept { return static_cast<int>(lower.size()); }

  static constexpr double kInfinity = 1e30;
  std::vector<double> least;  ///< per column; there is no upper bound
  std::vector<double> cost;
  std::vector<double> lower;  ///< per row: bounds of the sum, or -kInfinity, kInfinity
  std::vector<double> upper;
  std::vector<int> begin = {0};  ///< per row: where its entries begin
  std::vector<int> columns;      ///< per entry
  std::vector<double> factors;

 private:
  void addRow(double lowest, double highest);
};

/// Has a program solved by a library: it may crash or never end where its memory ends, it may
/// handle signals, and cannot be told to stop.
/// @param solve  calls the library, and sets the first half of the columns; whether there is a
///               solution
[[nodiscard]] std::vector<std::int64_t> solveInChildProcess(
    const IntegerProgram& program, const Context& context,
    const std::function<bool(const MixedIntegerProgram&, std::span<std::int64_t>)>& solve);

/// Branches of the tree that libraries search, at most: the limit is none of time.
inline constexpr int kMostNodes = 20000;
/// They end as near to the minimum as this, relatively.
inline constexpr double kGap = 0.01;

}  // namespace hexhex::quantization
