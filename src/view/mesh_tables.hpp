// A mesh as the tables of a page.
#pragma once

#include <span>
#include <vector>

#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <view/surface_nodes.hpp>
#include <view/table_codec.hpp>

namespace hexhex {

/// Where quantized coordinates are: coordinate = lower + step * number, the same step on all axes.
struct Quantization {
  Vec3 lower{};
  Vec3 upper{};
  double step = 1;
};

/// The smallest box around vertices and nodes, in 2^20 - 1 steps along its longest side.
/// @throws Error NotFinite; TooLarge if the longest side exceeds the largest double
[[nodiscard]] Quantization quantizationOf(const HexMesh& mesh, const SurfaceNodes& nodes = {});

/// Scaled Jacobians in 16 bits: 0 stands for -1, this for 1. As in viewer/src/format.ts.
inline constexpr double kQualitySteps = 65534;

/// Tables `points` (3 columns: vertices, then nodes), `cells` (8), `quality` (1) and, where the
/// mesh has them, `nodes` (SurfaceNodes::perCell), `generator_kinds` (1), `regions` (1),
/// `singular_edges` (vertex, vertex, 2 * valence + (1 on the boundary)), `feature_edges` (vertex,
/// vertex, tag) and `feature_quads` (4 vertices, tag).
[[nodiscard]] std::vector<PackedTable> packMesh(const HexMesh& mesh,
                                                const Quantization& quantization,
                                                std::span<const double> scaledJacobians,
                                                std::span<const SingularHexEdge> singularEdges,
                                                Stage& stage, const SurfaceNodes& nodes = {});

}  // namespace hexhex
