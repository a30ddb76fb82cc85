// Does a hexahedral mesh agree with the map that it came from? Independent of how it was made.
#pragma once

#include <string>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// One comparison, e.g. {"cells", "4320", "4319", false}.
struct VerifyItem {
  std::string name;      ///< stable key
  std::string expected;  ///< from the map
  std::string found;     ///< in the mesh
  bool passed = false;
};

struct VerifyReport {
  std::vector<VerifyItem> items;
  [[nodiscard]] bool passed() const noexcept {
    for (const VerifyItem& item : items) {
      if (!item.passed) return false;
    }
    return !items.empty();
  }
};

struct VerifyOptions {
  int scale = 1;            ///< the scale that the mesh was extracted with
  double tolerance = 1e-2;  ///< of the map, as in ExtractOptions
  /// Significant digits of the mesh's coordinates, relative to the largest of them: 1 to 17. 0: 7
  /// if all are single-precision numbers, otherwise 17.
  int digits = 0;
  /// Whether to count faces, edges and components of the mesh as well: a second opinion, which
  /// takes longer than the first.
  bool countElements = false;
};

/// Passes if and only if the mesh is that of the map, up to the numbers of vertices and of cells
/// and the 24 orientations of each cell. Linear time, and memory in proportion to map and mesh.
///
/// A mesh in canonical order is proven right lattice point by lattice point, by code that shares
/// the prepared map with extraction, and no decision; any other one is compared with a mesh that
/// was proven right (docs/verification.md). Vertices at the same place are told apart by their
/// cells.
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options, Context& context);
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
