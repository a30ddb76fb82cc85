// The table of file formats: all that a format can do is in its row. A new format is a file in
// formats/, its functions in formats.hpp, and a row in registry.cpp; whatever lists formats reads
// the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <hexhex/fill.hpp>

#include <io/core/input_file.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

/// What a format is called.
struct FormatLabel {
  std::string_view name;  ///< as in ReadOptions::format and WriteOptions::format
  /// In lower case, with the dot. Of several formats with one extension, the first that can do what
  /// is asked for is what a file name means; empty if the format has to be asked for by name.
  std::string_view extension;
  std::string_view description = {};
};

/// A format and what can be done with it; functions are null for what cannot.
struct Format {
  FormatLabel label;

  struct {
    ReadMap* read = nullptr;
    WriteMap* write = nullptr;
  } maps = {};
  /// Tets without a map, whether there is one or not.
  ReadTets* readTets = nullptr;
  TriangleMesh (*readTriangles)(const Input& input, Stage& stage) = nullptr;
  struct {
    ReadMesh* read = nullptr;
    WriteMesh* write = nullptr;
    WriteFolder* writeFolder = nullptr;
  } meshes = {};
  /// Cells of higher order, which are looked for first where meshes may have them.
  struct {
    HoldsCurved* isIn = nullptr;
    ReadCurved* read = nullptr;
    WriteCurved* write = nullptr;
    std::string_view extension = {};  ///< of what is written, if it is not the label's
    int onlyOrder = 0;                ///< that is written; 0: all are
  } curved = {};
  /// Meshes piece by piece.
  struct {
    OpenSink* openSink = nullptr;
    ReadPieces* read = nullptr;
  } pieces = {};
  /// Meshes in parts.
  struct {
    OpenPartSink* open = nullptr;
    std::string_view description = {};  ///< which files there are; empty: the format has no parts
    bool byTeams = true;                ///< whether processes can write it together
  } parts = {};
  WritePiecewise* writeArcs = nullptr;
  WritePiecewise* writePatches = nullptr;

  bool compresses = false;  ///< heeds WriteOptions::compress
  bool measures = false;    ///< holds WriteOptions::scaledJacobians
  bool groups = true;       ///< of boundary quads: heeds WriteOptions::patchAngle
  /// Writing takes requireHdf5(); in builds without HDF5 all functions are null.
  bool overHdf5 = false;
};

enum class FileContent : std::uint8_t {
  Map,
  HexMesh,
  MapOrHexMesh,
  Tets,
  Triangles,
  Parts,
  CurvedCells,  ///< to be written
  Arcs,
  Patches
};

/// The format of a file that holds, or will hold, such content: the one of this name or, if it is
/// empty, what the extension means. It reads or writes such files, if not both.
/// @throws Error FileUnsupported, naming the extensions or the formats that are known
[[nodiscard]] const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                                       FileContent content);

/// "vtu, mesh": the names of all formats that take meshes in pieces.
[[nodiscard]] std::string streamingFormats();
/// The names of all formats of parts that processes can write together.
[[nodiscard]] std::string teamFormats();

}  // namespace hexhex::io
