// From tets alone to a hexahedral mesh, in one go.
#pragma once

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

struct MeshedPart {
  HexMesh mesh;
  TetMap map;  ///< an integer-grid map, which the generators of the mesh refer to
  ShapeReport shape;
  QuantizeReport quantization;
  VerifyReport verification;
  ImproveReport improvement;
  /// Whether vertices may have left edges that have a tag, as cells were not positive otherwise.
  bool tagsReleased = false;
};

/// Calls mapFromTets(), quantize(), extract(), verify() and improve(). Where vertices on tagged
/// edges keep cells from being positive, it improves the mesh again and takes these edges for
/// others. With ShapeMethod::Auto it goes both ways, and keeps the mesh that is certified,
/// and better by its least scaled Jacobian, its distance and the curves that it follows. Whether
/// cells are positive in the end, improvement.after says.
/// @throws Error  as these functions; VerificationFailed if the mesh is not that of the map
[[nodiscard]] MeshedPart meshFromTets(const TetMesh& tets, const MeshOptions& options,
                                      Context& context);

}  // namespace HEXHEX_API_NAMESPACE
