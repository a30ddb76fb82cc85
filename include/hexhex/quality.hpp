// Quality and validity of hexahedra.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Scaled Jacobian of a hexahedron, in [-1, 1]: the smallest of the nine triple products of
/// normalized edge vectors at the eight corners and of the principal axes at the centre (as in the
/// Verdict library, so that ParaView shows the same number). 1 for a cube; 0 if an edge has zero
/// length.
[[nodiscard]] double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept;

/// Scaled Jacobians of all cells.
/// @throws Error InvalidArgument for a corner that is not a vertex of the mesh
[[nodiscard]] Array<double> scaledJacobians(const HexMesh& mesh, Context& context);

struct QualitySummary {
  double minimum = 0;
  double mean = 0;
  std::uint64_t notPositive = 0;              ///< cells with scaled Jacobian <= 0
  std::array<std::uint64_t, 20> histogram{};  ///< of [-1, 1] in steps of 0.1; 1 is in the last
};

[[nodiscard]] QualitySummary summarize(const Array<double>& scaledJacobians);

/// Whether the Jacobian determinant of a cell is positive everywhere in the closed cell, as
/// simulations require. Positive values at the eight corners and the centre do not guarantee this.
/// The proof uses signs that are exact for the given coordinates.
enum class Validity : std::uint8_t {
  Positive = 0,  ///< everywhere
  Refuted = 1,   ///< negative or zero somewhere, or a coordinate is not finite
  Undecided = 2  ///< closer to zero than a search of bounded length can resolve
};

/// Accuracy to which certificates determine the minimum scaled Jacobian of positive cells.
inline constexpr double kMinimumTolerance = 1e-3;

/// What is proven about a cell. Its scaled Jacobian at a point is the determinant divided by the
/// lengths of the columns there.
struct CellCertificate {
  Validity validity = Validity::Undecided;
  double minimum = -1;  ///< proven lower bound of the scaled Jacobian
  Vec3 place{};  ///< where the smallest value was found: (u, v, w) in [0, 1]^3, u from corner 0 to
                 ///< corner 1, v to corner 3, w to corner 4
  double scaledJacobian = 0;  ///< the value there; not positive in a refuted cell
};

/// @param corners  in the order of HexMesh
[[nodiscard]] CellCertificate certify(const std::array<Vec3, 8>& corners);

/// A cell that is not positive, and where its smallest value was found.
struct RefutedCell {
  std::uint64_t cell = 0;
  Vec3 place{};               ///< in the cell, as in CellCertificate
  Vec3 position{};            ///< in space
  double scaledJacobian = 0;  ///< the value there; not positive
};

/// What is proven about a mesh.
struct Certificate {
  Array<double> scaledJacobians;  ///< per cell, as returned by scaledJacobians()
  QualitySummary quality;         ///< summary of these
  Array<Validity> validity;       ///< per cell
  std::uint64_t positive = 0;     ///< number of cells
  std::uint64_t refuted = 0;
  std::uint64_t undecided = 0;
  /// Proven lower bound of the scaled Jacobian. If all cells are positive, the bound is tight to
  /// within kMinimumTolerance unless more than a thousand cells compete for it; otherwise it may be
  /// -1.
  double minimum = 0;
  std::vector<RefutedCell> worst;  ///< at most ten, most negative first

  [[nodiscard]] bool allPositive() const noexcept { return refuted + undecided == 0; }
};

/// Computes quality and validity of every cell in a single pass.
/// @throws Error InvalidArgument for a corner that is not a vertex of the mesh
[[nodiscard]] Certificate certify(const HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
