// Builds the tree bottom-up: each box encloses the next few boxes of the level below.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <base/parallel.hpp>
#include <mesh/tet_locator.hpp>

namespace hexhex {
namespace {

/// Elements per block: a block takes about a tenth of a millisecond.
constexpr std::size_t kGrain = 4096;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A box that encloses nothing.
constexpr Box kEmptyBox = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

/// The smallest box around both.
Box enclose(const Box& a, const Box& b) {
  Box sum;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.lower[k] = std::min(a.lower[k], b.lower[k]);
    sum.upper[k] = std::max(a.upper[k], b.upper[k]);
  }
  return sum;
}

Box boxAround(const TetMapView& map, const Tet& tet) {
  Box box = kEmptyBox;
  for (const Index v : tet) box = enclose(box, {map.points[v], map.points[v]});
  return box;
}

/// The same box, larger on all sides.
Box enlarged(Box box, TetLocator::Margin margin) {
  double size = 0;
  double coordinate = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    size = std::max(size, box.upper[k] - box.lower[k]);
    coordinate = std::max({coordinate, std::abs(box.lower[k]), std::abs(box.upper[k])});
  }
  const double distance =
      margin.ofSize * size + margin.ofCoordinates * coordinate + TetLocator::kLeastMargin;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] -= distance;
    box.upper[k] += distance;
  }
  return box;
}

/// Puts two zero bits before each of the lowest 21 bits.
std::uint64_t spread(std::uint64_t x) {
  // The usual masks: each step moves half of the remaining runs of bits apart.
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

/// Position of the middle of `box` along the Morton curve through the cube with a corner `origin`
/// and 2^21 / perLength as its side.
std::uint64_t mortonCode(const Box& box, const Vec3& origin, double perLength) {
  constexpr double kLargest = 2097151;  // 2^21 - 1
  std::array<std::uint64_t, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = 0.5 * box.lower[k] + 0.5 * box.upper[k];
    const double position = std::clamp((middle - origin[k]) * perLength, 0.0, kLargest);
    cell[k] = static_cast<std::uint64_t>(position);
  }
  return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2;
}

}  // namespace

TetLocator::TetLocator(const TetMapView& map, Margin margin, Stage& stage) {
  levelBegins_.push_back(0);
  std::size_t boxes = 0;
  for (std::size_t n = map.tets.size(); n > 0; n = n == 1 ? 0 : blockCount(n, kFan)) {
    boxes += n;
    levelBegins_.push_back(boxes);
  }
  boxes_.resize(boxes);
  sortTets(map, stage);
  fillTetBoxes(map, margin, stage);
  for (std::size_t level = 1; level + 1 < levelBegins_.size(); ++level) fillLevel(level, stage);
}

void TetLocator::sortTets(const TetMapView& map, Stage& stage) {
  Box all = kEmptyBox;
  for (const Tet& tet : map.tets) all = enclose(all, boxAround(map, tet));
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k) side = std::max(side, all.upper[k] - all.lower[k]);
  const double perLength = side > 0x1p-1000 ? 2097152 / side : 0;  // 2^21; finite

  struct Coded {
    std::uint64_t code;
    Index tet;
  };
  Array<Coded> coded(map.tets.size());
  parallelFor(stage, coded.size(), kGrain, [&](std::size_t t) {
    coded[t] = {mortonCode(boxAround(map, map.tets[t]), all.lower, perLength),
                static_cast<Index>(t)};
  });
  std::sort(coded.begin(), coded.end(), [](const Coded& a, const Coded& b) {
    return a.code != b.code ? a.code < b.code : a.tet < b.tet;
  });
  order_.resize(coded.size());
  parallelFor(stage, coded.size(), kGrain, [&](std::size_t i) { order_[i] = coded[i].tet; });
}

void TetLocator::fillTetBoxes(const TetMapView& map, Margin margin, Stage& stage) {
  parallelFor(stage, order_.size(), kGrain, [&](std::size_t i) {
    boxes_[i] = enlarged(boxAround(map, map.tets[order_[i]]), margin);
  });
}

void TetLocator::fillLevel(std::size_t level, Stage& stage) {
  const std::size_t below = levelBegins_[level - 1];
  const std::size_t begin = levelBegins_[level];
  parallelFor(stage, levelBegins_[level + 1] - begin, kGrain, [&](std::size_t node) {
    Box box = kEmptyBox;
    const std::size_t end = std::min(begin, below + (node + 1) * kFan);
    for (std::size_t i = below + node * kFan; i < end; ++i) box = enclose(box, boxes_[i]);
    boxes_[begin + node] = box;
  });
}

}  // namespace hexhex
