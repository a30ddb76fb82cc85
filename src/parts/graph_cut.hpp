// Parts by METIS or Scotch, which are loaded when they are asked for.
#pragma once

#include <cstdint>
#include <vector>

#include <parts/partition.hpp>

namespace hexhex::parts {

/// Cuts the graph of elements, weighted by cells, whose edges are weighted by the faces of cells
/// between them, about.
/// @return  per element: its part
/// @throws Error InvalidArgument if the library is not there, is built for other integers, or
/// fails;
///         TooLarge for a graph beyond its integers
[[nodiscard]] std::vector<std::uint32_t> cutGraph(const igm::PreparedMap& map,
                                                  const Partition& partition,
                                                  const std::vector<PartitionElement>& elements,
                                                  PartitionMethod method);

}  // namespace hexhex::parts
