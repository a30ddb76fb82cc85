// Bytes in a text, as VTK's XML files hold them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <io/core/text_scanner.hpp>

namespace hexhex {

namespace detail {

inline constexpr std::uint8_t kBase64Invalid = 255;
inline constexpr std::uint8_t kBase64Padding = 64;

constexpr std::array<std::uint8_t, 256> base64Table() {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> table{};
  table.fill(kBase64Invalid);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  table[static_cast<unsigned char>('=')] = kBase64Padding;
  return table;
}
inline constexpr std::array<std::uint8_t, 256> kBase64Table = base64Table();

}  // namespace detail

/// Reads bytes out of a base64 text, front to back. White space is skipped; texts that end with
/// padding may follow each other.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : rest_(text) {}

  /// Reads so many bytes; false if the text has not as many, or is no base64.
  [[nodiscard]] bool read(char* to, std::size_t size) {
    while (size > 0) {
      if (pendingBegin_ == pendingEnd_ && !decodeGroup()) return false;
      *to++ = pending_[pendingBegin_++];
      --size;
    }
    return true;
  }

  /// The most bytes that can be left.
  [[nodiscard]] std::size_t room() const noexcept {
    return rest_.size() / 4 * 3 + (pendingEnd_ - pendingBegin_);
  }

 private:
  /// Four characters are three bytes, or fewer with padding.
  bool decodeGroup() {
    std::array<std::uint8_t, 4> digits{};
    std::size_t count = 0;
    std::size_t used = 0;
    while (count < digits.size()) {
      if (used == rest_.size()) return false;
      const char c = rest_[used++];
      if (isSpace(c)) continue;
      digits[count] = detail::kBase64Table[static_cast<unsigned char>(c)];
      if (digits[count++] == detail::kBase64Invalid) return false;
    }
    rest_.remove_prefix(used);
    if (digits[0] == detail::kBase64Padding || digits[1] == detail::kBase64Padding) return false;
    const bool one = digits[2] == detail::kBase64Padding;
    const bool two = digits[3] == detail::kBase64Padding;
    if (one && !two) return false;
    const auto digit = [&](std::size_t i) { return std::uint32_t{digits[i]} & 63U; };
    const std::uint32_t bits =
        digit(0) << 18U | digit(1) << 12U | (one ? 0 : digit(2) << 6U) | (two ? 0 : digit(3));
    pending_ = {static_cast<char>(bits >> 16U), static_cast<char>(bits >> 8U),
                static_cast<char>(bits)};
    pendingBegin_ = 0;
    pendingEnd_ = one ? 1 : (two ? 2 : 3);
    return true;
  }

  std::string_view rest_;
  std::array<char, 3> pending_{};
  std::size_t pendingBegin_ = 0;
  std::size_t pendingEnd_ = 0;
};

}  // namespace hexhex
