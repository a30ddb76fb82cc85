#include <atomic>
#include <cassert>
#include <cstdint>
#include <new>

#include <hexhex/types.hpp>

#include <base/memory.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hexhex {

namespace {

/// From this size on, arrays get huge pages of their own: without them, extractions take 11 %
/// longer in the geometric mean, up to 28 % (docs/results/ablation.md).
constexpr std::size_t kLarge = 2 * kHugePage;
/// From this size on, arrays share huge pages.
constexpr std::size_t kMedium = std::size_t{1} << 15;

// Sanitizers know the standard allocator, and detect writes beyond the end of its memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kPooled = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kPooled = false;
#else
constexpr bool kPooled = true;
#endif
#else
constexpr bool kPooled = true;
#endif

std::atomic<bool> hugePagesForLarge{true};
std::atomic<bool> hugePagesShared{true};

/// Never destroyed, as arrays may live until the program ends.
PagePool& pool() {
  static auto* const pool = new PagePool;
  return *pool;
}

/// A hint: systems without huge pages use ordinary ones.
void adviseHugePages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  static_cast<void>(::madvise(memory, bytes, MADV_HUGEPAGE));
#endif
}

#if defined(__linux__)

/// Large arrays are mapped: the heap would keep what they leave, and what alignment leaves between
/// them: 30 of 265 MB at the peak of improving 1.2 million cells. Extractions take no longer.
constexpr bool kMapsLarge = kPooled;

/// Memory that begins on a huge page, or nullptr.
/// @param bytes  a multiple of kHugePage
char* mapAligned(std::size_t bytes) noexcept {
  assert(bytes % kHugePage == 0);
  // A larger mapping contains an aligned part; the rest is returned.
  void* const mapped = ::mmap(nullptr, bytes + kHugePage, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  char* const begin = static_cast<char*>(mapped);
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(begin) % kHugePage;
  if (before > 0) ::munmap(begin, before);
  ::munmap(begin + before + bytes, kHugePage - before);
  return begin + before;
}

void unmap(void* memory, std::size_t bytes) noexcept { ::munmap(memory, bytes); }

#else

constexpr bool kMapsLarge = false;
char* mapAligned(std::size_t /*bytes*/) noexcept { return nullptr; }
void unmap(void* /*memory*/, std::size_t /*bytes*/) noexcept {}

#endif

std::size_t wholePages(std::size_t bytes) {
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

void* allocateLarge(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(-1) / 2) throw std::bad_alloc();
  const std::size_t rounded = wholePages(bytes);
  void* const memory =
      kMapsLarge ? mapAligned(rounded) : ::operator new (rounded, std::align_val_t{kHugePage});
  if (memory == nullptr) throw std::bad_alloc();
  // Leaves out the last huge page if much of it would be wasted.
  const bool wastesLittle = rounded - bytes <= bytes / 16;
  if (hugePagesForLarge) adviseHugePages(memory, wastesLittle ? rounded : rounded - kHugePage);
  return memory;
}

void freeLarge(void* memory, std::size_t bytes) noexcept {
  if (kMapsLarge) {
    unmap(memory, wholePages(bytes));
  } else {
    ::operator delete (memory, std::align_val_t{kHugePage});
  }
}

bool isPooled(std::size_t bytes) { return kPooled && bytes >= kMedium && bytes < kLarge; }

}  // namespace

char* mapHugePages(std::size_t bytes) noexcept {
  char* const memory = mapAligned(bytes);
  if (memory != nullptr) adviseHugePages(memory, bytes);
  return memory;
}

void unmapHugePages(char* memory, std::size_t bytes) noexcept { unmap(memory, bytes); }

void useHugePages(bool forLarge, bool shared) {
  hugePagesForLarge = forLarge;
  hugePagesShared = shared;
}

namespace detail {

void* allocateArray(std::size_t bytes) {
  if (bytes >= kLarge) return allocateLarge(bytes);
  if (hugePagesShared && isPooled(bytes)) {
    if (void* const memory = pool().allocate(bytes)) return memory;
  }
  return ::operator new(bytes);
}

void freeArray(void* memory, std::size_t bytes) noexcept {
  if (bytes >= kLarge) {
    freeLarge(memory, bytes);
  } else if (!isPooled(bytes) || !pool().release(memory, bytes)) {
    ::operator delete(memory);
  }
}

}  // namespace detail

}  // namespace hexhex
