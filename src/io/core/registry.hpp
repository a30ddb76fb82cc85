// The table of file formats: one row describes all that a format can do. To add a format, add a
// file in formats/, declare its functions in formats.hpp, and add a row in registry.cpp; everything
// that lists formats reads the table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <hexhex/fill.hpp>

#include <io/core/input_file.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

/// The names of a format.
struct FormatLabel {
  std::string_view name;  ///< as in ReadOptions::format and WriteOptions::format
  /// Lower case, with the dot. A file name selects the first format with its extension that fits
  /// the request; empty if the format must be selected by name.
  std::string_view extension;
  std::string_view description = {};
};

/// A format and its functions; null where it lacks a capability.
struct Format {
  FormatLabel label;

  struct {
    ReadMap* read = nullptr;
    WriteMap* write = nullptr;
  } maps = {};
  /// Reads tets, ignoring a map if there is one.
  ReadTets* readTets = nullptr;
  struct {
    ReadTriangles* read = nullptr;
    bool (*isIn)(const Input& input) = nullptr;  ///< null: all files of the format hold surfaces
  } triangles = {};
  struct {
    ReadMesh* read = nullptr;
    WriteMesh* write = nullptr;
    WriteFolder* writeFolder = nullptr;
  } meshes = {};
  /// Cells of higher order; tried before `meshes` where a file may hold either.
  struct {
    HoldsCurved* isIn = nullptr;
    ReadCurved* read = nullptr;
    WriteCurved* write = nullptr;
    std::string_view extension = {};  ///< of files written, if not the label's
    int onlyOrder = 0;                ///< the only order that can be written; 0: any
  } curved = {};
  /// Meshes streamed piece by piece.
  struct {
    OpenSink* openSink = nullptr;
    ReadPieces* read = nullptr;
  } pieces = {};
  /// Meshes in parts.
  struct {
    OpenPartSink* open = nullptr;
    std::string_view description = {};  ///< the files written; empty: parts are not supported
    bool byTeams = true;                ///< whether the processes of a team can write it together
  } parts = {};
  WritePiecewise* writeArcs = nullptr;
  WritePiecewise* writePatches = nullptr;

  bool compresses = false;  ///< supports WriteOptions::compress
  bool measures = false;    ///< stores WriteOptions::scaledJacobians
  bool others = false;      ///< stores cells that are no hexahedra: WriteOptions::others
  bool groups = true;       ///< stores groups of boundary quads: supports WriteOptions::patchAngle
  /// Writing requires requireHdf5(); in builds without HDF5 all functions are null.
  bool overHdf5 = false;
};

enum class FileContent : std::uint8_t {
  Map,
  HexMesh,
  MapOrHexMesh,
  Tets,
  Triangles,
  Parts,
  CurvedCells,  ///< for writing
  Arcs,
  Patches
};

/// The format of a file with such content: the named one or, if the name is empty, the one that the
/// extension selects. It may support reading only or writing only.
/// @throws Error FileUnsupported, listing the known extensions or names
[[nodiscard]] const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                                       FileContent content);

/// Whether a file holds a surface, rather than tets.
[[nodiscard]] bool holdsSurface(const std::filesystem::path& file, Context& context);

/// The names of all formats that can be written piece by piece: "vtu, mesh".
[[nodiscard]] std::string streamingFormats();
/// The extensions of all formats that can be written with cells other than hexahedra.
[[nodiscard]] std::string formatsOfOthers();
/// The names of all formats of parts that a team of processes can write together.
[[nodiscard]] std::string teamFormats();

}  // namespace hexhex::io
