#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <latch>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif
#if HEXHEX_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif
#if HEXHEX_HAS_TBB
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace hexhex {

#if HEXHEX_HAS_TBB
namespace {

/// oneTBB guarantees that a loop sees what was written before it, and that its own writes are
/// visible after it. ThreadSanitizer cannot see into oneTBB, so this tells it.
class KnownOrder {
 public:
  /// Lives while the caller waits for a loop, or while a thread works on a range of it.
  enum class Of : std::uint8_t { Loop, Range };
  explicit KnownOrder(Of of) noexcept : of_(of) {
    of_ == Of::Loop ? release(loopBegins) : acquire(loopBegins);
  }
  ~KnownOrder() { of_ == Of::Loop ? acquire(rangeEnds) : release(rangeEnds); }
  KnownOrder(const KnownOrder&) = delete;
  KnownOrder& operator=(const KnownOrder&) = delete;

 private:
#if HEXHEX_THREAD_SANITIZER
  static void release(char& event) noexcept { __tsan_release(&event); }
  static void acquire(char& event) noexcept { __tsan_acquire(&event); }
#else
  static void release(char& /*event*/) noexcept {}
  static void acquire(char& /*event*/) noexcept {}
#endif
  static inline char loopBegins = 0;
  static inline char rangeEnds = 0;
  Of of_;
};

/// Arenas for reuse. oneTBB keeps a few kilobytes of every arena ever made, so a long-running
/// process must not make a new one for each call. Concurrent calls get different arenas: in a
/// shared one they would wait for each other.
class ArenaPool {
 public:
  using Arena = oneapi::tbb::task_arena;

  /// Calls f(arena) with an arena for this many threads.
  template <class F>
  void with(int threads, const F& f) {
    const Loan loan{*this, take(threads)};
    f(loan.arena.mapped());
  }

 private:
  using Idle = std::multimap<int, Arena>;  ///< by number of threads

  /// Lives while an arena is in use. Returning the arena allocates nothing.
  struct Loan {
    ArenaPool& pool;
    mutable Idle::node_type arena;
    ~Loan() {
      const std::lock_guard lock(pool.mutex_);
      pool.idle_.insert(std::move(arena));
    }
  };

  Idle::node_type take(int threads) {
    const std::lock_guard lock(mutex_);
    auto found = idle_.find(threads);
    if (found == idle_.end()) {
      Idle fresh;
      found = fresh.emplace(threads, threads);
      // Initialized here, not on first use: an arena that ran out of memory then would wait for
      // itself forever when used again. This one is destroyed.
      found->second.initialize();
      return fresh.extract(found);
    }
    return idle_.extract(found);
  }

  std::mutex mutex_;
  Idle idle_;
};

/// Never destroyed: at the end of a process, oneTBB may be gone first.
ArenaPool& arenaPool() {
  static auto* const pool = new ArenaPool;
  return *pool;
}

/// Outcome of a loop on several threads. Exceptions do not go through oneTBB: it loses them if it
/// has no memory to record them, and the loop would seem complete.
class LoopOutcome {
 public:
  [[nodiscard]] bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }
  /// Keeps the current exception if it is the first.
  void fail() noexcept {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
  void complete(std::size_t blocks) noexcept {
    completed_.fetch_add(blocks, std::memory_order_relaxed);
  }
  /// Call after the loop has ended.
  void rethrow(std::size_t blocks) const {
    if (failure_) std::rethrow_exception(failure_);
    // oneTBB had no memory for its own tasks, or to report that.
    if (completed_.load(std::memory_order_relaxed) != blocks) throw std::bad_alloc();
  }

 private:
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::atomic<std::size_t> completed_{0};
};

/// Whether this many more threads can run at the same time, each with the memory it takes: starts
/// them and lets them end. oneTBB assumes that threads can be started: if one cannot, because
/// address space is limited or exhausted or there are too many threads, it throws where it cannot
/// recover. The system caches the stacks of the threads tried here for those of oneTBB, so they are
/// about as large.
bool haveSpareThreads([[maybe_unused]] int wanted) {
#if defined(__unix__) || defined(__APPLE__)
  constexpr std::size_t kStack = (std::size_t{4} << 20) + (std::size_t{1} << 18);
  constexpr std::size_t kHeap = std::size_t{1} << 18;  // oneTBB allocates a few kilobytes for each
  const auto count = static_cast<std::size_t>(wanted);
  std::vector<pthread_t> threads;
  // Not by operator new, which programs may replace.
  std::vector<std::unique_ptr<void, void (*)(void*)>> heap;
  threads.reserve(count);
  heap.reserve(count);
  std::latch end(1);
  const auto stay = [](void* latch) -> void* {
    static_cast<std::latch*>(latch)->wait();
    return nullptr;
  };
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return false;
  static_cast<void>(pthread_attr_setstacksize(&attributes, kStack));
  for (std::size_t i = 0; i < count; ++i) {
    heap.emplace_back(std::malloc(kHeap), std::free);
    pthread_t thread{};
    if (!heap.back() || pthread_create(&thread, &attributes, stay, &end) != 0) break;
    threads.push_back(thread);
  }
  static_cast<void>(pthread_attr_destroy(&attributes));
  end.count_down();
  for (const pthread_t thread : threads) static_cast<void>(pthread_join(thread, nullptr));
  return threads.size() == count;
#else
  return true;
#endif
}

/// Returns when this many threads have arrived, or can no longer be expected to: threads start
/// within microseconds unless the machine is overloaded; threads that other work of the process
/// holds have been started already.
void gather(std::atomic<int>& arrived, int expected) {
  // Makes the C++ library allocate its per-thread exception state. If there is no memory for it
  // when the first exception is thrown, the process ends.
  [[maybe_unused]] const volatile int exceptions = std::uncaught_exceptions();
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + std::chrono::milliseconds(300);
  arrived.fetch_add(1);
  while (arrived.load() < expected && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
}

/// Makes oneTBB start its threads now, with a loop whose blocks wait for each other. Otherwise it
/// starts them when first needed, and cannot recover if the system refuses one then.
void startWorkers(ArenaPool::Arena& arena, int threads) {
  std::atomic<int> arrived{0};
  const KnownOrder loop(KnownOrder::Of::Loop);
  arena.execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<int>(0, threads, 1),
        [&](const oneapi::tbb::blocked_range<int>& /*one*/) {
          const KnownOrder ofRange(KnownOrder::Of::Range);
          gather(arrived, threads);
        },
        oneapi::tbb::simple_partitioner());
  });
}

/// How many threads this process can have.
class WorkerThreads {
 public:
  /// Returns `wanted`, or the number that has worked before if the system cannot spare enough more.
  int start(int wanted) {
    const std::lock_guard lock(mutex_);
    if (wanted <= started_) return wanted;
    // All or none, plus a few: oneTBB may start one more thread while another is about to sleep.
    if (!haveSpareThreads(wanted - started_ + kSpare)) return started_;
    try {
      arenaPool().with(wanted, [wanted](auto& arena) { startWorkers(arena, wanted); });
    } catch (const std::runtime_error&) {
      throw std::bad_alloc();  // oneTBB's way to say that it could not start a thread
    }
    started_ = wanted;
    return started_;
  }
  [[nodiscard]] int started() const noexcept { return started_; }

 private:
  static constexpr int kSpare = 2;
  std::mutex mutex_;
  std::atomic<int> started_{1};
};

WorkerThreads& workerThreads() {
  static auto* const threads = new WorkerThreads;  // as above
  return *threads;
}

}  // namespace
#endif

void parallelBlocks(LoopProgress* progress, std::size_t n, std::size_t grain, BlockFunction f) {
  const std::size_t blocks = blockCount(n, grain);
  const auto runBlock = [&](std::size_t block) {
    const std::size_t begin = block * grain;
    const std::size_t end = std::min(n, begin + grain);
    f(begin, end, block);
    if (progress != nullptr) progress->advance(end - begin);
  };
#if HEXHEX_HAS_TBB
  // Outside withThreads(), only with threads that have been started.
  if (blocks > 1 && currentThreads() > 1 && workerThreads().started() > 1) {
    LoopOutcome outcome;
    {
      const KnownOrder loop(KnownOrder::Of::Loop);
      oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, blocks, 1),
                                [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                                  const KnownOrder ofRange(KnownOrder::Of::Range);
                                  try {
                                    for (std::size_t block = range.begin(); block < range.end();
                                         ++block) {
                                      if (outcome.failed()) return;
                                      runBlock(block);
                                    }
                                    outcome.complete(range.size());
                                  } catch (...) {
                                    outcome.fail();
                                  }
                                });
    }
    outcome.rethrow(blocks);
    return;
  }
#endif
  for (std::size_t block = 0; block < blocks; ++block) runBlock(block);
}

void parallelBlocks(Stage& stage, std::size_t n, std::size_t grain, BlockFunction f) {
  LoopProgress progress(stage, n);
  parallelBlocks(&progress, n, grain, f);
}

void withThreads(int threads, FunctionRef<void()> f) {
#if HEXHEX_HAS_TBB
  const int count = effectiveThreads(threads);
  // More threads than cores must be permitted first. The permission holds for the whole process, so
  // it is changed only if necessary.
  std::optional<oneapi::tbb::global_control> permission;
  if (count > oneapi::tbb::info::default_concurrency()) {
    permission.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                       static_cast<std::size_t>(count));
  }
  const int started = workerThreads().start(count);
  arenaPool().with(started, [&](auto& arena) { arena.execute(f); });
#else
  static_cast<void>(threads);
  f();
#endif
}

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
