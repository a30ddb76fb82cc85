#include <algorithm>
#include <span>

#include <base/parallel.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/vtk/vtu_blocks.hpp>

namespace hexhex {
namespace {

// A millisecond's work, and as large as zlib's window needs to be good.
constexpr std::size_t kBlockBytes = std::size_t{1} << 17;
// Blocks that are compressed at once.
constexpr std::size_t kBatch = 64;

}  // namespace

VtuBlocks::VtuBlocks(OutputFile& output, std::uint64_t position, std::uint64_t bytes, int threads)
    : output_(output),
      quiet_(threads),
      stage_(quiet_, "compress"),
      headPosition_(position),
      lastBlock_(bytes % kBlockBytes),
      blocks_((bytes + kBlockBytes - 1) / kBlockBytes),
      compressed_(kBatch) {
  // The number of blocks, the size of one, that of a last shorter one, those of compressed ones.
  const std::vector<std::uint64_t> room(3 + blocks_, 0);
  output_.writeBytes(room.data(), room.size() * sizeof(std::uint64_t));
  position_ = position + room.size() * sizeof(std::uint64_t);
  collected_.resize(std::min<std::uint64_t>(kBatch, blocks_) * kBlockBytes);
}

void VtuBlocks::writeBytes(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const std::size_t count = std::min(size, collected_.size() - used_);
    std::copy_n(from, count, collected_.data() + used_);
    from += count;
    used_ += count;
    size -= count;
    if (used_ == collected_.size()) compress();
  }
}

void VtuBlocks::compress() {
  const std::size_t blocks = blockCount(used_, kBlockBytes);
  withThreadsHere(quiet_.threads(), [&] {
    parallelBlocks(
        stage_, used_, kBlockBytes, [&](std::size_t begin, std::size_t end, std::size_t block) {
          compressed_[block].clear();
          deflateBlock(std::span(collected_).subspan(begin, end - begin), compressed_[block]);
        });
  });
  for (std::size_t block = 0; block < blocks; ++block) {
    output_.writeBytes(compressed_[block].data(), compressed_[block].size());
    sizes_.push_back(compressed_[block].size());
    position_ += compressed_[block].size();
  }
  used_ = 0;
}

std::uint64_t VtuBlocks::finish() {
  compress();
  std::vector<std::uint64_t> head = {blocks_, kBlockBytes, lastBlock_};
  head.insert(head.end(), sizes_.begin(), sizes_.end());
  output_.flush();
  output_.writeBytesAt(headPosition_, head.data(), head.size() * sizeof(std::uint64_t));
  return position_;
}

}  // namespace hexhex
