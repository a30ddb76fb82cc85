#include <algorithm>
#include <bit>

#include <lattice/small_boxes.hpp>

namespace hexhex {

SmallBoxes::SmallBoxes(const LatticeTet& corners, std::int64_t unit) noexcept
    : lattice_(corners), unit_(unit), unitLength_(static_cast<double>(unit)) {
  std::array<Pair, 3> first;   // corners 0 and 1, by axis
  std::array<Pair, 3> second;  // corners 2 and 3
  Pair largest = {unitLength_, unitLength_};
  for (std::size_t k = 0; k < 3; ++k) {
    // Rounded down to a grid point, as the unit is a power of two.
    origin_[k] = corners[0][k] & -unit;
    first[k] = Pair{static_cast<double>(corners[0][k] - origin_[k]),
                    static_cast<double>(corners[1][k] - origin_[k])};
    second[k] = Pair{static_cast<double>(corners[2][k] - origin_[k]),
                     static_cast<double>(corners[3][k] - origin_[k])};
    largest = larger(larger(magnitudeOf(first[k]), magnitudeOf(second[k])), largest);
  }
  // Edges from corner 0: a to corner 1, and of b to corner 2 and c to corner 3 the pairs (c, a) and
  // (a, b), whose cross product is that of the faces opposite corners 2 and 3.
  std::array<double, 3> b;
  std::array<double, 3> c;
  std::array<Pair, 3> ca;
  std::array<Pair, 3> ab;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = first[k][1] - first[k][0];
    b[k] = second[k][0] - first[k][0];
    c[k] = second[k][1] - first[k][0];
    ca[k] = Pair{c[k], a};
    ab[k] = Pair{a, b[k]};
  }
  offsets_ = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    const double normal1 = b[i] * c[j] - b[j] * c[i];
    const Pair normals23 = ca[i] * ab[j] - ca[j] * ab[i];
    // All four add up to zero.
    normals_[k] = {Pair{-(normal1 + normals23[0] + normals23[1]), normal1}, normals23};
    // Corner 1 is on the face opposite corner 0, and corner 0 on all others.
    offsets_[0] -= normals_[k][0] * Pair{first[k][1], first[k][0]};
    offsets_[1] -= normals_[k][1] * first[k][0];
  }
  // With u = 2^-53 and no coordinate of a corner or point above s: corners carry one rounding;
  // edges, up to 2 s long in each axis, are off by 4 u s, components of normals, up to 8 s^2, by
  // 48 u s^2 or, if they are the sum of three, by 168 u s^2. Of a value at a point of the bounding
  // box, that makes 504 u s^3 for the normal at the point, as much and 24 u s^3 more in the offset,
  // and less than 200 u s^3 for the roundings of six products of up to 8 s^3 and of their sums of
  // up to 48 s^3; points are exact. 2^-42 is 2048 u.
  const double size = std::max(largest[0], largest[1]);
  error_ = 0x1p-42 * size * size * size;
}

/// The simplex whose interior contains a point that is outside of no face for certain, and near
/// some: most of them are corners.
CornerMask SmallBoxes::exactSimplexOf(const LatticePoint& point,
                                      const PerFace& values) const noexcept {
  for (std::size_t i = 0; i < 4; ++i) {
    if (lattice_[i] == point) return cornerBit(static_cast<int>(i));
  }
  return simplexBySides([&](std::size_t face) {
    return values[face / 2][face % 2] > error_ ? 1 : sideOfFace(lattice_, face, point);
  });
}

/// Which points of a box are not outside of a face for certain: as bits, the last coordinate
/// changing fastest. Without branches, as each point is as good as random.
std::uint32_t SmallBoxes::candidates(const GridBox& box, std::int64_t shift) const noexcept {
  const auto first = [&](std::size_t axis) {
    return static_cast<double>(box.range[axis].first * unit_ + shift - origin_[axis]);
  };
  const double step = unitLength_;
  const double error = error_;
  std::uint32_t found = 0;
  std::uint32_t bit = 1;
  double x = first(0);
  for (std::int32_t i = box.range[0].first; i <= box.range[0].last; ++i, x += step) {
    const PerFace level = moved(offsets_, normals_[0], x);
    double y = first(1);
    for (std::int32_t j = box.range[1].first; j <= box.range[1].last; ++j, y += step) {
      const PerFace row = moved(level, normals_[1], y);
      double z = first(2);
      for (std::int32_t k = box.range[2].first; k <= box.range[2].last; ++k, z += step) {
        found |= leastOf(moved(row, normals_[2], z)) < -error ? 0 : bit;
        bit <<= 1;
      }
    }
  }
  return found;
}

/// The simplex whose interior contains a candidate.
CornerMask SmallBoxes::simplexOf(const GridPoint& z, std::int64_t shift) const noexcept {
  LatticePoint point{};
  PerFace values = offsets_;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = z[k] * unit_ + shift;
    values = moved(values, normals_[k], static_cast<double>(point[k] - origin_[k]));
  }
  return leastOf(values) > error_ ? kWholeTet : exactSimplexOf(point, values);
}

bool SmallBoxes::append(const GridBox& box, std::int64_t shift,
                        std::vector<SweptLine>& lines) const {
  std::array<std::int32_t, 3> size;
  std::int64_t count = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    size[k] = box.range[k].last - box.range[k].first + 1;
    count *= size[k];
    if (count > kFewPoints) return false;
  }
  const std::uint32_t found = candidates(box, shift);
  if (found == 0) return true;
  const SweepAxes order = chooseSweepAxes(box);
  const std::array<std::uint8_t, 3>& axes = order();
  const std::array<std::int32_t, 3> strides = {size[1] * size[2], size[2], 1};
  GridPoint z{};
  const auto forEach = [&](std::size_t k, const auto& visit) {
    const GridRange range = box.range[axes[k]];
    for (z[axes[k]] = range.first; z[axes[k]] <= range.last; ++z[axes[k]]) {
      visit((z[axes[k]] - range.first) * strides[axes[k]]);
    }
  };
  forEach(0, [&](std::int32_t level) {
    forEach(1, [&](std::int32_t row) {
      SweptLine line{z[axes[0]], z[axes[1]], 0, 0, kNoSimplex, kNoSimplex, order};
      forEach(2, [&](std::int32_t point) {
        if (((found >> (level + row + point)) & 1U) == 0) return;
        const CornerMask simplex = simplexOf(z, shift);
        if (simplex == kNoSimplex) return;
        // Tets are convex: what they have of a line is consecutive.
        if (line.count == 0) {
          line.first = z[axes[2]];
          line.left = simplex;
        }
        ++line.count;
        line.right = simplex;
      });
      if (line.count > 0) lines.push_back(line);
    });
  });
  return true;
}

}  // namespace hexhex
