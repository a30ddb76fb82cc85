#include <algorithm>
#include <cmath>

#include <quantize/integer_program.hpp>
#if defined(HEXHEX_CBC_NAME)
#include <cstddef>
#include <dlfcn.h>
#include <string>

#include <coin/Cbc_C_Interface.h>
#include <quantize/child_process.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>
#endif

namespace hexhex {

#if defined(HEXHEX_CBC_NAME)
namespace {

/// What of CBC is called. Found before a child process begins, in which the loader could be locked.
struct Cbc {
  explicit Cbc(void* library)
      : newModel(reinterpret_cast<decltype(newModel)>(dlsym(library, "Cbc_newModel"))),
        addColumn(reinterpret_cast<decltype(addColumn)>(dlsym(library, "Cbc_addCol"))),
        addRow(reinterpret_cast<decltype(addRow)>(dlsym(library, "Cbc_addRow"))),
        set(reinterpret_cast<decltype(set)>(dlsym(library, "Cbc_setParameter"))),
        setLogLevel(reinterpret_cast<decltype(setLogLevel)>(dlsym(library, "Cbc_setLogLevel"))),
        solve(reinterpret_cast<decltype(solve)>(dlsym(library, "Cbc_solve"))),
        bestSolution(reinterpret_cast<decltype(bestSolution)>(dlsym(library, "Cbc_bestSolution"))) {
  }

  decltype(&Cbc_newModel) newModel;
  decltype(&Cbc_addCol) addColumn;
  decltype(&Cbc_addRow) addRow;
  decltype(&Cbc_setParameter) set;
  decltype(&Cbc_setLogLevel) setLogLevel;
  decltype(&Cbc_solve) solve;
  decltype(&Cbc_bestSolution) bestSolution;
};

void* load() {
  // Libraries cannot be loaded without memory, and may crash then: so much they take together.
  static_cast<void>(Array<char>(std::size_t{1} << 25));
  void* const loaded = dlopen(HEXHEX_CBC_NAME, RTLD_NOW);
  const std::string problem = loaded == nullptr ? dlerror() : "";
  // Without it, integers are others: that must not depend on what happens to fail.
  if (loaded == nullptr && problem.find("No such file") == std::string::npos) {
    throw Error(ErrorCode::FileUnsupported,
                "The library CBC is there, but cannot be loaded (" + problem +
                    "). Install it anew, or remove it: integers are then found by rounding.");
  }
  return loaded;
}

/// Loaded when the first program is to be solved: it brings fifteen libraries along.
void* library() {
  static void* const loaded = load();
  return loaded;
}

constexpr double kInfinity = 1e30;

/// @param integers  one for each length; as they are if there is no solution
/// @return  whether there is one
bool solve(const Cbc& cbc, const IntegerProgram& program, std::span<std::int64_t> integers) {
  // One column for each number of hexahedra, one for its distance from the length.
  Cbc_Model* const model = cbc.newModel();
  const auto addColumn = [&](double least, double cost, char isInteger) {
    cbc.addColumn(model, "", least, kInfinity, cost, isInteger, 0, nullptr, nullptr);
  };
  const auto addRow = [&](const std::vector<int>& columns, const std::vector<double>& factors,
                          char sense, double right) {
    cbc.addRow(model, "", static_cast<int>(columns.size()), columns.data(), factors.data(), sense,
               right);
  };
  const auto n = static_cast<int>(program.lengths.size());
  for (const int least : program.least) addColumn(least, 0, 1);
  for (const double length : program.lengths) addColumn(0, 1 / std::max(length, 1.0), 0);
  for (int a = 0; a < n; ++a) {
    const double length = program.lengths[static_cast<std::size_t>(a)];
    addRow({a, n + a}, {1, -1}, 'L', length);
    addRow({a, n + a}, {1, 1}, 'G', length);
  }
  for (const ArcEquation& equation : program.equations) {
    std::vector<int> columns;
    std::vector<double> factors;
    for (const auto& [arc, factor] : equation) {
      columns.push_back(static_cast<int>(arc));
      factors.push_back(factor);
    }
    addRow(columns, factors, 'E', 0);
  }
  cbc.set(model, "ratioGap", "0.01");
  cbc.set(model, "maxNodes", "20000");
  cbc.setLogLevel(model, 0);
  cbc.solve(model);
  const double* const best = cbc.bestSolution(model);
  if (best == nullptr) return false;
  std::transform(best, best + n, integers.begin(),
                 [](double value) { return std::llround(value); });
  return true;
}

}  // namespace

bool canLoadCbc() { return library() != nullptr; }

std::vector<std::int64_t> solveByCbc(const IntegerProgram& program, const Context& context) {
  const Cbc cbc(library());
  // CBC crashes, or never ends, where its memory ends; it takes over Ctrl-C, keeps its arguments in
  // global variables, and cannot be told to stop.
  const std::optional<std::vector<std::int64_t>> integers =
      inChildProcess(program.lengths.size(), context,
                     [&](std::span<std::int64_t> result) { return solve(cbc, program, result); });
  return integers.value_or(std::vector<std::int64_t>());
}
#else
bool canLoadCbc() { return false; }
std::vector<std::int64_t> solveByCbc(const IntegerProgram& /*program*/,
                                     const Context& /*context*/) {
  return {};
}
#endif

}  // namespace hexhex
