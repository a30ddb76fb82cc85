// From tets alone to a hexahedral mesh, in a single call.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/improve.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/shape.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct MeshOptions {
  ShapeOptions shape;
  QuantizeOptions quantize;
  ImproveOptions improve = {.pillow = PillowMode::Auto, .snapCurves = true};
};

/// Outcome of one method and the criteria for its mesh.
struct WayReport {
  ShapeMethod method = ShapeMethod::Auto;
  bool hasMesh = false;
  std::string refusal;  ///< why there is no mesh; empty if there is one, or if none was needed
  bool isCertified = false;
  double minimum = 0;   ///< minimum scaled Jacobian
  double distance = 0;  ///< between the boundaries, the larger of both directions, in diagonals
  double curvesFollowed = 0;  ///< share of the length of sharp edges, 0 to 1
  double merit = -1;          ///< 0 to 1 for a certified mesh: the product of the individual scores
};

struct MeshedPart {
  HexMesh mesh;
  TetMap map;  ///< an integer-grid map, to which the generators of the mesh refer
  ShapeReport shape;
  QuantizeReport quantization;
  VerifyReport verification;
  ImproveReport improvement;
  /// Whether vertices could leave tagged edges because cells were not positive otherwise.
  bool tagsReleased = false;
  /// Segments of tagged curves for which no mesh edges were found.
  std::uint64_t missingCurves = 0;
  /// Regions and tagged surfaces of the part that no cell or quad has: they are too small for it.
  std::vector<TagName> missingGroups;
  std::vector<WayReport> ways;  ///< with ShapeMethod::Auto: both methods
  std::string whyThisWay;  ///< with ShapeMethod::Auto: why this mesh was chosen, as half a sentence
};

/// Calls mapFromTets(), quantize(), extract(), verify() and improve(). Where vertices on tagged
/// edges keep cells from becoming positive, improves the mesh again and treats these edges as
/// untagged. Transfers the tags of the tets to the mesh: to boundary quads from the triangles
/// nearest to their centres; to cells from the tet that contains their centre; for curves, to the
/// edges that run along them or are nearest to them. Where the map of a polycube has no mesh, tries
/// that of another seed, once.
///
/// With ShapeMethod::Auto, tries both methods, concurrently if there are enough threads, and keeps
/// the certified mesh with the better combination of minimum scaled Jacobian (up to 0.3), distance
/// and curves followed. If the polycube is good by all of these criteria, frames are skipped. Check
/// improvement.after to see whether all cells are positive.
/// @throws Error  as these functions; NotMeshable with both reasons if neither method yields a
///         mesh; VerificationFailed if the mesh does not match the map
[[nodiscard]] MeshedPart meshFromTets(const TetMesh& tets, const MeshOptions& options,
                                      Context& context);

}  // namespace HEXHEX_API_NAMESPACE
