// Edges of triangles and their angles, and the reference surface of a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <base/vector3.hpp>

namespace hexhex::improvement {

using adjacency::ascending;

/// Twice the area of a triangle, along its normal.
[[nodiscard]] inline Vec3 normalOf(const std::array<Vec3, 3>& t) noexcept {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

/// 1 if either has no length.
[[nodiscard]] inline double cosineBetween(const Vec3& a, const Vec3& b) noexcept {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? dot(a, b) / lengths : 1;
}

/// @param visit  called with (vertices, triangles around them) once per edge, its vertices
///         ascending
template <class Visit>
void forEachEdge(std::span<const FeatureFace> triangles, const Visit& visit) {
  struct Side {
    std::array<Index, 2> vertices;
    Index triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<Index, 3>& v = triangles[t].vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      sides.push_back({ascending(v[i], v[(i + 1) % 3]), static_cast<Index>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Index> around;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    around.clear();
    for (; end < sides.size() && sides[end].vertices == sides[begin].vertices; ++end) {
      around.push_back(sides[end].triangle);
    }
    visit(sides[begin].vertices, std::span<const Index>(around));
    begin = end;
  }
}

// The surface that a mesh must not leave: triangles in smooth patches, between curves that end at
// corners.
//
// Projection walks from a known simplex over neighbouring triangles of its patch (or segments of
// its curve), so that the other side of a thin wall is out of reach, however near.

/// The input of ReferenceSurface.
struct SurfaceParts {
  Array<Vec3> points;
  std::vector<FeatureFace> triangles;        ///< those of different tags do not share a patch
  std::size_t boundaryTriangles = 0;         ///< these come first; the others are inside the object
  std::vector<Index> groups;                 ///< per triangle: no curve separates a group
  std::vector<std::array<Index, 2>> curves;  ///< not necessarily edges of triangles
  bool areTagged = false;                    ///< whether `curves` are
  std::vector<Index> corners;                ///< points
  double angle = 40;  ///< in degrees: edges where the surface turns by more are also curves
  /// These edges, ascending, if the angle alone does not determine them.
  std::optional<std::vector<std::array<Index, 2>>> sharp;
};

/// How a vertex may move.
enum class Freedom : std::uint8_t { Free, OnPatch, OnCurve, Fixed };

/// A place on the surface: the point, and the triangle or segment that holds it.
struct SurfacePlace {
  Vec3 point{};
  Index simplex = kNone;
};

class ReferenceSurface {
 public:
  ReferenceSurface() = default;
  ReferenceSurface(SurfaceParts parts, Stage& stage);

  [[nodiscard]] const Array<Vec3>& points() const noexcept { return points_; }
  [[nodiscard]] std::size_t triangleCount() const noexcept { return triangles_.size(); }
  /// Triangles below this number are the boundary of the object; the others are inside.
  [[nodiscard]] std::size_t boundaryCount() const noexcept { return boundaryTriangles_; }
  [[nodiscard]] std::array<Vec3, 3> triangle(Index t) const noexcept;
  [[nodiscard]] const std::array<Index, 3>& triangleVertices(Index t) const noexcept {
    return triangles_[t];
  }
  [[nodiscard]] std::array<Vec3, 2> segment(Index s) const noexcept;
  [[nodiscard]] std::size_t segmentCount() const noexcept { return segments_.size(); }
  [[nodiscard]] const std::array<Index, 2>& segmentVertices(Index s) const noexcept {
    return segments_[s];
  }
  [[nodiscard]] std::span<const Index> segmentsAt(Index point) const { return segmentsAt_(point); }
  /// The number of a triangle's patch.
  [[nodiscard]] Index patchOf(Index triangle) const noexcept { return patches_[triangle]; }
  /// The same triangles, with these edges as curves.
  [[nodiscard]] ReferenceSurface withCurves(std::vector<std::array<Index, 2>> sharp, double angle,
                                            Stage& stage) const;
  [[nodiscard]] std::span<const Index> corners() const noexcept { return corners_; }

  /// How a vertex inside the simplex with these corners may move.
  /// @param corners  one to three points
  /// @param[out] simplex  that holds the place, or the point if Fixed; unchanged if Free
  [[nodiscard]] Freedom freedomAt(std::span<const Index> corners, Index& simplex) const;

  /// Whether a triangle, curve or corner has a tag.
  [[nodiscard]] bool isTagged(Freedom freedom, Index simplex) const noexcept {
    if (freedom == Freedom::Fixed) {
      return std::binary_search(taggedCorners_.begin(), taggedCorners_.end(), simplex);
    }
    return freedom == Freedom::OnCurve ? taggedSegments_[simplex] : taggedTriangles_[simplex];
  }

  /// Whether a curve or corner is one only because of its angle or number of cells, so that the
  /// surface continues across it.
  [[nodiscard]] bool isCrease(Freedom freedom, Index simplex) const;
  /// Whether it is on a crease that fades out: at an end of its curve, no other curve goes on.
  [[nodiscard]] bool isFading(Freedom freedom, Index simplex) const;
  /// The triangle at a curve or corner that is nearest to a point.
  [[nodiscard]] Index triangleAt(Freedom freedom, Index simplex, const Vec3& point) const;

  /// The nearest place on the patch of a triangle, up to local minima: a walk downhill from there
  /// finds it.
  /// @param enough  the walk stops at the first place within this distance
  [[nodiscard]] SurfacePlace onPatch(const Vec3& point, Index triangle, double enough = 0) const;
  /// The same, across creases.
  [[nodiscard]] SurfacePlace acrossCreases(const Vec3& point, Index triangle,
                                           double enough = 0) const;
  /// The nearest place on the curve of a segment, up to the curve's ends.
  [[nodiscard]] SurfacePlace onCurve(const Vec3& point, Index segment) const;

 private:
  void findCurves(const SurfaceParts& parts, Stage& stage);
  void findCorners(const SurfaceParts& parts);
  [[nodiscard]] SurfacePlace onTriangles(const Vec3& point, Index triangle,
                                         const std::vector<Index>& sets, double enough) const;
  [[nodiscard]] bool isCurve(const std::array<Index, 2>& vertices, std::span<const Index> around,
                             const SurfaceParts& parts, double limit) const;

  Array<Vec3> points_;
  std::vector<std::array<Index, 3>> triangles_;
  std::size_t boundaryTriangles_ = 0;
  std::vector<Index> patches_;      ///< per triangle
  std::vector<Index> withCreases_;  ///< per triangle: its patch, merged across creases
  std::vector<bool> taggedTriangles_;
  std::vector<std::array<Index, 2>> segments_;
  std::vector<bool> taggedSegments_;
  std::vector<bool> creases_;         ///< per segment
  std::vector<Index> corners_;        ///< points, ascending
  std::vector<Index> taggedCorners_;  ///< those of them with a tag
  adjacency::VertexLists<Index> trianglesAt_;
  adjacency::VertexLists<Index> segmentsAt_;
};

/// The nearest point of a triangle, or of a segment.
[[nodiscard]] Vec3 nearestOf(const std::array<Vec3, 3>& triangle, const Vec3& point) noexcept;
[[nodiscard]] Vec3 nearestOf(const std::array<Vec3, 2>& segment, const Vec3& point) noexcept;

}  // namespace hexhex::improvement
