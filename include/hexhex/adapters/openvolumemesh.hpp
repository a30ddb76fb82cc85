// From and to meshes with the interface of OpenVolumeMesh, without including it: everything is a
// template, and only what is named here is called.
//
//   hexhex::TetMap map = hexhex::fromOpenVolumeMesh(
//       tetMesh, [&](OVM::CellHandle c, OVM::VertexHandle v) { return igm[c].at(v); });
//   hexhex::toOpenVolumeMesh(hexhex::extract(map), hexMesh);
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

namespace detail {

/// Any vector with operator[].
template <class Vector>
[[nodiscard]] Vec3 toVec3(const Vector& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Faces of a hexahedron in VTK's order, in OpenVolumeMesh's order: three pairs of opposite faces,
/// counter-clockwise seen from inside.
inline constexpr std::array<std::array<std::size_t, 4>, 6> kHexFaces = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {3, 2, 6, 7}, {1, 5, 6, 2}, {0, 3, 7, 4}}};

/// A face of a cell, to be sorted such that the two sides of one face stand together.
struct FaceSide {
  Quad key;  ///< its vertices, ascending
  std::size_t cell;
  std::size_t face;  ///< of kHexFaces
};

[[nodiscard]] inline std::vector<FaceSide> sortedSides(const HexMesh& mesh) {
  std::vector<FaceSide> sides;
  sides.reserve(6 * mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (std::size_t f = 0; f < 6; ++f) {
      Quad key{};
      for (std::size_t i = 0; i < 4; ++i) key[i] = mesh.cells[c][kHexFaces[f][i]];
      std::sort(key.begin(), key.end());
      sides.push_back({key, c, f});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
    return a.key != b.key ? a.key < b.key : a.cell < b.cell;
  });
  return sides;
}

}  // namespace detail

/// A map from a tetrahedral mesh, e.g. OpenVolumeMesh::TetrahedralGeometryKernel. Copies.
/// @param mesh       with n_vertices(), vertices(), cells(), vertex(handle) for the position, and
///                   get_cell_vertices(handle); handles with idx(), numbered from 0 without gaps
///                   (call collect_garbage() first)
/// @param parameter  parameter(cell handle, vertex handle): u, v, w of the cell's corner at that
///                   vertex, as something with operator[]
/// @throws Error InvalidArgument for a cell that does not have four vertices
template <class TetMesh, class Parameter>
[[nodiscard]] TetMap fromOpenVolumeMesh(const TetMesh& mesh, const Parameter& parameter) {
  TetMap map;
  map.points.resize(static_cast<std::size_t>(mesh.n_vertices()));
  for (const auto& vertex : mesh.vertices()) {
    map.points[static_cast<std::size_t>(vertex.idx())] = detail::toVec3(mesh.vertex(vertex));
  }
  for (const auto& cell : mesh.cells()) {
    const auto vertices = mesh.get_cell_vertices(cell);
    if (vertices.size() != 4) {
      throw Error(
          ErrorCode::InvalidArgument,
          "A cell has " + std::to_string(vertices.size()) + " vertices. Give a mesh of tetrahedra.",
          {PlaceKind::Tet, map.tets.size()});
    }
    Tet& tet = map.tets.emplace_back();
    TetParameters& parameters = map.parameters.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      tet[i] = static_cast<Index>(vertices[i].idx());
      parameters[i] = detail::toVec3(parameter(cell, vertices[i]));
    }
  }
  return map;
}

/// Adds a mesh to an empty hexahedral (or polyhedral) mesh, e.g.
/// OpenVolumeMesh::HexahedralGeometryKernel. Vertices and cells keep their numbers; faces are
/// numbered by their first cell.
/// @param out  with PointT, add_vertex(PointT), add_face(vector of vertex handles),
///             halfface_handle(face handle, 0 or 1), add_cell(vector of half-face handles)
/// @throws Error NonManifoldFace for a face of more than two cells; what comes out of extract() has
///         none
template <class HexMeshType>
void toOpenVolumeMesh(const HexMesh& mesh, HexMeshType& out) {
  using Point = typename HexMeshType::PointT;
  using VertexHandle = decltype(out.add_vertex(Point(0, 0, 0)));
  using FaceHandle = decltype(out.add_face(std::vector<VertexHandle>()));
  using HalfFaceHandle = decltype(out.halfface_handle(FaceHandle(), 0));
  std::vector<VertexHandle> vertices;
  vertices.reserve(mesh.points.size());
  for (const Vec3& p : mesh.points) vertices.push_back(out.add_vertex(Point(p[0], p[1], p[2])));

  // The other side of each face, by six times the cell plus the face.
  const std::vector<detail::FaceSide> sides = detail::sortedSides(mesh);
  constexpr std::size_t kBoundary = static_cast<std::size_t>(-1);
  std::vector<std::size_t> mate(6 * mesh.cells.size(), kBoundary);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].key != sides[i - 1].key) continue;
    const std::size_t a = 6 * sides[i - 1].cell + sides[i - 1].face;
    const std::size_t b = 6 * sides[i].cell + sides[i].face;
    if (mate[a] != kBoundary) {
      throw Error(ErrorCode::NonManifoldFace, "A face belongs to more than two cells.",
                  {PlaceKind::Cell, sides[i].cell});
    }
    mate[a] = b;
    mate[b] = a;
  }

  std::vector<FaceHandle> faces(6 * mesh.cells.size());
  std::vector<HalfFaceHandle> halfFaces(6);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (std::size_t f = 0; f < 6; ++f) {
      const std::size_t side = 6 * c + f;
      const bool first = mate[side] == kBoundary || mate[side] > side;
      if (first) {
        std::vector<VertexHandle> corners;
        for (const std::size_t i : detail::kHexFaces[f]) {
          corners.push_back(vertices[mesh.cells[c][i]]);
        }
        faces[side] = out.add_face(corners);
      } else {
        faces[side] = faces[mate[side]];
      }
      halfFaces[f] = out.halfface_handle(faces[side], first ? 0 : 1);
    }
    static_cast<void>(out.add_cell(halfFaces));
  }
}

}  // namespace hexhex
