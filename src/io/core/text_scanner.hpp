// Scans text in memory: tokens separated by white space, numbers (decimals of any length, and
// rationals p/q), errors with line numbers; reads elements with equal numbers of tokens in
// parallel.
#pragma once

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#if defined(__APPLE__)
#include <xlocale.h>
#elif !defined(_WIN32)
#include <locale.h>  // NOLINT(modernize-deprecated-headers): POSIX has more in it than C++
#endif

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/concat.hpp>
#include <base/function_ref.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>

namespace hexhex::io {

/// White space in all text formats.
[[nodiscard]] constexpr bool isSpace(char c) noexcept {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Without white space at both ends.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

/// Lower case of ASCII letters, independent of the locale.
[[nodiscard]] constexpr char lowerCase(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
[[nodiscard]] std::string lowerCase(std::string_view word);
/// The extension with its dot; empty if there is none.
[[nodiscard]] std::string lowerCaseExtension(const std::filesystem::path& file);

#if !defined(_WIN32)
namespace detail {

/// doubleFromChars(), based on strtod().
inline std::from_chars_result doubleByStrtod(const char* first, const char* last, double& value) {
  // from_chars() accepts neither leading spaces nor plus signs, and reads "0x1" as 0.
  constexpr std::string_view kCharacters = "+-.0123456789eEinfatyINFATY()";
  const std::string_view text(first, static_cast<std::size_t>(last - first));
  const std::string number(text.substr(0, text.find_first_not_of(kCharacters)));
  if (number.empty() || number.front() == '+') return {first, std::errc::invalid_argument};
  // The program may have set a locale with another decimal point.
  static const auto plain = newlocale(LC_ALL_MASK, "C", nullptr);
  char* end = nullptr;
  const double parsed = strtod_l(number.c_str(), &end, plain);
  const auto length = end - number.c_str();
  if (length == 0) return {first, std::errc::invalid_argument};
  const bool hasDigit = number.find_first_of("0123456789") < static_cast<std::size_t>(length);
  const bool hasNonzero = number.find_first_of("123456789") <
                          std::min(number.find_first_of("eE"), static_cast<std::size_t>(length));
  if (hasDigit && (std::isinf(parsed) || (parsed == 0 && hasNonzero))) {
    return {first + length, std::errc::result_out_of_range};
  }
  value = parsed;
  return {first + length, std::errc()};
}

}  // namespace detail
#endif

/// std::from_chars() for doubles, also where the standard library supports integers only (libc++
/// before 20).
/// @tparam T  double; a template parameter, so that a missing overload is not a compile error
template <class T>
std::from_chars_result doubleFromChars(const char* first, const char* last, T& value) {
#if !defined(_WIN32)
  if constexpr (!requires { std::from_chars(first, last, value); }) {
    return detail::doubleByStrtod(first, last, value);
  } else
#endif
  {
    return std::from_chars(first, last, value);
  }
}

enum class NumberProblem {
  None,
  NotANumber,
  NotFinite,        ///< infinity or NaN, written as a word
  Overflow,         ///< beyond the largest double
  ZeroDenominator,  ///< p/0
  TooLong           ///< a rational with more digits than kMaxRationalDigits
};

/// Limit for numerators and denominators, far beyond what exact maps contain (a few hundred
/// digits).
inline constexpr std::size_t kMaxRationalDigits = std::size_t{1} << 16;

/// Parses one whole token: an optional sign; then a decimal number with or without a point and an
/// exponent (Fortran's 1.5D+01 included), or two integers separated by '/'. The result is the
/// nearest double, ties to even; numbers too small for a double become 0.
/// @param[out] value  set if the result is None
[[nodiscard]] NumberProblem parseNumber(std::string_view token, double& value);

/// Parses a whole word as an integer; false if it is none, or does not fit.
template <class Integer>
[[nodiscard]] bool parseInteger(std::string_view word, Integer& value) {
  const char* const end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

/// The double nearest to numerator / denominator, ties to even; infinity on overflow; subnormal or
/// 0 on underflow.
///
/// Both consist of decimal digits, at least one, without a sign; the denominator is not 0.
[[nodiscard]] double nearestQuotient(std::string_view numerator, std::string_view denominator);

/// Name of a number in messages: "the dimension", "a coordinate of vertex 12".
struct NumberName {
  static constexpr std::size_t kNoNumber = ~std::size_t{0};

  NumberName(const char* name) : before(name) {}  // best a literal, whose length is known
  NumberName(std::string_view name) : before(name) {}
  NumberName(std::string_view before_, std::string_view of_, std::size_t number_ = kNoNumber)
      : before(before_), of(of_), number(number_) {}

  [[nodiscard]] std::string text() const {
    const std::string name = concat(before, of);
    return number == kNoNumber ? name : concat(name, " ", number);
  }

  std::string_view before;
  std::string_view of;
  std::size_t number = kNoNumber;
};

/// Finds the n-th token (run of non-space characters) of a text, so that several threads can read
/// it. Only for texts in which line breaks have no meaning.
class TokenIndex {
 public:
  /// @param text  must outlive the index
  TokenIndex(std::string_view text, Stage& stage);

  /// Number of tokens of the text.
  [[nodiscard]] std::size_t count() const noexcept { return before_.back(); }

  /// Number of tokens that begin before this position.
  [[nodiscard]] std::size_t countBefore(std::size_t position) const;

  /// Position of the first character of a token; the size of the text if there is no such token.
  [[nodiscard]] std::size_t find(std::size_t token) const;

 private:
  [[nodiscard]] bool beginsToken(std::size_t i) const {
    return !isSpace(text_[i]) && (i == 0 || isSpace(text_[i - 1]));
  }

  std::string_view text_;
  Array<std::size_t> before_;  ///< per block: tokens that begin before it; last: all
};

/// Reads tokens in sequence. Functions named read... return false and do not advance if the next
/// token is not of the expected kind or the text ends; a fail... function then reports why. Lines
/// are counted only when an error is raised, so that reading does not pay for them.
class TextScanner {
 public:
  enum class Comments {
    None,
    Hash  ///< from '#' to the end of the line
  };

  /// @param text  must outlive the scanner
  /// @param fileName  for error messages
  TextScanner(std::string_view text, std::string fileName, Comments comments = Comments::None)
      : begin_(text.data()),
        position_(text.data()),
        token_(text.data()),
        end_(text.data() + text.size()),
        fileName_(std::move(fileName)),
        comments_(comments) {}

  /// Moves to the i-th character of the text.
  void moveTo(std::size_t i) { position_ = token_ = begin_ + i; }
  /// Number of characters read.
  [[nodiscard]] std::size_t position() const noexcept {
    return static_cast<std::size_t>(position_ - begin_);
  }
  [[nodiscard]] std::string_view text() const noexcept {
    return {begin_, static_cast<std::size_t>(end_ - begin_)};
  }

  /// Moves to the next token; false at the end of the text.
  bool skipSpace() {
    while (position_ != end_) {
      if (isSpace(*position_)) {
        ++position_;
      } else if (isComment(*position_)) {
        skipLine();
      } else {
        break;
      }
    }
    token_ = position_;
    return position_ != end_;
  }

  /// Reads a finite number: decimal, correctly rounded, or rational (see parseNumber).
  bool readNumber(double& value) {
    if (!skipSpace()) return false;
    const auto result = doubleFromChars(position_, end_, value);
    if (result.ec == std::errc{} && endsToken(result.ptr) && std::isfinite(value)) {
      position_ = result.ptr;
      return true;
    }
    return readUnusualNumber(value);
  }

  /// Reads an integer; beyond 64 bits, the result saturates.
  bool readInteger(std::int64_t& value) {
    if (!skipSpace()) return false;
    const char* const first = skipPlus(position_);
    const auto result = std::from_chars(first, end_, value);
    if (result.ec == std::errc::invalid_argument || !endsToken(result.ptr)) return false;
    if (result.ec == std::errc::result_out_of_range) value = *first == '-' ? INT64_MIN : INT64_MAX;
    position_ = result.ptr;
    return true;
  }

  // The same for mandatory numbers: errors say what was found instead.
  [[nodiscard]] double number(const NumberName& name) {
    double value = 0;
    if (!readNumber(value)) failNumber(name.text());
    return value;
  }
  [[nodiscard]] std::int64_t integer(const NumberName& name) {
    std::int64_t value = 0;
    if (!readInteger(value)) failInteger(name.text());
    return value;
  }

  /// Reads the number of elements that follow, each taking at least `bytesEach` bytes of the file,
  /// and refuses impossible numbers before memory is allocated for them.
  /// @param what  plural, e.g. "vertices"
  [[nodiscard]] std::size_t readCount(std::string_view what, std::size_t bytesEach);

  /// The next token, without reading it; empty at the end of the text.
  [[nodiscard]] std::string_view peekToken();
  /// Reads the next token of any kind; empty at the end of the text.
  std::string_view readToken();
  /// The last token read, or the one that could not be read.
  [[nodiscard]] std::string_view currentToken() const;

  /// Reads the rest of the line, without the line break.
  std::string_view takeLine();
  /// Moves to the next line, where binary data begins; the rest of this line must be blank.
  void skipLineBreak();

  /// Number of tokens from the next one to the end of its line.
  [[nodiscard]] std::size_t countTokensOnLine();

  /// The 1-based line of the current token.
  [[nodiscard]] std::uint64_t line() const;

  [[nodiscard]] const std::string& fileName() const noexcept { return fileName_; }
  [[nodiscard]] bool mayHaveComments() const noexcept { return comments_ == Comments::Hash; }
  /// From here on, '#' has no meaning.
  void endComments() noexcept { comments_ = Comments::None; }

  /// Throws an error about the current token: "<file>, line 12: <sentence>".
  /// @param sentence  its parts, as for concat()
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    fail(code, Place{PlaceKind::Line, line()}, sentence...);
  }
  /// The same with a place other than the line.
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Place place, Parts... sentence) const {
    throw Error(code, concat(fileName_, ", line ", line(), ": ", sentence...), place);
  }
  /// After readNumber returned false: throws an error that says what was found instead of `what`.
  [[noreturn]] void failNumber(std::string_view what) const;
  /// After readInteger returned false: the same.
  [[noreturn]] void failInteger(std::string_view what) const;
  /// After readToken returned an unexpected token: the same.
  [[noreturn]] void failToken(std::string_view what) const;
  /// Throws if the text ends after `done` elements.
  void failIfAtEnd(std::size_t done, std::size_t count, std::string_view what);
  /// Throws if a section was read already.
  void failIfRepeated(bool present, std::string_view section) const;

 private:
  [[nodiscard]] bool isComment(char c) const { return c == '#' && mayHaveComments(); }
  [[nodiscard]] bool endsToken(const char* place) const {
    return place == end_ || isSpace(*place) || isComment(*place);
  }
  /// std::from_chars does not accept a plus sign.
  [[nodiscard]] const char* skipPlus(const char* place) const {
    const bool plus = *place == '+' && place + 1 != end_ && place[1] != '-';
    return plus ? place + 1 : place;
  }
  void skipLine() {
    while (position_ != end_ && *position_ != '\n') ++position_;
  }
  bool readUnusualNumber(double& value);
  /// Throws an error about the current token, or about the end of the file.
  [[noreturn]] void failFound(ErrorCode code, std::string_view what,
                              std::string_view problem) const;

  const char* begin_;
  const char* position_;
  const char* token_;
  const char* end_;
  std::string fileName_;
  Comments comments_;
};

/// "announces 9 nodes; at most 5 are supported."
[[nodiscard]] std::string exceedsLimit(std::uint64_t count, std::string_view what,
                                       std::uint64_t limit);

/// "announces 9 nodes, but the rest of the file has room for at most 3: ..."
[[nodiscard]] std::string lacksRoom(std::string_view count, std::string_view what,
                                    std::size_t room);

/// A token for error messages: quoted, truncated, without control characters.
[[nodiscard]] std::string quoted(std::string_view token);

/// Elements per task of a thread, which take less than a millisecond.
inline constexpr std::size_t kElementGrain = 1024;

/// Calls read(begin, end, i), which reads elements [begin, end) and advances i from begin to end,
/// for blocks of at most `grain` elements of [0, n), in parallel. At an invalid element it stops or
/// throws an Error.
/// @return the first invalid element, or n
[[nodiscard]] std::size_t firstUnreadable(
    Stage& stage, std::size_t n, std::size_t grain,
    FunctionRef<void(std::size_t, std::size_t, std::size_t&)> read);

}  // namespace hexhex::io
