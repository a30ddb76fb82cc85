#include <algorithm>
#include <string>

#include <quantize/integers/arc_integers.hpp>

#include <base/sorted.hpp>

namespace hexhex::quantization {

namespace {

[[noreturn]] void failClosed(const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Integers of arcs do not fit together: ") + what + " This is a bug.");
}

}  // namespace

std::vector<ArcEquation> arcEquations(const MotorcycleComplex& complex) {
  std::vector<ArcEquation> equations;
  for (Index p = 0; p < complex.patches.size(); ++p) {
    const Index other = complex.acrossPatch(p);
    if (other != kNone && other < p) continue;
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      std::map<Index, int> sum;
      for (const ArcSide& side : complex.patches[p].border) {
        if (side.axis == axis) sum[side.arc] += side.sign;
      }
      std::erase_if(sum, [](const auto& term) { return term.second == 0; });
      if (sum.empty()) continue;
      const int sign = sum.begin()->second < 0 ? -1 : 1;
      ArcEquation& equation = equations.emplace_back();
      for (const auto& [arc, factor] : sum) equation.emplace_back(arc, sign * factor);
    }
  }
  sortUnique(equations);
  return equations;
}

BlockIntegers::BlockIntegers(const MotorcycleComplex& complex,
                             const std::vector<std::int64_t>& integers)
    : positions_(complex.blockCount), across_(complex.patches.size()) {
  findPositions(complex, integers);
  findTransitions(complex);
}

void BlockIntegers::findPositions(const MotorcycleComplex& complex,
                                  const std::vector<std::int64_t>& integers) {
  // A step along an arc from node to node of a block.
  struct Step {
    lattice::LatticePoint to;
    std::size_t axis;
    std::int64_t by;
  };
  std::vector<std::map<lattice::LatticePoint, std::vector<Step>>> steps(complex.blockCount);
  for (const PatchSide& patch : complex.patches) {
    for (const ArcSide& side : patch.border) {
      const std::int64_t by = side.sign * integers[side.arc];
      steps[patch.block][side.start].push_back({side.end, side.axis, by});
      steps[patch.block][side.end].push_back({side.start, side.axis, -by});
    }
  }
  for (Index block = 0; block < complex.blockCount; ++block) {
    auto& positions = positions_[block];
    const lattice::LatticePoint first = steps[block].begin()->first;
    std::vector<lattice::LatticePoint> queue = {first};
    positions[first] = {};
    lattice::LatticePoint size{};
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const lattice::LatticePoint here = queue[next];
      for (const Step& step : steps[block].at(here)) {
        lattice::LatticePoint there = positions.at(here);
        there[step.axis] += step.by;
        const auto [found, isNew] = positions.emplace(step.to, there);
        if (found->second != there) failClosed("a block does not close up.");
        if (isNew) queue.push_back(step.to);
        for (std::size_t k = 0; k < 3; ++k) size[k] = std::max(size[k], there[k]);
      }
    }
    if (positions.size() != steps[block].size()) failClosed("a block's arcs are not connected.");
    // Starting at the lexicographically first node, a corner of the box, positions are nonnegative.
    cells_ +=
        static_cast<double>(size[0]) * static_cast<double>(size[1]) * static_cast<double>(size[2]);
  }
}

void BlockIntegers::findTransitions(const MotorcycleComplex& complex) {
  for (Index p = 0; p < complex.patches.size(); ++p) {
    const Index other = complex.acrossPatch(p);
    if (other == kNone) continue;
    const PatchSide& here = complex.patches[p];
    const lattice::LatticeMotion real = complex.across(here.first);
    for (const ArcSide& side : here.border) {
      const lattice::LatticePoint from = (*this)(here.block, side.start);
      const lattice::LatticePoint to = (*this)(complex.patches[other].block, real(side.start));
      const auto change = lattice::LatticeMotion::taking(from, to, real.rotation);
      if (&side == &here.border.front()) across_[p] = change;
      if (change != across_[p]) failClosed("the sides of a patch differ.");
    }
  }
}

}  // namespace hexhex::quantization
