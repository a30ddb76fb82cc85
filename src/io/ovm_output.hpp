// Maps and hex meshes as `.ovm` and `.ovmb` hold them.
#pragma once

#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm_mesh.hpp>

namespace hexhex {

/// A mesh as it will be written.
struct OvmOutput {
  std::span<const Vec3> points;  ///< of the mesh that it was made from
  OvmTopology topology;
  OvmProperties properties;
};

/// Half-faces point into their cells, and the first slots of cells begin with the cells' corners
/// where neighbours allow it; elsewhere, the property CornerOrder tells the order.
/// @throws Error InvalidArgument if arrays disagree, or features and valences name what is not in
///         the mesh; IndexOutOfRange, RepeatedVertex, NotFinite, NonManifoldFace, Orientation,
///         TooLarge
[[nodiscard]] OvmOutput toOvm(const TetMap& map, Stage& stage);

/// @param mesh  with corners and generators in range
/// @param map   where the mesh comes from, for the indices of generators, which are those of a file
///              that this library writes for this map; or null
/// @throws Error as for maps
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, const TetMap* map, Stage& stage);

}  // namespace hexhex
