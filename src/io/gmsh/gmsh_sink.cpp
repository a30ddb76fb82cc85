// MSH 4.1, binary, in pieces. The box around the mesh stands in front of the nodes but is known
// only behind them, and is written to its place in the end.
#include <algorithm>
#include <array>
#include <limits>

#include <hexhex/error.hpp>

#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/gmsh_types.hpp>

namespace hexhex {
namespace {

using namespace std::string_view_literals;

// With zeros in it, the bytes of a 1.
constexpr std::string_view kHead =
    "$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 "
    "\"hexahedra\"\n$EndPhysicalNames\n$Entities\n"sv;

class GmshSink final : public CheckedSink {
 public:
  GmshSink(const std::filesystem::path& file, Context& context)
      : CheckedSink(file.string(), "write mesh", context),
        output_(file),
        lines_(output_, threads()) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    box_ = {Vec3{kFar, kFar, kFar}, Vec3{-kFar, -kFar, -kFar}};
    if (output_.hasPositions()) return;
    throw Error(ErrorCode::FileWrite,
                file.string() +
                    ": the file was not written because it is a device or a pipe, to which a .msh "
                    "file cannot be written in pieces. Name a file.");
  }

 private:
  void takeBegin() override {
    output_.write(kHead);
    sizes({0, 0, 0, 1});  // entities of each dimension
    writeBytesOf(output_, std::uint32_t{1});
    writeBox();
    sizes({1});  // physical group
    writeBytesOf(output_, std::uint32_t{1});
    sizes({0});
    output_.write("\n$EndEntities\n$Nodes\n");
    const std::uint64_t blocks = pointCount() == 0 ? 0 : 1;
    sizes({blocks, pointCount(), blocks, pointCount()});
    if (blocks == 0) return;
    integers({3, 1, 0});
    sizes({pointCount()});
    lines_.write(
        pointCount(), 8,
        [](char* place, std::size_t i) { return putBytes(place, std::uint64_t{i} + 1); }, nullptr);
  }

  void takePoints(const PointPiece& piece) override {
    for (const Vec3& point : piece.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box_[0][axis] = std::min(box_[0][axis], point[axis]);
        box_[1][axis] = std::max(box_[1][axis], point[axis]);
      }
    }
    const std::span<const Vec3> points = piece.points;
    lines_.write(
        points.size(), sizeof(Vec3),
        [points](char* place, std::size_t i) { return putBytes(place, points[i]); }, nullptr);
  }

  void takeCellsBegin() override {
    output_.write("\n$EndNodes\n$Elements\n");
    const std::uint64_t blocks = cellCount() == 0 ? 0 : 1;
    sizes({blocks, cellCount(), blocks, cellCount()});
    if (blocks == 0) return;
    integers({3, 1, kGmshHexahedron});
    sizes({cellCount()});
  }
  void takeCells(std::uint64_t first, std::span<const Hex> cells) override {
    writeCells(first, cells);
  }
  void takeCells(std::uint64_t first, std::span<const Hex64> cells) override {
    writeCells(first, cells);
  }
  template <class Cell>
  void writeCells(std::uint64_t first, std::span<const Cell> cells) {
    const auto cell = [&](char* place, std::size_t i) {
      place = putBytes(place, first + i + 1);
      for (const auto vertex : cells[i]) place = putBytes(place, std::uint64_t{vertex} + 1);
      return place;
    };
    lines_.write(cells.size(), 72, cell, nullptr);
  }

  void takeEnd() override {
    output_.write("\n$EndElements\n");
    output_.flush();
    if (pointCount() > 0) {
      std::array<char, sizeof(box_)> bytes;  // NOLINT(*-member-init): filled at once
      char* place = bytes.data();
      for (const Vec3& corner : box_) place = putBytes(place, corner);
      constexpr std::uint64_t kBoxPosition =
          kHead.size() + 4 * sizeof(std::uint64_t) + sizeof(std::uint32_t);
      output_.writeBytesAt(kBoxPosition, bytes.data(), bytes.size());
    }
    output_.commit();
  }

  /// Room for the box.
  void writeBox() {
    for (int i = 0; i < 6; ++i) writeBytesOf(output_, 0.0);
  }
  void sizes(std::initializer_list<std::uint64_t> numbers) {
    for (const std::uint64_t number : numbers) writeBytesOf(output_, number);
  }
  void integers(std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) writeBytesOf(output_, number);
  }

  OutputFile output_;
  LineWriter lines_;
  std::array<Vec3, 2> box_{};
};

}  // namespace

std::unique_ptr<MeshSink> openGmsh41BinarySink(const std::filesystem::path& file,
                                               Context& context) {
  return std::make_unique<GmshSink>(file, context);
}

}  // namespace hexhex
