#include "memory.hpp"

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hexhex::bench {

namespace {

/// A line like "VmHWM:   1234 kB" of a file of /proc, in bytes.
std::optional<std::uint64_t> bytesIn(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string word; lines >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == key && lines >> kibibytes) return kibibytes * 1024;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> statusBytes(const std::string& key) {
  return bytesIn("/proc/self/status", key);
}

/// Makes the peak of the resident set start again from its present size.
bool resetPeak() {
  std::ofstream clear("/proc/self/clear_refs");
  clear << "5" << std::flush;
  return clear.good();
}

/// From here on, bytes, an extraction takes a good part of the period below.
constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 28;
/// Two seconds after memory was freed, Linux tells the host of all that is free then, and may give
/// it away. Who holds the memory for longer has it for two seconds from when it gives it back.
constexpr std::chrono::milliseconds kReportingPeriod(2500);

/// Gives the memory back after all threads have touched theirs.
void touchFreshMemory([[maybe_unused]] std::uint64_t bytes, std::barrier<>& together) {
#if defined(__linux__)
  void* memory = MAP_FAILED;
  if (bytes > 0) {
    memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  }
  // If there is none, the measurement starts from whatever there is.
  if (memory != MAP_FAILED) {
#if defined(MADV_HUGEPAGE)
    ::madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    constexpr std::uint64_t kPage = 4096;
    auto* const begin = static_cast<volatile char*>(memory);
    for (std::uint64_t i = 0; i < bytes; i += kPage) begin[i] = 1;
  }
  together.arrive_and_wait();
  if (bytes >= kMuchMemory) std::this_thread::sleep_for(kReportingPeriod);
  if (memory != MAP_FAILED) ::munmap(memory, bytes);
#else
  together.arrive_and_wait();
#endif
}

}  // namespace

void releaseFreeMemory() {
#if defined(__GLIBC__)
  static_cast<void>(malloc_trim(0));
#endif
}

void warmFreeMemory(std::uint64_t bytes, int threads) {
  const auto count = static_cast<std::uint64_t>(std::max(threads, 1));
  if (const auto available = availableMemory()) bytes = std::min(bytes, *available / (2 * count));
  // All hold their memory at the same time, or the second would get what the first gave back.
  std::barrier together(static_cast<std::ptrdiff_t>(count));
  std::vector<std::thread> others;
  for (std::uint64_t i = 1; i < count; ++i) {
    others.emplace_back([&together, bytes] { touchFreshMemory(bytes, together); });
  }
  touchFreshMemory(bytes, together);
  for (std::thread& other : others) other.join();
}

std::optional<std::uint64_t> availableMemory() { return bytesIn("/proc/meminfo", "MemAvailable:"); }

PeakMemory::PeakMemory() {
  releaseFreeMemory();
  if (resetPeak()) before_ = statusBytes("VmRSS:");
}

std::optional<std::uint64_t> PeakMemory::growth() const {
  const std::optional<std::uint64_t> peak = statusBytes("VmHWM:");
  if (!before_ || !peak) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

std::uint64_t peakOf(const std::string& name, const std::function<void()>& work) {
  static std::string knownName;
  static std::uint64_t known = 0;
  if (knownName != name) {
    const PeakMemory peak;
    work();
    known = peak.growth().value_or(0);
    knownName = name;
  }
  return known;
}

}  // namespace hexhex::bench
