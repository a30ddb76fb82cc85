// Structure of a map, for visualization: where charts change and where the map is singular.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// An inner face between tets with different charts. Its transition maps parameters u in the chart
/// of tets[0] to R u + t in the chart of tets[1].
struct ChartJump {
  std::array<Index, 2> tets{};      ///< ascending
  std::array<Index, 3> vertices{};  ///< of the face, in the order of the corners of tets[0]
  std::array<std::array<std::int8_t, 3>, 3> rotation{};  ///< R, row by row; one of 24, determinant
                                                         ///< 1
  std::array<double, 3> translation{};                   ///< t; integers
};

/// An edge of the tet mesh whose number of hexahedra is not 4 (inside) or 2 (on the boundary).
struct SingularTetEdge {
  Index vertex0 = 0;  ///< smaller than vertex1
  Index vertex1 = 0;
  std::int32_t valence = 0;
  bool boundary = false;
};

struct MapStructure {
  Array<ChartJump> chartJumps;           ///< sorted by tets[0], then corner opposite the face
  Array<SingularTetEdge> singularEdges;  ///< sorted by vertex0, then vertex1
  /// Defects of the map, as reported by check(). Whatever a defect makes impossible to determine is
  /// missing from the lists above.
  std::vector<Defect> defects;
};

/// Finds both in linear time, as far as possible even for a map with defects.
/// @param tolerance  as in ExtractOptions
/// @throws Error InvalidArgument for arrays with mismatched sizes and a tolerance out of range
[[nodiscard]] MapStructure findMapStructure(const TetMapView& map, double tolerance,
                                            Context& context);

}  // namespace HEXHEX_API_NAMESPACE
