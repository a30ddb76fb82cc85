#include "mesh_collector.hpp"

#include <algorithm>
#include <cctype>
#include <span>
#include <string>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

namespace hexhex::command {
namespace {

/// Puts the pieces of a mesh together.
class MeshCollector : public MeshSink {
 public:
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    if (pointCount >= kNone || cellCount >= kNone) throwTooLarge();
    mesh_.points.resize(pointCount);
    mesh_.cells.resize(cellCount);
  }

  void points(const PointPiece& piece) override {
    copy(piece.points, mesh_.points, piece.first);
    // A file has generators of all vertices or of none.
    if (!piece.generatorTet.empty()) {
      mesh_.generatorTet.resize(mesh_.points.size());
      copy(piece.generatorTet, mesh_.generatorTet, piece.first);
    }
    if (!piece.generatorCorners.empty()) {
      mesh_.generatorCorners.resize(mesh_.points.size());
      copy(piece.generatorCorners, mesh_.generatorCorners, piece.first);
    }
  }

  void cells(std::uint64_t first, std::span<const Hex> cells) override {
    copy(cells, mesh_.cells, first);
  }
  void cells(std::uint64_t /*first*/, std::span<const Hex64> /*cells*/) override {
    throwTooLarge();
  }
  void end() override {}

  [[nodiscard]] HexMesh take() { return std::move(mesh_); }

 private:
  template <class T>
  static void copy(std::span<const T> from, Array<T>& to, std::uint64_t first) {
    std::ranges::copy(from, to.begin() + static_cast<std::ptrdiff_t>(first));
  }
  [[noreturn]] static void throwTooLarge() {
    throw Error(ErrorCode::TooLarge, "The mesh has 2^32 vertices or cells or more.");
  }

  HexMesh mesh_;
};

}  // namespace

HexMesh readWithGenerators(const std::filesystem::path& file, Context& context) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".vtu") return readHexMesh(file, context);
  MeshCollector collector;
  readHexMeshTo(collector, file, context);
  return collector.take();
}

}  // namespace hexhex::command
