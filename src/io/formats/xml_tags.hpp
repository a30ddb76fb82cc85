// A minimal XML scanner for tags and their attributes. No entities, no validation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/error.hpp>

#include <io/core/text_scanner.hpp>

namespace hexhex::io {

/// First characters of XML files: of a tag, or of the UTF-8 byte order mark.
inline constexpr std::string_view kXmlFirst = "<\xEF";

/// A tag; refers to the scanned text.
struct XmlTag {
  std::string_view name;
  std::string_view attributes;  ///< everything between the name and the end of the tag
  bool closing = false;         ///< </name>
  std::size_t begin = 0;        ///< position of '<'
  std::size_t end = 0;          ///< position after '>'

  /// The value of an attribute; empty if it is missing.
  [[nodiscard]] std::string_view attribute(std::string_view attributeName) const {
    constexpr std::string_view kSpace = " \t\r\n";
    std::string_view rest = attributes;
    while (true) {
      const std::size_t equals = rest.find('=');
      if (equals == std::string_view::npos) return {};
      std::string_view found = rest.substr(0, equals);
      found.remove_prefix(std::min(found.find_first_not_of(kSpace), found.size()));
      found = found.substr(0, found.find_last_not_of(kSpace) + 1);
      const std::size_t open = rest.find_first_of("\"'", equals);
      if (open == std::string_view::npos) return {};
      const std::size_t close = rest.find(rest[open], open + 1);
      if (close == std::string_view::npos) return {};
      if (found == attributeName) return rest.substr(open + 1, close - open - 1);
      rest.remove_prefix(close + 1);
    }
  }
};

/// Iterates over the tags of a text. Comments, declarations and processing instructions are
/// skipped.
class XmlTags {
 public:
  /// @param text  must outlive the scanner and its tags
  /// @param fileName  for error messages
  XmlTags(std::string_view text, std::string fileName)
      : text_(text), fileName_(std::move(fileName)) {}

  /// Reads the next tag; false at the end of the text.
  /// @throws Error FileSyntax for a tag without end
  bool next(XmlTag& tag) {
    while (true) {
      tag.begin = text_.find('<', position_);
      if (tag.begin == std::string_view::npos) return false;
      const std::string_view rest = text_.substr(tag.begin);
      if (rest.starts_with("<!--")) {
        skipBehind("-->", tag);
      } else if (rest.starts_with("<?")) {
        skipBehind("?>", tag);
      } else if (rest.starts_with("<!")) {
        skipBehind(">", tag);
      } else {
        break;
      }
    }
    const std::size_t end = findEnd(tag);
    std::string_view inside = text_.substr(tag.begin + 1, end - tag.begin - 1);
    tag.closing = inside.starts_with('/');
    if (tag.closing) inside.remove_prefix(1);
    const std::size_t nameEnd = std::min(inside.find_first_of(" \t\r\n/"), inside.size());
    tag.name = inside.substr(0, nameEnd);
    tag.attributes = inside.substr(nameEnd);
    tag.end = position_ = end + 1;
    return true;
  }

  /// Throws an error about the line that the tag begins in: "<file>, line 12: <sentence>".
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, const XmlTag& tag, Parts... sentence) const {
    TextScanner scanner(text_, fileName_);
    scanner.moveTo(tag.begin);
    scanner.fail(code, sentence...);
  }
  /// A scanner of the text up to this position, for content between tags.
  [[nodiscard]] TextScanner scannerTo(std::size_t end) const {
    return {text_.substr(0, end), fileName_};
  }

 private:
  void skipBehind(std::string_view mark, const XmlTag& tag) {
    const std::size_t found = text_.find(mark, tag.begin);
    if (found == std::string_view::npos) {
      fail(ErrorCode::FileSyntax, tag, "the file ends inside of what begins with '<' here.");
    }
    position_ = found + mark.size();
  }

  /// The position of the '>' that ends the tag; quoted ones do not count.
  [[nodiscard]] std::size_t findEnd(const XmlTag& tag) const {
    char quote = 0;
    for (std::size_t i = tag.begin; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>') {
        return i;
      }
    }
    fail(ErrorCode::FileSyntax, tag, "the file ends inside of the tag that begins here.");
  }

  std::string_view text_;
  std::string fileName_;
  std::size_t position_ = 0;
};

}  // namespace hexhex::io
