#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include <base/parallel.hpp>
#include <io/core/bytes.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/vtk/vtu_decoding.hpp>

namespace hexhex::io {
namespace {

constexpr std::uint8_t kNoDigit = 255;
constexpr std::uint8_t kPadding = 64;

constexpr std::array<std::uint8_t, 256> kBase64Digits = [] {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  std::array<std::uint8_t, 256> table{};
  table.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  return table;
}();

/// Bytes front to back: as they are, or out of a base64 text. There, white space is skipped, and
/// texts that end with padding may follow each other.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool base64) : rest_(text), base64_(base64) {}

  /// Reads so many bytes; false if there are not as many, or the text is no base64.
  [[nodiscard]] bool read(char* to, std::size_t size) {
    if (!base64_) {
      if (size > rest_.size()) return false;
      std::copy_n(rest_.data(), size, to);
      rest_.remove_prefix(size);
      return true;
    }
    while (size > 0) {
      if (pendingBegin_ == pendingEnd_ && !decodeGroup()) return false;
      *to++ = pending_[pendingBegin_++];
      --size;
    }
    return true;
  }

  /// The most bytes that can be left.
  [[nodiscard]] std::size_t room() const noexcept {
    return base64_ ? rest_.size() / 4 * 3 + (pendingEnd_ - pendingBegin_) : rest_.size();
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
      digits[count] = kBase64Digits[static_cast<unsigned char>(c)];
      if (digits[count++] == kNoDigit) return false;
    }
    rest_.remove_prefix(used);
    if (digits[0] == kPadding || digits[1] == kPadding) return false;
    const bool one = digits[2] == kPadding;
    const bool two = digits[3] == kPadding;
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
  bool base64_;
  std::array<char, 3> pending_{};
  std::size_t pendingBegin_ = 0;
  std::size_t pendingEnd_ = 0;
};

/// Where the blocks of a compressed array are.
struct Blocks {
  std::uint64_t size = 0;             ///< of each block, not compressed
  std::uint64_t lastSize = 0;         ///< of the last one
  std::vector<std::uint64_t> begins;  ///< of the compressed blocks, and the end of the last
};

/// A number in front of the data, in this machine's order of bytes, as the reader has checked.
bool readLength(EncodedBytes& source, std::size_t lengthBytes, std::uint64_t& length) {
  std::array<char, sizeof(length)> bytes{};
  if (!source.read(bytes.data(), lengthBytes)) return false;
  if (lengthBytes == sizeof(std::uint32_t)) {
    std::uint32_t shortLength = 0;
    std::memcpy(&shortLength, bytes.data(), sizeof(shortLength));
    length = shortLength;
  } else {
    std::memcpy(&length, bytes.data(), sizeof(length));
  }
  return true;
}

/// In front of the blocks: their number, their size, that of a last shorter block or 0, and the
/// sizes of the compressed ones.
bool readBlocks(EncodedBytes& source, std::size_t lengthBytes, Blocks& blocks) {
  std::uint64_t count = 0;
  if (!readLength(source, lengthBytes, count) || !readLength(source, lengthBytes, blocks.size) ||
      !readLength(source, lengthBytes, blocks.lastSize) || count > source.room() / lengthBytes) {
    return false;
  }
  if (blocks.lastSize == 0) blocks.lastSize = blocks.size;
  blocks.begins = {0};
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t size = 0;
    if (!readLength(source, lengthBytes, size) || size > source.room()) return false;
    const std::uint64_t limit = size * kLargestZlibRatio;
    if ((i + 1 < count ? blocks.size : blocks.lastSize) > limit) return false;
    blocks.begins.push_back(blocks.begins.back() + size);
  }
  return blocks.begins.back() <= source.room() && blocks.lastSize <= blocks.size;
}

constexpr const char* kIncomplete = "the data of this array are incomplete.";
constexpr const char* kIncompleteOrNoBase64 =
    "the data of this array are incomplete, or no base64.";

}  // namespace

Array<char> decodeVtuArray(std::string_view text, const VtuEncoding& encoding, Stage& stage,
                           const std::function<void(const char* sentence)>& fail) {
  EncodedBytes source(text, encoding.base64);
  if (!encoding.compressed) {
    std::uint64_t length = 0;
    if (!readLength(source, encoding.lengthBytes, length) || length > source.room()) {
      fail(kIncomplete);
    }
    Array<char> bytes(static_cast<std::size_t>(length));
    if (!source.read(bytes.data(), bytes.size())) fail(kIncompleteOrNoBase64);
    return bytes;
  }
  Blocks blocks;
  if (!readBlocks(source, encoding.lengthBytes, blocks)) fail(kIncomplete);
  const std::size_t count = blocks.begins.size() - 1;
  if (count == 0) return {};
  Array<char> compressed(memorySize(blocks.begins.back()));
  if (!source.read(compressed.data(), compressed.size())) fail(kIncompleteOrNoBase64);
  Array<char> bytes(memorySize((count - 1) * blocks.size + blocks.lastSize));
  constexpr std::size_t kGrain = 8;  // blocks of some tens of kilobytes
  const auto inflate = [&](std::size_t i) {
    const auto begin = static_cast<std::size_t>(blocks.begins[i]);
    const auto end = static_cast<std::size_t>(blocks.begins[i + 1]);
    const auto place = static_cast<std::size_t>(i * blocks.size);
    const auto size = static_cast<std::size_t>(i + 1 < count ? blocks.size : blocks.lastSize);
    return inflateBlock({compressed.data() + begin, end - begin}, {bytes.data() + place, size});
  };
  if (firstFault(stage, count, inflate, kGrain) < count) {
    fail("the compressed data of this array are damaged.");
  }
  return bytes;
}

}  // namespace hexhex::io
