// Arcs of hex edges while the propeller engine follows them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>

#include <hexhex/curved.hpp>

#include <curved/edge_replay.hpp>
#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>
#include <igm/prepare.hpp>
#include <propeller/trace_guest.hpp>

namespace hexhex {

/// Makes the arcs that traceArcs() makes, bit for bit, in the order in which the engine comes to
/// the edges.
class ArcGuest final : public TraceGuest {
 public:
  /// @param withKeys  whether keys() will be asked for
  ArcGuest(const PreparedMap& map, bool withKeys) : map_(map), withKeys_(withKeys) {}

  /// @throws Error TooLarge for more edges than an Index can number
  void begin(const LatticeLines& lines, const TraceSizes& sizes, Stage& stage) override;
  void add(std::size_t block, const FollowedEdges& edges) override;
  void measure(std::size_t firstBlock, std::size_t endBlock) override;
  void place(std::size_t block) override;
  void take(LatticeLines lines) override { lines_ = std::move(lines); }

  // Once, when the engine is done:
  /// @throws Error Internal if edges are missing
  [[nodiscard]] Arcs takeArcs();
  /// Per arc.
  [[nodiscard]] std::span<const EdgeKey> keys() const noexcept { return keys_; }
  [[nodiscard]] LatticeNumbers numbers(Stage& stage) const {
    return {map_, *lines_, vertexCount_, stage};
  }

 private:
  /// For one block of each batch.
  struct Slot {
    Slot(const PreparedMap& map, const LatticeNumbers& vertices) : replay(map, vertices) {}

    EdgeReplay replay;
    // Of the block's arcs, until it is known where they belong; not used by batches of one block.
    Arcs arcs;
    Array<EdgeKey> keys;
    std::size_t arcCount = 0;
    std::size_t pointCount = 0;
    std::uint64_t firstArc = 0;
    std::uint64_t firstPoint = 0;
  };

  /// Whether blocks come one after the other, so that each knows at once where its arcs belong.
  [[nodiscard]] bool isInOrder() const noexcept { return slots_.size() == 1; }

  const PreparedMap& map_;
  bool withKeys_;
  std::uint64_t vertexCount_ = 0;
  std::optional<LatticeNumbers> vertices_;  ///< while the engine works
  std::optional<LatticeLines> lines_;       ///< when it is done
  std::deque<Slot> slots_;
  std::uint64_t arcCount_ = 0;  ///< so far
  std::uint64_t pointCount_ = 0;
  Arcs arcs_;
  Array<EdgeKey> keys_;
};

}  // namespace hexhex
