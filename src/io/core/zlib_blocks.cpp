#include <io/core/zlib_blocks.hpp>

#ifdef HEXHEX_HAS_ZLIB
#include <limits>
#include <new>
#include <zlib.h>

namespace hexhex::io {

bool hasZlib() noexcept { return true; }

bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept {
  // uLong has 32 bits on some machines; blocks are far smaller.
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  if (compressed.size() > kMost || bytes.size() > kMost) return false;
  auto size = static_cast<uLongf>(bytes.size());
  auto used = static_cast<uLong>(compressed.size());
  const int status = ::uncompress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                                   reinterpret_cast<const Bytef*>(compressed.data()), &used);
  return status == Z_OK && size == bytes.size();
}

void deflateBlock(std::span<const char> bytes, Array<char>& compressed) {
  constexpr int kLevel = 1;  // levels above take three times as long for a tenth less
  const std::size_t before = compressed.size();
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  compressed.resize(before + size);
  const int status = ::compress2(reinterpret_cast<Bytef*>(compressed.data() + before), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()),
                                 static_cast<uLong>(bytes.size()), kLevel);
  if (status != Z_OK) throw std::bad_alloc();  // there is room, so it can only lack memory
  compressed.resize(before + size);
}

}  // namespace hexhex::io

#else

#include <hexhex/error.hpp>

namespace hexhex::io {

bool hasZlib() noexcept { return false; }

bool inflateBlock(std::string_view /*compressed*/, std::span<char> /*bytes*/) noexcept {
  return false;
}

void deflateBlock(std::span<const char> /*bytes*/, Array<char>& /*compressed*/) {
  throw Error(ErrorCode::Internal, "This library was built without zlib.");
}

}  // namespace hexhex::io

#endif
