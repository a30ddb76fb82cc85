#include <algorithm>
#include <cstddef>
#include <dlfcn.h>
#include <string>

#include <quantize/integers/child_process.hpp>
#include <quantize/integers/loaded_solver.hpp>

#include <hexhex/error.hpp>

namespace hexhex::quantization {
namespace {

void* open(const char* name) {
  void* const loaded = dlopen(name, RTLD_NOW);
  const std::string problem = loaded == nullptr ? dlerror() : "";
  // Without it, integers are others: that must not depend on what happens to fail.
  if (loaded == nullptr && problem.find("No such file") == std::string::npos) {
    throw Error(ErrorCode::FileUnsupported,
                std::string("The library ") + name + " is there, but cannot be loaded (" + problem +
                    "). Install it anew, or remove it: integers are then found otherwise.");
  }
  return loaded;
}

}  // namespace

void* loadSolver(const char* name, const char* file) {
  // Libraries cannot be loaded without memory, and may crash then: so much they take together.
  static_cast<void>(Array<char>(std::size_t{1} << 25));
  void* const loaded = open(name);
  return loaded != nullptr ? loaded : open(file);
}

MixedIntegerProgram::MixedIntegerProgram(const IntegerProgram& program) {
  const auto n = static_cast<int>(program.lengths.size());
  least.assign(program.least.begin(), program.least.end());
  least.resize(2 * program.lengths.size());
  cost.resize(program.lengths.size());
  for (const double length : program.lengths) cost.push_back(1 / std::max(length, 1.0));
  for (int a = 0; a < n; ++a) {
    const double length = program.lengths[static_cast<std::size_t>(a)];
    for (const double sign : {-1.0, 1.0}) {
      columns.insert(columns.end(), {a, n + a});
      factors.insert(factors.end(), {1, sign});
      addRow(sign < 0 ? -kInfinity : length, sign < 0 ? length : kInfinity);
    }
  }
  for (const ArcEquation& equation : program.equations) {
    for (const auto& [arc, factor] : equation) {
      columns.push_back(static_cast<int>(arc));
      factors.push_back(factor);
    }
    addRow(0, 0);
  }
}

/// Of the entries that are last.
void MixedIntegerProgram::addRow(double lowest, double highest) {
  lower.push_back(lowest);
  upper.push_back(highest);
  begin.push_back(static_cast<int>(columns.size()));
}

std::vector<std::int64_t> solveInChildProcess(
    const IntegerProgram& program, const Context& context,
    const std::function<bool(const MixedIntegerProgram&, std::span<std::int64_t>)>& solve) {
  const MixedIntegerProgram mixed(program);
  return inChildProcess(program.lengths.size(), context,
                        [&](std::span<std::int64_t> integers) { return solve(mixed, integers); })
      .value_or(std::vector<std::int64_t>());
}

}  // namespace hexhex::quantization
