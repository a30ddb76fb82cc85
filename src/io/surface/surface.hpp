// Readers of surface files. They return what the file contains: vertices as listed, and polygons
// triangulated as fans around their first corner.
#pragma once

#include <cstddef>
#include <span>

#include <hexhex/fill.hpp>

#include <io/core/input_file.hpp>

namespace hexhex::io {

[[nodiscard]] TriangleMesh readStl(const Input& input, Stage& stage);
[[nodiscard]] TriangleMesh readObj(const Input& input, Stage& stage);
[[nodiscard]] TriangleMesh readOff(const Input& input, Stage& stage);
[[nodiscard]] TriangleMesh readPly(const Input& input, Stage& stage);

inline void addPolygon(TriangleMesh& mesh, std::span<const Index> corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

/// Merges vertices at the same position, and drops triangles with repeated corners.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace hexhex::io
