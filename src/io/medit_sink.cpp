#include <base/stage.hpp>
#include <io/file_sink.hpp>
#include <io/line_writer.hpp>
#include <io/medit_text.hpp>
#include <io/mesh_sink.hpp>

namespace hexhex {
namespace {

class MeditSink final : public FileSink {
 public:
  MeditSink(const std::filesystem::path& file, Context& context)
      : FileSink(file, context), lines_(output(), threads()) {}

 private:
  void writeBegin() override { output().write(kMeditHead).write(pointCount()).write('\n'); }
  void writePoints(const PointPiece& piece) override { writeMeditVertices(lines_, piece.points); }
  void writeCellsBegin() override {
    output().write("Hexahedra\n").write(cellCount()).write('\n');
  }
  void writeCells(std::uint64_t /*first*/, std::span<const Hex> cells) override {
    writeMeditElements(lines_, cells);
  }
  void writeCells(std::uint64_t /*first*/, std::span<const Hex64> cells) override {
    writeMeditElements(lines_, cells);
  }
  void writeEnd() override { output().write("End\n"); }

  LineWriter lines_;
};

}  // namespace

std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file, Context& context) {
  return std::make_unique<MeditSink>(file, context);
}

}  // namespace hexhex
