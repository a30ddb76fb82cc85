// The tets of a polycube, split where labels leave them no room.
#pragma once

#include <quantize/polycube/labelled_mesh.hpp>
#include <tetmap/carried_tags.hpp>

namespace hexhex::quantization {

struct PolycubeTets {
  TetMesh mesh;
  std::vector<adjacency::HalfFace> mate;  ///< per half-face
  std::vector<FaceFlags> flags;           ///< per tet
  std::vector<Index> parentTet;  ///< per tet: that of the labelled mesh which it is part of
  tetmap::AddedVertices added{0};
};

/// @param scale  of its points, a power of two
[[nodiscard]] PolycubeTets polycubeTets(const LabelledMesh& mesh, double scale);

/// Splits edges and tets until each tet has at most one corner, edge or triangle on the boundary,
/// and each boundary triangle at most one corner or edge between labels: those with more can be
/// flat wherever planes lie.
void makeRoom(PolycubeTets& tets);

/// Splits the longest edge of each tet at two of these vertices or more.
/// @param vertices  ascending
void refineAt(PolycubeTets& tets, const std::vector<Index>& vertices);

}  // namespace hexhex::quantization
