#include "memory.hpp"

#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace hexhex::bench {

namespace {

/// A line of /proc/self/status, e.g. "VmHWM:   1234 kB", in bytes.
std::optional<std::uint64_t> statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == key && status >> kibibytes) return kibibytes * 1024;
  }
  return std::nullopt;
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
