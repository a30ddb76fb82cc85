// How arrays (hexhex::Array) get their memory: in huge pages of their own, or in shared ones.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace hexhex {

/// Sets, for the whole process, whether large arrays get huge pages from now on, and whether
/// smaller ones share some; global, as an allocator knows nothing else. Only for ablations: an
/// array may be freed under another setting than it was allocated under.
void useHugePages(bool forLarge, bool shared);

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Address space that the system is to back with huge pages, where it has them.
/// @param bytes  a multiple of kHugePage
/// @return nullptr if there is none left
[[nodiscard]] char* mapHugePages(std::size_t bytes) noexcept;
void unmapHugePages(char* memory, std::size_t bytes) noexcept;

/// An array of less than a few huge pages would pay a page fault for each page of its own. So such
/// arrays share slabs of huge pages, and memory that one stage returns serves the next: without
/// this, an extraction of s17c_sphere_r10 takes 7.5 % longer (docs/results/ablation.md). Empty
/// slabs return to the system. Thread-safe.
class PagePool {
 public:
  static constexpr std::size_t kPage = 4096;
  static constexpr std::size_t kSlab = 4 * kHugePage;

  /// Uninitialized memory that begins on a page.
  /// @param bytes  at least 1
  /// @return nullptr if there is none left, or if `bytes` exceeds a slab
  [[nodiscard]] void* allocate(std::size_t bytes) {
    assert(bytes > 0);
    if (bytes > kSlab) return nullptr;
    const std::size_t pages = pagesOf(bytes);
    const std::scoped_lock lock(mutex_);
    for (Slab& slab : slabs_) {
      if (void* const memory = slab.take(pages)) return memory;
    }
    slabs_.reserve(slabs_.size() + 1);  // before there is anything to lose
    Slab slab;
    if (slab.memory == nullptr) return nullptr;
    slabs_.push_back(std::move(slab));
    return slabs_.back().take(pages);
  }

  /// Takes memory back.
  /// @param bytes  as passed to allocate()
  /// @return false, with nothing done, if it is not from this pool
  bool release(void* memory, std::size_t bytes) noexcept {
    const std::scoped_lock lock(mutex_);
    const auto slab =
        std::ranges::find_if(slabs_, [memory](const Slab& each) { return each.contains(memory); });
    if (slab == slabs_.end()) return false;
    slab->giveBack(memory, pagesOf(bytes));
    if (slab->used == 0) slabs_.erase(slab);
    return true;
  }

  [[nodiscard]] std::size_t slabCount() const {
    const std::scoped_lock lock(mutex_);
    return slabs_.size();
  }

 private:
  static constexpr std::size_t pagesOf(std::size_t bytes) { return (bytes + kPage - 1) / kPage; }

  struct Free {
    void operator()(char* memory) const noexcept { unmapHugePages(memory, kSlab); }
  };

  struct Slab {
    std::unique_ptr<char, Free> memory{mapHugePages(kSlab)};
    std::array<bool, kSlab / kPage> inUse{};  ///< per page
    std::size_t used = 0;                     ///< pages

    [[nodiscard]] bool contains(const void* what) const noexcept {
      return !std::less<>()(what, static_cast<void*>(memory.get())) &&
             std::less<>()(what, static_cast<void*>(memory.get() + kSlab));
    }
    /// The first of `pages` consecutive free pages; nullptr if there are none.
    [[nodiscard]] void* take(std::size_t pages) noexcept {
      if (inUse.size() - used < pages) return nullptr;
      auto* const first = std::search_n(inUse.begin(), inUse.end(), pages, false);
      if (first == inUse.end()) return nullptr;
      std::fill_n(first, pages, true);
      used += pages;
      return memory.get() + static_cast<std::size_t>(first - inUse.begin()) * kPage;
    }
    void giveBack(const void* what, std::size_t pages) noexcept {
      const auto offset = static_cast<std::size_t>(static_cast<const char*>(what) - memory.get());
      auto* const first = inUse.begin() + offset / kPage;
      assert(offset % kPage == 0 && pages <= used);
      assert(std::all_of(first, first + pages, [](bool each) { return each; }));
      std::fill_n(first, pages, false);
      used -= pages;
    }
  };

  mutable std::mutex mutex_;
  std::vector<Slab> slabs_;
};

}  // namespace hexhex
