// `.hexex`: the exchange format of parametrized tetrahedral meshes. Text, separated by white space:
//
//     <number of vertices>
//     x y z                                                (per vertex)
//     <number of tets>
//     v0 v1 v2 v3  u v w  u v w  u v w  u v w              (per tet: 0-based corners, parameters)
//
// Some programs append walls of a motorcycle complex (`W`, then W times `v v v distance`) or
// features
// (`vertices edges faces`, then that many vertices, pairs, and triples), or walls and then
// features: a line with one number alone announces walls, one with three features. As the format
// gives features no tags, they get tag 1; where all triangles of the boundary are listed, these are
// left out. Walls serve the complex and are no features, unless ReadOptions::keepWalls asks for
// those inside of the object, with tag 2.
#pragma once

#include <cstdint>
#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

#include <io/core/input_file.hpp>

namespace hexhex::io {

inline constexpr std::int32_t kHexexFeatureTag = 1;
inline constexpr std::int32_t kHexexWallTag = 2;

/// @throws Error FileNotFound, FileSyntax, IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] TetMap readHexex(const Input& input, const ReadOptions& options, Context& context);

/// Writes numbers with the fewest digits (at most 17) that read back to the same double. Features
/// follow the tets, without their tags.
/// @throws Error FileWrite; InvalidArgument if arrays disagree; NotFinite
void writeHexex(const TetMap& map, const std::filesystem::path& file, Context& context);

}  // namespace hexhex::io
