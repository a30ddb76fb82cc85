// Maps and hex meshes as `.ovm` and `.ovmb` hold them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/ovm/ovm_mesh.hpp>

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

/// The topology of the same.
/// @param tets  with vertices in range
[[nodiscard]] OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                                        Stage& stage);

/// @param mesh  with corners and generators in range
/// @param map   where the mesh comes from, for the indices of generators, which are those of a file
///              that this library writes for this map; or null
/// @throws Error as for maps
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, const TetMap* map, Stage& stage);

/// One property that is present.
struct OvmPropertyValues {
  OvmEntity entity = OvmEntity::Vertex;
  std::string_view name;
  const Array<Vec3>* points = nullptr;            ///< either this
  const Array<std::int32_t>* integers = nullptr;  ///< or this is set
};

/// All properties that are present, in the order in which they are written.
[[nodiscard]] std::vector<OvmPropertyValues> listProperties(const OvmProperties& properties);

/// Write and commit a mesh as `.ovmb` or `.ovm`, in the layout of OpenVolumeMesh's own files: for
/// each kind of element one chunk or section, handles without offset; numbers of `.ovm` have the
/// fewest digits that read back to the same double.
/// @throws Error FileWrite
void writeOvmbFile(const OvmOutput& mesh, OutputFile& output, Stage& stage);
void writeOvmTextFile(const OvmOutput& mesh, OutputFile& output, Stage& stage);

}  // namespace hexhex
