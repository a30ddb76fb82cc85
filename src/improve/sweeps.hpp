// Groups of vertices that move at the same time: no two of a group share a cell, so that the result
// does not depend on threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/curved_cells.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_mover.hpp>
#include <improve/vertex_places.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex::improvement {

class Colours {
 public:
  explicit Colours(const CellPoints& mesh);

  /// Vertices by their colour, otherwise in the order of the list: each group ends where the next
  /// begins.
  struct Groups {
    std::vector<Index> vertices;
    std::vector<std::size_t> ends;
  };
  [[nodiscard]] Groups groupsOf(std::span<const Index> vertices) const;

 private:
  [[nodiscard]] bool separates(const CellPoints& mesh) const;

  std::vector<std::uint16_t> colourOf_;  ///< per vertex
  std::size_t count_ = 0;
};

// Creases that keep cells from being positive: vertices may leave them as a last resort.
//
// The boundary of a mesh with bad cells is jagged where these are, and its sharp edges there are no
// features of the object.

class LooseVertices {
 public:
  /// Lets go those of a list that lie on patches, on creases, or where these meet; from now on,
  /// they move on all patches that only creases divide.
  /// @param places  outlives this
  LooseVertices(VertexPlaces& places, std::span<const Index> vertices, const Array<Vec3>& points);

  [[nodiscard]] bool empty() const noexcept { return held_.empty(); }

  /// Holds those again that are where they were.
  /// @return the others
  std::vector<Index> holdUnmoved(const Array<Vec3>& points);

 private:
  struct Held {
    Index vertex;
    Freedom freedom;
    Index simplex;
    Vec3 point;
  };
  VertexPlaces& places_;
  std::vector<Held> held_;
};

// Scaled Jacobians and certificates of some cells, straight or curved.

/// Calls use(cell, CellState) for the cells of a list, until it returns false.
/// @param curved   in place of the cells of the mesh, or null
/// @param leastOf  of (cell): a curved one with a smaller scaled Jacobian need not be certified
/// @return whether it never did
template <class LeastOf, class Use>
bool forStates(const HexMesh& mesh, const CurvedCells* curved, std::span<const Index> list,
               CurvedCells::Scratch& scratch, const LeastOf& leastOf, const Use& use) {
  for (std::size_t begin = 0; curved != nullptr && begin < list.size();
       begin += curved::kCellLanes) {
    const auto some = list.subspan(begin, std::min(curved::kCellLanes, list.size() - begin));
    const auto states = curved->statesOf(mesh.points, some, leastOf, scratch);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (!use(some[i], states[i])) return false;
    }
  }
  if (curved != nullptr) return true;
  static const mesh::MeasureCells measure = mesh::measuresOfCells().back();
  mesh::CellMeasures measures;
  std::array<Hex, mesh::CellMeasures::kMost> cells;
  for (std::size_t begin = 0; begin < list.size(); begin += mesh::CellMeasures::kMost) {
    const std::size_t n = std::min(mesh::CellMeasures::kMost, list.size() - begin);
    for (std::size_t i = 0; i < n; ++i) cells[i] = mesh.cells[list[begin + i]];
    measure(mesh.points.data(), std::span(cells).first(n), measures);
    for (std::size_t i = 0; i < n; ++i) {
      const bool certified = measures.inRange[i] != 0 && measures.least[i] > measures.errorOf(i);
      if (!use(list[begin + i], CellState{measures.scaled[i], certified})) return false;
    }
  }
  return true;
}

/// What is kept of the state of a cell: its scaled Jacobian, or less than any if it is not
/// certified.
[[nodiscard]] inline double certifiedQuality(const CellState& state) noexcept {
  constexpr double kNotCertified = -2;
  return state.certified ? state.scaled : kNotCertified;
}
[[nodiscard]] inline bool isCertified(double quality) noexcept { return quality >= -1; }

// From vertex to vertex, many at a time: cells become positive, then the worst ones better, then
// all.

class Sweeps {
 public:
  /// How a mesh stands: the less the better.
  struct Standing {
    std::size_t bad = 0;    ///< cells that are not certified
    std::size_t below = 0;  ///< and of the others those below the target
    double depth = 0;       ///< 1 less the least scaled Jacobian
    auto operator<=>(const Standing&) const = default;
  };
  [[nodiscard]] Standing standing(double target) const;
  /// Per cell: the scaled Jacobian, or less than any if it is not certified.
  [[nodiscard]] const Array<double>& qualities() const noexcept { return qualities_; }
  /// Cells that were at the target and are below.
  [[nodiscard]] std::vector<Index> fallenSince(const Array<double>& qualities, double target) const;
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

  /// Moves vertices of straight cells below the target, and many rings around, all at once, time
  /// after time until angles come hardly nearer to right ones. Boundary quads that come too far
  /// from the surface stay where they were from then on.
  /// @param slack     as of untangle(), for what folds on the way back onto the surface
  /// @param isFolded  whether most cells may be inside out
  /// @param farQuads  of the boundary, which are too far
  void moveAtOnce(double target, double slack, bool isFolded,
                  const std::function<Array<Quad>()>& farQuads);

  /// The vertices of cells that are not certified or below the target, and of rings around.
  [[nodiscard]] std::vector<Index> verticesBelow(double target, int rings) const;

  /// Puts all vertices where they were.
  void putBackAll(const Array<Vec3>& before, const Array<Index>& simplicesBefore);

  /// Moves vertices around cells whose scaled Jacobian is below the target. Those at the target
  /// stay there.
  /// @param slack  so far may vertices without tags leave the surface
  void raiseWorst(double target, double slack);

  /// Moves all vertices, so many times. No scaled Jacobian falls below the floor, and of those that
  /// are there, none below the least around.
  void smooth(int passes, double floor);

  /// Moves vertices that are off their places of the surface towards these, as far as smooth()
  /// would let cells be.
  void pullOntoSurface(double floor);

  /// Rounds of moveBack() and pullOntoSurface() until they are given up.
  static constexpr int kReturns = 8;
  /// Moves vertices of quads of the boundary towards where they were, as far as no cell becomes
  /// worse than smooth() would leave it.
  /// @param before, simplicesBefore  of all vertices
  void moveBack(std::span<const Quad> quads, const Array<Vec3>& before,
                const Array<Index>& simplicesBefore, double floor);

  /// Moves vertices of the boundary along it to where its quads are far from the surface, so that
  /// these become smaller and others larger, and then those inside after them. Scaled Jacobians
  /// stay as smooth() would leave them.
  /// @param errors  per quad of the boundary: how far it is, in any unit
  /// @param even    quads that are no farther weigh as if they were so far
  void spread(std::span<const Quad> quads, std::span<const double> errors, double even,
              double floor);

  /// The cells, with their points.
  [[nodiscard]] CellPoints cellPoints() const;

 private:
  /// Takes the qualities of n cells that `cellAt` lists.
  template <class CellAt>
  void measure(std::size_t n, const CellAt& cellAt);
  void measureAll();
  /// Ideal cells get the shape that cells have.
  void takeBoxes();
  /// Of some cells: how far scaled Jacobians are from 1, added up.
  [[nodiscard]] double deficitOf(std::span<const Index> cells) const;
  /// The cells whose quality is wanted.
  template <class Wanted>
  [[nodiscard]] std::vector<Index> cellsThat(const Wanted& isWanted) const;
  /// The same of those, or of those of a list, that have a vertex which can move.
  template <class Wanted>
  [[nodiscard]] std::vector<Index> movableCells(const Wanted& isWanted) const;
  template <class Wanted>
  [[nodiscard]] std::vector<Index> movable(std::vector<Index> list, const Wanted& isWanted) const;
  /// Raises cells below the floor, which is the target.
  void raise(const Exchange& exchange, double slack);
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
