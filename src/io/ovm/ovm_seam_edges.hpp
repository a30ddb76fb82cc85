// The edges between vertices on seams, which cells cannot tell by themselves to be new.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <adjacency/vertex_lists.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Numbers them from 0 on in lexicographic order, the smaller vertex first.
class SeamEdges {
 public:
  /// @param seamCorners  of the cells, as in HexMates
  SeamEdges(std::size_t vertexCount, std::span<const Hex> cells,
            std::span<const std::uint8_t> seamCorners, Stage& stage);

  [[nodiscard]] std::size_t size() const noexcept { return firsts_.back(); }
  /// The half-edge of an edge that there is.
  [[nodiscard]] Index halfEdge(Index from, Index to) const noexcept;
  /// Writes all edges, one after the other.
  void list(std::array<Index, 2>* edges, Stage& stage) const;

 private:
  VertexLists<Index>
      ends_;             ///< per vertex: the larger ones of its edges, ascending, and further ones
  Array<Index> firsts_;  ///< per vertex (+1): the number of its first edge
};

}  // namespace hexhex
