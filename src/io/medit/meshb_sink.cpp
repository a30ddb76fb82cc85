#include <optional>

#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/medit/meshb.hpp>
#include <io/medit/meshb_layout.hpp>

namespace hexhex {
namespace {

class MeshbSink final : public CheckedSink {
 public:
  MeshbSink(const std::filesystem::path& file, Context& context)
      : CheckedSink(file.string(), "write mesh", context),
        output_(file),
        lines_(output_, threads()) {}

 private:
  void takeBegin() override {
    const std::uint32_t version =
        meshbVersionFor({.vertices = pointCount(), .hexahedra = cellCount()});
    widths_.emplace(version);
    writeBytesOf(output_, std::uint32_t{1});  // tells the byte order
    writeBytesOf(output_, version);
    position_ = 8;
    beginSection(MeshbKeyword::Dimension, 8 + widths_->position);
    writeBytesOf(output_, std::uint32_t{3});
    beginSection(MeshbKeyword::Vertices, widths_->section(pointCount(), 1, 3));
    writeInteger(pointCount(), widths_->integer);
  }
  void takePoints(const PointPiece& piece) override {
    const std::span<const Vec3> points = piece.points;
    const auto vertex = [&](char* place, std::size_t i) {
      return putInteger(putBytes(place, points[i]), 0);
    };
    lines_.write(points.size(), 32, vertex, nullptr);
  }
  void takeCellsBegin() override {
    beginSection(MeshbKeyword::Hexahedra, widths_->section(cellCount(), 9, 0));
    writeInteger(cellCount(), widths_->integer);
  }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex> cells) override {
    writeCells(cells);
  }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex64> cells) override {
    writeCells(cells);
  }
  template <class Cell>
  void writeCells(std::span<const Cell> cells) {
    const auto cell = [&](char* place, std::size_t i) {
      for (const auto vertex : cells[i]) place = putInteger(place, std::uint64_t{vertex} + 1);
      return putInteger(place, 1);
    };
    lines_.write(cells.size(), 72, cell, nullptr);
  }
  void takeEnd() override {
    writeBytesOf(output_, MeshbKeyword::End);
    writeInteger(0, widths_->position);
    output_.commit();
  }

  /// The head of a section: its keyword, and where the next one begins.
  void beginSection(MeshbKeyword keyword, std::uint64_t bytes) {
    position_ += bytes;
    writeBytesOf(output_, keyword);
    writeInteger(position_, widths_->position);
  }
  void writeInteger(std::uint64_t number, std::uint64_t width) {
    writeBytesOf(output_, static_cast<std::uint32_t>(number));
    if (width == 8) writeBytesOf(output_, static_cast<std::uint32_t>(number >> 32U));
  }
  [[nodiscard]] char* putInteger(char* place, std::uint64_t number) const {
    return widths_->integer == 8 ? putBytes(place, number)
                                 : putBytes(place, static_cast<std::uint32_t>(number));
  }

  OutputFile output_;
  LineWriter lines_;
  std::optional<MeshbWidths> widths_;
  std::uint64_t position_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> openMeshbSink(const std::filesystem::path& file, Context& context) {
  return std::make_unique<MeshbSink>(file, context);
}

}  // namespace hexhex
