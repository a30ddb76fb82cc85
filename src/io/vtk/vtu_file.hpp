// `.vtu` files: what their tags say, and where their arrays are. Every size and offset is checked
// against the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/vtk/vtk_source.hpp>
#include <io/vtk/xml_tags.hpp>

namespace hexhex {

/// An open file. Functions throw Error FileSyntax or FileUnsupported.
class VtuFile final : public VtkSource {
 public:
  /// @param bytes  the file
  /// @param text   all of it, or its head if arrays are appended to it as plain bytes; outlives
  /// this
  /// @param stage  for parallel decoding; outlives this
  VtuFile(const ByteFile& bytes, std::string_view text, const std::string& fileName, Stage& stage);

  void requireIndexable() const override;

 private:
  void readTags();
  void readFileTag(const XmlTag& tag);
  void readPieceTag(const XmlTag& tag);
  void readArrayTag(const XmlTag& tag, VtkSection section);
  void readAppendedTag(const XmlTag& tag);
  [[nodiscard]] std::uint64_t readCount(const XmlTag& tag, std::string_view attribute) const;
  [[nodiscard]] VtkColumn loadNeeded(VtkSection section, std::string_view name, const char* what,
                                     VtkNumbers numbers, std::optional<std::uint64_t> count) const;
  [[nodiscard]] VtkColumn loadArray(const XmlTag& tag, VtkNumbers numbers,
                                    std::optional<std::uint64_t> count) const;
  [[nodiscard]] std::uint64_t findAppended(const XmlTag& tag, VtkColumn& column) const;
  [[nodiscard]] Array<char> decode(const XmlTag& tag) const;
  [[nodiscard]] VtkColumn parse(const XmlTag& tag, VtkNumbers numbers,
                                std::optional<std::uint64_t> count) const;
  /// The text behind a tag, up to the next one.
  [[nodiscard]] std::string_view contentOf(const XmlTag& tag) const;

  Stage& stage_;
  std::string_view text_;
  std::uint64_t fileSize_;
  XmlTags tags_;
  bool hasFileTag_ = false;
  std::optional<XmlTag> piece_;
  std::size_t lengthBytes_ = 4;  ///< of the numbers in front of encoded arrays
  bool compressed_ = false;
  bool appendedBase64_ = false;
  std::optional<std::uint64_t> appended_;  ///< position behind the '_' of AppendedData
};

/// The head of a regular file whose arrays are appended to it as plain bytes, so that it can be
/// read in pieces; nothing of other files.
[[nodiscard]] Array<char> readPlainVtuHead(const InputFile& input);

/// Calls read(file, stage), without the whole file in memory where it can be avoided.
template <class Read>
[[nodiscard]] auto readVtuFile(const Input& input, std::string_view stageName, Context& context,
                               const Read& read) {
  return inStage(context, stageName, [&](Stage& stage) {
    std::optional<InputFile> open;
    Array<char> room;
    if (!input.bytes()) room = readPlainVtuHead(open.emplace(input.path()));
    const bool plain = !room.empty();
    const std::string_view text = plain ? asText(room) : input.text(room, stage);
    VtuFile file(plain ? ByteFile(*open, input.name()) : ByteFile(text, input.name()), text,
                 input.name(), stage);
    return read(file, stage);
  });
}

}  // namespace hexhex
