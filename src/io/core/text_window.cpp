#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>

#include <base/parallel.hpp>
#include <io/core/text_window.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kReadAtOnce = std::size_t{1} << 20;

}  // namespace

TextWindow::TextWindow(const InputFile& file, std::string name, Context& context, std::size_t size)
    : file_(file),
      name_(std::move(name)),
      context_(context),
      quiet_(context.threads()),
      stage_(quiet_, "read") {
  bytes_.resize(std::min<std::uint64_t>(size, file.size()));
  moveTo(0);
}

void TextWindow::moveTo(std::uint64_t position) {
  begin_ = position;
  size_ = 0;
  scanner_.emplace(std::string_view(), name_);
  index_.emplace(scanner_->text(), stage_);
  fill();
}

bool TextWindow::fill() {
  context_.throwIfCancelled();
  const std::size_t behind = scanner_->position();
  const std::size_t kept = size_ - behind;
  if (kept > 0) std::memmove(bytes_.data(), bytes_.data() + behind, kept);
  begin_ += behind;
  const std::uint64_t left = file_.size() - std::min(file_.size(), begin_ + kept);
  const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(bytes_.size() - kept, left));
  parallelBlocks(stage_, more, kReadAtOnce,
                 [&](std::size_t from, std::size_t to, std::size_t /*block*/) {
                   file_.readAt(begin_ + kept + from, bytes_.data() + kept + from, to - from);
                 });
  size_ = kept + more;
  // A token that may go on waits for its rest.
  std::string_view text(bytes_.data(), size_);
  if (more < left) {
    while (!text.empty() && !isSpace(text.back())) text.remove_suffix(1);
    if (text.empty()) text = {bytes_.data(), size_};
  }
  scanner_.emplace(text, name_);
  index_.emplace(text, stage_);
  sawComments_ = sawComments_ || text.find('#') != std::string_view::npos;
  return more > 0;
}

std::string TextWindow::token() {
  while (tokensLeft() == 0 && fill()) {
  }
  return std::string(scanner_->readToken());
}

std::optional<std::uint64_t> TextWindow::count() {
  const std::string word = token();
  std::uint64_t number = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
  // Products with the bytes of a record cannot overflow then.
  if (result.ec != std::errc{} || result.ptr != word.data() + word.size() ||
      number > file_.size()) {
    return {};
  }
  return number;
}

bool TextWindow::skip(std::uint64_t tokens) {
  while (true) {
    const std::size_t left = tokensLeft();
    if (tokens <= left) {
      const std::size_t first = index_->countBefore(scanner_->position());
      // Behind the last of them, not in front of the next: that may be bytes.
      if (tokens > 0) {
        scanner_->moveTo(index_->find(first + static_cast<std::size_t>(tokens) - 1));
        static_cast<void>(scanner_->readToken());
      }
      return true;
    }
    tokens -= left;
    scanner_->moveTo(scanner_->text().size());
    if (!fill()) return false;
  }
}

bool TextWindow::skipLineBreak() {
  const std::string_view rest = scanner_->text().substr(scanner_->position());
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos || rest.find_first_not_of(" \r") != end) return false;
  scanner_->moveTo(scanner_->position() + end + 1);
  return true;
}

}  // namespace hexhex::io
