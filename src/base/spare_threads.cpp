#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <base/spare_threads.hpp>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

namespace hexhex {

#if defined(__unix__) || defined(__APPLE__)
namespace {

/// More than the stacks of oneTBB's threads have, 4 MB.
constexpr std::size_t kStack = (std::size_t{4} << 20) + (std::size_t{1} << 18);
/// Of the heap, more than oneTBB allocates for a thread (some kilobytes).
constexpr std::size_t kHeap = std::size_t{1} << 18;

/// Threads that stay until there are as many as wanted.
class Trial {
 public:
  explicit Trial(int wanted) {
    threads_.reserve(static_cast<std::size_t>(wanted));
    heap_.reserve(static_cast<std::size_t>(wanted));
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0) return;
    static_cast<void>(pthread_attr_setstacksize(&attributes, kStack));
    for (int i = 0; i < wanted; ++i) {
      Memory memory(std::malloc(kHeap));
      pthread_t thread{};
      if (!memory || pthread_create(&thread, &attributes, &Trial::stay, this) != 0) break;
      threads_.push_back(thread);
      heap_.push_back(std::move(memory));
    }
    static_cast<void>(pthread_attr_destroy(&attributes));
  }
  ~Trial() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    end_.notify_all();
    for (const pthread_t thread : threads_) static_cast<void>(pthread_join(thread, nullptr));
  }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  [[nodiscard]] int started() const noexcept { return static_cast<int>(threads_.size()); }

 private:
  struct Free {
    void operator()(void* memory) const noexcept { std::free(memory); }
  };
  using Memory = std::unique_ptr<void, Free>;

  static void* stay(void* self) {
    auto& trial = *static_cast<Trial*>(self);
    std::unique_lock lock(trial.mutex_);
    trial.end_.wait(lock, [&] { return trial.ended_; });
    return nullptr;
  }

  std::vector<pthread_t> threads_;
  std::vector<Memory> heap_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
};

}  // namespace

int spareThreads(int wanted) { return Trial(wanted).started(); }
#else
int spareThreads(int wanted) { return wanted; }
#endif

void Gathering::arriveAndWait() {
  // Has the C++ library make what it keeps of exceptions for each thread. There may be no memory
  // for it when the first one is thrown, and that would end the process.
  [[maybe_unused]] const volatile int exceptions = std::uncaught_exceptions();
  using Clock = std::chrono::steady_clock;
  // Threads start within microseconds, unless the machine is crowded; if other work of the same
  // process holds them, they may not come for long, and have been started.
  constexpr std::chrono::milliseconds kPatience(300);
  constexpr std::chrono::microseconds kPause(20);
  const Clock::time_point deadline = Clock::now() + kPatience;
  arrived_.fetch_add(1);
  while (arrived_.load() < expected_ && Clock::now() < deadline) {
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace hexhex
