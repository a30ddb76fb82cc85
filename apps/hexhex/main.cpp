// The command `hexhex`: parses the command line, runs a subcommand, and turns errors into a message
// and an exit code.
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/version.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "long_run.hpp"
#include "output.hpp"

namespace hexhex::command {
namespace {

constexpr const char* kDescription =
    "Extracts hexahedral meshes from integer-grid maps on tetrahedral meshes.";

constexpr const char* kFooter = R"(Examples:
  hexhex generate sphere -o sphere.hexex         a map to play with
  hexhex check sphere.hexex                      is it valid, and what will come out?
  hexhex extract sphere.hexex -o sphere.vtu      the mesh, verified, for ParaView
  hexhex extract sphere.hexex -o fine.mesh --scale 4 --report fine.json
  hexhex verify sphere.hexex fine.mesh --scale 4
  hexhex info fine.mesh
  hexhex mesh part.msh -o mesh.vtu --cells 50000         from tets alone
  hexhex extract seamless.hexex -o mesh.vtu --quantize --cells 50000
  hexhex improve sphere.vtu --map sphere.hexex -o better.vtu
  hexhex convert sphere.vtu sphere.msh           for Gmsh
  hexhex view sphere.vtu --map sphere.hexex      a page that shows it in any browser

`hexhex SUBCOMMAND --help` explains the options of a subcommand.

`hexhex formats` lists the files that are read and written.

Exit codes:
    0  success
    1  the map is invalid
    2  bad usage: wrong options or arguments
    3  a file cannot be read, understood, or written
    4  the result failed its verification, memory was exhausted, or an internal error
  130  interrupted
Output files appear complete or not at all.)";

std::string usageProblem(const CLI::App* app, const CLI::Error& error) {
  // Report a misspelt word rather than the missing one that was meant.
  const std::string unexpected = unexpectedAsText(*app);
  const std::vector<CLI::App*> given = app->get_subcommands();
  return fmt::format("hexhex: error: {}\nRun `hexhex {}--help` for the options and examples.\n",
                     printable(unexpected.empty() ? error.what() : unexpected),
                     given.empty() ? "" : given.front()->get_name() + " ");
}

/// Memory reserved for when it runs out. Releasing the first block lets small work continue, such
/// as that of destructors, which must not fail; the second one lets everything be cleaned up.
std::array<std::atomic<void*>, 2> spareMemory;

void reserveMemory() {
  constexpr std::size_t kBytes = std::size_t{1} << 18;
  for (std::atomic<void*>& spare : spareMemory) spare = std::malloc(kBytes);
  std::set_new_handler([] {
    if (void* const first = spareMemory[0].exchange(nullptr)) return std::free(first);
    std::free(spareMemory[1].exchange(nullptr));
    throw std::bad_alloc();
  });
}

/// Prints the error without allocating memory.
int failForMemory() noexcept {
  static_cast<void>(
      std::fputs("hexhex: error: This machine is out of memory, or refuses threads or locks; "
                 "nothing was written. Try a smaller scale, or one thread. "
                 "[OutOfMemory]\n",
                 stderr));
  return kFailure;
}

/// Runs before main(), since CLI11 constructs its validators then and nothing can be caught.
[[gnu::constructor(101)]] void endWithoutMemory() {
  std::set_new_handler([] { std::_Exit(failForMemory()); });
}

/// Runs a subcommand and handles all errors.
int runGuarded(const Command& command) {
  try {
    return command.run();
  } catch (const Error& error) {
    printError(error, sentenceOf(error));
    return exitCodeOf(error.code());
  } catch (const std::bad_alloc&) {
    return failForMemory();
  } catch (const std::system_error&) {
    return failForMemory();
  } catch (const std::exception& error) {
    printToStderr("hexhex: error: Unexpected: {} Please report this. [{}]\n", error.what(),
                  name(ErrorCode::Internal));
    return kFailure;
  }
}

int run(int argc, char** argv) {
  CLI::App app(kDescription, "hexhex");
  app.set_version_flag("--version", "hexhex " HEXHEX_VERSION, "Print the version and exit");
  app.footer(kFooter);
  app.require_subcommand(1);
  app.failure_message(usageProblem);
  const std::array commands = {addMesh(app),    addMap(app),      addExtract(app),  addCheck(app),
                               addVerify(app),  addGenerate(app), addQuantize(app), addRepair(app),
                               addImprove(app), addInfo(app),     addConvert(app),  addFormats(app),
                               addView(app),    addHelp(app)};
  if (argc == 1) {
    fmt::print("{}", app.help());
    return kSuccess;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version arrive here as well.
    return app.exit(error) == 0 ? kSuccess : kBadUsage;
  }
  for (const Command& command : commands) {
    if (command.parser->parsed()) return runGuarded(command);
  }
  return kBadUsage;
}

}  // namespace
}  // namespace hexhex::command

int main(int argc, char** argv) {
  using namespace hexhex::command;
#ifdef SIGXFSZ
  // Exceeding a file size limit should be an error like a full disk, not end the process.
  std::signal(SIGXFSZ, SIG_IGN);
#endif
  reserveMemory();
  try {
    const int code = run(argc, argv);
    if (std::fflush(stdout) == 0 || code != kSuccess) return code;
  } catch (const std::bad_alloc&) {
    return failForMemory();
  } catch (...) {
    // Only printing can throw here, e.g. to a closed pipe.
  }
  static_cast<void>(std::fputs("hexhex: error: The standard output cannot be written.\n", stderr));
  return kFileProblem;
}
