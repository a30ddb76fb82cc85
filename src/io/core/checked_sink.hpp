// What all sinks have in common: the order of calls, checks of what comes, time and cancellation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// A sink whose derived classes are called in the right order only, with finite coordinates and
/// vertices that exist. A call that throws is the last one.
class CheckedSink : public MeshSink {
 public:
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) final;
  void points(const PointPiece& piece) final;
  void cells(std::uint64_t first, std::span<const Hex> cells) final;
  void cells(std::uint64_t first, std::span<const Hex64> cells) final;
  void end() final;

 protected:
  /// @param name  what errors begin with, e.g. a file
  /// @param stage  under which the time is noted; outlives this
  CheckedSink(std::string name, std::string_view stage, Context& context);

  virtual void takeBegin() = 0;
  /// The piece is not empty.
  virtual void takePoints(const PointPiece& piece) = 0;
  /// Called once before the first cells, or before the end if there are none.
  virtual void takeCellsBegin() = 0;
  virtual void takeCells(std::uint64_t first, std::span<const Hex> cells) = 0;
  virtual void takeCells(std::uint64_t first, std::span<const Hex64> cells) = 0;
  virtual void takeEnd() = 0;

  [[nodiscard]] int threads() const noexcept { return context_.threads(); }
  [[nodiscard]] std::uint64_t pointCount() const noexcept { return pointCount_; }
  [[nodiscard]] std::uint64_t cellCount() const noexcept { return cellCount_; }

 private:
  enum class State { Fresh, Points, Cells, Ended, Failed };

  template <class F>
  void run(const F& f);
  template <class Cell>
  void checkCells(std::uint64_t first, std::span<const Cell> cells);
  void requireNext(const char* what, std::uint64_t first, std::uint64_t size, std::uint64_t next,
                   std::uint64_t count) const;
  void requireConsistent(const PointPiece& piece);
  void beginCells();
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
/// @tparam Writer  has begin(pointCount, cellCount),
///         points(piece), beginCells(), cells(first, cells) for both kinds of cells, and end()
template <class Writer>
class WriterSink : public CheckedSink {
 public:
  template <class... Arguments>
  WriterSink(std::string name, std::string_view stage, Context& context,
             const Arguments&... arguments)
      : CheckedSink(std::move(name), stage, context), writer_(arguments...) {}

  [[nodiscard]] const Writer& writer() const noexcept { return writer_; }

 private:
  void takeBegin() override { writer_.begin(pointCount(), cellCount()); }
  void takePoints(const PointPiece& piece) override { writer_.points(piece); }
  void takeCellsBegin() override { writer_.beginCells(); }
  void takeCells(std::uint64_t first, std::span<const Hex> cells) override {
    writer_.cells(first, cells);
  }
  void takeCells(std::uint64_t first, std::span<const Hex64> cells) override {
    writer_.cells(first, cells);
  }
  void takeEnd() override { writer_.end(); }

  Writer writer_;
};

/// A sink over a writer that is made from a file and a number of threads.
template <class Writer>
[[nodiscard]] std::unique_ptr<MeshSink> openWriterSink(const std::filesystem::path& file,
                                                       Context& context) {
  return std::make_unique<WriterSink<Writer>>(file.string(), "write mesh", context, file,
                                              context.threads());
}

/// Hands a mesh over, from begin() to end(). Generators go along if there are as many as vertices.
void sendTo(MeshSink& sink, const HexMesh& mesh);

}  // namespace hexhex
