// Coordinates that no text format can hold.
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>

namespace hexhex {

/// The first point with a coordinate that is infinite or no number, or the number of points.
[[nodiscard]] inline std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;  // a fraction of a millisecond's work
  std::atomic<std::size_t> first{points.size()};
  parallelBlocks(stage, points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t i = begin; i < end; ++i) {
                     const Vec3& p = points[i];
                     if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))
                       continue;
                     std::size_t known = first.load(std::memory_order_relaxed);
                     while (i < known && !first.compare_exchange_weak(known, i)) {
                     }
                     return;
                   }
                 });
  return first.load();
}

}  // namespace hexhex
