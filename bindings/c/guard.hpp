// The border between C and C++: errors become a status, structs of any age become ours.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <hexhex.h>

#include <hexhex/error.hpp>

namespace hexhex::c {

[[nodiscard]] constexpr hexhex_status statusOf(ErrorCode code) noexcept {
  return static_cast<hexhex_status>(static_cast<int>(code) + 1);
}
[[nodiscard]] hexhex_place placeOf(const Place& place) noexcept;

/// Describes the exception that is being handled.
hexhex_status describeException(hexhex_error* error) noexcept;

/// Runs work(); whatever it throws ends here.
template <class Work>
hexhex_status guarded(hexhex_error* error, const Work& work) noexcept {
  try {
    work();
    if (error != nullptr) *error = {};
    return HEXHEX_OK;
  } catch (...) {
    return describeException(error);
  }
}

[[noreturn]] void throwNull(const char* argument);
[[noreturn]] void throwSize(const char* argument);
[[noreturn]] void throwBusy(const char* argument);
[[noreturn]] void throwCount(const char* argument, std::size_t count);

/// A pointer that may not be null.
template <class T>
T& require(T* pointer, const char* argument) {
  if (pointer == nullptr) throwNull(argument);
  return *pointer;
}

/// Whether a struct may be so large: those of today have some hundred bytes, and what was never set
/// is mostly another number.
[[nodiscard]] constexpr bool isStructSize(std::size_t size) noexcept {
  constexpr std::size_t kLargest = 4096;
  return size >= sizeof(std::size_t) && size <= kLargest;
}

/// The caller's struct, of which it knows `size` bytes, over the defaults. Bytes that this library
/// does not know have to be zero.
template <class T>
T readStruct(const T* given, T value, const char* argument) {
  if (given == nullptr) return value;
  const std::size_t size = given->size;
  if (!isStructSize(size)) throwSize(argument);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  for (std::size_t i = sizeof(T); i < size; ++i) {
    if (bytes[i] != 0) throwSize(argument);
  }
  std::memcpy(&value, given, std::min(size, sizeof(T)));
  value.size = sizeof(T);
  return value;
}

/// Before something is changed: whether writeStruct() will work.
template <class T>
void requireStruct(const T* out, const char* argument) {
  if (out != nullptr && !isStructSize(out->size)) throwSize(argument);
}

/// Our struct into the caller's, as far as it goes. What the caller knows beyond ours becomes zero.
template <class T>
void writeStruct(const T& value, T& out, const char* argument) {
  const std::size_t size = out.size;
  if (!isStructSize(size)) throwSize(argument);
  std::memset(&out, 0, size);
  std::memcpy(&out, &value, std::min(size, sizeof(T)));
  out.size = size;
}

}  // namespace hexhex::c
