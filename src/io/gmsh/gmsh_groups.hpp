// The sections of `.msh` files that tell which groups elements belong to, and what these are
// called.
#pragma once

#include <string_view>

#include <io/gmsh/gmsh_file.hpp>
#include <io/gmsh/gmsh_tags.hpp>

namespace hexhex {

/// Takes the names of groups from the section $PhysicalNames. Lines of another form are passed
/// over.
/// @param section  its text
void readGmshNames(std::string_view section, GmshTags& tags);

/// Reads the groups of entities in the section $Entities of MSH 4.1, up to its end.
/// @throws Error FileSyntax, NotFinite
void readGmshEntities(GmshFile& file, GmshTags& tags);

}  // namespace hexhex
