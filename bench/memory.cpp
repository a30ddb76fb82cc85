#include "memory.hpp"

#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
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

}  // namespace hexhex::bench
