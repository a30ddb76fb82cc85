// Handles that are destroyed, of another kind, or in use elsewhere are errors and no crashes: each
// has a header in front of it, with a magic number, its kind, and its users.
// docs/developer/reliability.md says what remains undefined.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace hexhex::c {

/// Deletes a handle. Its address identifies the kind.
using Destroyer = void (*)(const void* handle);
template <class T>
void deleteHandle(const void* handle) {
  delete static_cast<const T*>(handle);
}

/// Several may look at a handle and read it at the same time; who changes it is alone with it, but
/// for those who look at what never changes.
enum class Use { Look, Read, Change };

/// From now on the handle can be used.
void giveOut(const void* handle, Destroyer kind) noexcept;

/// Begins to use a handle. Takes no lock, so signal handlers may call it.
/// @return whether that is possible
[[nodiscard]] bool tryUse(const void* handle, Destroyer kind, Use use) noexcept;
/// The same.
/// @throws Error InvalidArgument that names the argument
void beginUse(const void* handle, Destroyer kind, Use use, const char* argument);
void endUse(const void* handle, Use use) noexcept;

/// Deletes a handle of this kind once the last one who uses it has done so. What is no such handle
/// is left alone.
void destroyHandle(const void* handle, Destroyer kind) noexcept;

template <class T>
[[nodiscard]] T* enter(std::unique_ptr<T> handle) noexcept {
  giveOut(handle.get(), &deleteHandle<T>);
  return handle.release();
}
template <class T>
void destroy(T* handle) noexcept {
  destroyHandle(handle, &deleteHandle<T>);
}

/// A handle in use, as long as this lives: reading it, or changing it unless it is const.
template <class T>
class Used {
 public:
  static constexpr Use kUsual = std::is_const_v<T> ? Use::Read : Use::Change;

  /// @throws Error InvalidArgument
  Used(T* handle, const char* argument, Use use = kUsual) : handle_(handle), use_(use) {
    beginUse(handle, kKind, use, argument);
  }
  /// For functions that have no way to fail: converts to false if the handle cannot be used.
  Used(T* handle, std::nothrow_t /*tag*/, Use use = kUsual) noexcept
      : handle_(tryUse(handle, kKind, use) ? handle : nullptr), use_(use) {}
  ~Used() {
    if (handle_ != nullptr) endUse(handle_, use_);
  }
  Used(const Used&) = delete;
  Used& operator=(const Used&) = delete;

  explicit operator bool() const noexcept { return handle_ != nullptr; }
  T* operator->() const noexcept { return handle_; }
  T& operator*() const noexcept { return *handle_; }

 private:
  static constexpr Destroyer kKind = &deleteHandle<std::remove_const_t<T>>;
  T* handle_;
  Use use_;
};

/// The memory of a handle, with its header. It rests for a while before it becomes something else,
/// so that a destroyed handle is known as such until 1,024 others have been destroyed.
struct HandleMemory {
  static void* operator new(std::size_t size);
  static void operator delete(void* handle) noexcept;
};

}  // namespace hexhex::c
