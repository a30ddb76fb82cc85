// The command line of `hexhex extract`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/team.hpp>

#include "long_run.hpp"
#include "patch_names.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

/// The options for parts.
struct PartsChoice {
  std::optional<std::uint32_t> parts;  ///< empty: one mesh
  PartOptions options;
  bool mpi = false;  ///< join a team even if no other processes are detected

  /// Whether options that require --parts were given.
  [[nodiscard]] bool isOfParts() const noexcept {
    return options.ghostLayers > 0 || options.method != PartitionMethod::Curve;
  }
  [[nodiscard]] PartOptions chosen() const {
    PartOptions result = options;
    result.parts = parts.value_or(1);
    return result;
  }
};

struct ExtractArguments {
  MapSource input;
  std::string output;
  OutputChoice choice;
  std::string report;
  std::string arcs;
  std::string patches;
  std::string page;  ///< empty: none
  int order = 1;
  ExtractOptions options;
  bool repair = true;
  bool quantize = false;
  QuantizeOptions quantizeOptions;
  bool improve = false;
  ImproveOptions improveOptions;
  PatchAngle patchAngle;
  PatchNames names;
  RunOptions run;
  bool stream = false;
  PartsChoice parts;
  ProcessTeam* team = nullptr;  ///< null: a single process
  bool partial = false;
  bool noVerify = false;
};

void addExtractOptions(CLI::App& parser, ExtractArguments& arguments);

/// Detects everything that would fail later, before long work.
/// @throws Error  for incompatible options, and for files that cannot be written
void requireOutputs(const ExtractArguments& arguments);

}  // namespace hexhex::command
