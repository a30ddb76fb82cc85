// A text that is read from front to back, with some megabytes of it in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {

class TextWindow {
 public:
  /// @param file     a regular file; outlives this
  /// @param context  ends reading where it is cancelled
  /// @param size     how much is in memory: for files of bytes, the words between them need little
  TextWindow(const InputFile& file, std::string name, Context& context, std::size_t size = kText);
  static constexpr std::size_t kText = std::size_t{1} << 23;
  static constexpr std::size_t kWords = std::size_t{1} << 16;

  /// Goes to a byte of the file.
  void moveTo(std::uint64_t position);
  /// The byte that comes next.
  [[nodiscard]] std::uint64_t position() const { return begin_ + scanner_->position(); }

  /// The rest of a line at the beginning of the file; it is in memory.
  [[nodiscard]] std::string takeLine() { return std::string(scanner_->takeLine()); }
  /// The next token; empty at the end of the file.
  [[nodiscard]] std::string token();
  /// The next token as a number from 0; nothing if it is none.
  [[nodiscard]] std::optional<std::uint64_t> count();
  /// Skips so many tokens. @return whether there were as many
  [[nodiscard]] bool skip(std::uint64_t tokens);
  /// Goes behind a line break. @return whether there is one
  [[nodiscard]] bool skipLineBreak();

  /// Calls read(scanner, i), which reads element i or throws an Error, for the next n elements,
  /// from several threads.
  template <class Read>
  void elements(std::size_t n, std::size_t tokensEach, const Read& read) {
    for (std::size_t done = 0; done < n;) {
      const std::size_t complete = std::min(n - done, tokensLeft() / tokensEach);
      if (complete == 0 && !fill()) {
        throw Error(ErrorCode::FileSyntax, name_ + ": the file is incomplete.");
      }
      readElements(*scanner_, &*index_, stage_, complete, tokensEach,
                   [&](TextScanner& scanner, std::size_t i) { read(scanner, done + i); });
      done += complete;
    }
  }

  /// Whether there were marks of comments in what was in memory so far.
  [[nodiscard]] bool sawComments() const noexcept { return sawComments_; }

 private:
  [[nodiscard]] std::size_t tokensLeft() const {
    return index_->count() - index_->countBefore(scanner_->position());
  }
  /// Drops what is behind and reads on. @return whether there was more
  bool fill();

  const InputFile& file_;
  std::string name_;
  Context& context_;
  Context quiet_;  ///< many short loops, which report no progress
  Stage stage_;
  Array<char> bytes_;
  std::uint64_t begin_ = 0;  ///< in the file, of the bytes
  std::size_t size_ = 0;     ///< how many there are
  std::optional<TextScanner> scanner_;
  std::optional<TokenIndex> index_;
  bool sawComments_ = false;
};

}  // namespace hexhex::io
