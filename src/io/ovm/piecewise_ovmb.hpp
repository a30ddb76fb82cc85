// Arcs and patches as polyhedral `.ovmb`.
#pragma once

#include <filesystem>

#include <hexhex/curved.hpp>

namespace hexhex {

/// Vertices are hex vertices and inner points of arcs, edges are segments. Properties of the field:
/// `v_type` (0 hex vertex, 1 of an arc), `v_igm_uv` (place along the arc, 0),
/// `v_tet_generator_type`, `v_tet_generator_index`, `e_linear_hex_edge`, `e_tet_generator_type`,
/// `e_tet_generator_index`; and this library's `hexhex::generator_tet` and
/// `hexhex::generator_corners` of vertices and edges.
/// @param map  that the mesh was extracted from; null: indices are left out
void writeArcsOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                   const std::filesystem::path& file, Context& context);

/// The same with the inner points of patches (`v_type` 2, `v_igm_uv` their (u, v)), the sides of
/// polygons (`e_linear_hex_edge` -1 inside faces; without a map, -1 for all that tells their
/// simplex) and polygons: `f_linear_hex_face`, `f_intersected_tet_index`.
void writePatchesOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                      const std::filesystem::path& file, Context& context);

}  // namespace hexhex
