#include <algorithm>
#include <string>
#include <system_error>

#include <hexhex/error.hpp>

#include <io/core/checked_sink.hpp>
#include <io/core/plain_mesh.hpp>

namespace hexhex::io {
namespace {

/// A file turned out to be wrong when some pieces of it had been sent.
struct WrongFile {
  Error error;
};

/// Reads and sends n elements.
template <class T, class Send>
void sendRun(PlainMesh& mesh, std::uint64_t n, const Send& send, LoopProgress& progress) {
  Array<T> piece;
  for (std::uint64_t first = 0; first < n; first += kPieceElements) {
    piece.resize(std::min<std::uint64_t>(kPieceElements, n - first));
    try {
      mesh.read(std::span<T>(piece));
    } catch (const Error& error) {
      throw WrongFile{error};
    }
    send(first, std::span<const T>(piece));
    progress.advance(piece.size());
  }
}

void sendPlain(PlainMesh& mesh, MeshSink& sink, Stage& stage) {
  LoopProgress progress(stage, mesh.points + mesh.cells);
  sink.begin(mesh.points, mesh.cells);
  mesh.beginPoints();
  sendRun<Vec3>(
      mesh, mesh.points,
      [&](std::uint64_t first, std::span<const Vec3> points) {
        sink.points({first, points, {}, {}});
      },
      progress);
  mesh.beginCells();
  sendRun<Hex64>(
      mesh, mesh.cells,
      [&](std::uint64_t first, std::span<const Hex64> cells) { sink.cells(first, cells); },
      progress);
  sink.end();
}

std::unique_ptr<PlainMesh> openPlain(const PlainFormat& format, const InputFile& file,
                                     const std::string& name, Context& context) {
  try {
    return format.open(file, name, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    return nullptr;  // the other reader tells what is wrong
  }
}

}  // namespace

void readPlainMesh(const PlainFormat& format, MeshSink& sink, const Input& input,
                   Context& context) {
  std::error_code unknown;
  // A pipe can be opened but once.
  if (!input.bytes() && std::filesystem::is_regular_file(input.path(), unknown)) {
    const InputFile open(input.path());
    Stage stage(context, "read mesh");
    const std::unique_ptr<PlainMesh> mesh = openPlain(format, open, input.name(), context);
    try {
      if (mesh) {
        input.counts()->add(kCellKind<8>, mesh->cells);
        return sendPlain(*mesh, sink, stage);
      }
    } catch (const WrongFile& wrong) {
      // Whatever is wrong: the other reader tells the line, and the first of several mistakes.
      static_cast<void>(format.readWhole(input, context));
      throw wrong.error;
    }
  }
  sendTo(sink, format.readWhole(input, context));
}

std::uint64_t vertexOfNumber(std::uint64_t number, std::uint64_t points) {
  // 0, which is too small, becomes a large number.
  if (number - 1 < points) return number - 1;
  throw Error(ErrorCode::IndexOutOfRange, "A cell names vertex " + std::to_string(number) +
                                              ", but the " + std::to_string(points) +
                                              " vertices are numbered from 1.");
}

}  // namespace hexhex::io
