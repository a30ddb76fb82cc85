// Little-endian numbers in memory, and a cursor that reads them in sequence.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/concat.hpp>

namespace hexhex::io {

/// Converts a size stored in a file, which may not fit in std::size_t. @throws std::bad_alloc
[[nodiscard]] inline std::size_t memorySize(std::uint64_t bytes) {
  const auto size = static_cast<std::size_t>(bytes);
  if (size != bytes) throw std::bad_alloc();
  return size;
}

/// Reads a little-endian number from an address of any alignment.
template <class T>
[[nodiscard]] T loadLittle(const char* place) noexcept {
  std::array<char, sizeof(T)> bytes;  // NOLINT(*-member-init): overwritten by memcpy
  std::memcpy(bytes.data(), place, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Reads a big-endian number of 2, 4 or 8 bytes. Swaps bytes by halves: a byte-by-byte loop makes
/// converting a whole binary `.vtk` file 10 % slower.
template <class T>
[[nodiscard]] T loadBig(const char* place) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t,
                                  std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint16_t>>;
  static_assert(sizeof(T) == sizeof(Bits));
  Bits bits;
  std::memcpy(&bits, place, sizeof(bits));
  if constexpr (std::endian::native == std::endian::little) {
    constexpr Bits kOddBytes = static_cast<Bits>(0xff00ff00ff00ff00U);
    constexpr Bits kOddPairs = static_cast<Bits>(0xffff0000ffff0000U);
    bits = static_cast<Bits>((bits & kOddBytes) >> 8U | (bits << 8U & kOddBytes));
    if constexpr (sizeof(T) >= 4) bits = (bits & kOddPairs) >> 16U | (bits << 16U & kOddPairs);
    if constexpr (sizeof(T) == 8) bits = bits >> 32U | bits << 32U;
  }
  return std::bit_cast<T>(bits);
}

/// The little-endian bytes of a number.
template <class T>
[[nodiscard]] std::array<char, sizeof(T)> littleBytes(T value) noexcept {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Reads a section of a file from front to back; a missing byte is an error that gives its
/// position.
class ByteCursor {
 public:
  /// @param part  a substring of `file`; both views and the name must outlive the cursor
  ByteCursor(std::string_view part, std::string_view file, const std::string& fileName)
      : rest_(part), file_(file), fileName_(fileName) {}

  [[nodiscard]] std::size_t remaining() const noexcept { return rest_.size(); }
  /// Position in the file of the next byte to read.
  [[nodiscard]] std::size_t position() const noexcept {
    return static_cast<std::size_t>(rest_.data() - file_.data());
  }

  /// @param what  for the error message, e.g. "the name of a property"
  [[nodiscard]] std::string_view take(std::uint64_t size, std::string_view what) {
    if (size > rest_.size()) {
      fail(ErrorCode::FileSyntax, what, " needs ", size, " bytes, but only ", rest_.size(),
           " are left.");
    }
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  template <class T>
  [[nodiscard]] T read(std::string_view what) {
    return loadLittle<T>(take(sizeof(T), what).data());
  }

  /// Throws an error at the current position: "<file>, byte 48: <sentence>".
  /// @param sentence  its parts, as for concat()
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    failAt(position(), code, sentence...);
  }
  template <class... Parts>
  [[noreturn]] void failAt(std::size_t position, ErrorCode code, Parts... sentence) const {
    failAt(position, code, Place{}, sentence...);
  }
  template <class... Parts>
  [[noreturn]] void failAt(std::size_t position, ErrorCode code, Place place,
                           Parts... sentence) const {
    throw Error(code, concat(fileName_, ", byte ", position, ": ", sentence...), place);
  }

 private:
  std::string_view rest_;
  std::string_view file_;
  const std::string& fileName_;
};

}  // namespace hexhex::io
