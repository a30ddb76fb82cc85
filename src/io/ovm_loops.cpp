// Loops of faces, and what every cell has to fulfil (see ovm_cells.hpp).
#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/ovm_cells.hpp>

namespace hexhex {

template <std::size_t n>
OvmLoops<n>::OvmLoops(const OvmTopology& topology, Stage& stage) : loops_(topology.faces.size()) {
  constexpr std::size_t kGrain = 4096;
  parallelFor(stage, loops_.size(), kGrain, [&](std::size_t f) {
    const std::span<const Index> halfEdges = topology.faces[f];
    loops_[f].fill(kNone);
    if (halfEdges.size() != n) return;
    for (std::size_t i = 0; i < n; ++i) {
      loops_[f][i] = topology.from(halfEdges[i]);
      if (topology.to(halfEdges[i]) != topology.from(halfEdges[(i + 1) % n])) {
        loops_[f].fill(kNone);
        return;
      }
    }
  });
}

template <std::size_t n>
void requireProperCells(const OvmTopology& topology, const OvmLoops<n>& loops, std::size_t valence,
                        const std::string& fileName, const char* wanted) {
  const auto fail = [&](std::size_t cell, ErrorCode code, const std::string& sentence) {
    throw Error(code, fileName + ": cell " + std::to_string(cell) + " " + sentence,
                Place{PlaceKind::Cell, cell});
  };
  Array<char> used(2 * topology.faces.size(), 0);
  for (std::size_t c = 0; c < topology.cells.size(); ++c) {
    const std::span<const Index> halfFaces = topology.cells[c];
    if (halfFaces.size() != valence) {
      fail(c, ErrorCode::FileUnsupported,
           "has " + std::to_string(halfFaces.size()) + " faces; here, all cells must be " + wanted +
               " with " + std::to_string(valence) + ".");
    }
    for (const Index halfFace : halfFaces) {
      if (!loops.isGood(halfFace / 2)) {
        fail(c, ErrorCode::FileSyntax,
             "has face " + std::to_string(halfFace / 2) + ", which is no closed loop of " +
                 std::to_string(n) + " half-edges.");
      }
      if (used[halfFace] != 0) {
        fail(c, ErrorCode::FileSyntax,
             "has half-face " + std::to_string(halfFace) +
                 " a second time, or another cell has it. Each side of a face belongs to one "
                 "cell.");
      }
      used[halfFace] = 1;
    }
  }
}

template class OvmLoops<3>;
template class OvmLoops<4>;
template void requireProperCells<3>(const OvmTopology&, const OvmLoops<3>&, std::size_t,
                                    const std::string&, const char*);
template void requireProperCells<4>(const OvmTopology&, const OvmLoops<4>&, std::size_t,
                                    const std::string&, const char*);

}  // namespace hexhex
