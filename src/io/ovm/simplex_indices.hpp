// How files of OpenVolumeMesh number the simplices of a tet mesh.
#pragma once

#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>
#include <io/ovm/ovm_topology.hpp>

namespace hexhex {

/// Indices of vertices, edges, faces and cells in the `.ovm` or `.ovmb` file that this library
/// writes for a map of these tets.
class SimplexIndices {
 public:
  /// @param tets  must outlive this, and have vertices in range
  /// @throws Error  as buildOvmTopology()
  SimplexIndices(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage);

  /// Of a simplex among those of its dimension.
  [[nodiscard]] Index of(Index tet, CornerSet corners) const;

 private:
  [[nodiscard]] Index faceWithout(Index tet, Index vertex) const;

  std::span<const Tet> tets_;
  OvmTopology topology_;
  OvmEdgeFinder edges_;
  OvmLoops<3> loops_;
};

}  // namespace hexhex
