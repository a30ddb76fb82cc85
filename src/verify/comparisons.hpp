// Collects what goes into a VerifyReport.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <hexhex/check.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include <base/stage.hpp>

namespace hexhex::verification {

class Comparisons {
 public:
  void add(std::string name, std::string expected, std::string found, bool passed) {
    report_.items.push_back({std::move(name), std::move(expected), std::move(found), passed});
  }

  template <class Number>
  void addEqual(const char* name, Number expected, Number found) {
    add(name, std::to_string(expected), std::to_string(found), expected == found);
  }

  /// Something that must not occur.
  /// @param first  where it first occurs, in words
  void addNone(const char* name, std::uint64_t count, const std::string& first) {
    add(name, "0", count == 0 ? "0" : std::to_string(count) + " (first: " + first + ")",
        count == 0);
  }

  [[nodiscard]] bool passed() const noexcept { return report_.passed(); }
  [[nodiscard]] const VerifyReport& report() const noexcept { return report_; }
  [[nodiscard]] VerifyReport take() { return std::move(report_); }

 private:
  VerifyReport report_;
};

[[nodiscard]] inline std::string vertexName(std::size_t vertex) {
  return "vertex " + std::to_string(vertex);
}
[[nodiscard]] inline std::string cellName(std::size_t cell) {
  return "cell " + std::to_string(cell);
}

// Does a mesh have as many faces, edges and components as its map implies? A second opinion next to
// the proof, based on the mesh alone: faces and edges are identified by their vertices.

/// Compares a mesh, whose corners are in range, with what its map implies. Adds nothing if the map
/// is so coarse that different edges or faces have the same vertices: where cells meet themselves,
/// or meet another cell twice.
void compareSums(const Expectation& expected, const HexMesh& mesh, Stage& stage,
                 Comparisons& comparisons);

}  // namespace hexhex::verification
