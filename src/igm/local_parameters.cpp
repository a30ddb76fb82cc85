#include <igm/local_parameters.hpp>

namespace hexhex {

namespace {

/// The smallest step by which charts are moved: maps whose coordinates stay below half of it,
/// nearly all, are not moved at all. It costs ten of the 52 bits of a coordinate.
constexpr double kMinChartGrid = 1024;

/// Beyond, a double has no fractional bits worth the name.
constexpr double kMaxParameter = 0x1p48;

/// Translations between charts are 32-bit integers: with coordinates below this they, and twice
/// them, fit. (Sanitization, which knows the scale, allows no more either.)
constexpr double kMaxLocalParameter = 0x1p28;

}  // namespace

LocalParameters::LocalParameters(const OrientedMap& map) noexcept
    : parameters_(map.view.parameters),
      largest_(map.largestCoordinate),
      largestExtent_(map.largestExtent) {
  tooLarge_ = largest_ > kMaxParameter;
  if (tooLarge_) return;
  grid_ = kMinChartGrid;
  while (grid_ < 4 * map.largestExtent) grid_ *= 2;
  moved_ = largest_ > grid_ / 2;
  if (moved_) largest_ = grid_ / 2 + map.largestExtent;
  tooLarge_ = largest_ > kMaxLocalParameter;
}

const TetParameters& LocalParameters::copyTo(TetParameters& scratch, Index tet) const noexcept {
  scratch = (*this)(tet);
  return scratch;
}

}  // namespace hexhex
