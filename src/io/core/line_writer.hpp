// Formats text in parallel and writes it in order, with bounded memory: numbers take longer to
// spell than a file system to swallow.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/output_file.hpp>

namespace hexhex {

/// Room for any number: the longest, -1.2345678901234567e-308, has 24 characters.
inline constexpr std::size_t kNumberRoom = 24;

// Each puts text at a place that has room for it, and returns the place behind.
[[nodiscard]] inline char* put(char* place, char character) {
  *place = character;
  return place + 1;
}
[[nodiscard]] inline char* put(char* place, std::string_view text) {
  return std::copy(text.begin(), text.end(), place);
}
/// With the fewest digits (at most 17) that read back to the same value.
[[nodiscard]] inline char* put(char* place, double number) {
  // Whole numbers, which maps are full of, take a fifth of the time as integers. Of up to five
  // digits, none has a shorter form with an exponent; 0 may be negative.
  constexpr double kMost = 99999;
  if (number >= -kMost && number <= kMost && number != 0) {
    const auto whole = static_cast<std::int32_t>(number);
    if (static_cast<double>(whole) == number) {
      return std::to_chars(place, place + kNumberRoom, whole).ptr;
    }
  }
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
[[nodiscard]] inline char* put(char* place, std::int32_t number) {
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
[[nodiscard]] inline char* put(char* place, std::unsigned_integral auto number) {
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
/// Numbers with a space between them.
template <class Number, std::size_t n>
[[nodiscard]] char* putNumbers(char* place, const std::array<Number, n>& numbers) {
  place = put(place, numbers[0]);
  for (std::size_t i = 1; i < n; ++i) {
    *place++ = ' ';
    place = put(place, numbers[i]);
  }
  return place;
}

/// Writes runs of lines to a file.
class LineWriter {
 public:
  /// @param threads  as in Context
  LineWriter(OutputFile& output, int threads)
      : output_(output), quiet_(threads), stage_(quiet_, "write lines") {
    const auto count = kBlocksPerThread * static_cast<std::size_t>(effectiveThreads(threads));
    for (std::size_t i = 0; i < count; ++i) blocks_.emplace_back(new char[kBlockBytes]);
    sizes_.resize(count);
  }

  /// Writes what format(place, i) puts at its place, a char*, for every i in [0, n) in order.
  /// @param room    the most that one call of format puts there, at most kBlockBytes
  /// @param format  returns the place behind its text; called from several threads
  /// @param progress  advances by n if not null
  template <class Format>
  void write(std::size_t n, std::size_t room, const Format& format, LoopProgress* progress) {
    const std::size_t grain = kBlockBytes / room;
    const std::size_t round = grain * blocks_.size();
    for (std::size_t first = 0; first < n; first += round) {
      const std::size_t count = std::min(round, n - first);
      fillBlocks(first, count, grain, format);
      for (std::size_t block = 0; block < blockCount(count, grain); ++block) {
        output_.writeBytes(blocks_[block].get(), sizes_[block]);
      }
      if (progress != nullptr) progress->advance(count);
    }
  }

 private:
  // Fits in the second-level cache, and makes the cost of a block's start negligible.
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
  // Blocks take different times; with several for each thread no thread waits long for the others.
  static constexpr std::size_t kBlocksPerThread = 8;

  template <class Format>
  void fillBlocks(std::size_t first, std::size_t count, std::size_t grain, const Format& format) {
    withThreadsHere(quiet_.threads(), [&] {
      parallelBlocks(stage_, count, grain,
                     [&](std::size_t begin, std::size_t end, std::size_t block) {
                       char* place = blocks_[block].get();
                       for (std::size_t i = begin; i < end; ++i) place = format(place, first + i);
                       sizes_[block] = static_cast<std::size_t>(place - blocks_[block].get());
                     });
    });
  }

  OutputFile& output_;
  // Rounds are no matter of the caller's: progress is reported across all of them.
  Context quiet_;
  Stage stage_;
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::vector<std::size_t> sizes_;
};

/// Puts the bytes of a number, least first, and returns the place behind.
template <class T>
[[nodiscard]] char* putBytes(char* place, T number) {
  const auto bytes = littleBytes(number);
  return std::copy(bytes.begin(), bytes.end(), place);
}

/// The same of three coordinates.
[[nodiscard]] inline char* putBytes(char* place, const Vec3& point) {
  for (const double coordinate : point) place = putBytes(place, coordinate);
  return place;
}

/// Writes the bytes of a number, least first.
template <class T>
void writeBytesOf(OutputFile& output, T number) {
  const auto bytes = littleBytes(number);
  output.writeBytes(bytes.data(), bytes.size());
}

}  // namespace hexhex
