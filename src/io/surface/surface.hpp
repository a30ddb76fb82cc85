// Readers of surface files (see ReadTriangles).
#pragma once

#include <cstddef>
#include <span>

#include <hexhex/fill.hpp>

#include <io/formats/formats.hpp>

namespace hexhex::io {

ReadTriangles readStl, readObj, readOff, readPly;

inline void addPolygon(TriangleMesh& mesh, std::span<const Index> corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

/// Merges vertices at the same position, and drops triangles with repeated corners.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace hexhex::io
