// Makes the parts of a mesh independently: from cell counts per tet and a sweep of the part's own
// tets and those that its cells touch.
#pragma once

#include <cstdint>
#include <memory>

#include <hexhex/parts.hpp>

#include <igm/igm.hpp>
#include <sweep/tet_counts.hpp>

namespace hexhex::parts {

/// A map that has passed all checks and is scaled, with the caller's tags.
struct PartsOfMap {
  const igm::PreparedMap& map;
  const TetMapView& source;
  std::uint64_t expectedCells;
  ProcessTeam* team = nullptr;  ///< if not null, all its processes take part in counting
};

class PartMaker {
 public:
  PartMaker() = default;
  PartMaker(const PartMaker&) = delete;
  PartMaker& operator=(const PartMaker&) = delete;
  virtual ~PartMaker() = default;

  [[nodiscard]] virtual PartsInfo info() const = 0;
  [[nodiscard]] virtual const sweep::ElementCounts& counts() const noexcept = 0;
  /// Makes any part, in any order. Thread-safe.
  [[nodiscard]] virtual MeshPart make(std::uint32_t part, Stage& stage) = 0;
};

/// Counts what all tets own, and assigns cells to parts.
/// @param statistics  receives the numbers of vertices and generators
[[nodiscard]] std::unique_ptr<PartMaker> makePartMaker(const PartsOfMap& map,
                                                       const PartOptions& options, Context& context,
                                                       ExtractStatistics& statistics);

}  // namespace hexhex::parts
