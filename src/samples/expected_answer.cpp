// Counts cells of the coarse complex; everything scales with powers of the cells per block edge.
#include <numeric>
#include <vector>

#include <samples/expected_answer.hpp>

namespace hexhex::samples {

namespace {

/// Counts the classes into which pairs join the members of a set.
class Classes {
 public:
  explicit Classes(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }
  [[nodiscard]] std::size_t root(std::size_t member) const {
    while (parent_[member] != member) member = parent_[member];
    return member;
  }
  [[nodiscard]] bool isRoot(std::size_t member) const { return parent_[member] == member; }

 private:
  std::vector<std::size_t> parent_;
};

std::uint64_t countComponents(const BlockComplex& complex) {
  Classes blocks(complex.blockCount());
  for (const CoarseCell& cell : complex.cells()) {
    if (cell.dimension != 2 || cell.boundary) continue;
    blocks.join(cell.occurrences[0].block, cell.occurrences[1].block);
  }
  std::uint64_t count = 0;
  for (std::size_t block = 0; block < complex.blockCount(); ++block) {
    if (blocks.isRoot(block)) ++count;
  }
  return count;
}

/// Boundary faces are joined where they share an edge.
std::uint64_t countBoundaryComponents(const BlockComplex& complex) {
  const std::vector<CoarseCell>& cells = complex.cells();
  Classes classes(cells.size());
  for (std::size_t face = 0; face < cells.size(); ++face) {
    if (cells[face].dimension != 2 || !cells[face].boundary) continue;
    const Occurrence& occurrence = cells[face].occurrences.front();
    for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
      const BlockPart part = BlockPart::fromCode(code);
      if (part.dimension() != 1 || !occurrence.part.contains(part)) continue;
      classes.join(complex.find(occurrence.block, part).cell, face);
    }
  }
  std::uint64_t count = 0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const bool ofBoundary = cells[cell].boundary && cells[cell].dimension >= 1;
    if (ofBoundary && classes.isRoot(cell)) ++count;
  }
  return count;
}

}  // namespace

SampleAnswer expectedAnswer(const BlockComplex& complex, std::uint64_t cellsPerEdge) {
  SampleAnswer answer;
  Expectation& expected = answer.expected;
  for (const CoarseCell& cell : complex.cells()) {
    std::uint64_t innerVertices = 1;
    for (std::size_t a = 0; a < cell.dimension; ++a) innerVertices *= cellsPerEdge - 1;
    answer.vertices += innerVertices;
    expected.eulerCharacteristic += cell.dimension % 2 == 0 ? 1 : -1;
    if (cell.dimension == 3) expected.cells += cellsPerEdge * cellsPerEdge * cellsPerEdge;
    if (cell.dimension == 2 && cell.boundary) expected.boundaryQuads += cellsPerEdge * cellsPerEdge;
    if (cell.dimension == 1 && cell.singular()) {
      auto& singular = cell.boundary ? expected.boundarySingularEdges : expected.innerSingularEdges;
      singular[cell.valence()] += cellsPerEdge;
    }
  }
  expected.components = countComponents(complex);
  expected.boundaryComponents = countBoundaryComponents(complex);
  return answer;
}

}  // namespace hexhex::samples
