// The block structure and the spatial shape of every kind of sample.
#pragma once

#include <array>
#include <vector>

#include <hexhex/samples.hpp>
#include <hexhex/types.hpp>

#include <samples/block_complex.hpp>

namespace hexhex::samples {

/// Blocks and their shapes. Points are placed by trilinear interpolation between the corners of the
/// block, followed by a warp (which makes round objects round). Block edges are about one unit
/// long.
struct BlockModel {
  std::vector<BlockCorners> blocks;
  std::vector<std::array<Vec3, 8>> shapes;  ///< per block, its corners before the warp
  Vec3 (*warp)(const Vec3&) = nullptr;      ///< null: none

  /// The spatial position of a point of a block with given coordinates in [0, 1]^3.
  [[nodiscard]] Vec3 place(std::size_t block, const Vec3& local) const;
};

/// @param valence  of SampleKind::Star, at least 3; ignored by the others
[[nodiscard]] BlockModel blockModel(SampleKind kind, int valence);

}  // namespace hexhex::samples
