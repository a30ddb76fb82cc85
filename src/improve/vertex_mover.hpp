// Moves one vertex at a time, within what its place allows, for the better of the cells around it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <improve/point_mover.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex {

/// What movers work on; all of it outlives them.
struct MovingMesh {
  HexMesh& mesh;
  VertexPlaces& places;
  const VertexCells& around;
  const Array<IdealBox>& boxes;         ///< per cell
  const Array<std::uint8_t>& boundary;  ///< per cell: as of HexFaces
  double chord;  ///< so far may boundary quads be from the surface, if they are not farther anyway
};

/// A vertex with all that a step of it takes. One per thread.
class VertexMover {
 public:
  /// Vertices of one cell must not move at the same time.
  /// @param slack  so far may vertices leave patches and curves without tags
  VertexMover(const MovingMesh& all, double slack)
      : mesh_(all.mesh),
        places_(all.places),
        around_(all.around),
        boxes_(all.boxes),
        boundary_(all.boundary),
        chord_(all.chord),
        mover_(all.mesh.points, all.places, slack) {}

  /// Brings all Bezier coefficients of the cells nearer to being positive.
  /// @return the share of the cells' size that it moved by
  double untangle(Index vertex);

  /// Lowers the energy at corners, if all cells around are certified and stay so, and the least
  /// scaled Jacobian does not fall below `floor`, or at all if it is there; nor does the boundary
  /// leave the surface.
  /// @param power  of EnergyKind
  /// @return as untangle()
  double smooth(Index vertex, int power, double floor);

 private:
  /// What the cells around a vertex are like.
  struct StarQuality {
    double scaled = 1;  ///< the least scaled Jacobian
    bool certified = true;
  };
  void collect(Index vertex, bool bezier);
  [[nodiscard]] StarQuality qualityAt(Index vertex) const;
  [[nodiscard]] double sizeAt(Index vertex) const;

  /// How far the centres of boundary quads at a vertex, and of edges on its curve, are from the
  /// surface.
  [[nodiscard]] double chordErrorAt(Index vertex) const;

  HexMesh& mesh_;
  VertexPlaces& places_;
  const VertexCells& around_;
  const Array<IdealBox>& boxes_;
  const Array<std::uint8_t>& boundary_;
  double chord_;
  PointMover mover_;
  std::vector<EnergyTerm> terms_;
};

}  // namespace hexhex
