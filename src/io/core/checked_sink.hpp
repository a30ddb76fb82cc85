// Validation shared by all writers, and what all sinks share: order of calls, checks of the data,
// timing and cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/function_ref.hpp>
#include <base/stage.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

/// The first point with an infinite or NaN coordinate; the number of points if there is none.
[[nodiscard]] std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage);

/// Refuses a map that could not be read back.
/// @throws Error InvalidArgument if array sizes disagree, IndexOutOfRange, NotFinite
void requireWritable(const TetMap& map, Stage& stage);

/// Refuses a mesh that would crash a writer or could not be read back.
/// @throws Error InvalidArgument if array sizes disagree or a cell refers to a missing vertex,
///         NotFinite
void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage);

/// Validates the calls of one sink: their order, finite coordinates, vertex indices in range.
/// begin(), points(), beginsCells(), cells() and end() are called inside run() and throw if the
/// call is invalid.
class SinkCalls {
 public:
  /// @param name   prefix of error messages, e.g. a file name
  /// @param stage  to which the time is added; must outlive this
  SinkCalls(std::string name, std::string_view stage, Context& context);

  /// Performs one call. After a call has thrown, all further calls are refused.
  void run(FunctionRef<void()> call);

  void begin(std::uint64_t pointCount, std::uint64_t cellCount);
  void points(const PointPiece& piece);
  /// @return true once: for the first cells, or for the end of a mesh without cells
  [[nodiscard]] bool beginsCells();
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells);
  void end();

 private:
  enum class State { Fresh, Points, Cells, Ended, Failed };

  void requireNext(const char* what, std::uint64_t first, std::uint64_t size, std::uint64_t next,
                   std::uint64_t count) const;
  void requireConsistent(const PointPiece& piece);
  [[noreturn]] void refuse(const std::string& sentence) const;

  std::string name_;
  std::string_view stage_;
  Context& context_;
  // A sink runs many short loops; none reports progress of its own.
  Context quiet_;
  State state_ = State::Fresh;
  std::uint64_t pointCount_ = 0;
  std::uint64_t cellCount_ = 0;
  std::uint64_t nextPoint_ = 0;
  std::uint64_t nextCell_ = 0;
  bool hasTets_ = false;
  bool hasCorners_ = false;
};

/// A sink that passes validated data to the writer of a format.
/// @tparam Writer  has begin(pointCount, cellCount); points(piece), never empty; beginCells(),
///         called once even if there are no cells; cells(first, cells) for Hex and Hex64; and end()
template <class Writer>
class CheckedSink : public MeshSink {
 public:
  /// @param arguments  passed to the writer; for the others see SinkCalls
  template <class... Arguments>
  CheckedSink(std::string name, std::string_view stage, Context& context,
              const Arguments&... arguments)
      : calls_(std::move(name), stage, context), writer_(arguments...) {}

  [[nodiscard]] const Writer& writer() const noexcept { return writer_; }

  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    calls_.run([&] {
      calls_.begin(pointCount, cellCount);
      writer_.begin(pointCount, cellCount);
    });
  }
  void points(const PointPiece& piece) override {
    calls_.run([&] {
      calls_.points(piece);
      if (!piece.points.empty()) writer_.points(piece);
    });
  }
  void cells(std::uint64_t first, std::span<const Hex> cells) override { takeCells(first, cells); }
  void cells(std::uint64_t first, std::span<const Hex64> cells) override {
    takeCells(first, cells);
  }
  void end() override {
    calls_.run([&] {
      if (calls_.beginsCells()) writer_.beginCells();
      calls_.end();
      writer_.end();
    });
  }

 private:
  template <class Cell>
  void takeCells(std::uint64_t first, std::span<const Cell> cells) {
    calls_.run([&] {
      if (calls_.beginsCells()) writer_.beginCells();
      calls_.cells(first, cells);
      writer_.cells(first, cells);
    });
  }

  SinkCalls calls_;
  Writer writer_;
};

/// A base class, so that the file is there before the writer.
struct OwnedFile {
  OutputFile output;
};
/// A writer together with its output file.
template <class Writer>
class FileWriter : OwnedFile, public Writer {
 public:
  FileWriter(const std::filesystem::path& file, int threads)
      : OwnedFile{OutputFile(file)}, Writer(output, threads) {}

  void end() {
    Writer::end();
    output.commit();
  }
};

/// Opens a sink for a writer that is constructed from an OutputFile and a number of threads.
template <class Writer>
[[nodiscard]] std::unique_ptr<MeshSink> openWriterSink(const std::filesystem::path& file,
                                                       Context& context) {
  return std::make_unique<CheckedSink<FileWriter<Writer>>>(file.string(), "write mesh", context,
                                                           file, context.threads());
}

/// Sends a mesh to a sink, from begin() to end(), with its generators if it has any.
/// @throws Error InvalidArgument if only some vertices have generators
void sendTo(MeshSink& sink, const HexMesh& mesh);

}  // namespace hexhex::io
