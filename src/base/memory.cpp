#include <cstdlib>
#include <new>

#include <hexhex/types.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hexhex::detail {

namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
/// Below, the rounding to whole huge pages would waste too much.
constexpr std::size_t kLarge = 8 * kHugePage;

}  // namespace

void* allocateArray(std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (bytes >= kLarge) {
    if (bytes > static_cast<std::size_t>(-1) / 2) throw std::bad_alloc();
    const std::size_t rounded = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    void* const memory = std::aligned_alloc(kHugePage, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    // A wish, not a need: where the system has no huge pages, ordinary ones do.
    static_cast<void>(madvise(memory, rounded, MADV_HUGEPAGE));
    return memory;
  }
#endif
  void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void freeArray(void* memory, std::size_t /*bytes*/) noexcept { std::free(memory); }

}  // namespace hexhex::detail
