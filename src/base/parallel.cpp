#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/loop_order.hpp>
#include <base/parallel.hpp>

#if HEXHEX_HAS_TBB
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace hexhex {

namespace detail {
#if HEXHEX_HAS_TBB
namespace {

/// Arenas for their next use. oneTBB keeps some kilobytes of every arena that ever was, so a
/// process that works for long must not make a new one each time. Calls that run at the same time
/// get different arenas: sharing one would make them wait for each other.
class ArenaPool {
 public:
  using Arena = oneapi::tbb::task_arena;

  /// Lives while an arena is in use.
  class Loan {
   public:
    Loan(ArenaPool& pool, int threads)
        : pool_(pool), threads_(threads), arena_(pool.take(threads)) {}
    ~Loan() { pool_.giveBack(threads_, std::move(arena_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    [[nodiscard]] Arena& arena() const noexcept { return *arena_; }

   private:
    ArenaPool& pool_;
    int threads_;
    std::unique_ptr<Arena> arena_;
  };

 private:
  struct Idle {
    int threads;
    std::unique_ptr<Arena> arena;
  };

  std::unique_ptr<Arena> take(int threads) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(idle_.begin(), idle_.end(),
                                    [&](const Idle& idle) { return idle.threads == threads; });
    std::unique_ptr<Arena> arena;
    if (found == idle_.end()) {
      // Room for all that are lent, as giving them back must not fail.
      idle_.reserve(idle_.size() + lent_ + 1);
      arena = std::make_unique<Arena>(threads);
    } else {
      arena = std::move(found->arena);
      idle_.erase(found);
    }
    ++lent_;
    return arena;
  }
  void giveBack(int threads, std::unique_ptr<Arena> arena) noexcept {
    const std::lock_guard lock(mutex_);
    --lent_;
    idle_.push_back({threads, std::move(arena)});
  }

  std::mutex mutex_;
  std::vector<Idle> idle_;
  std::size_t lent_ = 0;
};

/// Never destroyed: at the end of a process, nobody knows whether oneTBB ends before.
ArenaPool& arenaPool() {
  static auto* const pool = new ArenaPool;
  return *pool;
}

}  // namespace
#endif

void runBlocks(std::size_t n, std::size_t grain, LoopProgress* progress,
               const BlockFunction& function) {
  const std::size_t blocks = blockCount(n, grain);
  const auto runBlock = [&](std::size_t block) {
    const std::size_t begin = block * grain;
    const std::size_t end = std::min(n, begin + grain);
    function(begin, end, block);
    if (progress != nullptr) progress->advance(end - begin);
  };
#if HEXHEX_HAS_TBB
  if (blocks > 1) {
    const LoopOrder loopOrder;
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, blocks, 1),
                              [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                                const RangeOrder rangeOrder;
                                for (std::size_t block = range.begin(); block < range.end();
                                     ++block) {
                                  runBlock(block);
                                }
                              });
    return;
  }
#endif
  for (std::size_t block = 0; block < blocks; ++block) runBlock(block);
}

void runWithThreads(int threads, const void* object, void (*call)(const void*)) {
#if HEXHEX_HAS_TBB
  const int count = effectiveThreads(threads);
  // More threads than cores have to be allowed first. The permission holds for the whole process,
  // so it is not touched without need.
  std::optional<oneapi::tbb::global_control> permission;
  if (count > oneapi::tbb::info::default_concurrency()) {
    permission.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                       static_cast<std::size_t>(count));
  }
  const ArenaPool::Loan loan(arenaPool(), count);
  loan.arena().execute([&] { call(object); });
#else
  static_cast<void>(threads);
  call(object);
#endif
}

}  // namespace detail

int effectiveThreads(int threads) {
#if HEXHEX_HAS_TBB
  const int cores = oneapi::tbb::info::default_concurrency();
  return threads > 0 ? std::min(threads, std::max(kMaxThreads, cores)) : cores;
#else
  static_cast<void>(threads);
  return 1;
#endif
}

int currentThreads() {
#if HEXHEX_HAS_TBB
  return std::max(1, oneapi::tbb::this_task_arena::max_concurrency());
#else
  return 1;
#endif
}

}  // namespace hexhex
