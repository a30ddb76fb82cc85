#include <algorithm>
#include <span>

#include <io/core/mesh_pieces.hpp>

namespace hexhex {
namespace {

// Points or cells of a piece: a few megabytes.
constexpr std::size_t kPiece = std::size_t{1} << 16;

/// The values of elements [first, first + count); none if the array is empty.
template <class T>
std::span<const T> part(const Array<T>& values, std::size_t first, std::size_t count) {
  if (values.empty()) return {};
  return std::span(values).subspan(first, count);
}

}  // namespace

void sendTo(MeshSink& sink, const HexMesh& mesh) {
  sink.begin(mesh.points.size(), mesh.cells.size());
  for (std::size_t first = 0; first < mesh.points.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, mesh.points.size() - first);
    sink.points({first, part(mesh.points, first, count), part(mesh.generatorTet, first, count),
                 part(mesh.generatorCorners, first, count)});
  }
  for (std::size_t first = 0; first < mesh.cells.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, mesh.cells.size() - first);
    sink.cells(first, part(mesh.cells, first, count));
  }
  sink.end();
}

}  // namespace hexhex
