#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <base/parallel.hpp>
#include <io/core/base64.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/vtk/vtu_decoding.hpp>

namespace hexhex {
namespace {

/// Bytes as they are, front to back.
class RawReader {
 public:
  explicit RawReader(std::string_view bytes) : rest_(bytes) {}
  [[nodiscard]] bool read(char* to, std::size_t size) {
    if (size > rest_.size()) return false;
    std::copy_n(rest_.data(), size, to);
    rest_.remove_prefix(size);
    return true;
  }
  [[nodiscard]] std::size_t room() const noexcept { return rest_.size(); }

 private:
  std::string_view rest_;
};

/// Where the blocks of a compressed array are.
struct Blocks {
  std::uint64_t size = 0;             ///< of each block, not compressed
  std::uint64_t lastSize = 0;         ///< of the last one
  std::vector<std::uint64_t> begins;  ///< of the compressed blocks, and the end of the last
};

/// Decodes one array from a source of bytes.
template <class Source>
class Decoder {
 public:
  Decoder(Source source, const VtuEncoding& encoding, Stage* stage, std::string& problem)
      : source_(source), encoding_(encoding), stage_(stage), problem_(problem) {}

  std::optional<Array<char>> decode() {
    return encoding_.compressed ? decodeBlocks() : decodePlain();
  }

 private:
  std::nullopt_t fail(const char* sentence) {
    problem_ = sentence;
    return std::nullopt;
  }
  bool readLength(std::uint64_t& length) {
    std::array<char, sizeof(length)> bytes{};
    if (!source_.read(bytes.data(), encoding_.lengthBytes)) return false;
    // In this machine's order of bytes, which the reader has made sure of.
    if (encoding_.lengthBytes == sizeof(std::uint32_t)) {
      std::uint32_t shortLength = 0;
      std::memcpy(&shortLength, bytes.data(), sizeof(shortLength));
      length = shortLength;
    } else {
      std::memcpy(&length, bytes.data(), sizeof(length));
    }
    return true;
  }

  std::optional<Array<char>> decodePlain() {
    std::uint64_t length = 0;
    if (!readLength(length) || length > source_.room()) {
      return fail("the data of this array are incomplete.");
    }
    Array<char> bytes(static_cast<std::size_t>(length));
    if (!source_.read(bytes.data(), bytes.size())) {
      return fail("the data of this array are incomplete, or no base64.");
    }
    return bytes;
  }

  /// In front of the blocks: their number, their size, that of a last shorter block or 0, and the
  /// sizes of the compressed ones.
  bool readBlocks(Blocks& blocks) {
    std::uint64_t count = 0;
    if (!readLength(count) || !readLength(blocks.size) || !readLength(blocks.lastSize))
      return false;
    if (count > source_.room() / encoding_.lengthBytes) return false;
    if (blocks.lastSize == 0) blocks.lastSize = blocks.size;
    blocks.begins = {0};
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint64_t size = 0;
      if (!readLength(size) || size > source_.room()) return false;
      const std::uint64_t limit = size * kLargestZlibRatio;
      if ((i + 1 < count ? blocks.size : blocks.lastSize) > limit) return false;
      blocks.begins.push_back(blocks.begins.back() + size);
    }
    return blocks.begins.back() <= source_.room() && blocks.lastSize <= blocks.size;
  }

  std::optional<Array<char>> decodeBlocks() {
    Blocks blocks;
    if (!readBlocks(blocks)) return fail("the data of this array are incomplete.");
    const std::size_t count = blocks.begins.size() - 1;
    if (count == 0) return Array<char>();
    Array<char> compressed(blocks.begins.back());
    if (!source_.read(compressed.data(), compressed.size())) {
      return fail("the data of this array are incomplete, or no base64.");
    }
    Array<char> bytes((count - 1) * blocks.size + blocks.lastSize);
    const auto inflate = [&](std::size_t i) {
      const std::uint64_t begin = blocks.begins[i];
      return inflateBlock(
          {compressed.data() + begin, blocks.begins[i + 1] - begin},
          {bytes.data() + i * blocks.size, i + 1 < count ? blocks.size : blocks.lastSize});
    };
    if (firstWrong(count, inflate) < count) {
      return fail("the compressed data of this array are damaged.");
    }
    return bytes;
  }

  template <class F>
  std::size_t firstWrong(std::size_t count, const F& inflate) {
    constexpr std::size_t kGrain = 8;  // blocks of some tens of kilobytes
    if (stage_ != nullptr) return firstFault(*stage_, count, inflate, kGrain);
    std::size_t i = 0;
    while (i < count && inflate(i)) ++i;
    return i;
  }

  Source source_;
  const VtuEncoding& encoding_;
  Stage* stage_;
  std::string& problem_;
};

}  // namespace

std::optional<Array<char>> decodeVtuArray(std::string_view text, const VtuEncoding& encoding,
                                          Stage* stage, std::string& problem) {
  if (encoding.compressed && !hasZlib()) {
    problem = "this program was built without zlib, which compressed arrays need.";
    return std::nullopt;
  }
  if (encoding.base64) return Decoder(Base64Reader(text), encoding, stage, problem).decode();
  return Decoder(RawReader(text), encoding, stage, problem).decode();
}

}  // namespace hexhex
