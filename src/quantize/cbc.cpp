#include <algorithm>
#include <cmath>
#include <mutex>

#include <quantize/integer_program.hpp>
#if defined(HEXHEX_CBC_NAME)
#include <csignal>
#include <cstddef>
#include <dlfcn.h>
#include <string>

#include <coin/Cbc_C_Interface.h>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>
#endif

namespace hexhex {

#if defined(HEXHEX_CBC_NAME)
namespace {

/// CBC ends the process where its memory ends, so it only begins if there is so much.
void requireMemory() { static_cast<void>(Array<char>(std::size_t{1} << 25)); }

void* load() {
  requireMemory();
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

template <class Function>
Function* symbol(Function* /*declared*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library(), name));
}

// NOLINTNEXTLINE(bugprone-macro-parentheses): a name
#define HEXHEX_CBC(function) symbol(&function, #function)

constexpr double kInfinity = 1e30;

class Model {
 public:
  Model() : model_(HEXHEX_CBC(Cbc_newModel)()), deleteModel_(HEXHEX_CBC(Cbc_deleteModel)) {}
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model() { deleteModel_(model_); }

  void addColumn(double least, double cost, bool isInteger) {
    static auto* const add = HEXHEX_CBC(Cbc_addCol);
    add(model_, "", least, kInfinity, cost, isInteger ? 1 : 0, 0, nullptr, nullptr);
  }
  void addRow(const std::vector<int>& columns, const std::vector<double>& factors, char sense,
              double right) {
    static auto* const add = HEXHEX_CBC(Cbc_addRow);
    add(model_, "", static_cast<int>(columns.size()), columns.data(), factors.data(), sense, right);
  }
  void set(const char* parameter, const char* value) {
    HEXHEX_CBC(Cbc_setParameter)(model_, parameter, value);
  }
  /// @return nullptr without a solution
  const double* solve() {
    HEXHEX_CBC(Cbc_setLogLevel)(model_, 0);
    HEXHEX_CBC(Cbc_solve)(model_);
    return HEXHEX_CBC(Cbc_bestSolution)(model_);
  }

 private:
  Cbc_Model* model_;
  decltype(&Cbc_deleteModel) deleteModel_;
};

/// Leaves the caller's way of dealing with Ctrl-C as it is.
class KeptInterrupt {
 public:
  KeptInterrupt() { sigaction(SIGINT, nullptr, &handler_); }
  KeptInterrupt(const KeptInterrupt&) = delete;
  KeptInterrupt& operator=(const KeptInterrupt&) = delete;
  ~KeptInterrupt() { sigaction(SIGINT, &handler_, nullptr); }

 private:
  struct sigaction handler_ {};
};

}  // namespace

bool canLoadCbc() { return library() != nullptr; }

std::vector<std::int64_t> solveByCbc(const IntegerProgram& program) {
  // CBC keeps its arguments in global variables, and catches Ctrl-C while it solves.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const KeptInterrupt kept;
  requireMemory();
  // One column for each number of hexahedra, one for its distance from the length.
  Model model;
  const auto n = static_cast<int>(program.lengths.size());
  for (const int least : program.least) model.addColumn(least, 0, true);
  for (const double length : program.lengths) model.addColumn(0, 1 / std::max(length, 1.0), false);
  for (int a = 0; a < n; ++a) {
    const double length = program.lengths[static_cast<std::size_t>(a)];
    model.addRow({a, n + a}, {1, -1}, 'L', length);
    model.addRow({a, n + a}, {1, 1}, 'G', length);
  }
  for (const ArcEquation& equation : program.equations) {
    std::vector<int> columns;
    std::vector<double> factors;
    for (const auto& [arc, factor] : equation) {
      columns.push_back(static_cast<int>(arc));
      factors.push_back(factor);
    }
    model.addRow(columns, factors, 'E', 0);
  }
  model.set("ratioGap", "0.01");
  model.set("maxNodes", "20000");
  std::vector<std::int64_t> solution;
  const double* const best = model.solve();
  for (int a = 0; best != nullptr && a < n; ++a) solution.push_back(std::llround(best[a]));
  return solution;
}
#else
bool canLoadCbc() { return false; }
std::vector<std::int64_t> solveByCbc(const IntegerProgram& /*program*/) { return {}; }
#endif

}  // namespace hexhex
