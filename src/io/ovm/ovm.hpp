// `.ovm` and `.ovmb`: the text and binary files of OpenVolumeMesh, with maps or hex meshes in them.
//
// A map is the property `HexHex::Parametrization`: for each half-face of a tet the parameters of
// the vertex opposite it, in the tet's chart. Also carried: valences of edges (`edge_valance`),
// rotations across half-faces (`HalffaceTransiton`), features (`AlgoHex::FeatureVertices`,
// `...Edges`, `...Faces`), and with hex meshes the generators of vertices (`v_tet_generator_type`).
//
// The format has no order of a cell's corners, and no generators by corners; so that both come back
// as they were, they are written as further properties, `hexhex::corner_order` (only where needed),
// `hexhex::generator_tet` and `hexhex::generator_corners`, which other programs ignore.
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// Read maps.
/// @throws Error FileNotFound; FileSyntax, with byte or line, also for a binary file without its
///         end; FileUnsupported if there is no map, or a cell is no tet; IndexOutOfRange,
///         NotFinite, TooLarge
[[nodiscard]] TetMap readOvmMap(const Input& input, Context& context);
[[nodiscard]] TetMap readOvmbMap(const Input& input, Context& context);

/// Read hex meshes. Cells may list their half-faces in any order; a mesh that is inside out is
/// turned.
/// @throws Error as above
[[nodiscard]] HexMesh readOvmHexMesh(const Input& input, Context& context);
[[nodiscard]] HexMesh readOvmbHexMesh(const Input& input, Context& context);

/// Read tets without a map, whether there is one or not.
/// @throws Error as above
[[nodiscard]] TetCells readOvmTets(const Input& input, Context& context);
[[nodiscard]] TetCells readOvmbTets(const Input& input, Context& context);

/// Write maps.
/// @throws Error FileWrite; InvalidArgument if arrays disagree, or features and valences name what
///         is not in the mesh; IndexOutOfRange, RepeatedVertex, NotFinite; NonManifoldFace,
///         Orientation for what the format cannot hold; TooLarge
void writeOvmMap(const TetMap& map, const std::filesystem::path& file, Context& context);
void writeOvmbMap(const TetMap& map, const std::filesystem::path& file, Context& context);

/// Write hex meshes.
/// @throws Error as above
void writeOvmHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context);
void writeOvmbHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& options, Context& context);

/// Write arcs as `.ovmb`. Vertices are hex vertices and inner points of arcs, edges are segments.
/// Properties of the field: `v_type` (0 hex vertex, 1 of an arc), `v_igm_uv` (place along the arc,
/// 0), `v_tet_generator_type`, `v_tet_generator_index`, `e_linear_hex_edge`,
/// `e_tet_generator_type`, `e_tet_generator_index`; and this library's `hexhex::generator_tet` and
/// `hexhex::generator_corners` of vertices and edges.
/// @param map  that the mesh was extracted from; null: indices are left out
void writeArcsOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                   const std::filesystem::path& file, Context& context);

/// The same with the inner points of patches (`v_type` 2, `v_igm_uv` their (u, v)), the sides of
/// polygons (`e_linear_hex_edge` -1 inside faces; without a map, -1 for all that tells their
/// simplex) and polygons: `f_linear_hex_face`, `f_intersected_tet_index`.
void writePatchesOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                      const std::filesystem::path& file, Context& context);

}  // namespace hexhex::io
