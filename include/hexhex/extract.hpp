// From an integer-grid map to a hexahedral mesh.
//
// The algorithm is that of Kohler, Heistermann and Bommes, "HexHex: Highspeed Extraction of
// Hexahedral Meshes", ACM Transactions on Graphics 44 (2025).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/repair.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Two algorithms for the same mesh, bit for bit.
enum class Engine : std::uint8_t {
  Atlas,     ///< reads cells off charts of the map, and traces only those that a cut meets
  Propeller  ///< the paper's algorithm: traces every edge
};

/// What to do with a map that has flipped or flat tets.
enum class RepairMode : std::uint8_t {
  Off,  ///< it is an error
  Auto  ///< it is repaired first, if this build can
};

/// Where the nodes of cells of higher order are that are no hex vertices (extractLagrange()).
enum class CurvedNodes : std::uint8_t {
  /// Those of the boundary, between regions and of tagged edges and quads on the image of the map,
  /// all others blended between them; cells are positive wherever straight ones are, for which some
  /// may leave the surface: ExtractStatistics::straightenedCells.
  Blended,
  Exact  ///< all on the image of the map, also where cells fold over
};

struct ExtractOptions {
  Engine engine = Engine::Atlas;
  /// Multiplies all parameters before extraction: scale^3 times as many cells. At least 1.
  int scale = 1;
  /// Enlargement of tets while candidates of lattice points are enumerated, in parameter units;
  /// never changes the result, only the time. 0 and infinity are legal. Of the propeller engine;
  /// the atlas engine enumerates no candidates. (Section 5.2.3)
  double epsilon = 1e-6;
  /// How far the input may be from fulfilling its integer conditions (transitions, boundary,
  /// singularities), in parameter units before scaling. Below 0.25.
  double tolerance = 1e-2;
  RepairMode repair = RepairMode::Off;
  bool round = false;  ///< as RepairOptions::round, if there is a repair
  CurvedNodes curvedNodes = CurvedNodes::Blended;
};

/// What happened during an extraction.
struct ExtractStatistics {
  double seconds = 0;                     ///< from input arrays to finished arrays
  int threads = 0;                        ///< used
  double epsilon = 0;                     ///< used; 0 with the atlas engine
  bool epsilonFallback = false;           ///< never set: no epsilon is too small
  bool mirrored = false;                  ///< the map reverses orientation
  std::uint64_t tetsInvertedInSpace = 0;  ///< harmless for the extraction, a warning
  double maxDisplacement = 0;             ///< by sanitization, in unscaled parameter units
  double maxTransitionResidual = 0;       ///< of the input, unscaled
  std::uint64_t chartJumps = 0;           ///< inner faces with a non-identity transition
  std::uint64_t innerFaces = 0;
  std::uint64_t singularEdges = 0;            ///< of the tet mesh, inner and boundary
  std::array<std::uint64_t, 4> generators{};  ///< simplices with hex vertices, by kind
  std::array<std::uint64_t, 4> vertices{};    ///< hex vertices by generator kind
  // Of the propeller engine:
  std::uint64_t localPropellers = 0;   ///< extracted, i.e. without the constant cases
  std::uint64_t globalPropellers = 0;  ///< directed hex edges

  // Of the atlas engine:
  std::uint64_t charts = 0;           ///< of the atlas
  std::uint64_t cutFaces = 0;         ///< inner faces of the tet mesh at which a chart ends
  std::uint64_t overlappingTets = 0;  ///< that did not fit their first chart
  std::uint64_t tracedCells = 0;      ///< cells with a corner that their chart does not show

  /// Of cells of higher order, ascending: those whose nodes on the boundary, between regions or of
  /// tags were moved off the image of the map, as the cell or a neighbour was not positive.
  std::vector<Index> straightenedCells;

  RepairReport repair;  ///< changed is false for a map that was valid
  /// The map that was extracted instead, whose mesh it is, and whose tets `generatorTet` means;
  /// null if the map was valid.
  std::shared_ptr<const TetMap> repairedMap;
};

/// Extracts the hexahedral mesh that the map implies. Linear in the number of tets plus the number
/// of hexahedra. The result does not depend on the number of threads.
///
/// Tets may have either orientation in space, as long as neighbours agree; a map that reverses
/// orientation everywhere is mirrored first.
///
/// What map.features tags is carried over to mesh.features, in ascending order of vertices:
///  - hex vertices at tagged tet vertices;
///  - hex edges that start out, from one of their ends, in the interior of a tagged tet edge (their
///    holder, Section 4.2). If tags differ, that at the edge's smaller vertex counts;
///  - hex faces that start out, at one of their corners beside one of their edges, in the interior
///    of a tagged triangle (their casing). If tags differ, that at the smallest vertex counts,
///    there that beside the edge to the smaller neighbour.
/// A tagged edge or triangle that is not in the tet mesh has no effect. Where map.regions is given,
/// mesh.regions has for each cell the region at its centre: that of the smallest tet that contains
/// the centre. Maps without either take no time for it.
///
/// If options.repair is Auto, a map with flipped or flat tets is repaired first (repair.hpp), and
/// the result belongs to statistics->repairedMap. A valid map takes no time for it.
///
/// @throws Error  for every violated condition of an integer-grid map, with its place;
///                InvalidArgument for features with vertices that do not exist or that are listed
///                twice with different tags, and for regions that are not one per tet
/// @param[out] statistics  filled if not null
[[nodiscard]] HexMesh extract(const TetMapView& map, const ExtractOptions& options,
                              Context& context, ExtractStatistics* statistics = nullptr);

/// The same with all cores and without progress.
[[nodiscard]] HexMesh extract(const TetMapView& map, const ExtractOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
