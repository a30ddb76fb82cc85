// A look at the tets while they are swept for vertices: further grids take little more then, as all
// of them are points of the grid of half the width. (To sweep anew for the midpoints of edges would
// cost arcs and an extraction together 4 to 8 %.)
#pragma once

#include <cstddef>
#include <utility>

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
#include <lattice/half_grids.hpp>
#include <sweep/tet_lines.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

/// All hex vertices, swept and numbered.
struct SweptVertices {
  TetLines lines;
  VertexNumbers numbers;
};

class SweepObserver {
 public:
  SweepObserver() = default;
  SweepObserver(const SweepObserver&) = delete;
  SweepObserver& operator=(const SweepObserver&) = delete;
  SweepObserver(SweepObserver&&) = delete;
  SweepObserver& operator=(SweepObserver&&) = delete;
  virtual ~SweepObserver() = default;

  /// The grids that it wants to see.
  [[nodiscard]] virtual HalfGridSet grids() const noexcept = 0;
  /// Tets of a block of kSweepBlock in order, blocks in any order and in parallel.
  virtual void add(std::size_t block, Index tet, const HalfGrids& grids) = 0;
  /// At the end.
  virtual void take(SweptVertices vertices) = 0;
};

/// Sweeps all tets for vertices, and numbers these.
/// @param observer  sees every tet, if there is one; the result is the caller's to hand over
[[nodiscard]] SweptVertices sweepVertices(const PreparedMap& map, Stage& stage,
                                          SweepObserver* observer = nullptr);

}  // namespace hexhex
