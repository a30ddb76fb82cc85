#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <new>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <quantize/integers/child_process.hpp>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <hexhex/error.hpp>

namespace hexhex::quantization {
namespace {

/// What the child says last, before its numbers.
enum Answer : std::int64_t { kCrashed, kDone, kImpossible, kNoMemory };

/// Numbers that parent and child both see; the first is an Answer.
class SharedNumbers {
 public:
  explicit SharedNumbers(std::size_t count)
      : bytes_(count * sizeof(std::int64_t)),
        memory_(mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
  }
  SharedNumbers(const SharedNumbers&) = delete;
  SharedNumbers& operator=(const SharedNumbers&) = delete;
  ~SharedNumbers() { munmap(memory_, bytes_); }

  [[nodiscard]] std::span<std::int64_t> all() const {
    return {static_cast<std::int64_t*>(memory_), bytes_ / sizeof(std::int64_t)};
  }

 private:
  std::size_t bytes_;
  void* memory_;
};

/// Signals wait meanwhile, for the child for ever: so what is sent to all of a terminal's processes
/// is the parent's business, and no handler runs twice.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

/// The child leaves nothing behind, and does not outlive its parent.
void isolate([[maybe_unused]] pid_t parent) {
#if defined(__linux__)
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
#endif
  const rlimit none{};
  setrlimit(RLIMIT_CORE, &none);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void runChild(std::span<std::int64_t> numbers,
                           const std::function<bool(std::span<std::int64_t>)>& work) {
  try {
    numbers[0] = work(numbers.subspan(1)) ? kDone : kImpossible;
  } catch (const std::bad_alloc&) {
    numbers[0] = kNoMemory;
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

/// Ends with the child; or ends it, if the caller does not wait.
void waitFor(pid_t child, const Context& context) {
  // What is short does not wait for the clock.
  std::chrono::microseconds pause(100);
  // A child that the caller's own handler has waited for is one that has ended.
  while (waitpid(child, nullptr, WNOHANG) == 0) {
    if (context.cancelled()) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      context.throwIfCancelled();
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::microseconds(10000));
  }
}

}  // namespace

std::optional<std::vector<std::int64_t>> inChildProcess(
    std::size_t count, const Context& context,
    const std::function<bool(std::span<std::int64_t>)>& work) {
  const SharedNumbers shared(count + 1);
  const std::span<std::int64_t> numbers = shared.all();
  pid_t child = 0;
  {
    const HeldSignals held;
    const pid_t parent = getpid();
    child = fork();
    if (child == 0) {
      isolate(parent);
      runChild(numbers, work);
    }
  }
  if (child < 0) {
    throw Error(ErrorCode::OutOfMemory,
                "The system refused a process that finds integers. End others, or try again.");
  }
  waitFor(child, context);
  if (numbers[0] == kNoMemory) throw std::bad_alloc();
  if (numbers[0] == kCrashed) {
    throw Error(ErrorCode::OutOfMemory,
                "The process that finds integers has crashed, as it does where memory is short. "
                "End other programs, or ask for a machine with more memory.");
  }
  if (numbers[0] == kImpossible) return std::nullopt;
  return std::vector<std::int64_t>(numbers.begin() + 1, numbers.end());
}

}  // namespace hexhex::quantization
