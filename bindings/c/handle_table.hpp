// Which handles are alive, of what kind they are, and who uses them: so that a handle that is
// freed, of another kind, or in use elsewhere is an error and no crash.
// docs/developer/reliability.md says what remains.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace hexhex::c {

/// Deletes a handle; and it tells of which kind that is.
using Destroyer = void (*)(const void* handle);
template <class T>
void deleteHandle(const void* handle) {
  delete static_cast<const T*>(handle);
}

/// Several may look at a handle and read it at the same time; who changes it is alone with it, but
/// for those who look at what never changes.
enum class Use { Look, Read, Change };

struct HandleEntry;

/// @throws std::bad_alloc
void enterHandle(const void* handle, Destroyer kind);

/// Begins to use a handle. Takes no lock, so signal handlers may call it.
/// @return nullptr if that cannot be
[[nodiscard]] HandleEntry* tryUse(const void* handle, Destroyer kind, Use use) noexcept;
/// The same.
/// @throws Error InvalidArgument that names the argument
[[nodiscard]] HandleEntry& beginUse(const void* handle, Destroyer kind, Use use,
                                    const char* argument);
void endUse(HandleEntry& entry, Use use) noexcept;

/// Deletes a handle of this kind once the last one who uses it has done so. What is no such handle
/// is left alone.
void destroyHandle(const void* handle, Destroyer kind) noexcept;

/// Makes a new handle known.
template <class T>
[[nodiscard]] T* enter(std::unique_ptr<T> handle) {
  enterHandle(handle.get(), &deleteHandle<T>);
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
  Used(T* handle, const char* argument, Use use = kUsual)
      : handle_(handle), use_(use), entry_(&beginUse(handle, kKind, use, argument)) {}
  /// For functions that have no way to fail: converts to false if the handle cannot be used.
  Used(T* handle, std::nothrow_t /*tag*/, Use use = kUsual) noexcept
      : handle_(handle), use_(use), entry_(tryUse(handle, kKind, use)) {}
  ~Used() {
    if (entry_ != nullptr) endUse(*entry_, use_);
  }
  Used(const Used&) = delete;
  Used& operator=(const Used&) = delete;

  explicit operator bool() const noexcept { return entry_ != nullptr; }
  T* operator->() const noexcept { return handle_; }
  T& operator*() const noexcept { return *handle_; }

 private:
  static constexpr Destroyer kKind = &deleteHandle<std::remove_const_t<T>>;
  T* handle_;
  Use use_;
  HandleEntry* entry_;
};

/// What all handles are made from: their memory rests for a while before it becomes something else,
/// so that a freed handle is known as such until some thousand others have been freed.
struct RestingMemory {
  static void* operator new(std::size_t size);
  static void operator delete(void* memory) noexcept;
};

}  // namespace hexhex::c
