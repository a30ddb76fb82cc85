// Memory for arrays of medium size, in huge pages that they share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace hexhex {

/// Arrays of less than a few huge pages, each with pages of its own, cost more page faults than
/// anything else; one huge page costs no more than a few dozen ordinary ones. So arrays share slabs
/// of huge pages, and memory that one stage has given back serves the next. Empty slabs go back to
/// the system. Several threads may use a pool at the same time.
class PagePool {
 public:
  static constexpr std::size_t kPage = 4096;
  /// Bytes of a slab, and its alignment.
  static constexpr std::size_t kSlab = std::size_t{1} << 23;

  PagePool() = default;
  PagePool(const PagePool&) = delete;
  PagePool& operator=(const PagePool&) = delete;
  ~PagePool();

  /// Memory that begins on a page, uninitialized.
  /// @param bytes    at least 1
  /// @param newSlab  whether to make one where no slab has room
  /// @return nullptr if there is none to be had: from larger arrays than slabs, or on systems
  ///         without huge pages, too
  [[nodiscard]] void* allocate(std::size_t bytes, bool newSlab);

  /// Takes memory back.
  /// @param bytes  as of allocate()
  /// @return false, without having done anything, if it is not from this pool
  bool release(void* memory, std::size_t bytes) noexcept;

  [[nodiscard]] std::size_t slabCount() const;

 private:
  class Slab;

  mutable std::mutex mutex_;
  std::vector<Slab> slabs_;
};

/// A slab: which of its pages are in use.
class PagePool::Slab {
 public:
  explicit Slab(char* begin) : begin_(begin) {}

  /// The first of so many free pages in a row; nullptr if there are none.
  [[nodiscard]] char* take(std::size_t pages) noexcept;
  void giveBack(const char* memory, std::size_t pages) noexcept;

  [[nodiscard]] char* begin() const noexcept { return begin_; }
  [[nodiscard]] bool contains(const void* memory) const noexcept {
    const auto offset =
        reinterpret_cast<std::uintptr_t>(memory) - reinterpret_cast<std::uintptr_t>(begin_);
    return offset < kSlab;
  }
  [[nodiscard]] bool isEmpty() const noexcept { return used_ == 0; }

 private:
  static constexpr std::size_t kPages = kSlab / kPage;

  [[nodiscard]] std::size_t next(std::size_t page, bool inUse) const noexcept;
  void mark(std::size_t first, std::size_t pages, bool inUse) noexcept;
  void populate(std::size_t end) noexcept;

  char* begin_;
  std::size_t used_ = 0;       ///< pages
  std::size_t populated_ = 0;  ///< bytes from begin on that the system has provided
  std::array<std::uint64_t, kPages / 64> inUse_{};  ///< a bit per page
};

}  // namespace hexhex
