// Extracts a hexahedral mesh from an integer-grid map.
//
// Implements Tobias Kohler, Martin Heistermann and David Bommes, "HexHex: Highspeed Extraction of
// Hexahedral Meshes", ACM Transactions on Graphics 44 (2025).
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/repair.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Two algorithms that produce the same mesh, bit for bit.
enum class Engine : std::uint8_t {
  Atlas,     ///< reads cells from charts of the map and traces only those that meet a cut
  Propeller  ///< the algorithm of the paper: traces every edge
};

/// Placement of the nodes of higher-order cells that are not hex vertices (extractLagrange()).
enum class CurvedNodes : std::uint8_t {
  /// Nodes on the boundary, on region interfaces and on tagged edges and quads lie on the image of
  /// the map; all others are blended between them. A cell is positive wherever its straight
  /// counterpart is. To achieve this, some cells may leave the surface: see
  /// LagrangeMesh::straightenedCells.
  Blended,
  Exact  ///< all nodes lie on the image of the map, even where cells fold over
};

struct ExtractOptions {
  Engine engine = Engine::Atlas;
  /// Factor for all parameters, applied before extraction: yields scale^3 times as many cells. At
  /// least 1.
  int scale = 1;
  /// Maximum violation of the integer conditions (transitions, boundary, singularities) in the
  /// input, in parameter units before scaling. Below 0.25.
  double tolerance = 1e-2;
  /// If not null, a map with flipped or flat tets is repaired first (repair.hpp): receives the
  /// repaired map, to which the mesh belongs, and what it held before is gone. If null, such a map
  /// is an error.
  RepairedMap* repair = nullptr;
  bool round = false;  ///< as RepairOptions::round, if the map is repaired
  CurvedNodes curvedNodes = CurvedNodes::Blended;
};

/// Counts and times of an extraction.
struct ExtractStatistics {
  double seconds = 0;                     ///< from input arrays to finished arrays
  int threads = 0;                        ///< number of threads used
  bool mirrored = false;                  ///< the map reverses orientation
  std::uint64_t tetsInvertedInSpace = 0;  ///< a warning: harmless for extraction
  double maxDisplacement = 0;             ///< caused by sanitization, in unscaled parameter units
  double maxTransitionResidual = 0;       ///< of the input, in unscaled parameter units
  std::uint64_t chartJumps = 0;           ///< inner faces with a non-identity transition
  std::uint64_t innerFaces = 0;
  std::uint64_t singularEdges = 0;            ///< of the tet mesh, interior and boundary
  std::array<std::uint64_t, 4> generators{};  ///< simplices that hold hex vertices, by kind
  std::array<std::uint64_t, 4> vertices{};    ///< hex vertices by kind of generator
  // Propeller engine:
  std::uint64_t localPropellers = 0;   ///< extracted explicitly, excluding the constant cases
  std::uint64_t globalPropellers = 0;  ///< directed hex edges

  // Atlas engine:
  std::uint64_t charts = 0;           ///< in the atlas
  std::uint64_t cutFaces = 0;         ///< interior faces of the tet mesh where a chart ends
  std::uint64_t overlappingTets = 0;  ///< tets that did not fit into their first chart
  std::uint64_t tracedCells = 0;      ///< cells with a corner outside their chart
};

/// Extracts the hexahedral mesh that the map implies, in time linear in the number of tets plus the
/// number of hexahedra. The result does not depend on the number of threads.
///
/// Tets may have either orientation in space, as long as neighbours agree. A map that reverses
/// orientation everywhere is mirrored first.
///
/// Tags in map.features are transferred to mesh.features, in ascending order of vertices:
///  - to hex vertices at tagged tet vertices;
///  - to hex edges that leave one of their ends through the interior of a tagged tet edge (their
///    holder, Section 4.2). If the tags at both ends differ, the one at the smaller vertex wins;
///  - to hex faces that leave one of their corners, beside one of their edges, through the interior
///    of a tagged triangle (their casing). If tags differ, the one at the smallest vertex wins, and
///    there the one beside the edge to the smaller neighbour.
/// Tagged edges and triangles that are not in the tet mesh are ignored. If map.regions is given,
/// mesh.regions holds for each cell the region of the smallest tet that contains its centre. Maps
/// without features and regions incur no cost.
///
/// With options.repair, a map with flipped or flat tets is repaired first, and the mesh is that of
/// options.repair->map. A valid map incurs no cost.
///
/// @throws Error  for every violated condition of an integer-grid map, with its place;
///         InvalidArgument if features name vertices that do not exist or are listed twice with
///         different tags, or if there is not one region per tet
/// @param[out] statistics  filled if not null
[[nodiscard]] HexMesh extract(const TetMapView& map, const ExtractOptions& options,
                              Context& context, ExtractStatistics* statistics = nullptr);

/// The same, with all cores and without progress.
[[nodiscard]] HexMesh extract(const TetMapView& map, const ExtractOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
