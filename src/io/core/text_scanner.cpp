#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
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

NumberProblem parseRational(std::string_view numerator, std::string_view denominator,
                            double& value) {
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
  const std::size_t exponent = token.find_first_of("dDeE");
  if (exponent != std::string_view::npos && lowerCase(token[exponent]) == 'd') {
    std::string usual(token);
    usual[exponent] = 'e';
    return parseNumber(usual, value);
  }
  const bool negative = takeSign(token);
  if (!token.empty() && (token.front() == '-' || token.front() == '+')) {
    return NumberProblem::NotANumber;
  }
  const std::size_t slash = token.find('/');
  double magnitude = 0;
  const NumberProblem problem =
      slash == std::string_view::npos
          ? parseDecimal(token, magnitude)
          : parseRational(token.substr(0, slash), token.substr(slash + 1), magnitude);
  if (problem == NumberProblem::None) value = negative ? -magnitude : magnitude;
  return problem;
}

namespace {

/// A natural number: base 2^32, least significant limb first, no leading zeros (0 has no limbs).
using Natural = std::vector<std::uint32_t>;

constexpr std::size_t kLimbBits = 32;

/// value = value * factor + addend
void multiplyAdd(Natural& value, std::uint32_t factor, std::uint32_t addend) {
  std::uint64_t carry = addend;
  for (std::uint32_t& limb : value) {
    carry += std::uint64_t{limb} * factor;
    limb = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;
  }
  if (carry != 0) value.push_back(static_cast<std::uint32_t>(carry));
}

Natural fromDecimal(std::string_view digits) {
  // Nine digits are the most whose power of ten fits in a limb.
  constexpr std::size_t kChunk = 9;
  Natural value;
  value.reserve(digits.size() / kChunk + 1);
  for (std::size_t begin = 0; begin < digits.size();) {
    const std::size_t end = std::min(begin + kChunk, digits.size());
    std::uint32_t chunk = 0;
    std::uint32_t power = 1;
    for (; begin < end; ++begin) {
      chunk = chunk * 10 + static_cast<std::uint32_t>(digits[begin] - '0');
      power *= 10;
    }
    multiplyAdd(value, power, chunk);
  }
  return value;
}

/// Position of the highest set bit plus one. The value is not 0.
std::int64_t bitLength(const Natural& value) {
  return static_cast<std::int64_t>(kLimbBits * (value.size() - 1) +
                                   static_cast<std::size_t>(std::bit_width(value.back())));
}

Natural shiftedLeft(const Natural& value, std::int64_t bits) {
  const auto limbs = static_cast<std::size_t>(bits) / kLimbBits;
  const auto factor = std::uint32_t{1} << (static_cast<std::size_t>(bits) % kLimbBits);
  Natural result(limbs, 0);
  result.insert(result.end(), value.begin(), value.end());
  // The low limbs are 0, so multiplying all limbs shifts the value only.
  multiplyAdd(result, factor, 0);
  return result;
}

bool lessThan(const Natural& a, const Natural& b) {
  if (a.size() != b.size()) return a.size() < b.size();
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

/// a = a - b, where a >= b
void subtract(Natural& a, const Natural& b) {
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::uint64_t difference = std::uint64_t{a[i]} - (i < b.size() ? b[i] : 0) - borrow;
    a[i] = static_cast<std::uint32_t>(difference);
    borrow = (difference >> kLimbBits) & 1U;
  }
  while (!a.empty() && a.back() == 0) a.pop_back();
}

/// The double nearest to quotient * 2^exponent, ties to even. The lowest bit of the quotient is
/// sticky: it stands for all bits below. The quotient has at least 55 bits.
double roundToNearest(std::uint64_t quotient, std::int64_t exponent) {
  constexpr std::int64_t kSmallestExponent = -1074;  // of a subnormal double
  constexpr std::int64_t kMantissaBits = 53;
  const auto length = static_cast<std::int64_t>(std::bit_width(quotient));
  const std::int64_t lowest = std::max(exponent + length - kMantissaBits, kSmallestExponent);
  const std::int64_t dropped = lowest - exponent;
  if (dropped > length) return 0.0;  // below half the smallest double
  std::uint64_t kept = quotient >> dropped;
  const std::uint64_t rest = quotient & ((std::uint64_t{1} << dropped) - 1);
  const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
  if (rest > half || (rest == half && kept % 2 == 1)) ++kept;
  // Beyond this the result is infinite anyway, and the exponent would not fit an int.
  constexpr std::int64_t kHugeExponent = 2000;
  return std::ldexp(static_cast<double>(kept), static_cast<int>(std::min(lowest, kHugeExponent)));
}

/// Divides integers of any size, by long division bit by bit.
double divideExactly(const Natural& numerator, const Natural& denominator) {
  // Shifted to equal length, their quotient lies between 1/2 and 2. Its 56 bits have at least 55
  // significant ones: 53 for the double, a rounding bit and a sticky bit.
  constexpr int kQuotientBits = 56;
  const std::int64_t excess = bitLength(numerator) - bitLength(denominator);
  Natural remainder = excess < 0 ? shiftedLeft(numerator, -excess) : numerator;
  const Natural divisor = excess > 0 ? shiftedLeft(denominator, excess) : denominator;
  std::uint64_t quotient = 0;
  for (int i = 0; i < kQuotientBits; ++i) {
    quotient <<= 1U;
    if (!lessThan(remainder, divisor)) {
      subtract(remainder, divisor);
      quotient |= 1U;
    }
    multiplyAdd(remainder, 2, 0);
  }
  if (!remainder.empty()) quotient |= 1U;
  return roundToNearest(quotient, excess - (kQuotientBits - 1));
}

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
  const Natural p = fromDecimal(numerator);
  if (p.empty()) return 0.0;
  return divideExactly(p, fromDecimal(denominator));
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
