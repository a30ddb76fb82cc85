// The table of file formats. A new format is one file beside this folder's and one entry in
// registry.cpp; whatever lists formats reads the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// What a format is called.
struct FormatLabel {
  std::string_view name;  ///< as in ReadOptions::format and WriteOptions::format
  /// In lower case, with the dot. Of several formats with one extension, the first that can do what
  /// is asked for is what a file name means; empty if the format has to be asked for by name.
  std::string_view extension;
  std::string_view description;
};

/// A format and what is done with it; functions are null where nothing is.
struct Format {
  FormatLabel label;

  struct {
    TetMap (*read)(const Input& input, const ReadOptions& options, Context& context) = nullptr;
    void (*write)(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
                  Context& context) = nullptr;
  } maps = {};
  /// Tets without a map, whether there is one or not.
  TetCells (*readTets)(const Input& input, Context& context) = nullptr;
  TriangleMesh (*readTriangles)(const Input& input, Context& context) = nullptr;
  struct {
    HexMesh (*read)(const Input& input, Context& context) = nullptr;
    void (*write)(const HexMesh& mesh, const std::filesystem::path& file,
                  const WriteOptions& options, Context& context) = nullptr;
  } meshes = {};
  /// Cells of higher order, which are looked for first where meshes may have them.
  struct {
    bool (*isIn)(const Input& input, Context& context) = nullptr;
    LagrangeMesh (*read)(const Input& input, Context& context) = nullptr;
  } curved = {};
  /// Meshes in pieces.
  struct {
    std::unique_ptr<MeshSink> (*openSink)(const std::filesystem::path& file,
                                          Context& context) = nullptr;
    void (*read)(MeshSink& sink, const Input& input, Context& context) = nullptr;
  } pieces = {};

  bool compresses = false;  ///< heeds WriteOptions::compress
  /// Writing takes requireHdf5(); in builds without HDF5 all functions are null.
  bool overHdf5 = false;
};

enum class FileContent : std::uint8_t { Map, HexMesh, MapOrHexMesh, Tets, Triangles };

/// The format of a file that holds, or will hold, such content: the one of this name or, if it is
/// empty, what the extension means. It reads or writes such files, if not both.
/// @throws Error FileUnsupported, naming the extensions or the formats that are known
[[nodiscard]] const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                                       FileContent content);

/// "vtu, mesh": the names of all formats that take meshes in pieces.
[[nodiscard]] std::string streamingFormats();

}  // namespace hexhex::io
