// Extraction in pieces, for meshes that need not or cannot fit into memory as a whole.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Corner indices of a hexahedron in a mesh with more vertices than 32 bits can number.
using Hex64 = std::array<std::uint64_t, 8>;

/// Consecutive hex vertices, starting at number `first`.
struct PointPiece {
  std::uint64_t first = 0;
  std::span<const Vec3> points;
  std::span<const Index> generatorTet;          ///< as in HexMesh
  std::span<const CornerSet> generatorCorners;  ///< as in HexMesh
};

/// Receives a mesh in pieces: begin(), then all points in order, then all cells in order, then
/// end(). All calls come from one thread at a time. An exception thrown by a sink ends the
/// extraction and propagates to its caller.
class MeshSink {
 public:
  MeshSink() = default;
  MeshSink(const MeshSink&) = delete;
  MeshSink& operator=(const MeshSink&) = delete;
  virtual ~MeshSink() = default;

  /// @param pointCount, cellCount  totals for the whole mesh
  virtual void begin(std::uint64_t pointCount, std::uint64_t cellCount) = 0;
  virtual void points(const PointPiece& piece) = 0;
  /// Cells starting at number `first`. Called for meshes of up to 2^32 - 2 vertices.
  virtual void cells(std::uint64_t first, std::span<const Hex> cells) = 0;
  /// The same for larger meshes.
  virtual void cells(std::uint64_t first, std::span<const Hex64> cells) = 0;
  virtual void end() = 0;
};

/// Extracts the same mesh as extract(), bit for bit, but passes it on in pieces; always uses the
/// atlas engine. Working memory: as much as a map of this many tets needs, about five bytes per hex
/// vertex, and one piece.
/// @throws Error  as extract(), and whatever the sink throws
void extractTo(MeshSink& sink, const TetMapView& map, const ExtractOptions& options,
               Context& context, ExtractStatistics* statistics = nullptr);

/// The same, to a file: `.vtu` (without the array `scaled_jacobian`) or `.mesh` (without boundary
/// quads). The file appears complete or not at all.
void extractToFile(const std::filesystem::path& file, const TetMapView& map,
                   const ExtractOptions& options, Context& context,
                   ExtractStatistics* statistics = nullptr);

}  // namespace HEXHEX_API_NAMESPACE
