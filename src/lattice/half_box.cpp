#include <algorithm>
#include <bit>

#include <lattice/half_box.hpp>

namespace hexhex {

HalfBox::HalfBox(const LatticeTet& corners, std::int64_t unit) noexcept {
  const std::int64_t half = unit / 2;
  const int shift = std::countr_zero(static_cast<std::uint64_t>(half));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t low =
        std::min(std::min(corners[0][k], corners[1][k]), std::min(corners[2][k], corners[3][k]));
    const std::int64_t high =
        std::max(std::max(corners[0][k], corners[1][k]), std::max(corners[2][k], corners[3][k]));
    first[k] = static_cast<std::int32_t>((low + half - 1) >> shift);
    steps[k] = static_cast<std::int32_t>(high >> shift) - first[k];
  }
}

}  // namespace hexhex
