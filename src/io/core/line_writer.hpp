// Formats text in parallel and writes it in order, in bounded memory: formatting numbers takes
// longer than writing them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>

#include <base/function_ref.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>

namespace hexhex::io {

/// Writes runs of lines to a file.
class LineWriter {
 public:
  /// @param output   an OutputFile or FilePart
  /// @param threads  as in Context
  template <class Output>
  LineWriter(Output& output, int threads)
      : pass_([&output](std::string_view text) { output.writeBytes(text.data(), text.size()); }),
        quiet_(threads),
        stage_(quiet_, "write lines") {
    const auto count = kBlocksPerThread * static_cast<std::size_t>(effectiveThreads(threads));
    for (std::size_t i = 0; i < count; ++i) blocks_.emplace_back(new char[kBlockBytes]);
    sizes_.resize(count);
  }

  void write(std::string_view text) { pass_(text); }
  /// Writes the text that format(place, i) stores at `place`, a char*, for i in [0, n) in order.
  /// @param room    maximum size of one call's text, at most kBlockBytes
  /// @param format  returns the end of its text; called from several threads
  /// @param progress  advanced by n unless null
  template <class Format>
  void write(std::size_t n, std::size_t room, const Format& format, LoopProgress* progress) {
    writeBlocks(
        n, kBlockBytes / room,
        [&format](char* place, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) place = format(place, i);
          return place;
        },
        progress);
  }

 private:
  // Fits in the L2 cache, and makes the overhead of starting a block negligible.
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
  // Blocks take different times; with several per thread, no thread waits long for the others.
  static constexpr std::size_t kBlocksPerThread = 8;

  /// @param formatLines  stores the text of [begin, end), and returns its end
  void writeBlocks(std::size_t n, std::size_t grain,
                   FunctionRef<char*(char* place, std::size_t begin, std::size_t end)> formatLines,
                   LoopProgress* progress) {
    const std::size_t round = grain * blocks_.size();
    for (std::size_t first = 0; first < n; first += round) {
      const std::size_t count = std::min(round, n - first);
      withThreadsHere(quiet_.threads(), [&] {
        parallelBlocks(stage_, count, grain,
                       [&](std::size_t begin, std::size_t end, std::size_t block) {
                         char* const place = blocks_[block].get();
                         const char* const after = formatLines(place, first + begin, first + end);
                         sizes_[block] = static_cast<std::size_t>(after - place);
                       });
      });
      for (std::size_t block = 0; block < blockCount(count, grain); ++block) {
        pass_({blocks_[block].get(), sizes_[block]});
      }
      if (progress != nullptr) progress->advance(count);
    }
  }

  std::function<void(std::string_view)> pass_;
  // Rounds are internal: progress is reported across all of them.
  Context quiet_;
  Stage stage_;
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::vector<std::size_t> sizes_;
};

}  // namespace hexhex::io
