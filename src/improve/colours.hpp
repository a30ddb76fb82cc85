// Groups of vertices that move at the same time: no two of a group share a cell, so that the result
// does not depend on threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/cell_points.hpp>

namespace hexhex::improvement {

class Colours {
 public:
  explicit Colours(const CellPoints& mesh);

  /// Vertices by their colour, otherwise in the order of the list: each group ends where the next
  /// begins.
  struct Groups {
    std::vector<Index> vertices;
    std::vector<std::size_t> ends;
  };
  [[nodiscard]] Groups groupsOf(std::span<const Index> vertices) const;

 private:
  std::vector<std::uint16_t> colourOf_;  ///< per vertex
  std::size_t count_ = 0;
};

}  // namespace hexhex::improvement
