// Just enough XML to find tags and their attributes. No entities, no validation.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <io/core/text_scanner.hpp>

namespace hexhex {

/// One tag; refers to the text that was scanned.
struct XmlTag {
  std::string_view name;
  std::string_view attributes;  ///< everything between the name and the end of the tag
  bool closing = false;         ///< </name>
  std::size_t begin = 0;        ///< position of '<'
  std::size_t end = 0;          ///< position after '>'

  /// The value of an attribute; empty if there is none of that name.
  [[nodiscard]] std::string_view attribute(std::string_view attributeName) const;
};

/// Walks through the tags of a text, one after the other. Comments, declarations and processing
/// instructions are skipped.
class XmlTags {
 public:
  /// @param text  must outlive the scanner and its tags
  /// @param fileName  for error messages
  XmlTags(std::string_view text, std::string fileName)
      : text_(text), fileName_(std::move(fileName)) {}

  /// Reads the next tag; false at the end of the text.
  /// @throws Error FileSyntax for a tag without end
  bool next(XmlTag& tag);

  /// Throws an error about the line that the tag begins in: "<file>, line 12: <sentence>".
  [[noreturn]] void fail(ErrorCode code, std::string_view sentence, const XmlTag& tag) const {
    failAt(tag.begin, code, sentence);
  }
  /// For what stands between tags: a scanner of the text up to this position.
  [[nodiscard]] TextScanner scannerTo(std::size_t end) const {
    return {text_.substr(0, end), fileName_};
  }

 private:
  [[noreturn]] void failAt(std::size_t position, ErrorCode code, std::string_view sentence) const;
  /// The position after the next occurrence of `mark`.
  [[nodiscard]] std::size_t after(std::string_view mark, std::size_t begin) const;
  /// The position of the '>' that ends the tag, which may contain quoted ones.
  [[nodiscard]] std::size_t findTagEnd(std::size_t begin) const;

  std::string_view text_;
  std::string fileName_;
  std::size_t position_ = 0;
};

}  // namespace hexhex
