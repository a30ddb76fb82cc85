// Resident memory of this process, so that benchmarks can tell how much a call needed at its peak.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace hexhex::bench {

/// Gives freed memory back to the system, so that what comes next starts like a fresh process: it
/// neither profits from resident pages nor hides its growth in them.
void releaseFreeMemory();

/// Touches so much fresh memory in each of so many threads, in huge pages as far as the system
/// gives them, and gives it back. A virtual machine may have returned free memory to its host,
/// which makes the next touch up to twenty times as expensive; shortly after this it is the
/// machine's own again. Linux keeps freed pages for the core that freed them, so one thread cannot
/// warm for two.
void warmFreeMemory(std::uint64_t bytes, int threads);

/// Bytes that this process could still use without swapping; nothing if the system does not tell.
[[nodiscard]] std::optional<std::uint64_t> availableMemory();

/// Measures the growth of the resident set from construction on, at its peak. Linux counts resident
/// pages (VmHWM), so arrays count as far as they are touched, and the allocator's waste counts too.
class PeakMemory {
 public:
  PeakMemory();
  /// Bytes; nothing if the system does not tell.
  [[nodiscard]] std::optional<std::uint64_t> growth() const;

 private:
  std::optional<std::uint64_t> before_;
};

/// Growth of resident memory by one run of a benchmark's work, at its peak; 0 if the system does
/// not tell. The last name's is remembered, as repetitions of a benchmark call its function anew.
[[nodiscard]] std::uint64_t peakOf(const std::string& name, const std::function<void()>& work);

}  // namespace hexhex::bench
