#include <algorithm>
#include <span>

#include <base/parallel.hpp>
#include <io/core/token_index.hpp>

namespace hexhex {
namespace {

// What find() scans in vain: little compared with what a thread then reads from there.
constexpr std::size_t kBlockBytes = std::size_t{1} << 13;
// Blocks that one thread counts in a go.
constexpr std::size_t kGrain = 64;
// The largest number of tokens that a byte counts: the loop over so many is one of vectors.
constexpr std::size_t kStride = 128;

constexpr unsigned isGap(char c) { return isSpace(c) ? 1 : 0; }

/// Number of places where a token begins; `previous` is the character before the text.
std::size_t countTokens(char previous, std::string_view text) {
  std::size_t count = 0;
  std::size_t i = 0;
  if (!text.empty() && !isSpace(text[0]) && isSpace(previous)) ++count;
  for (i = 1; i < text.size(); i += kStride) {
    const std::size_t end = std::min(i + kStride, text.size());
    std::uint8_t part = 0;
    for (std::size_t j = i; j < end; ++j) {
      // Not &&, so that there is no branch.
      part = static_cast<std::uint8_t>(part + (isGap(text[j - 1]) & (1U - isGap(text[j]))));
    }
    count += part;
  }
  return count;
}

}  // namespace

TokenIndex::TokenIndex(std::string_view text, Stage& stage) : text_(text) {
  const std::size_t blocks = blockCount(text.size(), kBlockBytes);
  before_.resize(blocks + 1);
  before_.back() = 0;
  parallelFor(stage, blocks, kGrain, [&](std::size_t block) {
    const std::size_t begin = block * kBlockBytes;
    before_[block] =
        countTokens(begin == 0 ? ' ' : text[begin - 1], text.substr(begin, kBlockBytes));
  });
  exclusiveScan(std::span(before_));
}

std::size_t TokenIndex::countBefore(std::size_t position) const {
  const std::size_t block = position / kBlockBytes;
  std::size_t count = before_[block];
  for (std::size_t i = block * kBlockBytes; i < position; ++i) count += beginsToken(i) ? 1 : 0;
  return count;
}

std::size_t TokenIndex::find(std::size_t token) const {
  if (token >= count()) return text_.size();
  const auto next = std::upper_bound(before_.begin(), before_.end(), token);
  const auto block = static_cast<std::size_t>(next - before_.begin()) - 1;
  std::size_t left = token - before_[block];
  for (std::size_t i = block * kBlockBytes;; ++i) {
    if (beginsToken(i) && left-- == 0) return i;
  }
}

}  // namespace hexhex
