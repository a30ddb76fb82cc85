// The stages behind preprocessing, in a row.
#pragma once

#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/types.hpp>

#include <igm/prepare.hpp>

namespace hexhex {

/// Extracts the mesh of a map that has passed all checks and is scaled. If epsilon turns out to be
/// too small, starts over with infinity, which finds every vertex (Section 5.2.3).
/// @param expectedCells  the map's parametric volume
/// @param[in,out] statistics  receives what the stages count
/// @throws MissingVertex  if vertices are missing even so, which would be a bug
[[nodiscard]] HexMesh runPipeline(const PreparedMap& map, std::uint64_t expectedCells,
                                  double epsilon, Context& context, ExtractStatistics& statistics);

}  // namespace hexhex
