#include <quantize/integers/integer_program.hpp>
#if defined(HEXHEX_HIGHS_NAME)
#include <algorithm>
#include <cmath>
#include <dlfcn.h>

#include <interfaces/highs_c_api.h>
#include <quantize/integers/loaded_solver.hpp>
#endif

namespace hexhex::quantization {

#if defined(HEXHEX_HIGHS_NAME)
namespace {

void* highsLibrary() {
  static void* const loaded = loadSolver(HEXHEX_HIGHS_NAME, HEXHEX_HIGHS_FILE);
  return loaded;
}

/// What of HiGHS is called. Found before a child process begins, in which the loader could be
/// locked.
struct Highs {
  template <class Function>
  static Function* find(const char* name) {
    return reinterpret_cast<Function*>(dlsym(highsLibrary(), name));
  }
  decltype(Highs_create)* create = find<decltype(Highs_create)>("Highs_create");
  decltype(Highs_setBoolOptionValue)* setBool =
      find<decltype(Highs_setBoolOptionValue)>("Highs_setBoolOptionValue");
  decltype(Highs_setIntOptionValue)* setInt =
      find<decltype(Highs_setIntOptionValue)>("Highs_setIntOptionValue");
  decltype(Highs_setDoubleOptionValue)* setDouble =
      find<decltype(Highs_setDoubleOptionValue)>("Highs_setDoubleOptionValue");
  decltype(Highs_passMip)* passProgram = find<decltype(Highs_passMip)>("Highs_passMip");
  decltype(Highs_run)* run = find<decltype(Highs_run)>("Highs_run");
  decltype(Highs_getIntInfoValue)* getInt =
      find<decltype(Highs_getIntInfoValue)>("Highs_getIntInfoValue");
  decltype(Highs_getSolution)* getSolution = find<decltype(Highs_getSolution)>("Highs_getSolution");
};

bool solve(const Highs& highs, const MixedIntegerProgram& program,
           std::span<std::int64_t> integers) {
  void* const model = highs.create();
  highs.setBool(model, "output_flag", 0);
  highs.setInt(model, "threads", 1);
  highs.setInt(model, "mip_max_nodes", kMostNodes);
  highs.setDouble(model, "mip_rel_gap", kGap);
  const std::vector<double> most(program.least.size(), MixedIntegerProgram::kInfinity);
  std::vector<HighsInt> kinds(program.least.size(), kHighsVarTypeContinuous);
  std::fill_n(kinds.begin(), integers.size(), kHighsVarTypeInteger);
  const HighsInt status = highs.passProgram(
      model, program.columnCount(), program.rowCount(),
      static_cast<HighsInt>(program.columns.size()), kHighsMatrixFormatRowwise,
      kHighsObjSenseMinimize, 0, program.cost.data(), program.least.data(), most.data(),
      program.lower.data(), program.upper.data(), program.begin.data(), program.columns.data(),
      program.factors.data(), kinds.data());
  if (status == kHighsStatusError || highs.run(model) == kHighsStatusError) return false;
  HighsInt found = 0;
  highs.getInt(model, "primal_solution_status", &found);
  if (found != kHighsSolutionStatusFeasible) return false;
  std::vector<double> columns(program.least.size());
  std::vector<double> rows(program.lower.size());
  highs.getSolution(model, columns.data(), nullptr, rows.data(), nullptr);
  std::transform(columns.begin(), columns.begin() + std::ssize(integers), integers.begin(),
                 [](double value) { return std::llround(value); });
  return true;
}

std::vector<std::int64_t> solveByHighs(const IntegerProgram& program, const Context& context) {
  const Highs highs;
  return solveInChildProcess(
      program, context, [&](const MixedIntegerProgram& mixed, std::span<std::int64_t> integers) {
        return solve(highs, mixed, integers);
      });
}

}  // namespace

IntegerSolver highsSolver() {
  return highsLibrary() != nullptr ? IntegerSolver{"HiGHS", solveByHighs} : IntegerSolver{};
}
#else
IntegerSolver highsSolver() { return {}; }
#endif

}  // namespace hexhex::quantization
