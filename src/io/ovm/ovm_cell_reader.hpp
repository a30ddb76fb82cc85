// What tets and hexahedra have in common when they are made of the half-faces that a file lists.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/low_level.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {

/// Makes cells of what was read.
/// @tparam orders  how many orders of a cell's corners the property CornerOrder numbers
template <std::size_t corners, std::size_t orders>
class OvmCellReader {
  using Cell = std::array<Index, corners>;
  static constexpr CellKind kKind = kCellKind<corners>;
  static constexpr std::size_t kFaces = adjacency::kFaceCount<Cell>;
  static constexpr std::size_t kFaceCorners = adjacency::kFaceSize<Cell>;

 public:
  /// @param fileName  outlives this
  OvmCellReader(OvmMesh&& mesh, const std::string& fileName, Stage& stage)
      : mesh_(std::move(mesh)),
        topology_(mesh_.topology),
        properties_(mesh_.properties),
        fileName_(fileName),
        stage_(stage),
        loops_(topology_.faces.size()) {
    parallelFor(stage, loops_.size(), kGrain,
                [this](std::size_t f) { loops_[f] = loopOfFace<kFaceCorners>(topology_, f); });
  }

 protected:
  /// Calls read(cell, loops of its half-faces, number of its corner order) for all cells, in
  /// parallel. It is false if these do not bound a cell, or what belongs to the cell is wrong.
  /// @return the first cell for which it is false, or the number of cells
  /// @throws Error as requireProper()
  template <class Read>
  [[nodiscard]] std::size_t firstUnreadable(const Read& read) const {
    if (topology_.cells.length != kFaces) requireProper();
    Array<char> used(2 * topology_.faces.size(), 0);
    const std::size_t cells = topology_.cells.size();
    const auto isGood = [&](std::size_t c) {
      if (c + kAhead < cells) {
        for (const Index halfFace : topology_.cells[c + kAhead]) {
          prefetch(&used[halfFace]);
          prefetch(&loops_[halfFace / 2]);
        }
      }
      for (const Index halfFace : topology_.cells[c]) {
        std::atomic_ref(used[halfFace]).store(1, std::memory_order_relaxed);
      }
      return readCell(c, read);
    };
    const std::size_t fault = firstFault(stage_, cells, isGood, kGrain);
    // No half-face occurs twice if as many occur as there are places for them.
    const auto different = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
    if (fault < cells || different < topology_.cells.handles.size()) requireProper();
    return fault;
  }

  /// Calls read() for one cell.
  template <class Read>
  bool readCell(std::size_t cell, const Read& read) const {
    std::array<std::array<Index, kFaceCorners>, kFaces> loops;
    for (std::size_t s = 0; s < kFaces; ++s) {
      const Index halfFace = topology_.cells[cell][s];
      loops[s] = loopOfHalfFace(loops_[halfFace / 2], halfFace);
    }
    const Array<std::int32_t>& numbers = properties_[OvmInteger::CornerOrder];
    const auto order = static_cast<std::size_t>(numbers.empty() ? 0 : numbers[cell]);
    return order < orders && read(cell, loops, order);
  }

  /// Throws unless all cells have the right number of half-faces, none is in two cells, and all
  /// have good loops.
  void requireProper() const {
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
        if (!isGoodFace(halfFace / 2)) {
          fail(c, ErrorCode::FileSyntax,
               "has face " + std::to_string(halfFace / 2) + ", which is no closed loop of " +
                   std::to_string(kFaceCorners) + " half-edges.");
        }
        if (std::exchange(used[halfFace], 1) != 0) {
          fail(c, ErrorCode::FileSyntax,
               "has half-face " + std::to_string(halfFace) +
                   " a second time, or another cell has it. Each side of a face belongs to one "
                   "cell.");
        }
      }
    }
  }

  /// Throws an error about a cell whose half-faces bound none.
  [[noreturn]] void failToBound(std::size_t cell) const {
    throw Error(ErrorCode::FileSyntax,
                fileName_ + ": the half-faces of cell " + std::to_string(cell) +
                    " do not bound a " + std::string(kKind.singular) +
                    ", or its corner order is not from 0 to " + std::to_string(orders - 1) + ".",
                Place{kKind.place, cell});
  }

  /// @param faces  those of `features`
  template <class Features, class FaceFeature>
  void readFeatures(Features& features, std::vector<FaceFeature>& faces) const {
    forEachTag(OvmInteger::FeatureVertices, [&](std::size_t v, std::int32_t tag) {
      features.vertices.push_back({static_cast<Index>(v), tag});
    });
    forEachTag(OvmInteger::FeatureEdges, [&](std::size_t e, std::int32_t tag) {
      features.edges.push_back({topology_.edges[e], tag});
    });
    forEachTag(OvmInteger::FeatureFaces, [&](std::size_t f, std::int32_t tag) {
      if (!isGoodFace(f)) {
        throw Error(ErrorCode::FileSyntax,
                    fileName_ + ": face " + std::to_string(f) +
                        " is tagged as a feature, but is no closed loop of " +
                        std::to_string(kFaceCorners) + " half-edges.");
      }
      faces.push_back({loops_[f], tag});
    });
  }

  /// Calls f(element, value) for all elements with a value other than 0.
  template <class F>
  void forEachTag(OvmInteger property, const F& f) const {
    const Array<std::int32_t>& tags = properties_[property];
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] != 0) f(i, tags[i]);
    }
  }

  OvmMesh mesh_;
  const OvmTopology& topology_;
  const OvmProperties& properties_;
  const std::string& fileName_;
  Stage& stage_;

 private:
  static constexpr std::size_t kGrain = 2048;
  /// Faces of a cell may be far from each other in memory, so those of later cells are fetched
  /// ahead: else, reading a mesh with cells in random order takes half as long again.
  static constexpr std::size_t kAhead = 16;

  [[nodiscard]] bool isGoodFace(std::size_t face) const { return loops_[face][0] != kNone; }

  /// The vertices of each face, in loop order, from the half-face 2f on; kNone if it has no closed
  /// loop of as many half-edges.
  Array<std::array<Index, kFaceCorners>> loops_;
};

}  // namespace hexhex::io
