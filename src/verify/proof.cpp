#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <numeric>
#include <string>

#include <verify/cell_checker.hpp>
#include <verify/comparisons.hpp>
#include <verify/proof.hpp>

#include <hexhex/error.hpp>
#include <hexhex/stream.hpp>

#include <base/sorted.hpp>
#include <base/workspaces.hpp>
#include <igm/measures.hpp>

namespace hexhex::verification {

Expectation expectationOf(igm::PreparedMap& map, Stage& stage) {
  adjacency::addStars(map.topology, stage);
  return igm::computeExpectation(map, adjacency::countEdges(map.topology, stage), map.exact.scale);
}

ExpectedElements expectedElements(const Expectation& expected) noexcept {
  // The 12 edges of all cells are regular edges, of four cells or, on the boundary, two, plus
  // singular edges.
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

Proof::Proof(const igm::PreparedMap& map, const Expectation& expected, Stage& stage)
    : map_(map), places_(map, stage), centers_(sweep::findCells(map, stage)), inPieces_(false) {
  requireCounts(expected);
  if (hints_.count() == 0) places_.prove(stage, hints_);
}

Proof::Proof(const igm::PreparedMap& map, const Expectation& expected,
             const sweep::ElementCounts& counts)
    : map_(map),
      places_(map, counts.vertices),
      centers_(map.topology.tetCount(), false),
      inPieces_(true) {
  centers_.begin = counts.cells;
  requireCounts(expected);
}

void Proof::requireCounts(const Expectation& expected) {
  if (places_.count() == expectedElements(expected).vertices &&
      centers_.count() == expected.cells) {
    return;
  }
  hints_.add(0);
}

/// The tets that own a corner of the cells, ascending.
template <class Cell>
std::vector<Index> Proof::ownersOf(std::span<const Cell> cells, Stage& stage) const {
  constexpr std::size_t kGrain = 4096;
  const auto addOwners = [&](std::size_t first, std::size_t end, std::vector<Index>& owners) {
    // Each corner mostly has the owner of that corner of the cell before.
    std::array<Index, 8> latest;
    latest.fill(kNone);
    for (std::size_t c = first; c < end; ++c) {
      for (std::size_t k = 0; k < 8; ++k) {
        const std::uint64_t vertex = cells[c][k];
        if (vertex >= places_.count()) continue;
        if (latest[k] != kNone && places_.owns(latest[k], vertex)) continue;
        latest[k] = places_.ownerOf(vertex);
        owners.push_back(latest[k]);
      }
    }
    sortUnique(owners);
  };
  std::vector<Index> owners = collectFromBlocks<Index>(stage, cells.size(), kGrain, addOwners);
  sortUnique(owners);
  return owners;
}

void Proof::compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage) {
  if (inPieces_) {
    const auto [begin, end] = tetsWith(places_.begin(), first, first + points.size());
    std::vector<Index> owners(end - begin);
    std::iota(owners.begin(), owners.end(), static_cast<Index>(begin));
    places_.proveOnly(owners, stage, hints_);
  }
  places_.compare(first, points, stage, positions_);
}

template <class Cell>
void Proof::compare(std::uint64_t first, std::span<const Cell> cells, Stage& stage) {
  if (inPieces_) places_.proveOnly(ownersOf(cells, stage), stage, hints_);
  const auto [begin, end] = tetsWith(centers_.begin, first, first + cells.size());
  parallelForWith(
      stage, end - begin, sweep::kSweepBlock / 8,
      [&] { return CellChecker<Cell>(map_, centers_, places_, hints_, cells_); },
      [&, begin = begin](std::size_t i, CellChecker<Cell>& checker) {
        checker.prove(static_cast<Index>(begin + i), ConsecutiveCells<Cell>{first, cells});
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
  Proof proof(map, expected, stage);
  if (!proof.passed()) return false;
  proof.compare(0, mesh.points, stage);
  proof.compare(0, std::span<const Hex>(mesh.cells), stage);
  return proof.passed();
}

namespace {

/// Calls visit(begin, end) for stretches of ascending numbers: first own ones, then layers of
/// ghosts.
template <class Visit>
void forEachStretch(std::span<const std::uint64_t> numbers, const Visit& visit) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= numbers.size(); ++i) {
    if (i < numbers.size() && numbers[i - 1] < numbers[i]) continue;
    visit(begin, i);
    begin = i;
  }
}

/// Lists the tets that own numbered items.
/// @param begin  per tet (+1): the first item it owns
void addOwners(const Array<std::uint64_t>& begin, std::span<const std::uint64_t> numbers,
               std::vector<Index>& tets, Faults& wrong) {
  std::uint64_t first = 1;  // past the latest tet
  std::uint64_t end = 0;
  for (const std::uint64_t number : numbers) {
    if (first <= number && number < end) continue;
    if (number >= begin.back()) {
      wrong.add(number);
      continue;
    }
    const auto owner = std::upper_bound(begin.begin(), begin.end(), number) - 1;
    tets.push_back(static_cast<Index>(owner - begin.begin()));
    first = *owner;
    end = *(owner + 1);
  }
}

/// @throws Error VerificationFailed if anything is wrong
void requireNone(const Faults& wrong, std::uint32_t part, const char* what) {
  if (wrong.count() == 0) return;
  throw Error(ErrorCode::VerificationFailed,
              "Part " + std::to_string(part) +
                  " does not agree with the map: " + std::to_string(wrong.count()) + ' ' + what +
                  ", the first with number " + std::to_string(wrong.first()) +
                  ". This is a bug; please report it with the map.");
}

}  // namespace

PartProof::PartProof(const igm::PreparedMap& map, const Expectation& expected,
                     const sweep::ElementCounts& counts)
    : map_(map), places_(map, counts.vertices), centers_(map.topology.tetCount(), false) {
  centers_.begin = counts.cells;
  if (places_.count() == expectedElements(expected).vertices &&
      centers_.count() == expected.cells) {
    return;
  }
  throw Error(ErrorCode::VerificationFailed,
              "There are " + std::to_string(places_.count()) + " vertices and " +
                  std::to_string(centers_.count()) + " cells, not " +
                  std::to_string(expectedElements(expected).vertices) + " and " +
                  std::to_string(expected.cells) +
                  " as the map demands. This is a bug; please report it with the map.");
}

void PartProof::compare(const MeshPart& part, Stage& stage) {
  Faults hints;
  Faults points;
  Faults cells;
  assert(part.mesh.points.size() == part.globalPoints.size());
  assert(part.mesh.cells.size() == part.globalCells.size());
  const std::vector<Index> tets = tetsOf(part, points, cells);
  requireNone(points, part.part, "vertices that there are not");
  requireNone(cells, part.part, "cells that there are not");
  places_.proveOnly(tets, stage, hints);
  requireNone(hints, part.part, "tets with other vertices");
  comparePoints(part, stage, points);
  requireNone(points, part.part, "vertices in other places");
  if (places_.count() < kNone) {
    compareCells<Hex>(part, stage, hints, cells);
  } else {
    compareCells<Hex64>(part, stage, hints, cells);
  }
  requireNone(hints, part.part, "tets with other cells");
  requireNone(cells, part.part, "cells with other corners");
}

/// The tets that own vertices or cells of the part.
std::vector<Index> PartProof::tetsOf(const MeshPart& part, Faults& wrongPoints,
                                     Faults& wrongCells) const {
  std::vector<Index> tets;
  addOwners(places_.begin(), part.globalPoints, tets, wrongPoints);
  addOwners(centers_.begin, part.globalCells, tets, wrongCells);
  sortUnique(tets);
  return tets;
}

void PartProof::comparePoints(const MeshPart& part, Stage& stage, Faults& wrong) const {
  const std::span<const std::uint64_t> numbers(part.globalPoints);
  const std::span<const Vec3> points(part.mesh.points);
  forEachStretch(numbers, [&](std::size_t begin, std::size_t end) {
    places_.compare(numbers.subspan(begin, end - begin), points.subspan(begin, end - begin), stage,
                    wrong);
  });
}

namespace {

/// Cells of a part with ascending numbers, in global numbers of vertices. (Converted one by one, as
/// copies of all take 3 % of an extraction; tetsOf() has seen that the numbers are vertices.)
template <class Cell>
class PartCells {
 public:
  /// @param begin  first of the cells
  /// @param from   the smallest number to be found
  PartCells(const MeshPart& part, std::size_t begin, std::size_t end, std::uint64_t from)
      : part_(part), end_(end) {
    const auto first = part.globalCells.begin();
    next_ =
        static_cast<std::size_t>(std::lower_bound(first + static_cast<std::ptrdiff_t>(begin),
                                                  first + static_cast<std::ptrdiff_t>(end), from) -
                                 first);
  }
  /// The cell with that number, or null. Numbers must be passed in ascending order.
  [[nodiscard]] const Cell* find(std::uint64_t number) noexcept {
    while (next_ < end_ && part_.globalCells[next_] < number) ++next_;
    if (next_ == end_ || part_.globalCells[next_] != number) return nullptr;
    for (std::size_t k = 0; k < 8; ++k) {
      const Index vertex = part_.mesh.cells[next_][k];
      const bool isThere = vertex < part_.globalPoints.size();
      cell_[k] = isThere ? static_cast<Number>(part_.globalPoints[vertex]) : kNoVertex;
    }
    return &cell_;
  }

 private:
  using Number = typename Cell::value_type;
  static constexpr Number kNoVertex = std::numeric_limits<Number>::max();

  const MeshPart& part_;
  std::size_t next_;
  std::size_t end_;
  Cell cell_{};
};

}  // namespace

template <class Cell>
void PartProof::compareCells(const MeshPart& part, Stage& stage, Faults& hints,
                             Faults& wrong) const {
  const std::span<const std::uint64_t> numbers(part.globalCells);
  forEachStretch(numbers, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> tets;
    addOwners(centers_.begin, numbers.subspan(begin, end - begin), tets, wrong);
    parallelForWith(
        stage, tets.size(), 1,
        [&] { return CellChecker<Cell>(map_, centers_, places_, hints, wrong); },
        [&](std::size_t i, CellChecker<Cell>& checker) {
          checker.prove(tets[i], PartCells<Cell>(part, begin, end, centers_.begin[tets[i]]));
        });
  });
}

}  // namespace hexhex::verification
