#include "memory.hpp"

#include <fstream>
#include <string>

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

}  // namespace

void releaseFreeMemory() {
#if defined(__GLIBC__)
  static_cast<void>(malloc_trim(0));
#endif
}

void warmFreeMemory([[maybe_unused]] std::uint64_t bytes) {
#if defined(__linux__)
  if (bytes == 0) return;
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return;  // then the measurement starts from whatever there is
#if defined(MADV_HUGEPAGE)
  ::madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  constexpr std::uint64_t kPage = 4096;
  auto* const begin = static_cast<volatile char*>(memory);
  for (std::uint64_t i = 0; i < bytes; i += kPage) begin[i] = 1;
  ::munmap(memory, bytes);
#endif
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
