// What the command line says of an extraction.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/team.hpp>

#include "extract_parts.hpp"
#include "long_run.hpp"
#include "patch_names.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

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
  ProcessTeam* team = nullptr;  ///< of which this is one process
  bool partial = false;
  bool noVerify = false;
};

void addExtractOptions(CLI::App& parser, ExtractArguments& arguments);

/// Everything that can be known to fail before long work.
/// @throws Error  for what does not go together, and for files that cannot be written
void requireOutputs(const ExtractArguments& arguments);

}  // namespace hexhex::command
