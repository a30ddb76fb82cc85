// `hexhex formats`: lists the supported file formats.
#include <string>

#include <fmt/core.h>

#include <hexhex/io.hpp>

#include "command.hpp"

namespace hexhex::command {
namespace {

/// "read, write", "read", "write", or "-".
std::string uses(bool reads, bool writes) {
  if (reads) return writes ? "read, write" : "read";
  return writes ? "write" : "-";
}

std::string notes(const FileFormat& format) {
  std::string text;
  const auto add = [&text](bool holds, const char* note) {
    if (holds) text += (text.empty() ? "" : ", ") + std::string(note);
  };
  add(format.readsTets, "--tets");
  add(format.readsSurfaces, "map, mesh");
  add(format.streams, "--stream");
  add(format.compresses, "--compress");
  return text;
}

void printRow(std::string_view name, std::string_view extension, std::string_view maps,
              std::string_view meshes, std::string_view description, std::string_view options) {
  fmt::print("{:<12} {:<10} {:<12} {:<12} {:<34}{}{}\n", name, extension, maps, meshes, description,
             options.empty() ? "" : " ", options);
}

int run() {
  printRow("name", "extension", "maps", "hex meshes", "what it is", "options");
  for (const FileFormat& format : fileFormats()) {
    printRow(format.name, format.extension.empty() ? "-" : format.extension,
             uses(format.readsMaps, format.writesMaps),
             uses(format.readsHexMeshes, format.writesHexMeshes), format.description,
             notes(format));
  }
  fmt::print(
      "\nWhere several formats have one extension, a file name means the first; --format NAME "
      "writes the\n"
      "others. --tets: tets are read for --tets and --polycube, and by `hexhex map` and `hexhex "
      "mesh`; map,\n"
      "mesh: these fill the surface with tets.\n"
      "\n--for SOLVER writes what a solver reads (docs/user/solvers):\n\n");
  fmt::print("{:<12} {:<14} {:<12} {:<10} {}\n", "solver", "program", "format", "extension",
             "of higher order");
  for (const SolverFormat& solver : solverFormats()) {
    fmt::print("{:<12} {:<14} {:<12} {:<10} {}\n", solver.name, solver.program, solver.format,
               solver.extension, solver.curved.empty() ? "-" : solver.curved);
  }
  return kSuccess;
}

}  // namespace

Command addFormats(CLI::App& app) {
  CLI::App* const parser = app.add_subcommand("formats", "List the file formats");
  parser->footer("Example:\n  hexhex formats");
  return {parser, [] { return run(); }};
}

}  // namespace hexhex::command
