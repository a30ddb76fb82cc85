// Recursive coordinate bisection: Berger and Bokhari, "A partitioning strategy for nonuniform
// problems on multiprocessors", IEEE Transactions on Computers 36 (1987). Elements are cut across
// the longest side of their bounding box, where that balances the cells, and so is each half. Parts
// follow one another along the curve that visits one half before the other. Unlike cuts along
// Hilbert's curve, these follow the shape of the object.
#include <algorithm>
#include <cassert>
#include <limits>

#include <parts/partition.hpp>

namespace hexhex::parts {

namespace {

std::size_t longestAxis(std::span<const PartitionElement> elements) {
  Vec3 low;
  Vec3 high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const PartitionElement& element : elements) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], element.place[k]);
      high[k] = std::max(high[k], element.place[k]);
    }
  }
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[longest] - low[longest]) longest = k;
  }
  return longest;
}

std::uint64_t sumOfCells(std::span<const PartitionElement> elements) {
  std::uint64_t sum = 0;
  for (const PartitionElement& element : elements) sum += element.cells;
  return sum;
}

/// Moves the elements that come first along an axis to the front, with about `cells` cells in all.
/// Repeatedly halves the range that contains the element at the cut, which goes to the front if its
/// middle does.
/// @return  number of elements in front
std::size_t bringToFront(std::span<PartitionElement> elements, std::size_t axis,
                         std::uint64_t cells) {
  const auto before = [axis](const PartitionElement& a, const PartitionElement& b) {
    if (a.place[axis] != b.place[axis]) return a.place[axis] < b.place[axis];
    return a.tet != b.tet ? a.tet < b.tet : a.block < b.block;
  };
  std::size_t front = 0;
  while (elements.size() > 1) {
    const std::size_t half = elements.size() / 2;
    std::nth_element(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(half),
                     elements.end(), before);
    const std::uint64_t ofHalf = sumOfCells(elements.first(half));
    if (cells < ofHalf) {
      elements = elements.first(half);
    } else {
      cells -= ofHalf;
      front += half;
      elements = elements.subspan(half);
    }
  }
  const bool first = !elements.empty() && elements.front().cells <= 2 * cells;
  return front + (first ? 1 : 0);
}

/// @param partOf  of these elements, which get reordered
void cut(std::span<PartitionElement> elements, std::span<std::uint32_t> partOf,
         std::uint32_t firstPart, std::uint32_t parts) {
  if (parts == 1 || elements.empty()) {
    std::fill(partOf.begin(), partOf.end(), firstPart);
    return;
  }
  const std::uint32_t half = parts / 2;
  const auto cells =
      static_cast<std::uint64_t>(lattice::UInt128{sumOfCells(elements)} * half / parts);
  const std::size_t front = bringToFront(elements, longestAxis(elements), cells);
  assert(front <= elements.size());
  cut(elements.first(front), partOf.first(front), firstPart, half);
  cut(elements.subspan(front), partOf.subspan(front), firstPart + half, parts - half);
}

}  // namespace

std::vector<std::uint32_t> bisect(std::vector<PartitionElement>& elements, std::uint32_t parts) {
  assert(parts > 0);
  std::vector<std::uint32_t> partOf(elements.size());
  cut(elements, partOf, 0, parts);
  return partOf;
}

}  // namespace hexhex::parts
