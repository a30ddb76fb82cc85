// Loops of faces, and what every cell has to fulfil (see ovm_cells.hpp).
#include <algorithm>
#include <atomic>
#include <span>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <io/ovm/ovm_cells.hpp>

namespace hexhex {

template <std::size_t n>
OvmLoops<n>::OvmLoops(const OvmTopology& topology, Stage& stage) : loops_(topology.faces.size()) {
  constexpr std::size_t kGrain = 4096;
  // Edges of a face may be far from each other in memory.
  constexpr std::size_t kAhead = 16;
  const OvmLists& faces = topology.faces;
  parallelBlocks(stage, loops_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t f = begin; f < end; ++f) {
                     if (faces.length == n && f + kAhead < end) {
                       for (const Index halfEdge : faces[f + kAhead]) {
                         prefetch(&topology.edges[halfEdge / 2]);
                       }
                     }
                     loops_[f] = loopOfFace<n>(topology, f);
                   }
                 });
}

namespace {

/// Whether all is well: looked at in parallel.
template <std::size_t n>
bool areProperCells(const OvmTopology& topology, const OvmLoops<n>& loops, std::size_t valence,
                    Stage& stage) {
  constexpr std::size_t kGrain = 4096;
  if (topology.cells.length != valence) return false;
  Array<char> used(2 * topology.faces.size());
  std::fill(used.begin(), used.end(), char{0});
  const std::span<const Index> all(topology.cells.handles);
  constexpr std::size_t kAhead = 64;  // faces of a cell may be far from each other in memory
  const std::size_t fault = firstFault(stage, all.size(), [&](std::size_t i) {
    if (i + kAhead < all.size()) {
      prefetch(&used[all[i + kAhead]]);
      prefetch(&loops.ofFace(all[i + kAhead] / 2));
    }
    std::atomic_ref(used[all[i]]).store(1, std::memory_order_relaxed);
    return loops.isGood(all[i] / 2);
  });
  if (fault < all.size()) return false;
  // No half-face occurs twice if as many occur as there are places for them.
  std::atomic<std::size_t> different{0};
  parallelBlocks(stage, used.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::size_t sum = 0;
                   for (std::size_t i = begin; i < end; ++i) sum += used[i] != 0 ? 1U : 0U;
                   different.fetch_add(sum, std::memory_order_relaxed);
                 });
  return different.load() == all.size();
}

}  // namespace

template <std::size_t n>
void requireProperCells(const OvmTopology& topology, const OvmLoops<n>& loops, std::size_t valence,
                        const std::string& fileName, const char* wanted, Stage& stage) {
  if (areProperCells(topology, loops, valence, stage)) return;
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
                                    const std::string&, const char*, Stage&);
template void requireProperCells<4>(const OvmTopology&, const OvmLoops<4>&, std::size_t,
                                    const std::string&, const char*, Stage&);

}  // namespace hexhex
