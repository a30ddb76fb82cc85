#include <algorithm>
#include <cassert>
#include <cstdint>
#include <new>
#include <string>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/loaded_library.hpp>
#include <base/missing_library.hpp>
#include <io/core/compressed_blocks.hpp>

#ifdef HEXHEX_HAS_ZLIB
#include <limits>
#include <memory>
#include <zlib.h>
#endif

namespace hexhex::io {

bool decodeLz4Block(std::string_view compressed, std::span<char> bytes) noexcept {
  std::size_t at = 0;
  std::size_t size = 0;
  const auto byte = [&] { return std::size_t{static_cast<unsigned char>(compressed[at++])}; };
  // A length of 15 goes on in further bytes, up to one below 255.
  const auto wholeLength = [&](std::size_t length) {
    bool goesOn = length == 15;
    while (goesOn && at < compressed.size()) {
      const std::size_t more = byte();
      length += more;
      goesOn = more == 255;
    }
    return length;
  };
  while (at < compressed.size()) {
    const std::size_t token = byte();
    const std::size_t literals = wholeLength(token >> 4U);
    if (literals > compressed.size() - at || literals > bytes.size() - size) return false;
    std::copy_n(compressed.data() + at, literals, bytes.data() + size);
    at += literals;
    size += literals;
    if (at == compressed.size()) break;  // the last sequence has literals only
    if (compressed.size() - at < 2) return false;
    const std::size_t low = byte();
    const std::size_t distance = low | byte() << 8U;
    constexpr std::size_t kShortestMatch = 4;
    std::size_t match = wholeLength(token & 15U) + kShortestMatch;
    if (distance == 0 || distance > size || match > bytes.size() - size) return false;
    for (; match > 0; --match, ++size) bytes[size] = bytes[size - distance];  // may overlap
  }
  return size == bytes.size();
}

namespace {

/// lzma_stream_buffer_decode() of liblzma 5, which few files need: it is not linked.
using DecodeLzma = int (*)(std::uint64_t* memoryLimit, std::uint32_t flags, const void* allocator,
                           const std::uint8_t* in, std::size_t* inPosition, std::size_t inSize,
                           std::uint8_t* out, std::size_t* outPosition, std::size_t outSize);

DecodeLzma lzma() {
  static const auto function =
      LoadedLibrary({"liblzma.so.5"}).find<DecodeLzma>("lzma_stream_buffer_decode");
  return function;
}

}  // namespace

void requireLzma(const std::filesystem::path& file) {
  if (lzma() != nullptr) return;
  throw Error(ErrorCode::FileUnsupported,
              concat(file,
                     ": arrays compressed with LZMA take the library liblzma, which cannot be "
                     "loaded. Install liblzma5, or save the file without compression."));
}

bool decodeLzmaBlock(std::string_view compressed, std::span<char> bytes) noexcept {
  std::uint64_t memoryLimit = std::uint64_t{1} << 30U;  // the strongest setting takes 65 MB
  std::size_t used = 0;
  std::size_t size = 0;
  const int status = lzma()(
      &memoryLimit, 0, nullptr, reinterpret_cast<const std::uint8_t*>(compressed.data()), &used,
      compressed.size(), reinterpret_cast<std::uint8_t*>(bytes.data()), &size, bytes.size());
  return status == 0 && size == bytes.size();
}

namespace {

/// Appends what compress(place) writes, at most `most` bytes, and returns as their number.
template <class Compress>
void appendBlock(Array<char>& compressed, std::size_t most, const Compress& compress) {
  const std::size_t before = compressed.size();
  compressed.resize(before + most);
  const std::size_t used = compress(compressed.data() + before);
  compressed.resize(before + used);
}

/// Of liblz4, which is not linked: readers do without it.
struct Lz4 {
  LoadedLibrary library{{"liblz4.so.1"}};
  int (*bound)(int size) = library.find<int (*)(int)>("LZ4_compressBound");
  int (*compress)(const char* in, char* out, int size, int room) =
      library.find<int (*)(const char*, char*, int, int)>("LZ4_compress_default");
};

const Lz4& lz4() {
  static const Lz4 loaded;
  return loaded;
}

}  // namespace

void requireLz4(const std::filesystem::path& file) {
  if (lz4().library.problem().empty()) return;
  throw Error(ErrorCode::FileUnsupported,
              concat(file,
                     ": compression with LZ4 takes the library liblz4, which cannot be loaded. "
                     "Install liblz4-1, or compress with zlib."));
}

void compressByLz4(std::span<const char> bytes, Array<char>& compressed) {
  const auto size = static_cast<int>(bytes.size());
  const int most = lz4().bound(size);
  appendBlock(compressed, static_cast<std::size_t>(most), [&](char* place) {
    const int used = lz4().compress(bytes.data(), place, size, most);
    if (used == 0) throw std::bad_alloc();  // there is room for all
    return static_cast<std::size_t>(used);
  });
}

#ifdef HEXHEX_HAS_ZLIB

bool hasZlib() noexcept { return true; }
void requireZlib(const std::filesystem::path& /*file*/, std::string_view /*work*/,
                 std::string_view /*instead*/) {}

bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept {
  // uLong has 32 bits on some platforms; blocks are far smaller.
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  if (compressed.size() > kMost || bytes.size() > kMost) return false;
  auto size = static_cast<uLongf>(bytes.size());
  auto used = static_cast<uLong>(compressed.size());
  const int status = ::uncompress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                                   reinterpret_cast<const Bytef*>(compressed.data()), &used);
  return status == Z_OK && size == bytes.size();
}

namespace {

constexpr int kLevel = 1;  // higher levels take longer for little: zlib's 6 three times, for 10 %

/// libdeflate, which compresses 2.5 times as fast as zlib, to a twentieth more. It is not linked.
class Libdeflate {
 public:
  /// @throws Error FileWrite if it is installed, but cannot be loaded: bytes must not depend on
  /// that
  Libdeflate() {
    LoadedLibrary library({"libdeflate.so.0"});
    allocate_ = library.find<decltype(allocate_)>("libdeflate_alloc_compressor");
    bound_ = library.find<decltype(bound_)>("libdeflate_zlib_compress_bound");
    compress_ = library.find<decltype(compress_)>("libdeflate_zlib_compress");
    free_ = library.find<decltype(free_)>("libdeflate_free_compressor");
    isMissing_ = library.isMissing();
    if (isMissing_ || library.problem().empty()) return;
    throw Error(ErrorCode::FileWrite,
                concat("libdeflate, which compresses blocks, cannot be loaded: ", library.problem(),
                       ". Write without compression, or remove that library."));
  }
  [[nodiscard]] bool isMissing() const { return isMissing_; }

  /// As deflateBlock().
  void deflate(std::span<const char> bytes, Array<char>& compressed) const {
    const std::unique_ptr<Compressor, void (*)(Compressor*)> compressor(allocate_(kLevel), free_);
    if (compressor == nullptr) throw std::bad_alloc();
    const std::size_t most = bound_(nullptr, bytes.size());
    appendBlock(compressed, most, [&](char* place) {
      const std::size_t used = compress_(compressor.get(), bytes.data(), bytes.size(), place, most);
      assert(used > 0);  // there is room for all
      return used;
    });
  }

 private:
  struct Compressor;
  bool isMissing_ = true;
  Compressor* (*allocate_)(int level) = nullptr;
  std::size_t (*bound_)(Compressor*, std::size_t size) = nullptr;
  std::size_t (*compress_)(Compressor*, const void* in, std::size_t inSize, void* out,
                           std::size_t outSize) = nullptr;
  void (*free_)(Compressor*) = nullptr;
};

}  // namespace

Array<char> inflateGzip(std::string_view compressed, const std::string& name) {
  constexpr std::size_t kFirstRoom = std::size_t{1} << 16;
  constexpr std::size_t kStep = std::size_t{1} << 30;  // zlib's counts have 32 bits
  constexpr int kGzipOnly = 16;                        // added to the window size
  z_stream stream{};
  if (::inflateInit2(&stream, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, ::inflateEnd);
  Array<char> bytes;
  std::size_t size = 0;
  bool isComplete = false;  // whether the last member is
  while (!isComplete || !compressed.empty()) {
    if (size == bytes.size()) bytes.resize(std::max(2 * size, kFirstRoom));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
    stream.avail_in = static_cast<uInt>(std::min(compressed.size(), kStep));
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + size);
    stream.avail_out = static_cast<uInt>(std::min(bytes.size() - size, kStep));
    const uInt in = stream.avail_in;
    const uInt out = stream.avail_out;
    const int status = ::inflate(&stream, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    const bool moved = stream.avail_in < in || stream.avail_out < out;
    compressed.remove_prefix(in - stream.avail_in);
    size += out - stream.avail_out;
    isComplete = status == Z_STREAM_END;
    if (isComplete && (compressed.empty() || ::inflateReset(&stream) == Z_OK)) continue;
    if (status == Z_OK && moved) continue;
    throw Error(ErrorCode::FileSyntax,
                name + ": the file is no complete gzip file, or damaged. Try `gzip --test`.");
  }
  bytes.resize(size);
  return bytes;
}

void deflateByZlib(std::span<const char> bytes, Array<char>& compressed) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  appendBlock(compressed, size, [&](char* place) {
    const int status = ::compress2(reinterpret_cast<Bytef*>(place), &size,
                                   reinterpret_cast<const Bytef*>(bytes.data()),
                                   static_cast<uLong>(bytes.size()), kLevel);
    if (status != Z_OK) throw std::bad_alloc();  // there is room for all, so memory ran out
    return std::size_t{size};
  });
}

void deflateBlock(std::span<const char> bytes, Array<char>& compressed) {
  static const Libdeflate library;
  if (library.isMissing()) return deflateByZlib(bytes, compressed);
  library.deflate(bytes, compressed);
}

#else

bool hasZlib() noexcept { return false; }
void requireZlib(const std::filesystem::path& file, std::string_view work,
                 std::string_view instead) {
  failWithoutLibrary(work, "zlib (zlib1g-dev)", instead, file);
}

bool inflateBlock(std::string_view /*compressed*/, std::span<char> /*bytes*/) noexcept {
  return false;
}

Array<char> inflateGzip(std::string_view /*compressed*/, const std::string& name) {
  requireZlib(name, "read compressed files", "unpack the file first (gunzip)");
  return {};
}

void deflateByZlib(std::span<const char> /*bytes*/, Array<char>& /*compressed*/) {
  throw Error(ErrorCode::Internal, "This library was built without zlib.");
}

void deflateBlock(std::span<const char> bytes, Array<char>& compressed) {
  deflateByZlib(bytes, compressed);
}

#endif

}  // namespace hexhex::io
