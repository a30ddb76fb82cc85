// The mesh to improve: straight cells, or curved ones with the straight cells between their nodes.
#pragma once

#include <cstddef>
#include <memory>

#include <adjacency/hex_topology.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/improved_cells.hpp>

namespace hexhex::improvement {

/// Which kind of cells there are only matters here, and to steps that only straight cells take.
struct Subject {
  HexMesh& mesh;  ///< its points move
  /// If not null, these cells are improved; the mesh is their refinedMesh(), with the same points.
  LagrangeMesh* curved = nullptr;

  [[nodiscard]] bool isCurved() const noexcept { return curved != nullptr; }
  /// Number of cells of the mesh per improved cell: order^3 if these are curved, else 1.
  [[nodiscard]] std::size_t parts() const;
  /// The cells that are improved.
  /// @param around  the cells of the mesh; must outlive the result, like both meshes
  [[nodiscard]] std::unique_ptr<const ImprovedCells> cells(const adjacency::VertexCells& around,
                                                           Stage& stage) const;
  [[nodiscard]] Certificate certifyNow(Context& context) const;
  void putBack(const Array<Vec3>& points) const;
};

}  // namespace hexhex::improvement
