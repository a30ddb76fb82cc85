// Computes seamless maps from tets alone, for parts that come without a map.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Method for computing a map.
enum class ShapeMethod : std::uint8_t {
  Auto,      ///< frames; if they yield no map, a polycube
  Polycube,  ///< deforms the object into axis-aligned boxes: no interior singular edges
  Frames     ///< follows a smooth frame field, aligned with the boundary and its features
};

struct ShapeOptions {
  ShapeMethod method = ShapeMethod::Auto;
  /// Edges where the surface turns by more than this angle, in degrees, are features of the object.
  /// Those that are edges of the map receive a tag, so that the mesh has them, too. 0 to 180.
  double featureAngle = 40;
  /// Random seed: another one may succeed where this one fails.
  std::uint64_t seed = 1;
};

/// Diagnostics of polycube labels. Charts are connected triangles with the same label; in a valid
/// labelling, they are the faces of the polycube.
struct LabelReport {
  std::uint64_t charts = 0;
  std::uint64_t corners = 0;   ///< where at least three charts meet
  std::uint64_t badLoops = 0;  ///< chart borders with fewer than four corners
  /// Corners of more than three charts or without room for their faces, and points around which
  /// labels wind otherwise than normals.
  std::uint64_t badCorners = 0;
  std::uint64_t oppositeEdges = 0;  ///< mesh edges between opposite labels
  std::uint64_t turningPoints = 0;  ///< where edges of the polycube would reverse direction
  std::uint64_t wrongTurns = 0;     ///< charts whose right angles do not add up
  std::uint64_t flatCharts = 0;     ///< charts two of whose edges would lie on each other
  double deviation = 0;  ///< mean of 1 minus the cosine between a triangle's normal and its label

  /// Whether no problem is known.
  [[nodiscard]] bool isValid() const noexcept {
    return badLoops + badCorners + oppositeEdges + turningPoints + wrongTurns + flatCharts == 0;
  }
};

struct ShapeReport {
  ShapeMethod method = ShapeMethod::Auto;  ///< method that produced the map
  /// Rows: the axes in space that became the axes of the map.
  std::array<Vec3, 3> rotation = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  LabelReport labels;
  std::uint64_t labelMoves = 0;    ///< random changes tried
  std::uint64_t addedTets = 0;     ///< by splits
  std::uint64_t featureEdges = 0;  ///< edges of the tets above the angle
  std::uint64_t taggedEdges = 0;   ///< those of them that are edges of the map
  std::uint64_t innerFaces = 0;    ///< interior triangles with a tag or on a region interface
  std::uint64_t alignedFaces = 0;  ///< those of them in planes of the map, to be covered by quads
  double alignedArea = 1;          ///< share of the area of inner faces that these have
  MapDistortion distortion;
};

struct ShapedMap {
  TetMap map;
  ShapeReport report;
};

/// Computes a seamless map of a tet mesh, as input for quantize(). Parameters are in units of
/// space. The given points come first in the map. Tets that were not split keep their corners, but
/// in another order if the given one was not positive. The map keeps the tags of the tets; untagged
/// edges where the surface turns receive a tag of their own. Deterministic for any number of
/// threads.
///
/// Frames yield the best meshes, but many frame fields do not correspond to a mesh, which is
/// detected within seconds (Palmer et al. 2020). For a polycube, the object is rotated (Gregson et
/// al. 2011), each boundary triangle is assigned one of six labels by graph cuts (Livesu et al.
/// 2013), random cuts in small areas make these labels valid, and mapFromFlags() computes the map.
///
/// @throws Error NotMeshable if no map was found, with the place that prevents it; NonManifoldFace,
///         NonManifoldEdge, NonManifoldVertex; FlippedTet for tets without volume; Orientation for
///         tets that overlap their neighbours; TooLarge for more than 500,000 tets; the errors of
///         broken meshes; InvalidArgument for options out of range, or if canQuantize() is false
[[nodiscard]] ShapedMap mapFromTets(const TetMesh& tets, const ShapeOptions& options,
                                    Context& context);

}  // namespace HEXHEX_API_NAMESPACE
