// Files that are read piece by piece: those with vertices and hexahedra in two runs of equal
// records, as nearly all files are. Other files, and broken ones, are left to the readers of whole
// files, which know all forms and report every mistake.
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

/// Points or cells of a piece: a few megabytes.
inline constexpr std::size_t kPieceElements = std::size_t{1} << 16;

/// Equal records, one after the other.
struct PlainRun {
  std::uint64_t position = 0;  ///< of the first, in the file; 0: there is no such run
  std::uint64_t count = 0;
};

/// Where a file has its vertices and hexahedra, and what their records are.
struct PlainLayout {
  PlainRun points = {};
  PlainRun cells = {};
  bool isText = false;              ///< numbers between white space; otherwise bytes
  bool isBigEndian = false;         ///< of bytes
  std::size_t coordinateBytes = 8;  ///< 4: of single precision
  std::size_t integerBytes = 4;
  std::uint64_t firstVertex = 1;  ///< how the first vertex is numbered
  std::size_t behindPoint = 0;    ///< integers behind the coordinates of a point
  std::size_t inFrontOfCell = 0;  ///< integers in front of the corners of a cell
  std::size_t behindCell = 0;     ///< ... and behind them
  bool tellsCorners = false;      ///< whether those in front say how many corners there are

  [[nodiscard]] std::size_t pointBytes() const {
    return 3 * coordinateBytes + behindPoint * integerBytes;
  }
  [[nodiscard]] std::size_t cellBytes() const {
    return (inFrontOfCell + 8 + behindCell) * integerBytes;
  }
  /// Whether both are there, in this order.
  [[nodiscard]] bool isComplete() const {
    return 0 < points.position && points.position < cells.position;
  }
};

/// How one format is read in pieces.
struct PlainFormat {
  /// Looks through a regular file; nothing, or an Error, if it is not of the form.
  std::optional<PlainLayout> (*look)(const ByteFile& file, Context& context);
  HexMesh (*readWhole)(const Input& input, Stage& stage);
};

/// Reads a file into a sink: piece by piece if it has the form, or else as a whole.
/// @throws Error  as the reader of whole files; what the sink throws
void readPlainMesh(const PlainFormat& format, MeshSink& sink, const Input& input, Context& context);

/// A text that is read from front to back, with some megabytes of it in memory.
class TextWindow {
 public:
  /// @param context  ends reading where it is cancelled
  /// @param size     how much is in memory: for files of bytes, the words between them need little
  TextWindow(const ByteFile& file, Context& context, std::size_t size = kText);
  static constexpr std::size_t kText = std::size_t{1} << 23;
  static constexpr std::size_t kWords = std::size_t{1} << 16;

  /// Goes to a byte of the file.
  void moveTo(std::uint64_t position);
  /// The byte that comes next.
  [[nodiscard]] std::uint64_t position() const { return begin_ + scanner_->position(); }

  /// The rest of a line at the beginning of the file; it is in memory.
  [[nodiscard]] std::string takeLine() { return std::string(scanner_->takeLine()); }
  /// The next token; empty at the end of the file.
  [[nodiscard]] std::string token();
  /// The next token as a number from 0; nothing if it is none.
  [[nodiscard]] std::optional<std::uint64_t> count();
  /// Skips so many tokens. @return whether there were as many
  [[nodiscard]] bool skip(std::uint64_t tokens);
  /// Goes behind a line break. @return whether there is one
  [[nodiscard]] bool skipLineBreak();

  /// Calls read(scanner, i), which reads element i or throws an Error, for the next n elements,
  /// from several threads.
  template <class Read>
  void elements(std::size_t n, std::size_t tokensEach, const Read& read) {
    for (std::size_t done = 0; done < n;) {
      const std::size_t complete = std::min(n - done, tokensLeft() / tokensEach);
      if (complete == 0 && !fill()) {
        throw Error(ErrorCode::FileSyntax, file_.name() + ": the file is incomplete.");
      }
      readElements(*scanner_, &*index_, stage_, complete, tokensEach,
                   [&](TextScanner& scanner, std::size_t i) { read(scanner, done + i); });
      done += complete;
    }
  }

  /// For short loops, which report no progress.
  [[nodiscard]] Stage& stage() noexcept { return stage_; }
  [[nodiscard]] const ByteFile& file() const noexcept { return file_; }
  /// Whether there were marks of comments in what was in memory so far.
  [[nodiscard]] bool sawComments() const noexcept { return sawComments_; }

 private:
  [[nodiscard]] std::size_t tokensLeft() const {
    return index_->count() - index_->countBefore(scanner_->position());
  }
  /// Drops what is behind and reads on. @return whether there was more
  bool fill();

  ByteFile file_;
  Context& context_;
  Context quiet_;  ///< many short loops, which report no progress
  Stage stage_;
  Array<char> bytes_;
  std::uint64_t begin_ = 0;  ///< in the file, of the bytes
  std::size_t size_ = 0;     ///< how many there are
  std::optional<TextScanner> scanner_;
  std::optional<TokenIndex> index_;
  bool sawComments_ = false;
};

}  // namespace hexhex::io
