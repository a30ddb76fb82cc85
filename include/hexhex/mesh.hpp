// From tets alone to a hexahedral mesh, in one go.
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

/// What one way led to, and what its mesh is judged by.
struct WayReport {
  ShapeMethod method = ShapeMethod::Auto;
  bool hasMesh = false;
  std::string refusal;  ///< why there is no mesh; empty if there is one, or none was needed
  bool isCertified = false;
  double minimum = 0;         ///< scaled Jacobian
  double distance = 0;        ///< between the boundaries, the larger one, in diagonals
  double curvesFollowed = 0;  ///< share of the length of sharp edges, 0 to 1
  double merit = -1;          ///< 0 to 1 for a certified mesh: the product of how good each is
};

struct MeshedPart {
  HexMesh mesh;
  TetMap map;  ///< an integer-grid map, which the generators of the mesh refer to
  ShapeReport shape;
  QuantizeReport quantization;
  VerifyReport verification;
  ImproveReport improvement;
  /// Whether vertices may have left edges that have a tag, as cells were not positive otherwise.
  bool tagsReleased = false;
  /// Pieces of tagged curves of the part that no edges of the mesh were found along.
  std::uint64_t missingCurves = 0;
  std::vector<WayReport> ways;  ///< with ShapeMethod::Auto: both
  std::string whyThisWay;       ///< with ShapeMethod::Auto: why this mesh was kept, half a sentence
};

/// Calls mapFromTets(), quantize(), extract(), verify() and improve(). Where vertices on tagged
/// edges keep cells from being positive, it improves the mesh again and takes these edges for
/// others. Tags of the tets are those of the mesh: of boundary quads, by the triangles nearest to
/// their centres; of cells, by the tet that holds their centre; of curves, by the edges that run
/// along them, or nearest to them. With ShapeMethod::Auto it goes both ways, at once if there are
/// threads for it, and keeps the mesh that is certified, and better by its least scaled Jacobian
/// (up to 0.3), its distance and the curves that it follows; unless a polycube is good in all of
/// these: then no frames are needed. Whether cells are positive in the end, improvement.after says.
/// @throws Error  as these functions; NotMeshable with both reasons if neither way leads to a mesh;
///                VerificationFailed if the mesh is not that of the map
[[nodiscard]] MeshedPart meshFromTets(const TetMesh& tets, const MeshOptions& options,
                                      Context& context);

}  // namespace HEXHEX_API_NAMESPACE
