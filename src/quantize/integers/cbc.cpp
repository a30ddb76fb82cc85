#include <quantize/integers/integer_program.hpp>
#if defined(HEXHEX_CBC_NAME)
#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <string>

#include <coin/Cbc_C_Interface.h>
#include <quantize/integers/loaded_solver.hpp>
#endif

namespace hexhex::quantization {

#if defined(HEXHEX_CBC_NAME)
namespace {

/// Loaded when the first program is to be solved: it brings fifteen libraries along.
void* cbcLibrary() {
  static void* const loaded = loadSolver(HEXHEX_CBC_NAME, HEXHEX_CBC_FILE);
  return loaded;
}

/// What of CBC is called. Found before a child process begins, in which the loader could be locked.
struct Cbc {
  template <class Function>
  static Function* find(const char* name) {
    return reinterpret_cast<Function*>(dlsym(cbcLibrary(), name));
  }
  decltype(Cbc_newModel)* newModel = find<decltype(Cbc_newModel)>("Cbc_newModel");
  decltype(Cbc_addCol)* addColumn = find<decltype(Cbc_addCol)>("Cbc_addCol");
  decltype(Cbc_addRow)* addRow = find<decltype(Cbc_addRow)>("Cbc_addRow");
  decltype(Cbc_setParameter)* set = find<decltype(Cbc_setParameter)>("Cbc_setParameter");
  decltype(Cbc_setLogLevel)* setLogLevel = find<decltype(Cbc_setLogLevel)>("Cbc_setLogLevel");
  decltype(Cbc_solve)* solve = find<decltype(Cbc_solve)>("Cbc_solve");
  decltype(Cbc_bestSolution)* bestSolution = find<decltype(Cbc_bestSolution)>("Cbc_bestSolution");
};

bool solve(const Cbc& cbc, const MixedIntegerProgram& program, std::span<std::int64_t> integers) {
  constexpr double kInfinity = MixedIntegerProgram::kInfinity;
  Cbc_Model* const model = cbc.newModel();
  for (std::size_t c = 0; c < program.least.size(); ++c) {
    cbc.addColumn(model, "", program.least[c], kInfinity, program.cost[c],
                  c < integers.size() ? 1 : 0, 0, nullptr, nullptr);
  }
  for (std::size_t r = 0; r < program.lower.size(); ++r) {
    const bool hasLower = program.lower[r] > -kInfinity;
    const bool hasUpper = program.upper[r] < kInfinity;
    cbc.addRow(model, "", program.begin[r + 1] - program.begin[r],
               program.columns.data() + program.begin[r], program.factors.data() + program.begin[r],
               hasLower && hasUpper ? 'E'
               : hasLower           ? 'G'
                                    : 'L',
               hasLower ? program.lower[r] : program.upper[r]);
  }
  cbc.set(model, "ratioGap", std::to_string(kGap).c_str());
  cbc.set(model, "maxNodes", std::to_string(kMostNodes).c_str());
  cbc.setLogLevel(model, 0);
  cbc.solve(model);
  const double* const best = cbc.bestSolution(model);
  if (best == nullptr) return false;
  std::transform(best, best + integers.size(), integers.begin(),
                 [](double value) { return std::llround(value); });
  return true;
}

std::vector<std::int64_t> solveByCbc(const IntegerProgram& program, const Context& context) {
  const Cbc cbc;
  return solveInChildProcess(
      program, context, [&](const MixedIntegerProgram& mixed, std::span<std::int64_t> integers) {
        return solve(cbc, mixed, integers);
      });
}

}  // namespace

IntegerSolver cbcSolver() {
  return cbcLibrary() != nullptr ? IntegerSolver{"CBC", solveByCbc} : IntegerSolver{};
}
#else
IntegerSolver cbcSolver() { return {}; }
#endif

}  // namespace hexhex::quantization
