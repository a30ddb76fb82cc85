// Where the charts of a map differ, and where it is singular: what one wants to see of a map.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// An inner face whose two tets have different charts. Its transition takes parameters u in the
/// chart of tets[0] to R u + t in that of tets[1].
struct ChartJump {
  std::array<Index, 2> tets{};      ///< ascending
  std::array<Index, 3> vertices{};  ///< of the face, in the order of the corners of tets[0]
  std::array<std::array<std::int8_t, 3>, 3> rotation{};  ///< R by rows; one of 24, determinant 1
  std::array<double, 3> translation{};                   ///< t; integers
};

/// An edge of the tet mesh with another number of hexahedra around it than 4 inside, or 2 on the
/// boundary.
struct SingularTetEdge {
  Index vertex0 = 0;  ///< smaller than vertex1
  Index vertex1 = 0;
  std::int32_t valence = 0;
  bool boundary = false;
};

struct MapStructure {
  Array<ChartJump> chartJumps;           ///< by tets[0], then corner opposite the face
  Array<SingularTetEdge> singularEdges;  ///< by vertex0, then vertex1
  /// What is wrong with the map, as check() reports it. What a defect keeps from being found is
  /// left out above.
  std::vector<Defect> defects;
};

/// Finds both, in linear time, also of a map with defects as far as they allow.
/// @param tolerance  as in ExtractOptions
/// @throws Error InvalidArgument for arrays whose sizes do not match and a tolerance out of range
[[nodiscard]] MapStructure findMapStructure(const TetMapView& map, double tolerance,
                                            Context& context);

}  // namespace HEXHEX_API_NAMESPACE
