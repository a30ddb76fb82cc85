#include <algorithm>
#include <span>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {

std::string lowerCase(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = lowerCase(c);
  return result;
}

std::string lowerCaseExtension(const std::filesystem::path& file) {
  return lowerCase(file.extension().string());
}

std::string exceedsLimit(std::uint64_t count, std::string_view what, std::uint64_t limit) {
  return "announces " + std::to_string(count) + " " + std::string(what) + "; at most " +
         std::to_string(limit) + " are supported.";
}

std::string lacksRoom(std::string_view count, std::string_view what, std::size_t room) {
  return "announces " + std::string(count) + " " + std::string(what) +
         ", but the rest of the file has room for at most " + std::to_string(room) +
         ": either the number is wrong or the file is incomplete.";
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
  if (count < 0) {
    fail(ErrorCode::FileSyntax, "the number of " + std::string(what) + " is negative.");
  }
  // The last one may lack its separator at the end of the file.
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
    fail(ErrorCode::FileSyntax, "the line has to end behind " + quoted(currentToken()) +
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
  // An end in front of which nothing but line breaks stand belongs to the last line with content.
  const char* last = token_;
  if (last == end_) {
    while (last != begin_ && isSpace(last[-1])) --last;
  }
  return static_cast<std::uint64_t>(std::count(begin_, last, '\n')) + 1;
}

void TextScanner::fail(ErrorCode code, std::string_view sentence, Place place) const {
  throw Error(code, fileName_ + ", line " + std::to_string(line()) + ": " + std::string(sentence),
              place);
}

void TextScanner::fail(ErrorCode code, std::string_view sentence) const {
  fail(code, sentence, Place{PlaceKind::Line, line()});
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
                ", a fraction with more than " + std::to_string(kMaxRationalDigits) +
                    " digits; round it to a decimal number.");
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
  const std::string expected = "expected " + std::string(what) + ", found ";
  if (token.empty()) fail(ErrorCode::FileSyntax, expected + "the end of the file.");
  fail(code, expected + quoted(token) + std::string(problem));
}

void TextScanner::failToken(std::string_view what) const {
  fail(ErrorCode::FileSyntax,
       "expected " + std::string(what) + ", found " + quoted(currentToken()) + ".");
}

void TextScanner::failIfAtEnd(std::size_t done, std::size_t count, std::string_view what) {
  if (skipSpace()) return;
  fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                  std::to_string(count) + " " + std::string(what) +
                                  ": it is incomplete.");
}

void TextScanner::failIfRepeated(bool present, std::string_view section) const {
  if (!present) return;
  fail(ErrorCode::FileSyntax, "the section " + std::string(section) + " occurs a second time.");
}

namespace {

// What find() scans in vain: little compared with what a thread then reads from there, and with
// what else a section takes that has nothing in it.
constexpr std::size_t kBlockBytes = std::size_t{1} << 10;
// Blocks that one thread counts at once.
constexpr std::size_t kTextScannerGrain = 512;

constexpr unsigned isGap(char c) { return isSpace(c) ? 1 : 0; }

/// Number of places where a token begins; `previous` is the character before the text.
std::size_t countTokens(char previous, std::string_view text) {
  if (text.empty()) return 0;
  std::uint32_t count = isGap(previous) & (1U - isGap(text[0]));
  for (std::size_t i = 1; i < text.size(); ++i) {
    // Not &&, whose branch keeps the loop from being one of vectors, four times as fast: reading
    // text takes a third longer then.
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

}  // namespace hexhex::io
