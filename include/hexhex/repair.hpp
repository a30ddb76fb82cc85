// Local repair of maps with flipped or flat tets: moves parameters so that the maps can be
// extracted.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct RepairOptions {
  double tolerance = 1e-2;  ///< as in ExtractOptions
  int scale = 1;            ///< upper bound for later scaling of the map
  /// First round boundary and singular coordinates that deviate from integers by more than the
  /// tolerance but less than 0.1.
  bool round = false;
  bool refine = true;  ///< allow splitting tet edges where moving parameters is not enough
};

/// Result of a repair at one place.
struct RepairedRegion {
  Place place;                ///< a bad tet
  Vec3 position{};            ///< in space: the mean of the vertices of the region's bad tets
  std::uint64_t badTets = 0;  ///< flipped or flat before the repair
  std::uint64_t tets = 0;     ///< in the optimized patch
  std::uint64_t movedVertices = 0;
  double largestMove = 0;  ///< largest change of a coordinate, in parameter units
};

struct RepairReport {
  bool changed = false;  ///< false for a valid map, which is returned unchanged
  std::uint64_t badTets = 0;
  std::vector<RepairedRegion> regions;
  std::uint64_t movedVertices = 0;    ///< in all regions
  double largestMove = 0;             ///< in all regions
  std::uint64_t splitEdges = 0;       ///< each split adds a vertex to the tet mesh
  std::uint64_t addedTets = 0;        ///< by these splits
  std::uint64_t roundedVertices = 0;  ///< moved because of RepairOptions::round
  double seconds = 0;
};

/// Receives what an extraction repaired: see ExtractOptions::repair.
struct RepairedMap {
  /// The map from which the mesh was extracted, and to whose tets `generatorTet` refers; null if
  /// the caller's map was valid.
  std::shared_ptr<const TetMap> map;
  RepairReport report;  ///< filled even if the repair fails
};

/// Whether this build supports repair (requires Eigen).
[[nodiscard]] bool canRepair() noexcept;

/// Returns a valid map that differs from the input, bit for bit, only in patches of a few rings of
/// tets around flipped and flat ones. In these patches, parameters are optimized along the
/// coordinates left free by transitions, boundary, singular edges and nodes until all tets are
/// positive (Garanzha et al., "Foldover-free maps in 50 lines of code", 2021). Where that is
/// impossible, edges are split. The result has passed the exact check, and its volume and the
/// singular edges around the patches are those implied by the defective map. Deterministic.
///
/// @throws Error  with the place, for maps with other defects, whose repair would require guessing
///         what was intended; FlippedTet if the repair fails; InvalidArgument if canRepair() is
///         false and the map needs repair
/// @param[out] report  filled if not null, even if an error is thrown
[[nodiscard]] TetMap repair(const TetMap& map, const RepairOptions& options, Context& context,
                            RepairReport* report = nullptr);

/// The same, with all cores and without progress.
[[nodiscard]] TetMap repair(const TetMap& map, const RepairOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
