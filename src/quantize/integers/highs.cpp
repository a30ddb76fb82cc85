// Loads HiGHS at run time and calls it through its C interface.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <type_traits>

#include <quantize/integers/integer_program.hpp>

#include <hexhex/error.hpp>

#include <base/loaded_library.hpp>

namespace hexhex::quantization {

namespace {

/// The search ends at this relative distance from the optimum ...
constexpr double kGap = 0.01;
/// ... or after this many interrupt callbacks, about a second; programs of real maps take some
/// thirty. A time limit would make the result depend on the machine.
constexpr int kMostQuestions = 10000;

/// The functions used of HiGHS 1, as declared in interfaces/highs_c_api.h (HighsInt is int).
struct Highs {
  using Model = void*;
  struct Answer {
    int isInterrupted;  ///< others follow
  };
  using Callback = void (*)(int type, const char* message, const void* about, Answer* answer,
                            void* user);

  int (*majorVersion)() = nullptr;
  int (*integerSize)(const void*) = nullptr;
  Model (*create)() = nullptr;
  void (*destroy)(Model) = nullptr;
  int (*setBool)(Model, const char* option, int) = nullptr;
  int (*setInt)(Model, const char* option, int) = nullptr;
  int (*setDouble)(Model, const char* option, double) = nullptr;
  int (*setCallback)(Model, Callback, void* user) = nullptr;
  int (*startCallback)(Model, int type) = nullptr;
  int (*passProgram)(Model, int columnCount, int rowCount, int entryCount, int format, int sense,
                     double offset, const double* cost, const double* least, const double* most,
                     const double* lower, const double* upper, const int* begin, const int* columns,
                     const double* factors, const int* kinds) = nullptr;
  int (*run)(Model) = nullptr;
  int (*modelStatus)(Model) = nullptr;
  int (*getInt)(Model, const char* info, int*) = nullptr;
  int (*getSolution)(Model, double* columns, double* columnDuals, double* rows,
                     double* rowDuals) = nullptr;
};

// Constants of that header.
constexpr int kError = -1;
constexpr int kContinuous = 0;
constexpr int kInteger = 1;
constexpr int kRowwise = 2;
constexpr int kMinimize = 1;
constexpr int kFeasible = 2;
constexpr int kSolveError = 4;
constexpr int kSimplexInterrupt = 1;
constexpr int kMipInterrupt = 6;

/// @return without functions if it is not installed
Highs load() {
  Highs highs;
  LoadedLibrary library({HEXHEX_HIGHS_FILES "libhighs.so.1", "libhighs.so"}, "HEXHEX_HIGHS");
  // Only a missing library is acceptable: without HiGHS the integers differ, so they must not
  // depend on whether loading it happens to fail.
  if (library.isMissing()) return highs;
  const auto find = [&](auto& function, const char* name) {
    function = library.find<std::remove_reference_t<decltype(function)>>(name);
  };
  find(highs.majorVersion, "Highs_versionMajor");
  find(highs.integerSize, "Highs_getSizeofHighsInt");
  find(highs.create, "Highs_create");
  find(highs.destroy, "Highs_destroy");
  find(highs.setBool, "Highs_setBoolOptionValue");
  find(highs.setInt, "Highs_setIntOptionValue");
  find(highs.setDouble, "Highs_setDoubleOptionValue");
  find(highs.setCallback, "Highs_setCallback");
  find(highs.startCallback, "Highs_startCallback");
  find(highs.passProgram, "Highs_passMip");
  find(highs.run, "Highs_run");
  find(highs.modelStatus, "Highs_getModelStatus");
  find(highs.getInt, "Highs_getIntInfoValue");
  find(highs.getSolution, "Highs_getSolution");
  const std::string& problem = library.problem();
  if (problem.empty() && highs.majorVersion() == 1 && highs.integerSize(nullptr) == sizeof(int)) {
    return highs;
  }
  throw Error(ErrorCode::FileUnsupported,
              "HiGHS 1.6, or a later 1.x, with integers of 32 bits cannot be loaded (" +
                  (problem.empty() ? "the one that is there is another version" : problem) +
                  "). Install it anew (pip install highsbox, and HEXHEX_HIGHS names its "
                  "libhighs.so), or remove it: integers are then found by rounding.");
}

/// Loads HiGHS on first use.
const Highs& highsLibrary() {
  static const Highs loaded = load();
  return loaded;
}

/// The program in the form of HiGHS. The first half of the columns are the integers, the second
/// half their distances from the lengths.
struct Rows {
  explicit Rows(const IntegerProgram& program) {
    const auto n = static_cast<int>(program.lengths.size());
    for (int a = 0; a < n; ++a) {
      const double length = program.lengths[static_cast<std::size_t>(a)];
      for (const double sign : {-1.0, 1.0}) {
        columns.insert(columns.end(), {a, n + a});
        factors.insert(factors.end(), {1, sign});
        add(sign < 0 ? -HUGE_VAL : length, sign < 0 ? length : HUGE_VAL);
      }
    }
    for (const ArcEquation& equation : program.equations) {
      for (const auto& [arc, factor] : equation) {
        columns.push_back(static_cast<int>(arc));
        factors.push_back(factor);
      }
      add(0, 0);
    }
  }

  std::vector<double> lower;  ///< per row: bounds of its sum
  std::vector<double> upper;
  std::vector<int> begin = {0};  ///< per row: its first entry
  std::vector<int> columns;      ///< per entry
  std::vector<double> factors;

 private:
  /// Ends a row, with the bounds of its sum.
  void add(double lowest, double highest) {
    lower.push_back(lowest);
    upper.push_back(highest);
    begin.push_back(static_cast<int>(columns.size()));
  }
};

/// Solves one program.
class Solution {
 public:
  Solution(const Highs& highs, const Context& context)
      : highs_(highs), context_(context), model_(highs.create()) {
    highs.setBool(model_, "output_flag", 0);
    highs.setInt(model_, "threads", 1);
    highs.setDouble(model_, "mip_rel_gap", kGap);
    highs.setCallback(model_, goOnOrNot, this);
    highs.startCallback(model_, kSimplexInterrupt);
    highs.startCallback(model_, kMipInterrupt);
  }
  Solution(const Solution&) = delete;
  Solution& operator=(const Solution&) = delete;
  ~Solution() { highs_.destroy(model_); }

  std::vector<std::int64_t> find(const IntegerProgram& program) {
    const std::size_t n = program.lengths.size();
    pass(program);
    const int status = highs_.run(model_);
    context_.throwIfCancelled();
    if (status == kError || highs_.modelStatus(model_) <= kSolveError) throw std::bad_alloc();
    int found = 0;
    highs_.getInt(model_, "primal_solution_status", &found);
    if (found != kFeasible) return {};
    std::vector<double> columns(2 * n);
    std::vector<double> rows(rowCount_);
    highs_.getSolution(model_, columns.data(), nullptr, rows.data(), nullptr);
    std::vector<std::int64_t> integers(n);
    std::transform(columns.begin(), columns.begin() + std::ssize(integers), integers.begin(),
                   [](double value) { return std::llround(value); });
    return integers;
  }

 private:
  void pass(const IntegerProgram& program) {
    const std::size_t n = program.lengths.size();
    const Rows rows(program);
    rowCount_ = rows.lower.size();
    std::vector<double> cost(n);
    for (const double length : program.lengths) cost.push_back(1 / std::max(length, 1.0));
    std::vector<double> least(program.least.begin(), program.least.end());
    least.resize(2 * n);
    const std::vector<double> most(2 * n, HUGE_VAL);
    std::vector<int> kinds(2 * n, kContinuous);
    std::fill_n(kinds.begin(), n, kInteger);
    const int status = highs_.passProgram(
        model_, static_cast<int>(2 * n), static_cast<int>(rowCount_),
        static_cast<int>(rows.columns.size()), kRowwise, kMinimize, 0, cost.data(), least.data(),
        most.data(), rows.lower.data(), rows.upper.data(), rows.begin.data(), rows.columns.data(),
        rows.factors.data(), kinds.data());
    if (status == kError) throw std::bad_alloc();
  }

  static void goOnOrNot(int /*type*/, const char* /*message*/, const void* /*about*/,
                        Highs::Answer* answer, void* user) {
    auto& self = *static_cast<Solution*>(user);
    if (++self.questions_ > kMostQuestions || self.context_.cancelled()) answer->isInterrupted = 1;
  }

  const Highs& highs_;
  const Context& context_;
  Highs::Model model_;
  std::size_t rowCount_ = 0;
  int questions_ = 0;
};

std::vector<std::int64_t> solveByHighs(const IntegerProgram& program, const Context& context) {
  return Solution(highsLibrary(), context).find(program);
}

}  // namespace

IntegerSolver highsSolver() {
  return highsLibrary().run != nullptr ? IntegerSolver{"HiGHS", solveByHighs} : IntegerSolver{};
}

}  // namespace hexhex::quantization
