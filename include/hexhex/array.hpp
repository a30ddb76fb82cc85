// Arrays in results, which callers can keep, view, or pass on without a copy.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/export.h>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Whether growing arrays leave elements of this type uninitialized: true for numbers, and for
/// types that opt in because they are always written before they are read. Only for trivially
/// copyable types.
template <class T>
inline constexpr bool kLeftUninitialized = std::is_trivially_default_constructible_v<T>;

namespace detail {

/// Memory for arrays. Large arrays request huge pages: the first touch of a fresh array costs
/// mostly page faults, and those occur per page.
[[nodiscard]] void* allocateArray(std::size_t bytes);
void freeArray(void* memory, std::size_t bytes) noexcept;

/// Leaves such elements uninitialized, so that large arrays are only touched once, by the thread
/// that fills them.
template <class T>
struct ArrayAllocator {
  using value_type = T;
  ArrayAllocator() = default;
  template <class U>
  ArrayAllocator(const ArrayAllocator<U>& /*other*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    static_assert(alignof(T) <= alignof(std::max_align_t));
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T))
      throw std::bad_array_new_length();
    return static_cast<T*>(detail::allocateArray(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    detail::freeArray(memory, count * sizeof(T));
  }
  template <class U>
  [[nodiscard]] bool operator==(const ArrayAllocator<U>& /*other*/) const noexcept {
    return true;
  }
  template <class U>
  void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>) {
    if constexpr (!kLeftUninitialized<U>) ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
};

template <class T>
using ArrayStorage = std::vector<T, ArrayAllocator<T>>;

}  // namespace detail

/// Frees the memory returned by Array::release().
template <class T>
class ArrayDeleter {
 public:
  ArrayDeleter() = default;
  explicit ArrayDeleter(detail::ArrayStorage<T>&& storage) noexcept
      : storage_(std::move(storage)) {}
  void operator()(T* /*elements*/) noexcept { detail::ArrayStorage<T>().swap(storage_); }

 private:
  detail::ArrayStorage<T> storage_;
};

/// A std::vector whose resize() does not clear memory, and which can give up ownership of its
/// memory. Three ways to adopt the array of a result without copying an element:
///  - move it: `Array<Vec3> points = std::move(mesh.points);`
///  - view it while it lives, as a std::span or through data() and size(): elements are contiguous;
///  - release() it, for libraries that take a pointer and a deleter:
///    `std::shared_ptr<Vec3[]> points = mesh.points.release();`
template <class T>
class Array : private detail::ArrayStorage<T> {
  using Storage = detail::ArrayStorage<T>;

 public:
  using typename Storage::const_iterator;
  using typename Storage::const_pointer;
  using typename Storage::const_reference;
  using typename Storage::const_reverse_iterator;
  using typename Storage::difference_type;
  using typename Storage::iterator;
  using typename Storage::pointer;
  using typename Storage::reference;
  using typename Storage::reverse_iterator;
  using typename Storage::size_type;
  using typename Storage::value_type;

  Array() = default;
  using Storage::Storage;
  Array& operator=(std::initializer_list<T> elements) {
    Storage::operator=(elements);
    return *this;
  }

  using Storage::assign;
  using Storage::at;
  using Storage::back;
  using Storage::begin;
  using Storage::capacity;
  using Storage::cbegin;
  using Storage::cend;
  using Storage::clear;
  using Storage::data;
  using Storage::emplace_back;
  using Storage::empty;
  using Storage::end;
  using Storage::erase;
  using Storage::front;
  using Storage::insert;
  using Storage::max_size;
  using Storage::pop_back;
  using Storage::push_back;
  using Storage::rbegin;
  using Storage::rend;
  using Storage::reserve;
  using Storage::resize;
  using Storage::shrink_to_fit;
  using Storage::size;
  using Storage::operator[];

  void swap(Array& other) noexcept { Storage::swap(other); }

  [[nodiscard]] friend bool operator==(const Array& a, const Array& b) {
    return static_cast<const Storage&>(a) == static_cast<const Storage&>(b);
  }
  [[nodiscard]] friend bool operator<(const Array& a, const Array& b) {
    return static_cast<const Storage&>(a) < static_cast<const Storage&>(b);
  }

  /// Transfers ownership of the elements and leaves the array empty. Call size() first. The
  /// returned pointer frees them, however and in whichever thread it is destroyed.
  [[nodiscard]] std::unique_ptr<T[], ArrayDeleter<T>> release() noexcept {
    T* const elements = data();
    return {elements, ArrayDeleter<T>(std::move(static_cast<Storage&>(*this)))};
  }
};

}  // namespace HEXHEX_API_NAMESPACE
