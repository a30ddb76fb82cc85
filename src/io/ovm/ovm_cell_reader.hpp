// What tets and hexahedra have in common when they are made of the half-faces that a file lists.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// The cells of a file.
template <std::size_t corners>
class OvmCells {
  using Cell = std::array<Index, corners>;
  static constexpr CellKind kKind = kCellKind<corners>;
  static constexpr std::size_t kFaces = kFaceCount<Cell>;

 public:
  using Loop = std::array<Index, kFaceSize<Cell>>;

  /// @param mesh, fileName  outlive this
  /// @param orders  how many orders of a cell's corners the property CornerOrder numbers
  OvmCells(const OvmMesh& mesh, std::size_t orders, const std::string& fileName, Stage& stage)
      : topology_(mesh.topology),
        cornerOrders_(mesh.properties[OvmInteger::CornerOrder]),
        orders_(orders),
        fileName_(fileName),
        stage_(stage),
        loops_(topology_.faces.size()) {
    parallelFor(stage, loops_.size(), kGrain,
                [this](std::size_t f) { loops_[f] = loopOfFace<kFaceSize<Cell>>(topology_, f); });
  }

  /// The vertices of each face, in loop order, from the half-face 2f on; kNone if it has no closed
  /// loop of as many half-edges.
  [[nodiscard]] std::span<const Loop> loops() const noexcept { return loops_; }

  /// The same of a cell's half-faces.
  [[nodiscard]] std::array<Loop, kFaces> loopsOf(std::size_t cell) const noexcept {
    std::array<Loop, kFaces> loops;
    for (std::size_t s = 0; s < kFaces; ++s) {
      const Index halfFace = topology_.cells[cell][s];
      loops[s] = loopOfHalfFace(loops_[halfFace / 2], halfFace);
    }
    return loops;
  }

  /// The number of the order in which a cell lists its corners; it may be wrong.
  [[nodiscard]] std::size_t orderOf(std::size_t cell) const noexcept {
    return cornerOrders_.empty() ? 0 : static_cast<std::size_t>(cornerOrders_[cell]);
  }

  /// Calls read(cell) for all cells, in parallel. It is false if the half-faces do not bound a cell
  /// or, whatever it means, what belongs to the cell is wrong.
  /// @return the first cell for which it is false, or the number of cells
  /// @throws Error as requireProper()
  template <class Read>
  [[nodiscard]] std::size_t firstUnreadable(const Read& read) const {
    if (topology_.cells.length != kFaces) requireProper();
    Array<char> used(2 * topology_.faces.size(), 0);
    const std::size_t cells = topology_.cells.size();
    const std::size_t fault = firstFault(
        stage_, cells,
        [&](std::size_t c) {
          if (c + kAhead < cells) {
            for (const Index halfFace : topology_.cells[c + kAhead]) {
              prefetch(&used[halfFace]);
              prefetch(&loops_[halfFace / 2]);
            }
          }
          for (const Index halfFace : topology_.cells[c]) {
            std::atomic_ref(used[halfFace]).store(1, std::memory_order_relaxed);
          }
          return read(c);
        },
        kGrain);
    // No half-face occurs twice if as many occur as there are places for them.
    const auto different = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
    if (fault < cells || different < topology_.cells.handles.size()) requireProper();
    return fault;
  }

  /// Throws unless all cells have the right number of half-faces, none is in two cells, and all
  /// have good loops.
  void requireProper() const;

  /// Throws an error about a cell whose half-faces bound none.
  [[noreturn]] void failToBound(std::size_t cell) const {
    throw Error(ErrorCode::FileSyntax,
                fileName_ + ": the half-faces of cell " + std::to_string(cell) +
                    " do not bound a " + std::string(kKind.singular) +
                    ", or its corner order is not from 0 to " + std::to_string(orders_ - 1) + ".",
                Place{kKind.place, cell});
  }

 private:
  static constexpr std::size_t kGrain = 2048;
  /// Faces of a cell may be far from each other in memory, so those of later cells are fetched
  /// ahead: else, reading a mesh with cells in random order takes half as long again.
  static constexpr std::size_t kAhead = 16;

  const OvmTopology& topology_;
  const Array<std::int32_t>& cornerOrders_;
  std::size_t orders_;
  const std::string& fileName_;
  Stage& stage_;
  Array<Loop> loops_;
};

template <std::size_t corners>
void OvmCells<corners>::requireProper() const {
  const auto fail = [&](std::size_t cell, ErrorCode code, const std::string& sentence) {
    throw Error(code, fileName_ + ": cell " + std::to_string(cell) + " " + sentence,
                Place{PlaceKind::Cell, cell});
  };
  Array<char> used(2 * topology_.faces.size(), 0);
  for (std::size_t c = 0; c < topology_.cells.size(); ++c) {
    const std::span<const Index> halfFaces = topology_.cells[c];
    if (halfFaces.size() != kFaces) {
      fail(c, ErrorCode::FileUnsupported,
           "has " + std::to_string(halfFaces.size()) + " faces; here, all cells must be " +
               std::string(kKind.plural) + " with " + std::to_string(kFaces) + ".");
    }
    for (const Index halfFace : halfFaces) {
      if (loops_[halfFace / 2][0] == kNone) {
        fail(c, ErrorCode::FileSyntax,
             "has face " + std::to_string(halfFace / 2) + ", which is no closed loop of " +
                 std::to_string(kFaceSize<Cell>) + " half-edges.");
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

}  // namespace hexhex
