// Hilbert's curve by the method of Skilling, "Programming the Hilbert curve", AIP Conference
// Proceedings 707 (2004): coordinates are turned into the transposed index bit by bit.
#include <algorithm>
#include <limits>

#include <parts/partition.hpp>

namespace hexhex {

namespace {

constexpr unsigned kBits = 21;  // for each axis: three of them fit 64 bits

/// How far along the curve a place is, in a cube of 2^kBits along each side.
std::uint64_t hilbertIndex(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t kTop = 1U << (kBits - 1);
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1U) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& coordinate : x) {
      if ((coordinate & bit) != 0) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ coordinate) & below;
        x[0] ^= swapped;
        coordinate ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1U) {
    if ((x[2] & bit) != 0) turned ^= bit - 1;
  }
  std::uint64_t index = 0;
  for (unsigned bit = kBits; bit-- > 0;) {
    for (const std::uint32_t coordinate : x) {
      index = index << 1U | (((coordinate ^ turned) >> bit) & 1U);
    }
  }
  return index;
}

}  // namespace

void sortAlongCurve(std::vector<PartitionElement>& elements, Stage& stage) {
  Vec3 low;
  low.fill(std::numeric_limits<double>::infinity());
  double size = 0;
  for (const PartitionElement& element : elements) {
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], element.place[k]);
  }
  for (const PartitionElement& element : elements) {
    for (std::size_t k = 0; k < 3; ++k) size = std::max(size, element.place[k] - low[k]);
  }
  constexpr double kCells = (1U << kBits) - 1;
  const double scale = size > 0 ? kCells / size : 0;
  struct Key {
    std::uint64_t index;
    std::size_t element;
  };
  std::vector<Key> keys(elements.size());
  constexpr std::size_t kGrain = 4096;
  parallelFor(stage, elements.size(), kGrain, [&](std::size_t i) {
    std::array<std::uint32_t, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = (elements[i].place[k] - low[k]) * scale;
      at[k] = static_cast<std::uint32_t>(std::clamp(along, 0.0, kCells));
    }
    keys[i] = {hilbertIndex(at), i};
  });
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.index != b.index ? a.index < b.index : a.element < b.element;
  });
  std::vector<PartitionElement> sorted;
  sorted.reserve(elements.size());
  for (const Key& key : keys) sorted.push_back(elements[key.element]);
  elements = std::move(sorted);
}

}  // namespace hexhex
