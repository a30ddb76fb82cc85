// What can be extracted of a map that is not valid: the cells that no defect touches.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct PartialOptions {
  int scale = 1;            ///< as in ExtractOptions
  double tolerance = 1e-2;  ///< likewise
};

/// A place where cells are missing: connected tets that no extracted cells cover completely.
struct Hole {
  Index tet = kNone;  ///< the smallest
  std::uint64_t tets = 0;
  std::uint64_t invalidTets = 0;  ///< flipped, flat, off the lattice, or with no way into them
  Vec3 position{};                ///< in space: the mean of the tets' vertices
  double missingCells = 0;        ///< their parametric volume, what is flipped counting negative,
                                  ///< minus what cells cover: how many cells a valid map would have
};

struct PartialMesh {
  /// Without generators and tags. mesh.regions is 1 for each cell at a hole, which has a face that
  /// neither another cell nor the boundary of the tets is behind, and 0 for the others.
  HexMesh mesh;
  std::vector<Hole> holes;  ///< most missing cells first
  std::uint64_t invalidTets = 0;
  double missingCells = 0;          ///< of all holes
  std::uint64_t faceConflicts = 0;  ///< faces that do not fit: with more than two cells, or two in
                                    ///< the same direction. Zero, unless cells overlap
};

/// Extracts every cell whose whole unit cube lies in valid tets, i.e. in such that are positive on
/// the sanitized lattice, whose corners sanitization hardly moved, and between which transitions
/// hold exactly. Each cell is verified by itself: the pieces of tets in its cube add up to its
/// volume. Time grows with the number of cells times the number of tets that one meets.
///
/// Vertices at holes may exist twice where the tets around them are connected through invalid ones
/// only.
/// @throws Error  if not even the mesh of tets is valid; InvalidArgument; TooLarge; Cancelled
[[nodiscard]] PartialMesh extractPartial(const TetMapView& map, const PartialOptions& options,
                                         Context& context);

}  // namespace HEXHEX_API_NAMESPACE
