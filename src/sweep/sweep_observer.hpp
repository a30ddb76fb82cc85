// A look at the tets while an engine sweeps them: further grids take little more then, as all of
// them are points of the grid of half the width.
#pragma once

#include <cstddef>
#include <utility>

#include <hexhex/types.hpp>

#include <lattice/half_grids.hpp>
#include <sweep/tet_lines.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

/// All hex vertices, as an engine has swept and numbered them.
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

}  // namespace hexhex
