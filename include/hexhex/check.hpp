// Diagnosis of a map: its properties, the mesh to expect, and its defects.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// A violated condition: how often, how badly, and the worst places.
struct Defect {
  struct Occurrence {
    Place place;
    double amount = 0;  ///< in parameter units (distance, or signed volume of a flipped tet)
  };
  ErrorCode code = ErrorCode::Internal;
  std::string sentence;           ///< what is wrong and what to do
  std::uint64_t count = 0;        ///< number of all occurrences
  std::vector<Occurrence> worst;  ///< at most ten, worst first
};

/// Properties of the mesh that follow from the map without extraction, for checking the mesh.
struct Expectation {
  std::uint64_t cells = 0;          ///< parametric volume
  std::uint64_t boundaryQuads = 0;  ///< parametric area of the boundary
  /// Number of singular hex edges by valence: the parametric length of singular tet edges.
  std::map<int, std::uint64_t> innerSingularEdges;
  std::map<int, std::uint64_t> boundarySingularEdges;
  std::int64_t eulerCharacteristic = 0;  ///< V - E + F - C
  std::uint64_t components = 0;
  std::uint64_t boundaryComponents = 0;
};

struct CheckReport {
  std::uint64_t points = 0;
  std::uint64_t tets = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
  std::uint64_t boundaryFaces = 0;
  std::uint64_t innerFaces = 0;
  std::uint64_t chartJumps = 0;           ///< inner faces with a non-identity transition
  std::uint64_t isolatedVertices = 0;     ///< a warning: vertices without a tet are ignored
  std::uint64_t tetsInvertedInSpace = 0;  ///< a warning
  bool mirrored = false;                  ///< a notice: the map reverses orientation
  bool cornersReversed = false;  ///< a notice: tets list their corners in negative orientation
  double maxTransitionResidual = 0;
  double maxDisplacement = 0;  ///< caused by sanitization
  /// Number of singular tet edges by valence (number of hexahedra around them).
  std::map<int, std::uint64_t> innerSingularTetEdges;
  std::map<int, std::uint64_t> boundarySingularTetEdges;
  std::uint64_t singularNodes = 0;
  /// Genus of each boundary component, in descending order.
  std::vector<std::int64_t> boundaryGenus;
  std::vector<Defect> defects;  ///< empty for a valid map
  Expectation expected;         ///< only meaningful if there are no defects

  [[nodiscard]] bool valid() const noexcept { return defects.empty(); }
};

struct CheckOptions {
  double tolerance = 1e-2;  ///< as in ExtractOptions
  int scale = 1;            ///< for `expected`
};

/// Checks a map and collects all violated conditions instead of stopping at the first. Throws only
/// for arguments out of range and for cancellation.
[[nodiscard]] CheckReport check(const TetMapView& map, const CheckOptions& options,
                                Context& context);
[[nodiscard]] CheckReport check(const TetMapView& map, const CheckOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
