// What `hexhex view` does after its options are known.
#pragma once

#include <string>

#include <hexhex/quantize.hpp>
#include <hexhex/verify.hpp>

#include "long_run.hpp"

namespace hexhex::command {

struct ViewArguments {
  std::string mesh;  ///< or a map, whose mesh is extracted
  std::string page;  ///< empty: the mesh's name with .html
  std::string map;   ///< empty: none
  VerifyOptions options;
  int order = 1;  ///< of the cells that are extracted
  bool quantize = false;
  QuantizeOptions quantizeOptions;
  bool serve = false;
  int port = 0;  ///< 0: any free one
  RunOptions run;
};

/// Writes or serves the page; returns the exit code.
/// @throws Error  FileUnsupported if the command was built without the viewer
int view(const ViewArguments& arguments);

}  // namespace hexhex::command
