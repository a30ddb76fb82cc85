// Repairs maps with flipped or flat tets locally, by moving parameters, so that they can be
// extracted.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct RepairOptions {
  double tolerance = 1e-2;  ///< as in ExtractOptions
  int scale = 1;            ///< the map is going to be scaled by at most this
  /// Moves boundary and singular coordinates that are off integers by more than the tolerance, but
  /// by less than 0.1, onto integers first.
  bool round = false;
  bool refine = true;  ///< may split edges of the tet mesh where moving parameters cannot work
};

/// What a repair did to one place.
struct RepairedRegion {
  Place place;                ///< a bad tet
  Vec3 position{};            ///< in space: the mean of the vertices of its bad tets
  std::uint64_t badTets = 0;  ///< flipped or flat, before
  std::uint64_t tets = 0;     ///< in the patch that was optimized
  std::uint64_t movedVertices = 0;
  double largestMove = 0;  ///< of a coordinate, in parameter units
};

struct RepairReport {
  bool changed = false;  ///< false for a valid map: it is left as it is
  std::uint64_t badTets = 0;
  std::vector<RepairedRegion> regions;
  std::uint64_t movedVertices = 0;    ///< of all regions
  double largestMove = 0;             ///< likewise
  std::uint64_t splitEdges = 0;       ///< each adds a vertex to the tet mesh
  std::uint64_t addedTets = 0;        ///< by that
  std::uint64_t roundedVertices = 0;  ///< by RepairOptions::round
  double seconds = 0;
};

/// Whether this build can repair (it was made with Eigen).
[[nodiscard]] bool canRepair() noexcept;

/// Returns a valid map: the same where it was valid, bit for bit, but for patches of a few rings of
/// tets around flipped and flat ones. There, parameters are optimized along the coordinates that
/// transitions, boundary, singular edges and nodes leave free, until all tets are positive
/// (Garanzha et al., "Foldover-free maps in 50 lines of code", 2021). Where that is impossible,
/// edges are split. The result has passed the exact check, and its volume and the singular edges
/// around the patches are those that the defective map implies. Deterministic.
///
/// @throws Error  for maps that have other defects, of which the repair would have to guess what
///                was meant, with their place; FlippedTet if the repair fails; InvalidArgument if
///                canRepair() is false and there is something to repair
/// @param[out] report  filled if not null, also if an error is thrown
[[nodiscard]] TetMap repair(const TetMap& map, const RepairOptions& options, Context& context,
                            RepairReport* report = nullptr);

/// The same with all cores and without progress.
[[nodiscard]] TetMap repair(const TetMap& map, const RepairOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
