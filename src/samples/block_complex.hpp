// The coarse hexahedral complex whose cells are the blocks of a sample: which blocks share a
// corner, edge or face, how their frames turn into each other, and what is singular. Its size does
// not depend on the options of a sample, so it uses maps and nested vectors.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/grid_motion.hpp>

namespace hexhex::samples {

/// Corner c of a block is at (c & 1, c >> 1 & 1, c >> 2 & 1) of the unit cube.
using BlockCorners = std::array<Index, 8>;

/// A corner, edge, face or the inside of a block: per axis 0 or 1 (fixed at that end) or 2 (runs
/// along the axis).
struct BlockPart {
  std::array<int, 3> digits{};

  static constexpr int kAlong = 2;
  static constexpr std::size_t kCount = 27;

  [[nodiscard]] static BlockPart fromCode(std::size_t code);
  [[nodiscard]] static BlockPart face(std::size_t axis, int side);
  [[nodiscard]] std::size_t code() const;
  [[nodiscard]] std::size_t dimension() const;
  /// Whether `part` is this part or lies in its closure.
  [[nodiscard]] bool contains(const BlockPart& part) const;
  /// Corners of the block in the closure of this part.
  [[nodiscard]] std::vector<std::size_t> corners() const;
};

/// A coarse cell as seen from one of the blocks around it. Every coarse cell has its own frame (an
/// origin corner and as many axes as its dimension), the same for all blocks.
struct Occurrence {
  std::size_t block = 0;
  BlockPart part;
  std::size_t origin = 0;                    ///< corner of the block
  std::array<lattice::Direction, 3> axes{};  ///< of the cell's frame, in the block's frame
  lattice::Rotation fromFirst;  ///< from the first occurrence's block frame to this one's
};

/// A vertex, edge, face or block of the complex (dimension 0 to 3).
struct CoarseCell {
  std::size_t dimension = 0;
  bool boundary = false;
  std::vector<Occurrence> occurrences;
  /// Axes of the first occurrence's block along which the parameters of an inner point of the cell
  /// may move without violating a condition of integer-grid maps.
  std::array<bool, 3> free = {true, true, true};

  /// Number of blocks around the cell.
  [[nodiscard]] int valence() const { return static_cast<int>(occurrences.size()); }
  /// For an edge: whether its valence is irregular.
  [[nodiscard]] bool singular() const { return valence() != (boundary ? 2 : 4); }
};

/// Location of a part of a block: occurrence `occurrence` of cell `cell`.
struct CellReference {
  std::size_t cell = 0;
  std::size_t occurrence = 0;
};

/// The block on the other side of a face, and the transition from this block's frame to its frame
/// (for blocks that are unit cubes).
struct Neighbour {
  std::size_t block = 0;
  lattice::Transition transition;
};

class BlockComplex {
 public:
  /// @param blocks  right-handed; blocks with the same corners share the part between them
  explicit BlockComplex(std::vector<BlockCorners> blocks);

  [[nodiscard]] std::size_t blockCount() const { return blocks_.size(); }
  /// All cells, sorted by dimension.
  [[nodiscard]] const std::vector<CoarseCell>& cells() const { return cells_; }
  [[nodiscard]] CellReference find(std::size_t block, const BlockPart& part) const {
    return references_[block][part.code()];
  }
  /// The cells on the boundary of a cell, of one dimension less.
  [[nodiscard]] std::vector<std::size_t> sides(std::size_t cell) const;
  /// Empty if the face is on the boundary.
  [[nodiscard]] std::optional<Neighbour> neighbour(std::size_t block, std::size_t axis,
                                                   int side) const;

 private:
  void collectCells();
  void markBoundary();
  void turnStars();
  void restrictFreeAxes();
  [[nodiscard]] Occurrence frameOf(std::size_t block, const BlockPart& part) const;

  std::vector<BlockCorners> blocks_;
  std::vector<CoarseCell> cells_;
  std::vector<std::array<CellReference, BlockPart::kCount>> references_;
};

}  // namespace hexhex::samples
