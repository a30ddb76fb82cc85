#include <algorithm>
#include <bit>
#include <cmath>

#include <base/pair.hpp>
#include <lattice/half_grids.hpp>

namespace hexhex {

namespace {

using Four = std::array<double, 4>;

/// Coordinates of a tet's corners from a grid point near corner 0, in halves, by axis.
struct NearCorners {
  std::array<Four, 3> at;
  GridPoint nearby;

  NearCorners(const LatticeTet& corners, std::int64_t unit) noexcept {
    const double perHalf = 2.0 / static_cast<double>(unit);
    const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t grid = corners[0][k] >> shift;
      const std::int64_t zero = grid << shift;
      nearby[k] = static_cast<std::int32_t>(grid);
      for (std::size_t i = 0; i < 4; ++i) {
        at[k][i] = static_cast<double>(corners[i][k] - zero) * perHalf;
      }
    }
  }
};

/// Weights of the four corners, times six volumes.
struct Weights {
  Pair of01;
  Pair of23;

  [[nodiscard]] Weights plus(const Weights& gradient, std::int32_t steps) const noexcept {
    const auto factor = static_cast<double>(steps);
    const Pair factors = {factor, factor};
    return {of01 + gradient.of01 * factors, of23 + gradient.of23 * factors};
  }
  [[nodiscard]] bool anyBelow(double limit) const noexcept {
    const Pair limits = {limit, limit};
    const auto below = (of01 < limits) | (of23 < limits);
    return (below[0] | below[1]) != 0;
  }
};

/// The same as functions of a point.
struct WeightPlanes {
  std::array<Weights, 3> gradient;
  Weights atOrigin;

  explicit WeightPlanes(const std::array<Four, 3>& at) noexcept {
    std::array<std::array<double, 3>, 3> e;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) e[i][k] = at[k][i + 1] - at[k][0];
    }
    const Pair none = {0, 0};
    atOrigin.of01 = none;
    atOrigin.of23 = none;
    double volume = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t m = k == 2 ? 0 : k + 1;
      const std::size_t n = k == 0 ? 2 : k - 1;
      const double g1 = e[1][m] * e[2][n] - e[1][n] * e[2][m];
      const double g2 = e[2][m] * e[0][n] - e[2][n] * e[0][m];
      const double g3 = e[0][m] * e[1][n] - e[0][n] * e[1][m];
      volume += e[0][k] * g1;
      gradient[k].of01 = Pair{-(g1 + g2 + g3), g1};
      gradient[k].of23 = Pair{g2, g3};
      const Pair corner = {at[k][0], at[k][0]};
      atOrigin.of01 -= gradient[k].of01 * corner;
      atOrigin.of23 -= gradient[k].of23 * corner;
    }
    atOrigin.of01 += Pair{volume, 0};
  }
};

}  // namespace

HalfGridSearch::HalfGridSearch(HalfGridSet wanted) : wanted_(wanted), places_(512) {
  for (std::size_t key = 0; key < places_.size(); ++key) {
    const std::array<std::size_t, 3> axes = {key / 64, key / 8 % 8, key % 8};
    for (unsigned place = 0; place < 64; ++place) {
      bool inBox = true;
      unsigned grid = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = (place >> (2 * k)) & 3U;
        inBox = inBox && at <= axes[k] / 2;
        grid |= static_cast<unsigned>((axes[k] + at) & 1U) << k;
      }
      Places& places = places_[key];
      if (inBox && ((wanted >> grid) & 1U) != 0) {
        places.places[places.count++] = static_cast<std::uint8_t>(place);
      }
    }
  }
}

HalfGrids::HalfGrids(const LatticeTet& corners, std::int64_t unit,
                     const HalfGridSearch& search) noexcept
    : corners_(corners), unit_(unit) {
  if (!comparePoints(search)) occupied_ = unsure_ = search.wanted();
}

/// Sets `occupied_`, `unsure_` and `inside_`.
/// @return false if the tet is not small
bool HalfGrids::comparePoints(const HalfGridSearch& search) noexcept {
  const NearCorners near(corners_, unit_);
  std::array<std::int32_t, 3> first;
  std::array<std::int32_t, 3> steps;
  double size = 1;
  bool large = false;
  bool none = false;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr double kOffset = 1024;
    const Four& c = near.at[k];
    const double low = std::min(std::min(c[0], c[1]), std::min(c[2], c[3]));
    const double high = std::max(std::max(c[0], c[1]), std::max(c[2], c[3]));
    size = std::max(size, std::max(high, -low));
    if (!(size < kOffset)) return false;
    // Rounding is monotone, so no point of the exact box is lost, neither here nor by conversions.
    // Conversions to integers truncate, which takes numbers above zero to be rounding down.
    first[k] = static_cast<std::int32_t>(kOffset) - static_cast<std::int32_t>(kOffset - low);
    steps[k] =
        static_cast<std::int32_t>(high + kOffset) - static_cast<std::int32_t>(kOffset) - first[k];
    none |= steps[k] < 0;
    large |= steps[k] >= HalfGridSearch::kSide;
  }
  if (none) return true;
  if (large) return false;
  const HalfGridSearch::Places& places = search.placesIn(first, steps);
  if (places.count == 0) return true;
  const WeightPlanes planes(near.at);
  // Errors in units of 2^-53, with magnitudes: coordinates carry one rounding (size), so edges, up
  // to 2 size, are known to 4 size; their products to 20 size^2, gradients 1 to 3 (8 size^2) to
  // 48 size^2, and gradient 0 (24 size^2) to 184 size^2. Products with coordinates, which are
  // below size, make 24 size^3 each, known to 184 + 24 + 24 = 232 size^3, and the volume 48 size^3,
  // known to 512 size^3. A weight sums seven such terms, six of them 24 size^3 large, in six
  // additions of at most 192 size^3: 6 * 232 + 512 + 6 * 192 < 2^12 size^3. 2^13 covers terms of
  // second order as well.
  const double error = 0x1p-40 * size * size * size;
  for (std::size_t i = 0; i < places.count; ++i) {
    const unsigned place = places.places[i];
    const std::int32_t x = first[0] + static_cast<std::int32_t>(place & 3U);
    const std::int32_t y = first[1] + static_cast<std::int32_t>((place >> 2) & 3U);
    const std::int32_t z = first[2] + static_cast<std::int32_t>(place >> 4);
    const Weights weights = planes.atOrigin.plus(planes.gradient[0], x)
                                .plus(planes.gradient[1], y)
                                .plus(planes.gradient[2], z);
    const auto grid = static_cast<HalfGrid>((x & 1) | (y & 1) << 1 | (z & 1) << 2);
    // Without branches, as what is inside is as good as random.
    const unsigned mayBeInside = weights.anyBelow(-error) ? 0 : halfGridBit(grid);
    const unsigned isUnsure = weights.anyBelow(error) ? mayBeInside : 0;
    inside_[insideCount_] = {
        {near.nearby[0] + (x >> 1), near.nearby[1] + (y >> 1), near.nearby[2] + (z >> 1)}, grid};
    insideCount_ += mayBeInside != 0 ? 1 : 0;
    occupied_ = static_cast<HalfGridSet>(occupied_ | mayBeInside);
    unsure_ = static_cast<HalfGridSet>(unsure_ | isUnsure);
  }
  return true;
}

std::size_t HalfGrids::sortInside(HalfGrid grid, SweepAxes sweepAxes,
                                  SweepPoints& points) const noexcept {
  const std::array<std::uint8_t, 3>& axes = sweepAxes();
  std::size_t count = 0;
  for (std::size_t i = 0; i < insideCount_; ++i) {
    if (inside_[i].grid != grid) continue;
    const GridPoint& z = inside_[i].z;
    const std::array<std::int32_t, 3> point = {z[axes[0]], z[axes[1]], z[axes[2]]};
    std::size_t at = count++;
    for (; at > 0 && point < points[at - 1]; --at) points[at] = points[at - 1];
    points[at] = point;
  }
  return count;
}

GridBox HalfGrids::boxOf(HalfGrid grid) noexcept {
  if (!boxes_) boxes_ = gridBoxes(corners_, unit_);
  GridBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.range[k] = (((grid >> k) & 1) != 0 ? boxes_->centers : boxes_->vertices).range[k];
  }
  return box;
}

LatticeTet HalfGrids::movedBack(HalfGrid grid) const noexcept {
  LatticeTet back = corners_;
  for (LatticePoint& corner : back) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= ((grid >> k) & 1) != 0 ? unit_ / 2 : 0;
  }
  return back;
}

}  // namespace hexhex
