// Reads a mesh with all that its file knows of it.
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

namespace hexhex::command {

/// A mesh as readHexMesh() reads it, and for .vtu files also where its vertices came from.
/// @throws Error  as readHexMesh()
[[nodiscard]] HexMesh readWithGenerators(const std::filesystem::path& file, Context& context);

}  // namespace hexhex::command
