// Flags that several threads set, in whatever order.
#pragma once

#include <atomic>
#include <cstdint>

namespace hexhex {

/// Sets bits that several threads may set; nearly always, all are set already.
inline void addBits(std::uint8_t& bits, unsigned added) {
  const std::atomic_ref shared(bits);
  if ((shared.load(std::memory_order_relaxed) & added) == added) return;
  shared.fetch_or(static_cast<std::uint8_t>(added), std::memory_order_relaxed);
}

}  // namespace hexhex
