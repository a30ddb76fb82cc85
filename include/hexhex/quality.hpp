// Shape quality of hexahedra.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Scaled Jacobian of one hexahedron in [-1, 1]: the smallest of the nine triple products of
/// normalized edge vectors at the eight corners and of the principal axes at the centre (as in the
/// Verdict library, so that ParaView shows the same number). 1 for a cube; 0 if an edge vanishes.
[[nodiscard]] double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept;

/// Scaled Jacobian of every cell.
/// @throws Error InvalidArgument for a corner that is not a vertex of the mesh
[[nodiscard]] Array<double> scaledJacobians(const HexMesh& mesh, Context& context);

struct QualitySummary {
  double minimum = 0;
  double mean = 0;
  std::uint64_t notPositive = 0;              ///< cells with scaled Jacobian <= 0
  std::array<std::uint64_t, 20> histogram{};  ///< of [-1, 1] in steps of 0.1; 1 falls in the last
};

[[nodiscard]] QualitySummary summarize(const Array<double>& scaledJacobians);

}  // namespace HEXHEX_API_NAMESPACE
