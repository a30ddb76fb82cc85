#include <algorithm>
#include <bit>

#include <lattice/triangle_cells.hpp>

namespace hexhex {

namespace {

// Of values, not of references as std::min and std::max, which become branches.
constexpr std::int64_t lesser(std::int64_t a, std::int64_t b) noexcept { return a < b ? a : b; }
constexpr std::int64_t greater(std::int64_t a, std::int64_t b) noexcept { return a < b ? b : a; }

}  // namespace

TriangleCells::TriangleCells(const std::array<LatticePoint, 3>& corners, std::int64_t unit) noexcept
    : triangle_(corners), unit_(unit) {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  const double scale = 1.0 / static_cast<double>(unit);
  std::array<std::array<double, 3>, 3> relative;
  double size = 1;
  cells_ = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t low = lesser(lesser(corners[0][k], corners[1][k]), corners[2][k]);
    const std::int64_t high = greater(greater(corners[0][k], corners[1][k]), corners[2][k]);
    origin_[k] = static_cast<std::int32_t>(low >> shift);
    const std::int64_t origin = std::int64_t{origin_[k]} << shift;
    first_[k] = firstHalfCell(low - origin, shift);
    last_[k] = lastHalfCell(high - origin, shift);
    cells_ = first_[k] > last_[k]
                 ? 0
                 : std::min(cells_ * ((last_[k] >> 1) - (first_[k] >> 1) + 1), kFewCells + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      relative[i][k] = static_cast<double>(corners[i][k] - origin) * scale;
    }
    size = std::max(size, static_cast<double>(high - origin) * scale);
  }
  ways_ = TriangleWays(relative, size);
}

}  // namespace hexhex
