// A block complex cut into tets: every block into refine^3 sub-blocks, every sub-block into 12 tets
// around a vertex at its centre. Vertices know their parameters in the chart of each block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <samples/block_complex.hpp>
#include <samples/kinds.hpp>

namespace hexhex::samples {

/// Parameters in units, or coordinates of a block's grid.
using Int3 = std::array<std::int64_t, 3>;

inline Int3 operator+(const Int3& a, const Int3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Int3 operator-(const Int3& a, const Int3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

[[nodiscard]] constexpr std::uint64_t power(std::int64_t base, std::size_t exponent) noexcept {
  std::uint64_t result = 1;
  for (std::size_t i = 0; i < exponent; ++i) result *= static_cast<std::uint64_t>(base);
  return result;
}

/// Parameters are multiples of 2^-16, stored as integers. That is fine enough for 500 sub-blocks
/// along a single hexahedron (131 steps each), and coarse enough for translations of 1e9 and
/// rotations to be exact in double (46 bits).
inline constexpr std::int64_t kUnitsPerCell = 1 << 16;

/// Corners of one of the 12 triangles of a sub-block's surface, counter-clockwise from outside.
using SurfaceTriangle = std::array<std::size_t, 3>;

/// The triangles of a sub-block. Its quads are cut at their smallest vertex, so that neighbours
/// agree on the diagonal. Each triangle makes a positive tet (centre, triangle).
/// @param vertices  of the corners of the sub-block (in the order of BlockCorners)
[[nodiscard]] std::array<SurfaceTriangle, 12> surfaceTriangles(
    const std::array<Index, 8>& vertices);

/// Index of a block's grid point in TetGrid's arrays.
using Slot = std::size_t;

class TetGrid {
 public:
  /// The unperturbed grid.
  /// @param cells   hexahedra along each block edge
  /// @param refine  sub-blocks along each block edge; all indices must fit in 32 bits
  TetGrid(const BlockModel& model, const BlockComplex& complex, int cells, int refine);

  [[nodiscard]] std::int64_t cells() const { return cells_; }
  [[nodiscard]] std::int64_t refine() const { return refine_; }
  [[nodiscard]] std::size_t blockCount() const { return blockCount_; }
  [[nodiscard]] std::size_t subBlocksPerBlock() const { return power(refine_, 3); }
  [[nodiscard]] std::size_t subBlockCount() const { return blockCount_ * subBlocksPerBlock(); }

  /// Number of grid points inside a coarse cell of this dimension.
  [[nodiscard]] std::size_t innerPointCount(std::size_t dimension) const {
    return power(refine_ - 1, dimension);
  }
  /// Grid coordinates, in an occurrence's block, of inner point number `point` of its cell.
  [[nodiscard]] Int3 gridPoint(const Occurrence& occurrence, std::size_t dimension,
                               std::size_t point) const;

  [[nodiscard]] Slot slot(std::size_t block, const Int3& gridPoint) const;
  [[nodiscard]] std::size_t subBlock(std::size_t block, const Int3& lowCorner) const;

  [[nodiscard]] Index centreVertex(std::size_t subBlock) const {
    return static_cast<Index>(gridVertexCount_ + subBlock);
  }
  [[nodiscard]] std::array<Index, 8> cornerVertices(std::size_t subBlock) const;

  /// Parameters of a sub-block's corners, in units, in the chart of its block.
  [[nodiscard]] std::array<Int3, 8> cornerParameters(std::size_t subBlock) const;

  /// Corners of a sub-block relative to its centre: in the block's chart (in units), and in space.
  [[nodiscard]] std::array<Vec3, 8> cornersInMap(std::size_t subBlock) const;
  [[nodiscard]] std::array<Vec3, 8> cornersInSpace(std::size_t subBlock) const;

  std::vector<Index> vertices;         ///< per slot
  std::vector<Int3> parameters;        ///< per slot, in units, in the chart of its block
  std::vector<Int3> centreParameters;  ///< per sub-block, likewise
  std::vector<Vec3> points;            ///< per vertex: the grid's, then the sub-blocks' centres

 private:
  template <class T>
  [[nodiscard]] std::array<T, 8> atCorners(const std::vector<T>& perSlot,
                                           std::size_t subBlock) const;
  /// The slot of corner 0 of a sub-block.
  [[nodiscard]] Slot lowSlot(std::size_t subBlock) const;
  void numberGridVertices(const BlockModel& model, const BlockComplex& complex);
  void placeCentres();
  [[nodiscard]] std::int64_t gridLine(std::int64_t i) const;

  std::int64_t cells_;
  std::int64_t refine_;
  std::size_t blockCount_;
  std::size_t gridVertexCount_ = 0;
  std::array<Slot, 8> cornerOffsets_{};  ///< slots of a sub-block's corners after its low slot
};

}  // namespace hexhex::samples
