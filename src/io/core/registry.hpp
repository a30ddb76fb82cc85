// The table of file formats. A new format is one file beside this one and one entry in
// registry.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>

namespace hexhex {

/// A format and what is done with it; functions are null where nothing is.
struct Format {
  std::string_view name;  ///< as in ReadOptions::format and WriteOptions::format
  /// In lower case, with the dot. Of several formats with one extension, the first that can do what
  /// is asked for is what a file name means; empty if the format has to be asked for by name.
  std::string_view extension;
  std::string_view description;

  TetMap (*readMap)(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) = nullptr;
  void (*writeMap)(const TetMap& map, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context) = nullptr;
  /// Tets without a map, whether there is one or not.
  TetCells (*readTets)(const std::filesystem::path& file, Context& context) = nullptr;

  HexMesh (*readMesh)(const std::filesystem::path& file, Context& context) = nullptr;
  void (*writeMesh)(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& options, Context& context) = nullptr;
  // For meshes in pieces; null if the format takes a mesh as a whole only.
  std::unique_ptr<MeshSink> (*openSink)(const std::filesystem::path& file,
                                        Context& context) = nullptr;
  void (*readMeshTo)(MeshSink& sink, const std::filesystem::path& file, Context& context) = nullptr;

  bool compresses = false;  ///< heeds WriteOptions::compress
  /// The library without which this build cannot write the format: then all functions are null.
  std::string_view missing = {};
};

/// The table, in the order in which formats are listed.
[[nodiscard]] std::span<const Format> allFormats() noexcept;

/// The name in the table of what may be called by another name.
[[nodiscard]] std::string_view usualFormatName(std::string_view name) noexcept;

/// The format of a file that holds, or will hold, a map or a hex mesh: the one of this name or, if
/// it is empty, what the extension means. It reads or writes such files, if not both.
/// @throws Error FileUnsupported, naming the extensions or the formats that are known
[[nodiscard]] const Format& mapFormat(const std::filesystem::path& file,
                                      std::string_view name = {});
/// @throws Error  the same, also for a format that this build cannot write
[[nodiscard]] const Format& hexMeshFormat(const std::filesystem::path& file,
                                          std::string_view name = {});
/// The same of a file that may hold either.
[[nodiscard]] const Format& mapOrHexMeshFormat(const std::filesystem::path& file,
                                               std::string_view name);
/// The same of a file whose tets can be read.
[[nodiscard]] const Format& tetFormat(const std::filesystem::path& file, std::string_view name);

/// "mesh, meshb": the names of all formats that fit.
[[nodiscard]] std::string listFormatNames(bool (*fits)(const Format& format));

}  // namespace hexhex
