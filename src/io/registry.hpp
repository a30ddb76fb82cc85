// The table of file formats by extension. A new format is one file beside this one and one line in
// registry.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

struct MapFormat {
  std::string_view extension;  ///< in lower case, with the dot
  TetMap (*read)(const std::filesystem::path& file, Context& context);
  void (*write)(const TetMap& map, const std::filesystem::path& file, Context& context);
};

struct HexMeshFormat {
  std::string_view name;  ///< as in WriteOptions::format
  /// In lower case, with the dot. Of several formats with one extension, the first is what a file
  /// name means; empty if the format has to be asked for by name.
  std::string_view extension;
  HexMesh (*read)(const std::filesystem::path& file, Context& context);  ///< null: only written
  void (*write)(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context);

  // For meshes in pieces; null if the format takes a mesh as a whole only.
  std::unique_ptr<MeshSink> (*openSink)(const std::filesystem::path& file,
                                        Context& context) = nullptr;
  void (*readTo)(MeshSink& sink, const std::filesystem::path& file, Context& context) = nullptr;

  /// The library without which this build cannot write the format: then `write` is null.
  std::string_view missing = {};
};

/// The format of a file by its extension.
/// @param name  of a format, which overrides the extension unless it is empty
/// @throws Error FileUnsupported, naming the extensions or the formats that are known
[[nodiscard]] const MapFormat& mapFormat(const std::filesystem::path& file);
[[nodiscard]] const HexMeshFormat& hexMeshFormat(const std::filesystem::path& file,
                                                 std::string_view name = {});

}  // namespace hexhex
