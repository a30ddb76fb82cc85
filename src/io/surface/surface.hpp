// Files of surfaces. Each reader returns what the file says: polygons as triangles around their
// first corner, and vertices as they are listed.
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

/// Vertices of one position become one, and triangles without three different corners are left out.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace hexhex::io
