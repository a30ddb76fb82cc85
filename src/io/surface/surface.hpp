// Readers of surface files (see ReadTriangles).
#pragma once

#include <cstddef>
#include <span>

#include <hexhex/fill.hpp>

#include <io/formats/formats.hpp>

namespace hexhex::io {

ReadTriangles readStl, readObj, readOff, readPly;

/// Adds the triangles of a polygon: those at its first corner if all its angles are convex,
/// otherwise ears, cut off one by one.
void addPolygon(TriangleMesh& mesh, std::span<const Index> corners);

/// Merges vertices at the same position, and drops triangles with repeated corners.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace hexhex::io
