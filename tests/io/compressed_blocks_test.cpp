// Blocks compressed by zlib, libdeflate and liblz4, where these are installed, can be read.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <support/compressions.hpp>

#include <hexhex/types.hpp>

#include <io/core/compressed_blocks.hpp>

namespace hexhex::io {
namespace {

/// Bytes that no compressor makes smaller.
std::string noise(std::size_t size) {
  std::string bytes(size, ' ');
  std::uint64_t state = 1;
  for (char& byte : bytes) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    byte = static_cast<char>(state >> 56U);
  }
  return bytes;
}

using Compress = void(std::span<const char> bytes, Array<char>& compressed);
using Decode = bool(std::string_view compressed, std::span<char> bytes) noexcept;

void expectBlocksOfAnySize(Compress& compress, Decode& decode) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = 1; size < 300; ++size) sizes.push_back(size);
  sizes.insert(sizes.end(), {65535, 65536, 131071, 131072});
  for (const std::size_t size : sizes) {
    for (const std::string& bytes : {noise(size), std::string(size, 'x')}) {
      Array<char> blocks(3, 'b');  // what is there already stays
      compress(bytes, blocks);
      ASSERT_EQ(std::string(blocks.begin(), blocks.begin() + 3), "bbb");
      std::string found(size, ' ');
      ASSERT_TRUE(decode({blocks.data() + 3, blocks.size() - 3}, found)) << size;
      EXPECT_EQ(found, bytes);
    }
  }
}

TEST(CompressedBlocks, OfAnySizeComeBack) {
  if (!hasZlib()) GTEST_SKIP() << "built without zlib";
  expectBlocksOfAnySize(deflateByZlib, inflateBlock);
  expectBlocksOfAnySize(deflateBlock, inflateBlock);
}

TEST(CompressedBlocks, OfLz4ComeBack) {
  if (!test::isThere(Compression::Lz4)) GTEST_SKIP() << "liblz4 is not installed";
  expectBlocksOfAnySize(compressByLz4, decodeLz4Block);
}

}  // namespace
}  // namespace hexhex::io
