// Streaming readers for the common layout: vertices and hexahedra in two runs of equal records.
// Other layouts and invalid files are left to the whole-file readers, which support every variant
// and report every error.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/number_source.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {

/// Points or cells per piece: a few megabytes.
inline constexpr std::size_t kPieceElements = std::size_t{1} << 16;

/// Consecutive records of equal shape.
struct PlainRun {
  std::uint64_t position = 0;  ///< of the first record in the file; 0: no such run
  std::uint64_t count = 0;
};

/// The location and record layout of a file's vertices and hexahedra.
struct PlainLayout {
  PlainRun points = {};
  PlainRun cells = {};
  bool isText = false;              ///< numbers separated by white space; otherwise binary
  bool isBigEndian = false;         ///< for binary files
  std::size_t coordinateBytes = 8;  ///< 4: single precision
  std::size_t integerBytes = 4;
  std::uint64_t firstVertex = 1;  ///< number of the first vertex
  std::size_t behindPoint = 0;    ///< integers after the coordinates of a point
  std::size_t inFrontOfCell = 0;  ///< integers before the corners of a cell
  std::size_t behindCell = 0;     ///< integers after them
  bool tellsCorners = false;      ///< whether the integers before the corners give their number

  [[nodiscard]] std::size_t pointBytes() const {
    return 3 * coordinateBytes + behindPoint * integerBytes;
  }
  [[nodiscard]] std::size_t cellBytes() const {
    return (inFrontOfCell + 8 + behindCell) * integerBytes;
  }
  /// Whether both runs were found, points first.
  [[nodiscard]] bool isComplete() const {
    return 0 < points.position && points.position < cells.position;
  }
};

/// How a format is read in pieces.
struct PlainFormat {
  /// Finds the layout of a regular file; empty, or throws an Error, if it has another one.
  std::optional<PlainLayout> (*look)(const ByteFile& file, Context& context);
  HexMesh (*readWhole)(const Input& input, Stage& stage);
};

/// Reads a file into a sink: piece by piece if the layout permits, otherwise as a whole.
/// @throws Error  as the whole-file reader does; and what the sink throws
void readPlainMesh(const PlainFormat& format, MeshSink& sink, const Input& input, Context& context);

/// A text file read from front to back through a window of a few megabytes.
class TextWindow {
 public:
  /// @param context  may cancel reading
  /// @param size     of the window; kWords suffices for the words between binary data
  TextWindow(const ByteFile& file, Context& context, std::size_t size = kText);
  static constexpr std::size_t kText = std::size_t{1} << 23;
  static constexpr std::size_t kWords = std::size_t{1} << 16;

  /// Moves to a position in the file.
  void moveTo(std::uint64_t position);
  /// Position in the file of the next byte.
  [[nodiscard]] std::uint64_t position() const { return begin_ + source_->position(); }

  /// The rest of the line. @pre  the line is in the window, as at the beginning of the file
  [[nodiscard]] std::string takeLine() { return std::string(source_->takeLine()); }
  /// The next token; empty at the end of the file.
  [[nodiscard]] std::string token();
  /// The next token as a nonnegative integer; empty if it is not one.
  [[nodiscard]] std::optional<std::uint64_t> count();
  /// Skips tokens. @return false if the file ends before
  [[nodiscard]] bool skip(std::uint64_t tokens);
  /// Skips a line break. @return false if there is none
  [[nodiscard]] bool skipLineBreak();

  /// Calls read(scanner, i), which reads element i or throws an Error, for the next n elements,
  /// from several threads.
  template <class Read>
  void elements(std::size_t n, std::size_t tokensEach, const Read& read) {
    for (std::size_t done = 0; done < n;) {
      const std::size_t complete = std::min(n - done, source_->tokensLeft() / tokensEach);
      if (complete == 0 && !fill()) {
        throw Error(ErrorCode::FileSyntax, file_.name() + ": the file is incomplete.");
      }
      source_->elements(complete, tokensEach,
                        [&](TextScanner& scanner, std::size_t i) { read(scanner, done + i); });
      done += complete;
    }
  }

  /// A stage for short loops; reports no progress.
  [[nodiscard]] Stage& stage() noexcept { return stage_; }
  [[nodiscard]] const ByteFile& file() const noexcept { return file_; }
  /// Whether the part of the file read so far contains '#'.
  [[nodiscard]] bool sawComments() const noexcept { return sawComments_; }

 private:
  /// Begins to read a text.
  void open(std::string_view text);
  /// Discards the text already read and refills the window. @return false at the end of the file
  bool fill();

  ByteFile file_;
  Context& context_;
  Context quiet_;  ///< many short loops, which report no progress
  Stage stage_;
  Array<char> bytes_;
  std::uint64_t begin_ = 0;  ///< position of the window in the file
  std::size_t size_ = 0;     ///< bytes in the window
  std::optional<TextSource> source_;
  bool sawComments_ = false;
};

}  // namespace hexhex::io
