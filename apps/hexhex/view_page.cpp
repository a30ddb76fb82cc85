#include "view_page.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>

#include <hexhex/io.hpp>
#include <hexhex/view.hpp>

#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "mesh_collector.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "serve_page.hpp"

namespace hexhex::command {
namespace {

/// Mesh and what is known about it.
struct Subject {
  HexMesh mesh;
  std::optional<VerifyReport> verification;

  [[nodiscard]] bool agrees() const { return !verification || verification->passed(); }
};

Subject readSubject(const ViewArguments& arguments, Context& context) {
  Subject subject;
  subject.mesh = readWithGenerators(arguments.mesh, context);
  if (!arguments.map.empty()) {
    const TetMap map = readMap(arguments.map, context);
    subject.verification = verify(map, subject.mesh, arguments.options, context);
  }
  return subject;
}

ViewOptions optionsOf(const ViewArguments& arguments, const Subject& subject) {
  ViewOptions options;
  options.title = std::filesystem::path(arguments.mesh).filename().string();
  if (subject.verification) {
    options.verification = &*subject.verification;
    options.mapName = std::filesystem::path(arguments.map).filename().string();
  }
  return options;
}

std::filesystem::path pageOf(const ViewArguments& arguments) {
  if (!arguments.page.empty()) return arguments.page;
  return std::filesystem::path(arguments.mesh).replace_extension(".html");
}

void warnUnlessAgreed(const ViewArguments& arguments, const Subject& subject) {
  if (subject.agrees()) return;
  printWarning("The mesh does not agree with " + arguments.map +
               "; the page lists the checks that failed.");
}

int writePage(const ViewArguments& arguments, ProgressDisplay& progress, Context& context) {
  const std::filesystem::path page = pageOf(arguments);
  requireDifferent(arguments.mesh, page);
  if (!arguments.map.empty()) requireDifferent(arguments.map, page);
  requireWritable(page);
  const Subject subject = readSubject(arguments, context);
  writeViewPage(subject.mesh, page, optionsOf(arguments, subject), context);
  progress.clear();
  warnUnlessAgreed(arguments, subject);
  if (!arguments.quiet) {
    fmt::print("{} -> {}\n", arguments.mesh, page.string());
    printLine("mesh", counted(subject.mesh.cells.size(), "cell"));
    printLine("page", bytesAsText(std::filesystem::file_size(page)));
    printLine("to see it", "open the page in a browser; no network is needed");
  }
  return subject.agrees() ? kSuccess : kFailure;
}

/// Serves until Ctrl-C, which is no failure here.
int serve(const ViewArguments& arguments, ProgressDisplay& progress, Context& context) {
  Subject subject = readSubject(arguments, context);
  const ServedPage page =
      makeServedPage(subject.mesh, kMeshUrl, optionsOf(arguments, subject), context);
  progress.clear();
  warnUnlessAgreed(arguments, subject);
  const bool agrees = subject.agrees();
  subject = {};  // the page has all of it
  const auto announce = [&arguments](const std::string& address) {
    // The address is what --serve is for, so --quiet does not silence it.
    if (arguments.quiet) {
      fmt::print("{}\n", address);
    } else {
      fmt::print("{} is at {} until you press Ctrl-C.\n", arguments.mesh, address);
    }
    std::fflush(stdout);
  };
  servePage(page, arguments.port, announce, context);
  return agrees ? kSuccess : kFailure;
}

}  // namespace

int view(const ViewArguments& arguments) {
  ProgressDisplay progress(arguments.quiet);
  Context context(arguments.threads, progress.callback());
  const CancelOnSignal cancelOnSignal(context);
  requireHexMeshFormat(arguments.mesh);
  if (arguments.serve) return serve(arguments, progress, context);
  return writePage(arguments, progress, context);
}

}  // namespace hexhex::command
