#include <atomic>
#include <cstddef>

#include <base/loop_order.hpp>

namespace hexhex::detail {
namespace {

// Global, so that a thread needs nothing from the caller's stack to get there.
std::atomic<std::size_t> loopsBegun{0};
std::atomic<std::size_t> rangesEnded{0};

}  // namespace

LoopOrder::LoopOrder() noexcept { loopsBegun.fetch_add(1, std::memory_order_release); }
LoopOrder::~LoopOrder() { static_cast<void>(rangesEnded.load(std::memory_order_acquire)); }

RangeOrder::RangeOrder() noexcept { static_cast<void>(loopsBegun.load(std::memory_order_acquire)); }
RangeOrder::~RangeOrder() { rangesEnded.fetch_add(1, std::memory_order_release); }

}  // namespace hexhex::detail
