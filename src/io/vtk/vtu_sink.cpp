// The parts of a `.vtu` file follow each other array by array, but a mesh in pieces brings some of
// each. So all arrays are written side by side, each from its own position on.
#include <map>
#include <optional>

#include <hexhex/error.hpp>

#include <io/core/checked_sink.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtu.hpp>
#include <io/vtk/vtu_content.hpp>
#include <io/vtk/vtu_layout.hpp>

namespace hexhex {
namespace {

class VtuSink final : public CheckedSink {
 public:
  VtuSink(const std::filesystem::path& file, Context& context)
      : CheckedSink(file.string(), "write mesh", context), output_(file) {
    if (output_.hasPositions()) return;
    throw Error(ErrorCode::FileWrite,
                file.string() +
                    ": the file was not written because it is a device or a pipe, but the arrays "
                    "of a .vtu file that comes in pieces are written side by side. Name a file.");
  }

 private:
  void takeBegin() override {}

  void takePoints(const PointPiece& piece) override {
    if (piece.first == 0) layOut(!piece.generatorTet.empty(), !piece.generatorCorners.empty());
    part(VtuContent::Points).writeBytes(piece.points.data(), piece.points.size_bytes());
    if (!piece.generatorTet.empty()) {
      part(VtuContent::GeneratorTet)
          .writeBytes(piece.generatorTet.data(), piece.generatorTet.size_bytes());
    }
    if (!piece.generatorCorners.empty()) {
      part(VtuContent::GeneratorCorners)
          .writeBytes(piece.generatorCorners.data(), piece.generatorCorners.size_bytes());
      writeGeneratorKinds(part(VtuContent::GeneratorKind), piece.generatorCorners);
    }
  }

  void takeCellsBegin() override {
    if (!layout_) layOut(false, false);  // there are no vertices
  }
  void takeCells(std::uint64_t first, std::span<const Hex> cells) override {
    writeAnyCells(first, cells);
  }
  void takeCells(std::uint64_t first, std::span<const Hex64> cells) override {
    writeAnyCells(first, cells);
  }

  template <class Cell>
  void writeAnyCells(std::uint64_t first, std::span<const Cell> cells) {
    writeConnectivity(part(VtuContent::Connectivity), cells, layout_->wideConnectivity());
    writeOffsets(part(VtuContent::Offsets), first, cells.size(), layout_->wideOffsets());
    writeTypes(part(VtuContent::Types), cells.size());
  }

  void takeEnd() override {
    for (auto& [content, part] : parts_) part.flush();
    const std::string_view tail = VtuLayout::tail();
    output_.writeBytesAt(layout_->tailPosition(), tail.data(), tail.size());
    output_.commit();
  }

  /// Only the first piece tells which arrays there are, and so where they begin.
  void layOut(bool generatorTets, bool generatorCorners) {
    layout_.emplace(VtuShape{pointCount(), cellCount(), generatorTets, generatorCorners, false});
    output_.writeBytesAt(0, layout_->head().data(), layout_->head().size());
    for (const VtuArray& array : layout_->arrays()) {
      output_.writeBytesAt(array.position - sizeof(array.bytes), &array.bytes, sizeof(array.bytes));
      parts_.emplace(array.content, FilePart(output_, array.position));
    }
  }

  FilePart& part(VtuContent content) { return parts_.at(content); }

  OutputFile output_;
  std::optional<VtuLayout> layout_;
  std::map<VtuContent, FilePart> parts_;
};

}  // namespace

std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file, Context& context) {
  return std::make_unique<VtuSink>(file, context);
}

}  // namespace hexhex
