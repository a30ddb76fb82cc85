// Partial extraction from invalid maps: the cells that no defect touches.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct PartialOptions {
  int scale = 1;            ///< as in ExtractOptions
  double tolerance = 1e-2;  ///< as in ExtractOptions
};

/// A place where cells are missing: connected tets that extracted cells do not cover completely.
struct Hole {
  Index tet = kNone;  ///< the smallest tet of the hole
  std::uint64_t tets = 0;
  std::uint64_t invalidTets = 0;  ///< flipped, flat, off the lattice, or unreachable
  Vec3 position{};                ///< in space: the mean of the tets' vertices
  double missingCells = 0;  ///< expected number of cells in a valid map: the parametric volume of
                            ///< the tets, negative where flipped, minus the volume covered by cells
};

struct PartialMesh {
  /// Has no generators and tags. mesh.regions is 1 for cells at a hole, i.e. with a face that
  /// borders neither another cell nor the boundary of the tets, and 0 for all others.
  HexMesh mesh;
  std::vector<Hole> holes;  ///< in descending order of missing cells
  std::uint64_t invalidTets = 0;
  double missingCells = 0;          ///< sum over all holes
  std::uint64_t faceConflicts = 0;  ///< faces of more than two cells, or of two that list them in
                                    ///< the same direction; 0 unless cells overlap
};

/// Extracts every cell whose unit cube lies entirely in valid tets: tets that are positive on the
/// sanitized lattice, whose corners were hardly moved by sanitization, and between which
/// transitions hold exactly. Each cell is verified individually: the pieces of tets in its cube add
/// up to its volume. Time is proportional to the number of cells times the number of tets per cell.
///
/// Vertices at holes may be duplicated where the tets around them are connected only through
/// invalid tets.
/// @throws Error  if the tet mesh itself is invalid; InvalidArgument; TooLarge; Cancelled
[[nodiscard]] PartialMesh extractPartial(const TetMapView& map, const PartialOptions& options,
                                         Context& context);

}  // namespace HEXHEX_API_NAMESPACE
