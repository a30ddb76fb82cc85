// The section $Elements of `.msh` files, behind its name.
#pragma once

#include <io/gmsh/gmsh_cells.hpp>
#include <io/gmsh/gmsh_file.hpp>
#include <io/gmsh/gmsh_tags.hpp>

namespace hexhex {

/// Of version 4.1: blocks of elements, each of one entity and type.
/// @param tags  of all entities
/// @return whether there are other elements than cells
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, TooLarge
[[nodiscard]] bool readElements41(GmshFile& file, const GmshTags& tags, GmshCells<4>& cells);
[[nodiscard]] bool readElements41(GmshFile& file, const GmshTags& tags, GmshCells<8>& cells);

/// Of version 2: as text each element says its type, as bytes come blocks of one type.
/// @throws Error  the same
[[nodiscard]] bool readElements22(GmshFile& file, const GmshTags& tags, GmshCells<4>& cells);
[[nodiscard]] bool readElements22(GmshFile& file, const GmshTags& tags, GmshCells<8>& cells);

}  // namespace hexhex
