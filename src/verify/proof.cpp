#include <verify/cell_prover.hpp>
#include <verify/proof.hpp>

#include <hexhex/stream.hpp>

#include <base/workspaces.hpp>
#include <igm/measures.hpp>

namespace hexhex::verification {

Expectation expectationOf(igm::PreparedMap& map, Stage& stage) {
  adjacency::addStars(map.topology, stage);
  return igm::computeExpectation(map, adjacency::countEdges(map.topology, stage), map.exact.scale);
}

ExpectedElements expectedElements(const Expectation& expected) noexcept {
  // The 12 edges of all cells are regular edges, of four cells or, on the boundary, of two, and
  // singular ones.
  std::uint64_t singular = 0;
  std::uint64_t singularBoundary = 0;
  std::uint64_t cellsAtSingular = 0;
  for (const auto& [valence, count] : expected.innerSingularEdges) {
    singular += count;
    cellsAtSingular += count * static_cast<std::uint64_t>(valence);
  }
  for (const auto& [valence, count] : expected.boundarySingularEdges) {
    singular += count;
    singularBoundary += count;
    cellsAtSingular += count * static_cast<std::uint64_t>(valence);
  }
  const std::uint64_t regularBoundary = 2 * expected.boundaryQuads - singularBoundary;
  const std::uint64_t regularInner =
      (12 * expected.cells - cellsAtSingular - 2 * regularBoundary) / 4;
  ExpectedElements counts;
  counts.edges = singular + regularBoundary + regularInner;
  counts.faces = (6 * expected.cells + expected.boundaryQuads) / 2;
  counts.vertices = static_cast<std::uint64_t>(expected.eulerCharacteristic) + counts.edges +
                    expected.cells - counts.faces;
  return counts;
}

Proof::Proof(const igm::PreparedMap& map, const Expectation& expected, bool indexed, Stage& stage)
    : map_(map), places_(map, indexed, stage), centers_(sweep::findCells(map, stage)) {
  if (places_.count() == expectedElements(expected).vertices &&
      centers_.count() == expected.cells) {
    places_.prove(stage, hints_);
  } else {
    hints_.add(0);
  }
}

template <class Cell>
void Proof::compare(std::uint64_t first, std::span<const Cell> cells, Stage& stage) {
  const auto [begin, end] = tetsWith(centers_.begin, first, first + cells.size());
  parallelForWith(
      stage, end - begin, sweep::kSweepBlock / 8,
      [&] { return CellProver<Cell>(map_, centers_, places_, hints_, cells_); },
      [&, begin = begin](std::size_t i, CellProver<Cell>& prover) {
        prover.prove(static_cast<Index>(begin + i), ConsecutiveCells<Cell>{first, cells});
      });
}
template void Proof::compare(std::uint64_t first, std::span<const Hex> cells, Stage& stage);
template void Proof::compare(std::uint64_t first, std::span<const Hex64> cells, Stage& stage);

bool isProven(const igm::PreparedMap& map, const Expectation& expected, const HexMesh& mesh,
              Stage& stage) {
  if (mesh.cells.size() != expected.cells ||
      mesh.points.size() != expectedElements(expected).vertices) {
    return false;
  }
  Proof proof(map, expected, true, stage);
  if (!proof.passed()) return false;
  proof.compare(0, mesh.points, stage);
  proof.compare(0, std::span<const Hex>(mesh.cells), stage);
  return proof.passed();
}

}  // namespace hexhex::verification
