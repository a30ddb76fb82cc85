#include <algorithm>
#include <bit>

#include <base/page_pool.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hexhex {

namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

std::size_t pagesOf(std::size_t bytes) { return (bytes + PagePool::kPage - 1) / PagePool::kPage; }

#if defined(__linux__) && defined(MADV_HUGEPAGE)

/// Address space for a slab, or nullptr.
char* mapSlab() noexcept {
  // Twice as much has an aligned part of the size; the rest is returned.
  void* const mapped = ::mmap(nullptr, 2 * PagePool::kSlab, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  char* const begin = static_cast<char*>(mapped);
  const std::size_t over = reinterpret_cast<std::uintptr_t>(begin) % PagePool::kSlab;
  const std::size_t before = over == 0 ? 0 : PagePool::kSlab - over;
  char* const slab = begin + before;
  if (before > 0) ::munmap(begin, before);
  ::munmap(slab + PagePool::kSlab, PagePool::kSlab - before);
  // A wish: where the system has no huge pages, ordinary ones do.
  ::madvise(slab, PagePool::kSlab, MADV_HUGEPAGE);
  return slab;
}

void unmapSlab(char* slab) noexcept { ::munmap(slab, PagePool::kSlab); }

/// Has the system provide pages at once that will be written anyway.
void provide([[maybe_unused]] char* begin, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(MADV_POPULATE_WRITE)
  ::madvise(begin, bytes, MADV_POPULATE_WRITE);
#endif
}

bool isProvided(char* page) noexcept {
  unsigned char resident = 0;
  return ::mincore(page, PagePool::kPage, &resident) == 0 && (resident & 1U) != 0;
}

#else

char* mapSlab() noexcept { return nullptr; }
void unmapSlab(char* /*slab*/) noexcept {}
void provide(char* /*begin*/, std::size_t /*bytes*/) noexcept {}
bool isProvided(char* /*page*/) noexcept { return true; }

#endif

}  // namespace

PagePool::~PagePool() {
  for (const Slab& slab : slabs_) unmapSlab(slab.begin());
}

void* PagePool::allocate(std::size_t bytes, bool newSlab) {
  if (bytes > kSlab) return nullptr;
  const std::scoped_lock lock(mutex_);
  const std::size_t pages = pagesOf(bytes);
  for (Slab& slab : slabs_) {
    if (char* const memory = slab.take(pages)) return memory;
  }
  if (!newSlab) return nullptr;
  slabs_.reserve(slabs_.size() + 1);  // before there is anything that could be lost
  char* const begin = mapSlab();
  if (begin == nullptr) return nullptr;
  return slabs_.emplace_back(begin).take(pages);
}

bool PagePool::release(void* memory, std::size_t bytes) noexcept {
  const std::scoped_lock lock(mutex_);
  const auto slab = std::find_if(slabs_.begin(), slabs_.end(),
                                 [memory](const Slab& each) { return each.contains(memory); });
  if (slab == slabs_.end()) return false;
  slab->giveBack(static_cast<const char*>(memory), pagesOf(bytes));
  if (slab->isEmpty()) {
    unmapSlab(slab->begin());
    slabs_.erase(slab);
  }
  return true;
}

std::size_t PagePool::slabCount() const {
  const std::scoped_lock lock(mutex_);
  return slabs_.size();
}

char* PagePool::Slab::take(std::size_t pages) noexcept {
  if (kPages - used_ < pages) return nullptr;
  for (std::size_t end = 0; end < kPages;) {
    const std::size_t first = next(end, false);
    if (first + pages > kPages) return nullptr;
    end = next(first, true);
    if (end - first < pages) continue;
    mark(first, pages, true);
    used_ += pages;
    populate((first + pages) * kPage);
    return begin_ + first * kPage;
  }
  return nullptr;
}

void PagePool::Slab::giveBack(const char* memory, std::size_t pages) noexcept {
  mark(static_cast<std::size_t>(memory - begin_) / kPage, pages, false);
  used_ -= pages;
}

/// The first page from this one on that is in use, or that is not; kPages if there is none.
std::size_t PagePool::Slab::next(std::size_t page, bool inUse) const noexcept {
  const std::uint64_t flip = inUse ? 0 : ~std::uint64_t{0};
  for (std::uint64_t skip = ~std::uint64_t{0} << (page % 64); page < kPages;
       skip = ~std::uint64_t{0}) {
    const std::size_t word = page / 64;
    const std::uint64_t found = (inUse_[word] ^ flip) & skip;
    if (found != 0) return 64 * word + static_cast<std::size_t>(std::countr_zero(found));
    page = 64 * (word + 1);
  }
  return kPages;
}

void PagePool::Slab::mark(std::size_t first, std::size_t pages, bool inUse) noexcept {
  while (pages > 0) {
    const std::size_t here = std::min(pages, 64 - first % 64);
    const std::uint64_t bits = (~std::uint64_t{0} >> (64 - here)) << (first % 64);
    std::uint64_t& word = inUse_[first / 64];
    word = inUse ? word | bits : word & ~bits;
    first += here;
    pages -= here;
  }
}

/// Up to here.
void PagePool::Slab::populate(std::size_t end) noexcept {
  if (end <= populated_) return;
  provide(begin_ + populated_, end - populated_);
  // If the last page of the huge one is there, too, it is a huge one.
  const std::size_t whole = (end + kHugePage - 1) / kHugePage * kHugePage;
  populated_ = isProvided(begin_ + whole - kPage) ? whole : end;
}

}  // namespace hexhex
