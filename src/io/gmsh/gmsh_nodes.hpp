// The section $Nodes of `.msh` files.
#pragma once

#include <hexhex/types.hpp>

#include <io/gmsh/gmsh_file.hpp>
#include <io/gmsh/node_tags.hpp>

namespace hexhex {

/// Nodes in the order of the file.
struct GmshNodes {
  Array<Vec3> points;
  NodeTags tags;
};

/// Reads the section behind its name.
/// @throws Error FileSyntax, also for two nodes with one tag; NotFinite, TooLarge
[[nodiscard]] GmshNodes readGmshNodes(GmshFile& file);

}  // namespace hexhex
