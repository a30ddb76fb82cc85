// Axis-aligned bounding boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex {

struct Box {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 low = {kFar, kFar, kFar};  ///< while empty
  Vec3 high = {-kFar, -kFar, -kFar};

  void add(const Vec3& point) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  [[nodiscard]] double diagonal() const noexcept { return length(minus(high, low)); }
};

}  // namespace hexhex
