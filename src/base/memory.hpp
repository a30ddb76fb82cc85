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

/// Whether large arrays are to have huge pages from now on, and whether smaller ones share some, in
/// the whole process: an allocator knows nothing but globals. For ablations alone; arrays may end
/// under another rule than they began.
void useHugePages(bool forLarge, bool shared);

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Address space in which the system is to provide huge pages, where it has them.
/// @param bytes  a multiple of kHugePage
/// @return nullptr if there is none
[[nodiscard]] char* mapHugePages(std::size_t bytes) noexcept;
void unmapHugePages(char* memory, std::size_t bytes) noexcept;

/// An array of less than a few huge pages that has pages of its own costs a page fault for each of
/// them. So such arrays share slabs of huge pages, and memory that one stage has given back serves
/// the next: without, an extraction of s17c_sphere_r10 takes 7.5 % longer (docs/ablation.md). Empty
/// slabs go back to the system. Several threads may use a pool at the same time.
class PagePool {
 public:
  static constexpr std::size_t kPage = 4096;
  static constexpr std::size_t kSlab = 4 * kHugePage;

  /// Memory that begins on a page, uninitialized.
  /// @param bytes  at least 1
  /// @return nullptr if there is none to be had: for larger arrays than slabs, too
  [[nodiscard]] void* allocate(std::size_t bytes) {
    assert(bytes > 0);
    if (bytes > kSlab) return nullptr;
    const std::size_t pages = pagesOf(bytes);
    const std::scoped_lock lock(mutex_);
    for (Slab& slab : slabs_) {
      if (void* const memory = slab.take(pages)) return memory;
    }
    slabs_.reserve(slabs_.size() + 1);  // before there is anything that could be lost
    Slab slab;
    if (slab.memory == nullptr) return nullptr;
    slabs_.push_back(std::move(slab));
    return slabs_.back().take(pages);
  }

  /// Takes memory back.
  /// @param bytes  as of allocate()
  /// @return false, without having done anything, if it is not from this pool
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
    std::array<bool, kSlab / kPage> inUse{};  ///< by page
    std::size_t used = 0;                     ///< pages

    [[nodiscard]] bool contains(const void* what) const noexcept {
      return !std::less<>()(what, static_cast<void*>(memory.get())) &&
             std::less<>()(what, static_cast<void*>(memory.get() + kSlab));
    }
    /// The first of so many free pages in a row; nullptr if there are none.
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
