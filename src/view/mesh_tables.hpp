// A mesh as the tables of a page: integers, packed as differences, byte planes, zlib. The
// counterpart is decodeChunk() in viewer/src/format.ts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::view {

/// A table in compressed chunks of consecutive rows.
struct PackedTable {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t rowsPerChunk = 0;
  bool byRows = false;  ///< whether numbers are packed row by row; otherwise column by column
  std::vector<std::string> chunks;  ///< one zlib stream each
};

/// Writes the numbers of rows [begin, end), row by row, to `to`. Called from several threads.
using FillRows = std::function<void(std::size_t begin, std::size_t end, std::uint32_t* to)>;

/// Packs a table. Consecutive rows should be similar. The result does not depend on the number of
/// threads.
[[nodiscard]] PackedTable packTable(std::string_view name, std::size_t rows, std::size_t columns,
                                    const FillRows& fill, Stage& stage);

/// The base64 encoding (RFC 4648) of bytes.
[[nodiscard]] std::string toBase64(std::string_view bytes);

/// What a page needs of higher-order cells: the nodes on their faces, except those at corners. They
/// are numbered after the hex vertices, in the order in which cells first name them.
struct SurfaceNodes {
  int order = 1;
  Array<Vec3> points;
  std::size_t perCell = 0;  ///< (p + 1)^3 - (p - 1)^3 - 8
  /// `perCell` numbers per cell: the nodes (i, j, k) of LagrangeMesh with an index that is 0 or p,
  /// but not all three, in the same order. As in viewer/src/curves.ts.
  Array<Index> numbers;
};

/// @throws Error  as requireConsistent() of the mesh
[[nodiscard]] SurfaceNodes surfaceNodesOf(const LagrangeMesh& mesh);

/// The quality of the cells.
struct CellQuality {
  std::span<const double> scaledJacobians;
  std::vector<Index> notPositive = {};  ///< cells without certificate, ascending
};

/// The same mesh before improvement. Without points, the page shows a single state.
struct StateBefore {
  std::span<const Vec3> points;  ///< of the vertices
  std::span<const Vec3> nodes;   ///< in the order of SurfaceNodes::points
  CellQuality quality = {};
};

/// Quantization of coordinates: coordinate = lower + step * number, with the same step on all axes.
struct Quantization {
  Vec3 lower{};
  Vec3 upper{};
  double step = 1;
};

/// The smallest box around the vertices and nodes of both states, with 2^20 - 1 steps along its
/// longest side.
/// @throws Error NotFinite; TooLarge if the longest side exceeds the largest double
[[nodiscard]] Quantization quantizationOf(const HexMesh& mesh, const SurfaceNodes& nodes = {},
                                          const StateBefore& before = {});

/// Scaled Jacobians in 16 bits: 0 stands for -1, this for 1. As in viewer/src/format.ts.
inline constexpr double kQualitySteps = 65534;

/// Tables `points` (3 columns: vertices, then nodes), `cells` (8), `quality` (1), `skin` (1: the
/// faces of the boundary, 6 * cell + face), `skin_patches` (1: their groups) and, where the mesh
/// has them, `nodes` (SurfaceNodes::perCell), `generator_kinds` (1), `regions` (1),
/// `singular_edges` (vertex, vertex, 2 * valence + (1 on the boundary)), `feature_edges` (vertex,
/// vertex, tag), `feature_quads` (4 vertices, tag), `not_positive` (1), `points_before` (3: what is
/// to be added to `points`, modulo 2^32), `quality_before` (1) and `not_positive_before` (1).
[[nodiscard]] std::vector<PackedTable> packMesh(
    const HexMesh& mesh, const Quantization& quantization, const CellQuality& quality,
    std::span<const SingularHexEdge> singularEdges, Stage& stage, const SurfaceNodes& nodes = {},
    const StateBefore& before = {}, std::span<const std::uint32_t> skinPatches = {});

}  // namespace hexhex::view
