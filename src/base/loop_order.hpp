#pragma once

namespace hexhex::detail {

// oneTBB guarantees that what was written before a loop is seen in it, and what the loop wrote is
// seen after it. The thread sanitizer cannot look into oneTBB, but it understands the same stated
// with these two. They are compiled with the sanitizer, unlike the loops themselves: oneTBB's
// headers touch the caller's stack in ways that only oneTBB orders.

/// Lives while the caller waits for a loop.
struct LoopOrder {
  LoopOrder() noexcept;
  ~LoopOrder();
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;
};

/// Lives while a thread works on a range of blocks.
struct RangeOrder {
  RangeOrder() noexcept;
  ~RangeOrder();
  RangeOrder(const RangeOrder&) = delete;
  RangeOrder& operator=(const RangeOrder&) = delete;
};

}  // namespace hexhex::detail
