#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <system_error>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Removes a leading sign; returns whether it was a minus.
bool takeSign(std::string_view& token) {
  if (token.empty() || (token.front() != '-' && token.front() != '+')) return false;
  const bool negative = token.front() == '-';
  token.remove_prefix(1);
  return negative;
}

bool allDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), isDigit);
}

NumberProblem parseRational(std::string_view rational, double& value) {
  const std::size_t slash = rational.find('/');
  const std::string_view numerator = rational.substr(0, slash);
  std::string_view denominator = rational.substr(slash + 1);
  const bool negative = takeSign(denominator);
  if (!allDigits(numerator) || !allDigits(denominator)) return NumberProblem::NotANumber;
  if (std::max(numerator.size(), denominator.size()) > kMaxRationalDigits) {
    return NumberProblem::TooLong;
  }
  if (denominator.find_first_not_of('0') == std::string_view::npos) {
    return NumberProblem::ZeroDenominator;
  }
  const double quotient = nearestQuotient(numerator, denominator);
  if (std::isinf(quotient)) return NumberProblem::Overflow;
  value = negative ? -quotient : quotient;
  return NumberProblem::None;
}

/// Whether a decimal number outside the range of doubles is too large rather than too small:
/// decided by the decimal exponent of its first nonzero digit.
bool isTooLarge(std::string_view decimal) {
  const std::size_t mantissaEnd = std::min(decimal.find_first_of("eE"), decimal.size());
  const std::string_view mantissa = decimal.substr(0, mantissaEnd);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_not_of("0.");
  if (first == std::string_view::npos) return false;
  std::int64_t exponent = 0;
  if (mantissaEnd < decimal.size()) {
    std::string_view digits = decimal.substr(mantissaEnd + 1);
    const bool negative = takeSign(digits);
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (result.ec == std::errc::result_out_of_range) return !negative;
    if (negative) exponent = -exponent;
  }
  // Half the range, so that adding the length of the mantissa cannot overflow.
  constexpr std::int64_t kLimit = std::numeric_limits<std::int64_t>::max() / 2;
  exponent = std::clamp(exponent, -kLimit, kLimit);
  return exponent + static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) > 0;
}

NumberProblem parseDecimal(std::string_view decimal, double& value) {
  if (decimal.empty()) return NumberProblem::NotANumber;
  double parsed = 0;
  const char* const end = decimal.data() + decimal.size();
  const auto result = doubleFromChars(decimal.data(), end, parsed);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) {
    return NumberProblem::NotANumber;
  }
  const bool spelledOut = !isDigit(decimal.front()) && decimal.front() != '.';
  if (spelledOut) return NumberProblem::NotFinite;
  if (result.ec == std::errc::result_out_of_range || std::isinf(parsed)) {
    if (isTooLarge(decimal)) return NumberProblem::Overflow;
    parsed = 0;
  }
  value = parsed;
  return NumberProblem::None;
}

}  // namespace

NumberProblem parseNumber(std::string_view token, double& value) {
  const bool isRational = token.find('/') != std::string_view::npos;
  const std::size_t exponent = isRational ? token.size() : token.find_first_of("dDeE");
  if (exponent < token.size() && lowerCase(token[exponent]) == 'd') {
    std::string usual(token);
    usual[exponent] = 'e';
    return parseNumber(usual, value);
  }
  const bool negative = takeSign(token);
  if (!token.empty() && (token.front() == '-' || token.front() == '+')) {
    return NumberProblem::NotANumber;
  }
  double magnitude = 0;
  const NumberProblem problem =
      isRational ? parseRational(token, magnitude) : parseDecimal(token, magnitude);
  if (problem == NumberProblem::None) value = negative ? -magnitude : magnitude;
  return problem;
}

namespace {

/// A natural number: base 10^18, most significant limb first.
using Natural = std::vector<std::uint64_t>;

constexpr std::uint64_t kBase = 1'000'000'000'000'000'000;
constexpr std::size_t kLimbDigits = 18;

/// Divides natural numbers digit by digit, as on paper.
class LongDivision {
 public:
  /// @param dividend, divisor  digits, the first of which is not 0; as if a point stood behind it
  LongDivision(std::string_view dividend, std::string_view divisor)
      : limbs_(std::max(dividend.size(), divisor.size()) / kLimbDigits + 2),
        remainder_(limbsOf(dividend)) {
    const Natural one = limbsOf(divisor);
    multiples_[0].resize(limbs_, 0);
    for (std::size_t k = 1; k < multiples_.size(); ++k) {
      multiples_[k] = multiples_[k - 1];
      std::uint64_t carry = 0;
      for (std::size_t i = limbs_; i-- > 0;) {
        multiples_[k][i] += one[i] + carry;
        carry = multiples_[k][i] / kBase;
        multiples_[k][i] %= kBase;
      }
    }
  }

  /// The next digit of the quotient; the first one stands before the point, and may be 0.
  [[nodiscard]] char nextDigit() {
    const auto above = std::upper_bound(multiples_.begin(), multiples_.end(), remainder_);
    const Natural& taken = *std::prev(above);
    std::uint64_t borrow = 0;
    std::uint64_t carry = 0;
    for (std::size_t i = limbs_; i-- > 0;) {
      const std::uint64_t less = taken[i] + borrow;
      borrow = remainder_[i] < less ? 1 : 0;
      const std::uint64_t tenfold = 10 * (remainder_[i] + borrow * kBase - less) + carry;
      carry = tenfold / kBase;
      remainder_[i] = tenfold % kBase;
    }
    return static_cast<char>('0' + (above - multiples_.begin() - 1));
  }
  /// Whether all further digits are 0.
  [[nodiscard]] bool isDone() const { return remainder_ == multiples_[0]; }

 private:
  /// The first limb is 0: ten times the remainder needs it.
  [[nodiscard]] Natural limbsOf(std::string_view digits) const {
    std::string padded(digits);
    padded.resize((limbs_ - 1) * kLimbDigits, '0');
    Natural limbs(limbs_, 0);
    for (std::size_t i = 1; i < limbs_; ++i) {
      const char* const end = padded.data() + i * kLimbDigits;
      std::from_chars(end - kLimbDigits, end, limbs[i]);
    }
    return limbs;
  }

  std::size_t limbs_;
  Natural remainder_;
  std::array<Natural, 10> multiples_;  ///< of the divisor, from 0 on
};

}  // namespace

double nearestQuotient(std::string_view numerator, std::string_view denominator) {
  // Integers of at most 15 digits are exact doubles, and IEEE division rounds correctly.
  constexpr std::size_t kExactDigits = 15;
  if (numerator.size() <= kExactDigits && denominator.size() <= kExactDigits) {
    std::uint64_t p = 0;
    std::uint64_t q = 1;
    std::from_chars(numerator.data(), numerator.data() + numerator.size(), p);
    std::from_chars(denominator.data(), denominator.data() + denominator.size(), q);
    return static_cast<double>(p) / static_cast<double>(q);
  }
  numerator.remove_prefix(std::min(numerator.find_first_not_of('0'), numerator.size()));
  denominator.remove_prefix(denominator.find_first_not_of('0'));
  if (numerator.empty()) return 0.0;
  LongDivision division(numerator, denominator);
  const std::int64_t point = 1 + static_cast<std::int64_t>(numerator.size()) -
                             static_cast<std::int64_t>(denominator.size());
  // The nearest double to an integer / 10^places * 10^point.
  const auto nearest = [point](auto integer, std::size_t places) {
    double value = std::numeric_limits<double>::infinity();
    const std::int64_t exponent = point - static_cast<std::int64_t>(places);
    static_cast<void>(parseDecimal(concat(integer, "e", exponent), value));
    return value;
  };
  // Between the numbers that begin with these digits, there is rarely a point where rounding
  // changes.
  constexpr std::size_t kFirstDigits = 19;  // as fit in 64 bits
  std::string digits;
  while (digits.size() < kFirstDigits) digits += division.nextDigit();
  std::uint64_t first = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), first);
  const double low = nearest(first, kFirstDigits);
  if (division.isDone() || low == nearest(first + 1, kFirstDigits)) return low;
  // Such points, halfway between doubles, have at most 768 digits other than leading zeros: what
  // comes behind these only tells whether the quotient is larger.
  constexpr std::size_t kMostDigits = 770;
  while (digits.size() < kMostDigits) digits += division.nextDigit();
  if (!division.isDone()) digits += '1';
  return nearest(digits, digits.size());
}

std::string lowerCase(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = lowerCase(c);
  return result;
}

std::string lowerCaseExtension(const std::filesystem::path& file) {
  return lowerCase(file.extension().string());
}

std::string exceedsLimit(std::uint64_t count, std::string_view what, std::uint64_t limit) {
  return concat("announces ", count, " ", what, "; at most ", limit, " are supported.");
}

std::string lacksRoom(std::string_view count, std::string_view what, std::size_t room) {
  return concat("announces ", count, " ", what, ", but the rest of the file has room for at most ",
                room, ": either the number is wrong or the file is incomplete.");
}

std::string quoted(std::string_view token) {
  // Long enough to recognize a number of 17 digits, short enough for one line.
  constexpr std::size_t kLongest = 40;
  std::string result = "\"";
  for (const char c : token.substr(0, kLongest)) {
    const bool printable = c >= ' ' && c <= '~';
    result += printable ? c : '?';
  }
  if (token.size() > kLongest) result += "...";
  return result + "\"";
}

std::string_view TextScanner::currentToken() const {
  const char* last = token_;
  while (!endsToken(last)) ++last;
  return {token_, static_cast<std::size_t>(last - token_)};
}

std::string_view TextScanner::peekToken() {
  skipSpace();
  return currentToken();
}

std::string_view TextScanner::readToken() {
  const std::string_view token = peekToken();
  position_ += token.size();
  return token;
}

bool TextScanner::readUnusualNumber(double& value) {
  const std::string_view token = currentToken();
  if (parseNumber(token, value) != NumberProblem::None) return false;
  position_ += token.size();
  return true;
}

std::size_t TextScanner::readCount(std::string_view what, std::size_t bytesEach) {
  const std::int64_t count = integer({"the number of ", what});
  if (count < 0) fail(ErrorCode::FileSyntax, "the number of ", what, " is negative.");
  // The last element may lack its separator at the end of the file.
  const std::size_t room = (static_cast<std::size_t>(end_ - position_) + 1) / bytesEach;
  if (static_cast<std::uint64_t>(count) > room) {
    fail(ErrorCode::FileSyntax, lacksRoom(currentToken(), what, room));
  }
  if (static_cast<std::uint64_t>(count) > kNone) {
    fail(ErrorCode::TooLarge, exceedsLimit(static_cast<std::uint64_t>(count), what, kNone));
  }
  return static_cast<std::size_t>(count);
}

std::string_view TextScanner::takeLine() {
  const char* const begin = position_;
  skipLine();
  const std::string_view line(begin, static_cast<std::size_t>(position_ - begin));
  if (position_ != end_) ++position_;
  token_ = position_;
  return line;
}

void TextScanner::skipLineBreak() {
  const char* place = position_;
  while (place != end_ && (*place == ' ' || *place == '\r')) ++place;
  if (place == end_ || *place != '\n') {
    fail(ErrorCode::FileSyntax, "the line has to end behind ", quoted(currentToken()),
         ", since the bytes of numbers begin on the next line.");
  }
  position_ = token_ = place + 1;
}

std::size_t TextScanner::countTokensOnLine() {
  std::size_t count = 0;
  if (!skipSpace()) return count;
  for (const char* place = position_; place != end_ && *place != '\n' && !isComment(*place);) {
    if (isSpace(*place)) {
      ++place;
      continue;
    }
    ++count;
    while (!endsToken(place)) ++place;
  }
  return count;
}

std::uint64_t TextScanner::line() const {
  // At the end of the file, report the last line with content, not trailing blank lines.
  const char* last = token_;
  if (last == end_) {
    while (last != begin_ && isSpace(last[-1])) --last;
  }
  return static_cast<std::uint64_t>(std::count(begin_, last, '\n')) + 1;
}

void TextScanner::failNumber(std::string_view what) const {
  double ignored = 0;
  switch (parseNumber(currentToken(), ignored)) {
    case NumberProblem::NotFinite:
      failFound(ErrorCode::NotFinite, what, ", which is not finite.");
    case NumberProblem::Overflow:
      failFound(ErrorCode::NotFinite, what, ", which exceeds the largest number (about 1.8e308).");
    case NumberProblem::ZeroDenominator:
      failFound(ErrorCode::FileSyntax, what, ", which divides by zero.");
    case NumberProblem::TooLong:
      failFound(ErrorCode::FileUnsupported, what,
                concat(", a fraction with more than ", kMaxRationalDigits,
                       " digits; round it to a decimal number."));
    case NumberProblem::None:
    case NumberProblem::NotANumber:
      break;
  }
  failFound(ErrorCode::FileSyntax, what, ", which is not a number.");
}

void TextScanner::failInteger(std::string_view what) const {
  failFound(ErrorCode::FileSyntax, what, ", which is not a whole number.");
}

void TextScanner::failFound(ErrorCode code, std::string_view what, std::string_view problem) const {
  const std::string_view token = currentToken();
  const std::string expected = concat("expected ", what, ", found ");
  if (token.empty()) fail(ErrorCode::FileSyntax, expected, "the end of the file.");
  fail(code, expected, quoted(token), problem);
}

void TextScanner::failToken(std::string_view what) const {
  fail(ErrorCode::FileSyntax, "expected ", what, ", found ", quoted(currentToken()), ".");
}

void TextScanner::failIfAtEnd(std::size_t done, std::size_t count, std::string_view what) {
  if (skipSpace()) return;
  fail(ErrorCode::FileSyntax, "the file ends after ", done, " of ", count, " ", what,
       ": it is incomplete.");
}

void TextScanner::failIfRepeated(bool present, std::string_view section) const {
  if (!present) return;
  fail(ErrorCode::FileSyntax, "the section ", section, " occurs a second time.");
}

namespace {

// find() scans at most one block: little compared with what a thread then reads from there.
constexpr std::size_t kBlockBytes = std::size_t{1} << 10;
// Blocks counted per task.
constexpr std::size_t kTextScannerGrain = 512;

constexpr unsigned isGap(char c) { return isSpace(c) ? 1 : 0; }

/// Number of tokens that begin in the text; `previous` is the character before it.
std::size_t countTokens(char previous, std::string_view text) {
  if (text.empty()) return 0;
  std::uint32_t count = isGap(previous) & (1U - isGap(text[0]));
  for (std::size_t i = 1; i < text.size(); ++i) {
    // A branch (&&) would keep the loop from being vectorized, which is four times as fast; reading
    // text would take a third longer.
    count += isGap(text[i - 1]) & (1U - isGap(text[i]));
  }
  return count;
}

}  // namespace

TokenIndex::TokenIndex(std::string_view text, Stage& stage) : text_(text) {
  const std::size_t blocks = blockCount(text.size(), kBlockBytes);
  before_.resize(blocks + 1);
  before_.back() = 0;
  parallelFor(stage, blocks, kTextScannerGrain, [&](std::size_t block) {
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

std::size_t firstUnreadable(Stage& stage, std::size_t n, std::size_t grain,
                            FunctionRef<void(std::size_t, std::size_t, std::size_t&)> read) {
  std::atomic<std::size_t> firstWrong{n};
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    if (begin > firstWrong.load(std::memory_order_relaxed)) return;
    std::size_t i = begin;
    try {
      read(begin, end, i);
    } catch (const Error&) {  // element i is invalid; the caller reports it
    }
    if (i < end) lowerTo(i, firstWrong);
  });
  return firstWrong;
}

}  // namespace hexhex::io
