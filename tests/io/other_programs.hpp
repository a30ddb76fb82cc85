// How tests ask other programs what they understand of our files: through Python scripts in this
// folder, with the interpreter in HEXHEX_PYTHON, or else python3.
#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include <hexhex/types.hpp>

#include <io/io_test_support.hpp>

namespace hexhex::test {

inline std::string interpreter() {
  const char* const chosen = std::getenv("HEXHEX_PYTHON");
  return chosen != nullptr ? chosen : "python3";
}

/// The exit code of a shell command.
inline int runCommand(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Runs a script of this folder.
/// @return its exit code
inline int runScript(const std::string& name, const std::string& arguments,
                     const std::string& errors) {
  const std::filesystem::path script = std::filesystem::path(__FILE__).parent_path() / name;
  return runCommand(interpreter() + " '" + script.string() + "' " + arguments +
                    " > /dev/null 2> '" + errors + "'");
}

/// Whether an exit code says that the program, or the interpreter, is not installed.
inline bool isMissing(int code) {
  constexpr int kNotInstalled = 77;
  constexpr int kNoCommand = 127;
  return code == kNotInstalled || code == kNoCommand;
}

/// A grid with tagged quads on the boundary and inside, tagged edges and vertices.
inline HexMesh taggedGrid() {
  HexMesh mesh = gridMesh(3, 2, 2);
  const auto vertex = [](Index x, Index y, Index z) { return x + 4 * (y + 3 * z); };
  const auto quadAcrossX = [&](Index x, Index y, Index z) {
    return Quad{vertex(x, y, z), vertex(x, y + 1, z), vertex(x, y + 1, z + 1), vertex(x, y, z + 1)};
  };
  mesh.features.quads = {{quadAcrossX(0, 0, 0), 7},
                         {quadAcrossX(0, 1, 0), 7},
                         {quadAcrossX(3, 1, 1), 3},
                         {quadAcrossX(1, 0, 0), 3}};
  mesh.features.edges = {{{vertex(0, 0, 0), vertex(1, 0, 0)}, 5},
                         {{vertex(1, 0, 0), vertex(2, 0, 0)}, 5}};
  mesh.features.vertices = {{vertex(0, 0, 0), 1}, {vertex(3, 0, 0), 1}, {vertex(3, 2, 2), 2}};
  return mesh;
}

}  // namespace hexhex::test
