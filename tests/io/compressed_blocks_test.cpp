// Blocks compressed by zlib, and by libdeflate where it is installed, are read by zlib.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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

TEST(CompressedBlocks, OfAnySizeComeBack) {
  if (!hasZlib()) GTEST_SKIP() << "built without zlib";
  std::vector<std::size_t> sizes;
  for (std::size_t size = 1; size < 300; ++size) sizes.push_back(size);
  sizes.insert(sizes.end(), {65535, 65536, 131071, 131072});
  for (const std::size_t size : sizes) {
    for (const std::string& bytes : {noise(size), std::string(size, 'x')}) {
      for (const auto compress : {deflateByZlib, deflateBlock}) {
        Array<char> blocks(3, 'b');  // what is there already stays
        compress(bytes, blocks);
        ASSERT_EQ(std::string(blocks.begin(), blocks.begin() + 3), "bbb");
        std::string found(size, ' ');
        ASSERT_TRUE(inflateBlock({blocks.data() + 3, blocks.size() - 3}, found)) << size;
        EXPECT_EQ(found, bytes);
      }
    }
  }
}

}  // namespace
}  // namespace hexhex::io
