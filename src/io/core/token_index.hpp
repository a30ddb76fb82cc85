// Where the n-th token of a text is, so that several threads can read a text whose lines, if it has
// any, mean nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// White space of all text formats.
[[nodiscard]] constexpr bool isSpace(char c) noexcept {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Counts the tokens (runs of other characters than white space) of a text block by block.
class TokenIndex {
 public:
  /// @param text  must outlive the index
  TokenIndex(std::string_view text, Stage& stage);

  /// Number of tokens of the text.
  [[nodiscard]] std::size_t count() const noexcept { return before_.back(); }

  /// Number of tokens that begin before this position.
  [[nodiscard]] std::size_t countBefore(std::size_t position) const;

  /// Position of the first character of a token; the size of the text if there are not so many.
  [[nodiscard]] std::size_t find(std::size_t token) const;

 private:
  [[nodiscard]] bool beginsToken(std::size_t i) const {
    return !isSpace(text_[i]) && (i == 0 || isSpace(text_[i - 1]));
  }

  std::string_view text_;
  Array<std::size_t> before_;  ///< per block: tokens that begin before it; last: all
};

}  // namespace hexhex
