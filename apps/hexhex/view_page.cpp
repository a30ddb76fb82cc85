#include "view_page.hpp"

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <spawn.h>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/view.hpp>

#include "command.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "shared_options.hpp"

#ifndef __linux__
extern "C" char** environ;  // elsewhere, headers may not declare it
#endif

namespace hexhex::command {
namespace {

/// A mesh with related results.
struct Subject {
  std::variant<HexMesh, LagrangeMesh> mesh;
  std::optional<VerifyReport> verification;
  std::string map;     ///< with which it was compared
  std::string notice;  ///< of a repair; empty: none

  [[nodiscard]] bool agrees() const { return !verification || verification->passed(); }
  [[nodiscard]] std::size_t cellCount() const {
    if (const auto* const curved = std::get_if<LagrangeMesh>(&mesh)) return curved->cellCount();
    return std::get<HexMesh>(mesh).cells.size();
  }
};

VerifyReport compare(const TetMapView& map, const Subject& subject, const VerifyOptions& options,
                     Context& context) {
  if (const auto* const curved = std::get_if<LagrangeMesh>(&subject.mesh)) {
    return verify(map, straightMesh(*curved), options, context);
  }
  return verify(map, std::get<HexMesh>(subject.mesh), options, context);
}

/// Extracts the mesh of a map.
Subject extractSubject(const ViewArguments& arguments, TetMap map, Context& context) {
  refuseIf(!arguments.map.empty(),
           arguments.mesh +
               " is a map itself, and its mesh is compared with it anyway. Leave "
               "out --map.");
  if (arguments.quantize) map = quantize(map, arguments.quantizeOptions, context).map;
  ExtractOptions options;
  options.scale = arguments.options.scale;
  options.tolerance = arguments.options.tolerance;
  RepairedMap repaired;
  options.repair = &repaired;
  options.curvedNodes = arguments.curvedNodes;
  Subject subject;
  if (arguments.order == 1) {
    subject.mesh = extract(map, options, context);
  } else {
    subject.mesh = extractLagrange(map, arguments.order, options, context);
  }
  subject.map = arguments.mesh;
  subject.verification = compare(extractedMap(map, &repaired), subject, arguments.options, context);
  if (repaired.map) subject.notice = repairNotice(repaired.report);
  return subject;
}

Subject readSubject(const ViewArguments& arguments, Context& context) {
  Subject subject;
  if (holdsLagrangeCells(arguments.mesh, context)) {
    subject.mesh = readLagrangeMesh(arguments.mesh, context);
  } else {
    std::vector<CellCount> counts;
    auto content = readMapOrHexMesh(
        arguments.mesh, {.hexesOnly = arguments.hexesOnly, .cellCounts = &counts}, context);
    if (arguments.hexesOnly) warnOfOtherCells(counts);
    if (auto* const map = std::get_if<TetMap>(&content)) {
      return extractSubject(arguments, std::move(*map), context);
    }
    subject.mesh = std::move(std::get<HexMesh>(content));
  }
  refuseIf(arguments.order > 1 || arguments.quantize,
           arguments.mesh +
               " is a mesh, whose cells are what they are. Leave out --order and --quantize, "
               "or name the map.");
  if (!arguments.map.empty()) {
    subject.map = arguments.map;
    subject.verification =
        compare(readMap(arguments.map, context), subject, arguments.options, context);
  }
  return subject;
}

std::string nameOf(const std::filesystem::path& file) { return file.filename().string(); }

ViewOptions optionsOf(const ViewArguments& arguments, const Subject& subject) {
  ViewOptions options;
  options.title = nameOf(arguments.mesh);
  if (subject.verification) {
    options.verification = &*subject.verification;
    options.mapName = nameOf(subject.map);
  }
  return options;
}

std::filesystem::path pageOf(const ViewArguments& arguments) {
  if (!arguments.page.empty()) return arguments.page;
  return std::filesystem::path(arguments.mesh).replace_extension(".html");
}

void printWarnings(const Subject& subject) {
  if (!subject.notice.empty()) printWarning(subject.notice);
  if (subject.agrees()) return;
  printWarning("The mesh does not agree with " + subject.map +
               "; the page lists the checks that failed.");
}

#ifdef __APPLE__
constexpr const char* kOpener = "open";
#else
constexpr const char* kOpener = "xdg-open";
#endif

/// Opens a page without waiting for the browser.
void openInBrowser(const std::filesystem::path& page) {
  std::string program = kOpener;
  std::string file = std::filesystem::absolute(page).string();  // absolute: not taken for an option
  const std::array<char*, 3> words = {program.data(), file.data(), nullptr};
  posix_spawn_file_actions_t streams;  // not ours: whoever reads these waits for their end
  int problem = ::posix_spawn_file_actions_init(&streams);
  if (problem == 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
      if (problem != 0) break;
      problem = ::posix_spawn_file_actions_addopen(&streams, stream, "/dev/null", O_RDWR, 0);
    }
    pid_t process = 0;
    if (problem == 0) {
      problem = ::posix_spawnp(&process, kOpener, &streams, nullptr, words.data(), environ);
    }
    ::posix_spawn_file_actions_destroy(&streams);
  }
  if (problem == 0) return;
  printWarning(fmt::format("The page is written, but {} cannot be started to open it: {}.", kOpener,
                           std::generic_category().message(problem)));
}

}  // namespace

int view(const ViewArguments& arguments) {
  LongRun longRun(arguments.run, {{"readLagrangeMesh", 2},
                                  {"readMapOrHexMesh", 2},
                                  {"extract", 4},
                                  {"extractLagrange", 4},
                                  {"readMap", 0.05},
                                  {"verify", 2.5},
                                  {"writeViewPage", 10}});
  Context& context = longRun.context();
  const std::filesystem::path page = pageOf(arguments);
  requireAllDifferent({arguments.mesh, arguments.map}, {page.string()});
  requireWritable(page);
  const Subject subject = readSubject(arguments, context);
  std::visit(
      [&](const auto& mesh) { writeViewPage(mesh, page, optionsOf(arguments, subject), context); },
      subject.mesh);
  longRun.finish();
  printWarnings(subject);
  if (!arguments.run.quiet) {
    printFiles(arguments.mesh, page);
    printLine("mesh", counted(subject.cellCount(), "cell"));
    std::error_code unknown;  // a pipe has no size
    const std::uintmax_t bytes = std::filesystem::file_size(page, unknown);
    if (!unknown) printLine("page", bytesAsText(bytes));
    if (!arguments.open) printLine("to see it", "open the page in any browser, or add --open");
  }
  if (arguments.open) openInBrowser(page);
  return subject.agrees() ? kSuccess : kFailure;
}

void requirePage(const std::string& page) {
  if (!page.empty()) requireWritable(page);
}

void writePage(const HexMesh& mesh, const std::string& page, const std::string& output,
               ViewOptions options, Context& context) {
  options.title = nameOf(output);
  writeViewPage(mesh, page, options, context);
}

void writePage(const LagrangeMesh& mesh, const std::string& page, const std::string& output,
               ViewOptions options, Context& context) {
  options.title = nameOf(output);
  writeViewPage(mesh, page, options, context);
}

void writePartPage(const TetMesh& tets, const std::string& page, const std::string& part,
                   const Error& error, LongRun& longRun) {
  if (page.empty() || error.code() != ErrorCode::NotMeshable) return;
  if (error.place().kind == PlaceKind::None) return;
  ViewOptions options;
  options.title = nameOf(part) + ", " + toString(error.place());
  const auto write = [&] {
    longRun.part("page",
                 [&] { writeViewPage(tets, error.place(), page, options, longRun.context()); });
  };
  if (!tryPage(write, longRun)) return;
  longRun.finish();
  printWarning(page + " shows where the part cannot be meshed: region 1.");
}

}  // namespace hexhex::command
