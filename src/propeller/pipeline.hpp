// The propeller engine, which is the paper's: its stages behind preprocessing, in a row.
#pragma once

#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/types.hpp>

#include <igm/prepare.hpp>

namespace hexhex::propeller {

/// Extracts the mesh of a map that has passed all checks and is scaled.
/// @param expectedCells  the map's parametric volume
/// @param epsilon        as in ExtractOptions
/// @param[in,out] statistics  receives what the stages count
[[nodiscard]] HexMesh runPipeline(const igm::PreparedMap& map, std::uint64_t expectedCells,
                                  double epsilon, Context& context, ExtractStatistics& statistics);

}  // namespace hexhex::propeller
