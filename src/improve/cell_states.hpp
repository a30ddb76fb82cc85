// Scaled Jacobians and certificates of some cells, straight or curved.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include <hexhex/types.hpp>

#include <improve/curved_cells.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex::improvement {

/// Calls use(cell, CellState) for the cells of a list.
/// @param curved  in place of the cells of the mesh, or null
template <class Use>
void forStates(const HexMesh& mesh, const CurvedCells* curved, std::span<const Index> list,
               CurvedCells::Scratch& scratch, const Use& use) {
  if (curved != nullptr) {
    for (const Index cell : list) use(cell, curved->stateOf(mesh.points, cell, scratch));
    return;
  }
  static const mesh::MeasureCells measure = mesh::measuresOfCells().back();
  mesh::CellMeasures measures;
  std::array<Hex, mesh::CellMeasures::kMost> cells;
  for (std::size_t begin = 0; begin < list.size(); begin += mesh::CellMeasures::kMost) {
    const std::size_t n = std::min(mesh::CellMeasures::kMost, list.size() - begin);
    for (std::size_t i = 0; i < n; ++i) cells[i] = mesh.cells[list[begin + i]];
    measure(mesh.points.data(), std::span(cells).first(n), measures);
    for (std::size_t i = 0; i < n; ++i) {
      const bool certified = measures.inRange[i] != 0 && measures.least[i] > measures.errorOf(i);
      use(list[begin + i], CellState{measures.scaled[i], certified});
    }
  }
}

/// What is kept of the state of a cell: its scaled Jacobian, or less than any if it is not
/// certified.
[[nodiscard]] inline double certifiedQuality(const CellState& state) noexcept {
  constexpr double kNotCertified = -2;
  return state.certified ? state.scaled : kNotCertified;
}
[[nodiscard]] inline bool isCertified(double quality) noexcept { return quality >= -1; }

}  // namespace hexhex::improvement
