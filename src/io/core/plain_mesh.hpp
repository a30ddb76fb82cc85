// Files that are read piece by piece: those with vertices and hexahedra in two runs of equal
// records, as nearly all files are. What is not of that form, or wrong, is for the readers of whole
// files: they know all forms, and what is to be said of a mistake.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <hexhex/context.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// An open file of that form. Its calls come in order; each throws an Error for what is wrong.
class PlainMesh {
 public:
  PlainMesh() = default;
  virtual ~PlainMesh() = default;
  PlainMesh(const PlainMesh&) = delete;
  PlainMesh& operator=(const PlainMesh&) = delete;

  /// Goes to the first vertex.
  virtual void beginPoints() = 0;
  /// Reads the next vertices.
  virtual void read(std::span<Vec3> to) = 0;
  /// Goes to the first hexahedron.
  virtual void beginCells() = 0;
  /// Reads the next hexahedra.
  virtual void read(std::span<Hex64> to) = 0;

  std::uint64_t points = 0;
  std::uint64_t cells = 0;
};

/// Points or cells of a piece: a few megabytes.
inline constexpr std::size_t kPieceElements = std::size_t{1} << 16;

/// How one format is read in pieces.
struct PlainFormat {
  /// Looks through a regular file; null, or an Error, if it is not of the form. The file outlives
  /// the result.
  std::unique_ptr<PlainMesh> (*open)(const InputFile& file, const std::string& name,
                                     Context& context);
  HexMesh (*readWhole)(const Input& input, Context& context);
};

/// Reads a file into a sink: piece by piece if it has the form, or else as a whole.
/// @throws Error  as the reader of whole files; what the sink throws
void readPlainMesh(const PlainFormat& format, MeshSink& sink, const Input& input, Context& context);

/// What a file numbers from 1. @throws Error IndexOutOfRange
[[nodiscard]] std::uint64_t vertexOfNumber(std::uint64_t number, std::uint64_t points);

}  // namespace hexhex::io
