#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/medit/medit.hpp>
#include <io/medit/medit_text.hpp>

namespace hexhex {
namespace {

class MeditSink final : public CheckedSink {
 public:
  MeditSink(const std::filesystem::path& file, Context& context)
      : CheckedSink(file.string(), "write mesh", context),
        output_(file),
        lines_(output_, threads()) {}

 private:
  void takeBegin() override { output_.write(kMeditHead).write(pointCount()).write('\n'); }
  void takePoints(const PointPiece& piece) override { writeMeditVertices(lines_, piece.points); }
  void takeCellsBegin() override { output_.write("Hexahedra\n").write(cellCount()).write('\n'); }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex> cells) override {
    writeMeditElements(lines_, cells);
  }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex64> cells) override {
    writeMeditElements(lines_, cells);
  }
  void takeEnd() override { output_.write("End\n").commit(); }

  OutputFile output_;
  LineWriter lines_;
};

}  // namespace

std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file, Context& context) {
  return std::make_unique<MeditSink>(file, context);
}

}  // namespace hexhex
