// `hexhex view` after option parsing, and pages written by other commands.
#pragma once

#include <string>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>
#include <hexhex/view.hpp>

#include "long_run.hpp"
#include "output.hpp"

namespace hexhex::command {

struct ViewArguments {
  std::string mesh;  ///< or a map, whose mesh is extracted
  std::string page;  ///< empty: the mesh's name with .html
  std::string map;   ///< empty: none
  VerifyOptions options;
  int order = 1;  ///< of extracted cells
  CurvedNodes curvedNodes = CurvedNodes::Blended;
  bool quantize = false;
  QuantizeOptions quantizeOptions;
  bool open = false;  ///< in the default browser
  RunOptions run;
  bool hexesOnly = false;
};

/// Writes the page; returns the exit code.
/// @throws Error  FileUnsupported if the command was built without the viewer
int view(const ViewArguments& arguments);

/// Checks that the page can be written; does nothing if the name is empty.
/// @throws Error  FileWrite; FileUnsupported if the command was built without the viewer
void requirePage(const std::string& page);

/// Writes the page of a mesh that a command has made.
/// @param output  the file of the mesh, after which the page is named
void writePage(const HexMesh& mesh, const std::string& page, const std::string& output,
               ViewOptions options, Context& context);
void writePage(const LagrangeMesh& mesh, const std::string& page, const std::string& output,
               ViewOptions options, Context& context);

/// Calls write(), for a page that shows why there is no mesh. That it cannot be written is only a
/// warning: the reason is what matters.
/// @return whether it was written
template <class Write>
bool tryPage(const Write& write, LongRun& longRun) {
  try {
    write();
    return true;
  } catch (const Error& problem) {
    longRun.finish();
    printWarning(std::string("There is no page: ") + problem.what());
    return false;
  }
}

/// Writes the page of a part that could not be meshed, if the error has a place in it, and says so.
/// @param page  empty: none is wanted
void writePartPage(const TetMesh& tets, const std::string& page, const std::string& part,
                   const Error& error, LongRun& longRun);

}  // namespace hexhex::command
