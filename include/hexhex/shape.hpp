// From tets alone to a seamless map: for parts of which nobody has made a map.
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

/// How a map is made.
enum class ShapeMethod : std::uint8_t {
  Auto,      ///< along frames, and if there is no such map, by a polycube
  Polycube,  ///< the object becomes one of axis-aligned boxes: no singular edges inside
  Frames     ///< along a smooth field of frames, aligned with the boundary and its features
};

struct ShapeOptions {
  ShapeMethod method = ShapeMethod::Auto;
  /// Edges where the surface turns by more than that, in degrees, are features of the object. They
  /// get a tag where they are edges of the map, so that the mesh has them, too. 0 to 180.
  double featureAngle = 40;
  /// Of random decisions: another one may find what this one does not.
  std::uint64_t seed = 1;
};

/// What is to be said of the labels of a polycube. Charts are connected triangles with one label:
/// faces of the polycube, if all is well.
struct LabelReport {
  std::uint64_t charts = 0;
  std::uint64_t corners = 0;        ///< where three charts or more meet
  std::uint64_t badLoops = 0;       ///< borders of charts with fewer than four corners
  std::uint64_t badCorners = 0;     ///< of more than three charts, or without room for their faces
  std::uint64_t oppositeEdges = 0;  ///< edges of the mesh between opposite labels
  std::uint64_t turningPoints = 0;  ///< where edges of the polycube would run back
  std::uint64_t wrongTurns = 0;     ///< charts whose right angles do not add up
  double deviation = 0;  ///< mean of 1 minus the cosine between a triangle's normal and its label

  /// Whether nothing is known to be wrong with them.
  [[nodiscard]] bool isValid() const noexcept {
    return badLoops + badCorners + oppositeEdges + turningPoints + wrongTurns == 0;
  }
};

struct ShapeReport {
  ShapeMethod method = ShapeMethod::Auto;  ///< that made the map
  /// Rows: the axes in space that became those of the map.
  std::array<Vec3, 3> rotation = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  LabelReport labels;
  std::uint64_t labelMoves = 0;    ///< random changes that were tried
  std::uint64_t addedTets = 0;     ///< by splits
  std::uint64_t featureEdges = 0;  ///< of the tets, beyond the angle
  std::uint64_t taggedEdges = 0;   ///< of these: edges of the map
  std::uint64_t innerFaces = 0;    ///< triangles inside, with a tag or between regions
  std::uint64_t alignedFaces = 0;  ///< of these: in planes of the map, so that quads will be there
  double alignedArea = 1;          ///< share of the area of inner faces that these have
  MapDistortion distortion;
};

struct ShapedMap {
  TetMap map;
  ShapeReport report;
};

/// Makes a seamless map of a tet mesh, which quantize() takes. Parameters are in units of space. Of
/// the map's points, the given ones come first; of its tets, those that were not split have the
/// given corners, in another order if that was not positive. Tags of the tets are those of the map;
/// edges where the surface turns that have none get one of their own. Deterministic, for any number
/// of threads.
///
/// Along frames: the best meshes, but many fields are those of no mesh, which is known in seconds
/// (Palmer et al. 2020). By a polycube: the object is turned (Gregson et al. 2011); each boundary
/// triangle gets one of six labels by graph cuts (Livesu et al. 2013), which random cuts in small
/// places make valid; and mapFromFlags() makes a map of these.
///
/// @throws Error NotMeshable if there is no map, with the place that keeps it from one;
///               NonManifoldFace, NonManifoldEdge, NonManifoldVertex; FlippedTet for tets without
///               volume; Orientation for tets that overlap their neighbours; TooLarge for more
///               than 500,000 tets; those of broken meshes; InvalidArgument for options out of
///               range, or if canQuantize() is false
[[nodiscard]] ShapedMap mapFromTets(const TetMesh& tets, const ShapeOptions& options,
                                    Context& context);

}  // namespace HEXHEX_API_NAMESPACE
