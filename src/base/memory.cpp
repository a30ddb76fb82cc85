#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

#include <hexhex/types.hpp>

#include <base/memory.hpp>
#include <base/page_pool.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hexhex::detail {

namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
/// Below, ordinary pages do.
constexpr std::size_t kLarge = 2 * kHugePage;
/// From here on, asking for all pages at once is cheaper than a fault for each.
constexpr std::size_t kManyPages = std::size_t{1} << 14;
/// From here on, so is a huge page.
constexpr std::size_t kManyMorePages = std::size_t{1} << 15;

// Sanitizers know malloc, and see what is written beyond the end of its memory.
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

std::atomic<bool> hugePages{true};

/// Never destroyed, as arrays may live until the end of the program.
PagePool& pool() {
  static auto* const pool = new PagePool;
  return *pool;
}

bool isPooled(std::size_t bytes) { return kPooled && bytes >= PagePool::kPage && bytes < kLarge; }

/// Has the system provide the pages now that will be written anyway. Where it cannot, it does so
/// page by page as ever.
void populate([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
  constexpr std::size_t kPage = 4096;
  const std::size_t over = reinterpret_cast<std::uintptr_t>(memory) % kPage;
  const std::size_t before = over == 0 ? 0 : kPage - over;
  const std::size_t whole = (bytes - before) / kPage * kPage;
  static_cast<void>(madvise(static_cast<char*>(memory) + before, whole, MADV_POPULATE_WRITE));
#endif
}

#if defined(__linux__) && defined(MADV_HUGEPAGE)
/// In huge pages, but for a rest that would waste too much of the last one. Asking is a wish, not a
/// need: where the system has none, ordinary ones do.
void* allocateLarge(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(-1) / 2) throw std::bad_alloc();
  const std::size_t rounded = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* const memory = std::aligned_alloc(kHugePage, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  const bool wastesLittle = rounded - bytes <= bytes / 16;
  const std::size_t huge = wastesLittle ? rounded : rounded - kHugePage;
  static_cast<void>(madvise(memory, huge, MADV_HUGEPAGE));
  if (!wastesLittle) populate(static_cast<char*>(memory) + huge, bytes - huge);
  return memory;
}
#endif

}  // namespace

void* allocateArray(std::size_t bytes) {
  const bool huge = hugePages.load(std::memory_order_relaxed);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (huge && bytes >= kLarge) return allocateLarge(bytes);
#endif
  if (huge && isPooled(bytes)) {
    if (void* const memory = pool().allocate(bytes, bytes >= kManyMorePages)) return memory;
  }
  void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  if (huge && bytes >= kManyPages) populate(memory, bytes);
  return memory;
}

void freeArray(void* memory, std::size_t bytes) noexcept {
  if (isPooled(bytes) && pool().release(memory, bytes)) return;
  std::free(memory);
}

}  // namespace hexhex::detail

namespace hexhex {

void useHugePages(bool use) { detail::hugePages.store(use, std::memory_order_relaxed); }

}  // namespace hexhex
