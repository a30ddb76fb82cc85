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
  /// The mesh has the right cells and vertices, but different edges or faces of it have the same
  /// vertices: the map is so coarse that a cell meets itself, or another one twice. No comparison
  /// that is about edges or faces says anything then.
  bool ambiguous = false;
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
};

/// Checks in linear time: cells = parametric volume, boundary quads = parametric boundary area,
/// singular hex edges by valence = parametric length of singular tet edges, faces shared by at most
/// two cells in opposite directions, Euler characteristic, components, boundary closed and with as
/// many components as that of the tets, every vertex used, and every vertex on a lattice point
/// (located in the tet mesh; `generatorTet` serves as a hint if the mesh has it).
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options, Context& context);
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
