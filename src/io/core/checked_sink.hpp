// What all writers refuse; and what all sinks have in common: the order of calls, checks of what
// comes, time and cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

/// The first point with a coordinate that is infinite or no number, or the number of points.
[[nodiscard]] std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage);

/// Refuses a map that could not be read back.
/// @throws Error InvalidArgument if arrays disagree, IndexOutOfRange, NotFinite
void requireWritable(const TetMap& map, Stage& stage);

/// Refuses meshes that would crash a writer or could not be read back.
/// @throws Error InvalidArgument if arrays disagree or a cell names no vertex, NotFinite
void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage);

/// The calls of one sink: in the right order only, with finite coordinates and vertices that exist.
/// Of a call inside run(), the functions throw if it is wrong.
class SinkCalls {
 public:
  /// @param name  what errors begin with, e.g. a file
  /// @param stage  under which the time is noted; outlives this
  SinkCalls(std::string name, std::string_view stage, Context& context);

  /// Does the work of one call. After a call that throws, all others are refused.
  void run(const std::function<void()>& call);

  void begin(std::uint64_t pointCount, std::uint64_t cellCount);
  void points(const PointPiece& piece);
  /// @return whether these are the first cells, or the end without any
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
  // The sink's loops are short and many: they report no progress of their own.
  Context quiet_;
  State state_ = State::Fresh;
  std::uint64_t pointCount_ = 0;
  std::uint64_t cellCount_ = 0;
  std::uint64_t nextPoint_ = 0;
  std::uint64_t nextCell_ = 0;
  bool hasTets_ = false;
  bool hasCorners_ = false;
};

/// A sink that hands what it checked to the writer of a format.
/// @tparam Writer  has begin(pointCount, cellCount); points(piece), with some points; beginCells(),
///         called once, even if there are no cells; cells(first, cells) for both kinds of cells;
///         and end()
template <class Writer>
class CheckedSink : public MeshSink {
 public:
  /// @param arguments  what the writer is made from; the others as SinkCalls has them
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

/// A writer with the file that it writes.
template <class Writer>
class FileWriter {
 public:
  FileWriter(const std::filesystem::path& file, int threads)
      : output_(file), writer_(output_, threads) {}

  void begin(std::uint64_t points, std::uint64_t cells) { writer_.begin(points, cells); }
  void points(const PointPiece& piece) { writer_.points(piece); }
  void beginCells() { writer_.beginCells(); }
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    writer_.cells(first, cells);
  }
  void end() {
    writer_.end();
    output_.commit();
  }

 private:
  OutputFile output_;
  Writer writer_;
};

/// A sink over a writer that is made from an open file and a number of threads.
template <class Writer>
[[nodiscard]] std::unique_ptr<MeshSink> openWriterSink(const std::filesystem::path& file,
                                                       Context& context) {
  return std::make_unique<CheckedSink<FileWriter<Writer>>>(file.string(), "write mesh", context,
                                                           file, context.threads());
}

/// Hands a mesh over, from begin() to end(). Generators go along if there are as many as vertices.
void sendTo(MeshSink& sink, const HexMesh& mesh);

}  // namespace hexhex::io
