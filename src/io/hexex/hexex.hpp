// `.hexex`: the exchange format of parametrized tetrahedral meshes. Text, separated by white space:
//
//     <number of vertices>
//     x y z                                                (per vertex)
//     <number of tets>
//     v0 v1 v2 v3  u v w  u v w  u v w  u v w              (per tet: 0-based corners, parameters)
//
// Some programs append walls (`W`, then W times `v v v distance`) or features (`vertices edges
// faces`, then that many vertices, pairs, and triples), or walls and then features: a line with one
// number alone announces walls, one with three features. Both become features of the map; as the
// format gives them no tags, features get tag 1, and walls that are not features as well get tag 2.
#pragma once

#include <cstdint>
#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <io/core/input_file.hpp>

namespace hexhex {

inline constexpr std::int32_t kHexexFeatureTag = 1;
inline constexpr std::int32_t kHexexWallTag = 2;

/// @throws Error FileNotFound, FileSyntax, IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] TetMap readHexex(const Input& input, Context& context);

/// Writes numbers with the fewest digits (at most 17) that read back to the same double. Features
/// follow the tets, without their tags.
/// @throws Error FileWrite; InvalidArgument if arrays disagree; NotFinite
void writeHexex(const TetMap& map, const std::filesystem::path& file, Context& context);

}  // namespace hexhex
