// The tets of a polycube, split where labels over-constrain them.
#pragma once

#include <quantize/polycube/labelled_mesh.hpp>
#include <tetmap/carried_tags.hpp>

namespace hexhex::quantization {

struct PolycubeTets {
  TetMesh mesh;
  std::vector<adjacency::HalfFace> mate;  ///< per half-face
  std::vector<FaceFlags> flags;           ///< per tet
  std::vector<Index> parentTet;  ///< per tet: the tet of the labelled mesh that contains it
  tetmap::AddedVertices added{0};
};

/// @param scale  factor of all points, a power of two
[[nodiscard]] PolycubeTets polycubeTets(const LabelledMesh& mesh, double scale);

/// Splits edges and tets until each tet has at most one vertex, edge or triangle on the boundary,
/// and each boundary triangle at most one vertex or edge on curves between labels: those with more
/// can be flat whatever the planes.
void makeRoom(PolycubeTets& tets);

/// Splits the longest edge of each tet that has at least two of these vertices.
/// @param vertices  ascending
void refineAt(PolycubeTets& tets, const std::vector<Index>& vertices);

}  // namespace hexhex::quantization
