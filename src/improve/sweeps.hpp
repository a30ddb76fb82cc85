// From vertex to vertex, many at a time: cells become positive, then the worst ones better, then
// all.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/cell_points.hpp>
#include <improve/colours.hpp>
#include <improve/curved_cells.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_mover.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

class Sweeps {
 public:
  /// The first three must outlive this.
  /// @param mesh      whose points move; of curved cells the refined mesh
  /// @param curved    cells between the same points that are to be improved in place of the mesh's,
  ///                  or null
  /// @param diagonal  of the surface
  Sweeps(HexMesh& mesh, const CurvedCells* curved, VertexPlaces& places, double diagonal,
         Stage& stage);

  /// Moves vertices around cells that are not certified until all are, or nothing helps any more.
  /// What did not become better stays as it was.
  /// @param slack  so far may vertices without tags leave the surface if nothing else helps
  void untangle(double slack);

  /// The same where vertices around bad cells may leave creases. What takes the boundary too far
  /// from the surface is put back.
  /// @param farQuads  of the boundary, which are too far
  /// @return vertices that left their creases, and may go on
  std::vector<Index> untangleAcrossCreases(double slack,
                                           const std::function<Array<Quad>()>& farQuads);

  /// Moves vertices around cells whose scaled Jacobian is below the target. Those at the target
  /// stay there.
  void raiseWorst(double target);

  /// Moves all vertices, so many times. No scaled Jacobian falls below the floor, and of those that
  /// are there, none below the least around.
  void smooth(int passes, double floor);

  /// Rounds of moveBack() until it is given up.
  static constexpr int kReturns = 8;
  /// Moves vertices of quads of the boundary towards where they were, as far as no cell becomes
  /// worse than smooth() would leave it.
  /// @param before, simplicesBefore  of all vertices
  void moveBack(std::span<const Quad> quads, const Array<Vec3>& before,
                const Array<Index>& simplicesBefore, double floor);

  /// The cells, with their points.
  [[nodiscard]] CellPoints cellPoints() const;

 private:
  /// Takes the qualities of n cells that `cellAt` lists.
  template <class CellAt>
  void measure(std::size_t n, const CellAt& cellAt);
  void measureAll();
  /// The cells whose quality is wanted, of all or of a list.
  template <class Wanted>
  [[nodiscard]] std::vector<Index> cellsThat(const Wanted& isWanted) const;
  template <class Wanted>
  [[nodiscard]] std::vector<Index> cellsThat(std::vector<Index> list, const Wanted& isWanted) const;
  /// Raises cells below the floor, which is the target.
  void raise(const Exchange& exchange);
  template <class Move>
  void sweep(std::span<const Index> vertices, double slack, const Move& move);

  HexMesh& mesh_;
  const CurvedCells* curved_;
  VertexPlaces& places_;
  Stage& stage_;
  adjacency::VertexCells meshAround_;
  adjacency::VertexCells nodeAround_;  ///< of curved cells
  Array<IdealBox> boxes_;              ///< per cell
  Array<double> qualities_;            ///< per cell: certifiedQuality(), of where points are
  Array<std::uint8_t> boundary_;       ///< per cell of the mesh: as of HexFaces
  double chord_;                       ///< as of ChordError
  std::optional<Colours> colours_;     ///< once they are asked for
};

}  // namespace hexhex::improvement
