// Shape quality of hexahedra, and whether they are valid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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

/// Whether the determinant of a cell's Jacobian matrix is positive everywhere in the closed cell:
/// what a simulation needs. Eight positive corners and the centre do not tell. Proven, by signs
/// that are exact for the coordinates as they are.
enum class Validity : std::uint8_t {
  Positive = 0,  ///< everywhere
  Refuted = 1,   ///< it is negative or zero somewhere, or a coordinate is not finite
  Undecided = 2  ///< it comes closer to zero than a search of bounded length tells
};

/// Certificates say how small the scaled Jacobian becomes in positive cells to within this.
inline constexpr double kMinimumTolerance = 1e-3;

/// What is proven of one cell. Its scaled Jacobian at any place is the determinant divided by the
/// lengths of the columns there.
struct CellCertificate {
  Validity validity = Validity::Undecided;
  double minimum = -1;        ///< the scaled Jacobian is nowhere less
  Vec3 place{};               ///< of the least value that was found: (u, v, w) in [0, 1]^3, u from
                              ///< corner 0 to corner 1, v to corner 3, w to corner 4
  double scaledJacobian = 0;  ///< there; not positive in a refuted cell
};

/// @param corners  in the order of HexMesh
[[nodiscard]] CellCertificate certify(const std::array<Vec3, 8>& corners);

/// A cell that is not positive, and where it is least of what was found.
struct RefutedCell {
  std::uint64_t cell = 0;
  Vec3 place{};               ///< in the cell, as in CellCertificate
  Vec3 position{};            ///< in space
  double scaledJacobian = 0;  ///< there; not positive
};

/// What is proven of a mesh.
struct Certificate {
  Array<double> scaledJacobians;  ///< per cell, as scaledJacobians() returns them
  QualitySummary quality;         ///< of these
  Array<Validity> validity;       ///< per cell
  std::uint64_t positive = 0;     ///< numbers of cells
  std::uint64_t refuted = 0;
  std::uint64_t undecided = 0;
  /// The scaled Jacobian is nowhere less. If all cells are positive, it comes as close to that as
  /// kMinimumTolerance, unless more than a thousand cells compete; otherwise it may be -1.
  double minimum = 0;
  std::vector<RefutedCell> worst;  ///< at most ten, the most negative first

  [[nodiscard]] bool allPositive() const noexcept { return refuted + undecided == 0; }
};

/// Quality and validity of every cell, in one pass.
/// @throws Error InvalidArgument for a corner that is not a vertex of the mesh
[[nodiscard]] Certificate certify(const HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
