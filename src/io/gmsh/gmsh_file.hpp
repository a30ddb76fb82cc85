// The frame of a `.msh` file: its version and encoding, and its sections one after the other.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/core/number_source.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex {

/// Reads a file from front to back.
class GmshFile {
 public:
  /// Reads the section $MeshFormat.
  /// @param text  must outlive this, and so must the others
  /// @throws Error FileSyntax, FileUnsupported
  GmshFile(std::string_view text, const std::string& fileName, Stage& stage);

  /// Whether the version is 4.1; otherwise it is 2.
  [[nodiscard]] bool version4() const noexcept { return version4_; }

  /// Goes to the next section and returns its name, without '$'; nothing at the end of the file.
  [[nodiscard]] std::optional<std::string_view> nextSection();
  /// Reads the end of a section.
  void endSection(std::string_view name);
  /// Skips the rest of a section, and returns what that is, with the end.
  std::string_view skipSection(std::string_view name);

  [[nodiscard]] Stage& stage() const noexcept { return stage_; }
  /// Stands where the file is read, and moves on with it.
  [[nodiscard]] TextScanner& scanner() noexcept { return scanner_; }
  /// Calls f(source) with a source of numbers that stands at the scanner's place (if they are
  /// bytes, on the next line), and goes on behind what it read.
  template <class F>
  void withSource(const F& f) {
    if (binary_) {
      scanner_.skipLineBreak();
      BinarySource source(bytes_, scanner_.position(), fileName_, stage_);
      f(source);
      scanner_.moveTo(source.position());
    } else {
      TextSource source(scanner_, *index_, stage_);
      f(source);
    }
  }

 private:
  void readVersion();
  void readEncoding();

  std::string_view text_;
  ByteFile bytes_;
  const std::string& fileName_;
  TextScanner scanner_;
  Stage& stage_;
  std::optional<TokenIndex> index_;  ///< only of text
  bool binary_ = false;
  bool version4_ = false;
};

}  // namespace hexhex
