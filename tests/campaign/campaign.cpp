// Random maps without end: extracts each in all ways, which must agree, and verifies what comes
// out.
//
//     campaign --maps 1000                 the maps 0 to 999 of seed 1
//     campaign --seed 7 --seconds 300      as many as fit into five minutes
//     campaign --seed 7 --only 123         map 123 of seed 7 again, e.g. in a debugger
//     campaign --quantized 20              also quantizes one map in 20
//
// A map that fails is saved as a .hexex file beside the command that draws it again.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <sys/time.h>
#include <unistd.h>
#include <utility>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/io_test_support.hpp>

#include "campaign/examination.hpp"
#include "campaign/random_map.hpp"

namespace {

using namespace hexhex;
using namespace hexhex::campaign;
using hexhex::test::TemporaryFolder;

struct Options {
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> only;
  std::uint64_t first = 0;
  std::uint64_t maps = static_cast<std::uint64_t>(-1);
  double seconds = 1e18;
  std::uint64_t quantized = 0;
  std::filesystem::path found = "campaign-found";
};

/// The longest that a map may take, in seconds of processors, so that nothing fails that was paused
/// or had to wait; the usual ones take a hundredth.
constexpr int kPatience = 120;
/// After so many failures a campaign ends: they are likely to be one.
constexpr int kMostFailures = 20;

/// What a crash has to tell; a signal handler may not make a string.
char whatRuns[200];

/// Lets SIGPROF come after so many seconds of processors; never after 0.
void setAlarm(int seconds) {
  itimerval time{};
  time.it_value.tv_sec = seconds;
  ::setitimer(ITIMER_PROF, &time, nullptr);
}

extern "C" void onCrash(int signal) {
  const std::string_view text(whatRuns);
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

[[noreturn]] void explain(int status) {
  std::printf(
      "campaign [--seed S] [--first N] [--maps COUNT] [--seconds T] [--only N] [--quantized N] "
      "[--found FOLDER]\n");
  std::exit(status);
}

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; i += 2) {
    const std::string_view name = arguments[i];
    if (name == "--help") explain(0);
    if (i + 1 == count) explain(2);
    const char* value = arguments[i + 1];
    if (name == "--seed") {
      options.seed = std::strtoull(value, nullptr, 10);
    } else if (name == "--only") {
      options.only = std::strtoull(value, nullptr, 10);
    } else if (name == "--first") {
      options.first = std::strtoull(value, nullptr, 10);
    } else if (name == "--maps") {
      options.maps = std::strtoull(value, nullptr, 10);
    } else if (name == "--seconds") {
      options.seconds = std::strtod(value, nullptr);
    } else if (name == "--quantized") {
      options.quantized = std::strtoull(value, nullptr, 10);
    } else if (name == "--found") {
      options.found = value;
    } else {
      explain(2);
    }
  }
  if (options.only) {
    options.first = *options.only;
    options.maps = 1;
  }
  return options;
}

struct Totals {
  std::map<std::string, std::uint64_t> kinds;
  std::uint64_t maps = 0;
  std::uint64_t tets = 0;
  std::uint64_t cells = 0;
  std::uint64_t quantized = 0;
  std::uint64_t notQuantized = 0;
  std::pair<double, std::uint64_t> longest;  ///< quantization, in seconds, and the map's number
  int failures = 0;
};

/// Draws and examines one map; saves it if it fails.
void run(std::uint64_t number, const Options& options, const std::filesystem::path& folder,
         Totals& totals) {
  std::snprintf(whatRuns, sizeof(whatRuns), "CRASHED, see: campaign --seed %llu --only %llu\n",
                static_cast<unsigned long long>(options.seed),
                static_cast<unsigned long long>(number));
  setAlarm(kPatience);
  Random random(options.seed, number);
  DrawnMap drawn;
  try {
    drawn = drawMap(random);
    if (options.only)
      std::printf("map %llu: %s\n", static_cast<unsigned long long>(number), drawn.kind.c_str());
    const ExaminedSizes sizes = examine(drawn, random, options.quantized, folder);
    ++totals.kinds[drawn.kind];
    totals.tets += sizes.tets;
    totals.cells += sizes.cells;
    totals.quantized += sizes.isQuantized ? 1 : 0;
    if (!sizes.notQuantized.empty()) {
      ++totals.notQuantized;
      std::printf("not quantized: map %llu (%s): %s\n", static_cast<unsigned long long>(number),
                  drawn.kind.c_str(), sizes.notQuantized.c_str());
    }
    totals.longest = std::max(totals.longest, {sizes.quantizationSeconds, number});
  } catch (const std::exception& error) {
    ++totals.failures;
    std::filesystem::create_directories(options.found);
    const std::filesystem::path file =
        options.found / (std::to_string(options.seed) + "-" + std::to_string(number) + ".hexex");
    std::printf("FAILED: map %llu (%s): %s\n  again: campaign --seed %llu --only %llu\n",
                static_cast<unsigned long long>(number), drawn.kind.c_str(), error.what(),
                static_cast<unsigned long long>(options.seed),
                static_cast<unsigned long long>(number));
    if (!drawn.map.tets.empty()) {
      writeMap(drawn.map, file);
      std::printf("  saved: %s\n", file.c_str());
    }
    std::fflush(stdout);
  }
  ++totals.maps;
  setAlarm(0);
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = parse(count, arguments);
  GTEST_FLAG_SET(throw_on_failure, true);
  GTEST_FLAG_SET(catch_exceptions, false);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF}) {
    std::signal(signal, onCrash);
  }
  // Every file is synced: on a disk, half of the time would go by waiting for it.
  if (std::filesystem::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 0);
  const TemporaryFolder folder;
  Totals totals;
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [begin] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  for (std::uint64_t i = 0; i < options.maps && seconds() < options.seconds; ++i) {
    run(options.first + i, options, folder.path(), totals);
    if (totals.failures >= kMostFailures) break;
  }
  for (const auto& [kind, maps] : totals.kinds) {
    std::printf("%8llu  %s\n", static_cast<unsigned long long>(maps), kind.c_str());
  }
  if (options.quantized > 0) {
    std::printf("%llu quantized, %llu could not be; the longest took %.1f s (map %llu)\n",
                static_cast<unsigned long long>(totals.quantized),
                static_cast<unsigned long long>(totals.notQuantized), totals.longest.first,
                static_cast<unsigned long long>(totals.longest.second));
  }
  std::printf(
      "seed %llu, maps %llu to %llu: %llu tets, %llu cells, %.0f s (%.1f maps per second), "
      "%d failed\n",
      static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(options.first),
      static_cast<unsigned long long>(options.first + totals.maps - 1),
      static_cast<unsigned long long>(totals.tets), static_cast<unsigned long long>(totals.cells),
      seconds(), static_cast<double>(totals.maps) / seconds(), totals.failures);
  return totals.failures == 0 ? 0 : 1;
}
