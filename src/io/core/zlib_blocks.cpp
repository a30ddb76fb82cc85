#include <string>

#include <hexhex/error.hpp>

#include <io/core/zlib_blocks.hpp>

#ifdef HEXHEX_HAS_ZLIB
#include <algorithm>
#include <limits>
#include <new>
#include <zlib.h>

namespace hexhex::io {

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

/// Decompresses a gzip file step by step.
class GzipStream {
 public:
  explicit GzipStream(std::string_view compressed) : rest_(compressed) {
    constexpr int kGzipOnly = 16;  // added to the window size
    if (::inflateInit2(&stream_, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~GzipStream() { ::inflateEnd(&stream_); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  /// Fills as much of `room` as possible. @return number of bytes; `good` is false for corrupt data
  [[nodiscard]] std::size_t read(std::span<char> room, bool& good) {
    constexpr std::size_t kStep = std::size_t{1} << 30;  // zlib's counts have 32 bits
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = static_cast<uInt>(std::min(rest_.size(), kStep));
    stream_.next_out = reinterpret_cast<Bytef*>(room.data());
    stream_.avail_out = static_cast<uInt>(std::min(room.size(), kStep));
    const uInt in = stream_.avail_in;
    const uInt out = stream_.avail_out;
    const int status = ::inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    rest_.remove_prefix(in - stream_.avail_in);
    ended_ = status == Z_STREAM_END;
    const std::size_t made = out - stream_.avail_out;
    good = ended_ || (status == Z_OK && (made > 0 || in > stream_.avail_in));
    if (ended_ && !rest_.empty()) good = ::inflateReset(&stream_) == Z_OK;
    return made;
  }
  /// Whether the last member is complete.
  [[nodiscard]] bool isComplete() const noexcept { return ended_ && rest_.empty(); }

 private:
  std::string_view rest_;
  z_stream stream_{};
  bool ended_ = false;
};

}  // namespace

Array<char> inflateGzip(std::string_view compressed, const std::string& name) {
  constexpr std::size_t kFirstRoom = std::size_t{1} << 16;
  GzipStream stream(compressed);
  Array<char> bytes;
  std::size_t size = 0;
  for (bool good = true; !stream.isComplete();) {
    if (size == bytes.size()) bytes.resize(std::max(2 * size, kFirstRoom));
    size += stream.read(std::span(bytes).subspan(size), good);
    if (good) continue;
    throw Error(ErrorCode::FileSyntax,
                name + ": the file is no complete gzip file, or damaged. Try `gzip --test`.");
  }
  bytes.resize(size);
  return bytes;
}

void deflateBlock(std::span<const char> bytes, Array<char>& compressed) {
  constexpr int kLevel = 1;  // higher levels take three times as long for 10 % less
  const std::size_t before = compressed.size();
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  compressed.resize(before + size);
  const int status = ::compress2(reinterpret_cast<Bytef*>(compressed.data() + before), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()),
                                 static_cast<uLong>(bytes.size()), kLevel);
  if (status != Z_OK) throw std::bad_alloc();  // the buffer is large enough, so memory ran out
  compressed.resize(before + size);
}

}  // namespace hexhex::io

#else
#include <base/missing_library.hpp>

namespace hexhex::io {

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

void deflateBlock(std::span<const char> /*bytes*/, Array<char>& /*compressed*/) {
  throw Error(ErrorCode::Internal, "This library was built without zlib.");
}

}  // namespace hexhex::io

#endif
