#include <algorithm>

#include <io/vtk/xml_tags.hpp>

namespace hexhex {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

}  // namespace

std::string_view XmlTag::attribute(std::string_view attributeName) const {
  std::string_view rest = attributes;
  while (true) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return {};
    const std::string_view found = trimmed(rest.substr(0, equals));
    const std::size_t open = rest.find_first_of("\"'", equals);
    if (open == std::string_view::npos) return {};
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return {};
    if (found == attributeName) return rest.substr(open + 1, close - open - 1);
    rest.remove_prefix(close + 1);
  }
}

bool XmlTags::next(XmlTag& tag) {
  while (true) {
    const std::size_t begin = text_.find('<', position_);
    if (begin == std::string_view::npos) return false;
    const std::string_view rest = text_.substr(begin);
    if (rest.starts_with("<!--")) {
      position_ = after("-->", begin);
    } else if (rest.starts_with("<?")) {
      position_ = after("?>", begin);
    } else if (rest.starts_with("<!")) {
      position_ = after(">", begin);
    } else {
      tag.begin = begin;
      break;
    }
  }
  const std::size_t end = findTagEnd(tag.begin);
  std::string_view inside = text_.substr(tag.begin + 1, end - tag.begin - 1);
  tag.closing = inside.starts_with('/');
  if (tag.closing) inside.remove_prefix(1);
  const std::size_t nameEnd = std::min(inside.find_first_of(" \t\r\n/"), inside.size());
  tag.name = inside.substr(0, nameEnd);
  tag.attributes = inside.substr(nameEnd);
  tag.end = position_ = end + 1;
  return true;
}

std::size_t XmlTags::after(std::string_view mark, std::size_t begin) const {
  const std::size_t found = text_.find(mark, begin);
  if (found != std::string_view::npos) return found + mark.size();
  failAt(begin, ErrorCode::FileSyntax, "the file ends inside of what begins with '<' here.");
}

std::size_t XmlTags::findTagEnd(std::size_t begin) const {
  char quote = 0;
  for (std::size_t i = begin; i < text_.size(); ++i) {
    const char c = text_[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i;
    }
  }
  failAt(begin, ErrorCode::FileSyntax, "the file ends inside of the tag that begins here.");
}

void XmlTags::failAt(std::size_t position, ErrorCode code, std::string_view sentence) const {
  const std::string_view before = text_.substr(0, position);
  const auto line = static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  throw Error(code, fileName_ + ", line " + std::to_string(line) + ": " + std::string(sentence),
              Place{PlaceKind::Line, line});
}

}  // namespace hexhex
