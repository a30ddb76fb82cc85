// Numbers edges while the atlas engine sweeps the tets for vertices and cells.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include <curved/element_numbers.hpp>
#include <igm/prepare.hpp>
#include <sweep/sweep_observer.hpp>

namespace hexhex {

class EdgeGuest final : public SweepObserver {
 public:
  explicit EdgeGuest(const PreparedMap& map)
      : map_(map), edges_(map, ElementKind::Edges), sweep_(edges_) {}

  [[nodiscard]] HalfGridSet grids() const noexcept override {
    return ElementNumbers::gridsOf(ElementKind::Edges);
  }
  void add(std::size_t block, Index tet, const HalfGrids& grids) override {
    sweep_.add(block, tet, grids);
  }
  void take(SweptVertices vertices) override { vertices_ = std::move(vertices); }

  /// What numberVerticesAndEdges() returns. Once, when the engine is done.
  /// @throws Error TooLarge for more edges than an Index can number
  [[nodiscard]] GridNumbers finish(Stage& stage) {
    sweep_.finish(stage);
    return {LatticeNumbers(map_, std::move(*vertices_), stage), std::move(edges_)};
  }

 private:
  const PreparedMap& map_;
  ElementNumbers edges_;
  ElementNumbers::Sweep sweep_;
  std::optional<SweptVertices> vertices_;
};

}  // namespace hexhex
