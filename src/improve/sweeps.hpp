// Sweeps over the vertices of a mesh. Vertices of one colour move in parallel: no two of them share
// a cell, so the result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/improved_cells.hpp>
#include <improve/neighbourhoods.hpp>
#include <improve/subject.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_mover.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

class Colours {
 public:
  explicit Colours(const CellPoints& mesh);

  /// Vertices sorted by colour, otherwise in their given order. Group i ends at ends[i].
  struct Groups {
    std::vector<Index> vertices;
    std::vector<std::size_t> ends;
  };
  [[nodiscard]] Groups groupsOf(std::vector<Index> vertices) const;

 private:
  [[nodiscard]] bool separates(const CellPoints& mesh) const;

  std::vector<std::uint16_t> colourOf_;  ///< per vertex
  std::size_t count_ = 0;
};

// Vertices released from creases, as a last resort for cells that do not become positive otherwise.
//
// The boundary of a mesh is jagged at bad cells, so sharp edges there are not features of the
// object.

class LooseVertices {
 public:
  /// Releases the listed vertices that are on creases or where only creases meet: from now on, they
  /// move across all patches that only creases separate.
  /// @param places  must outlive this
  LooseVertices(VertexPlaces& places, std::span<const Index> vertices, const Array<Vec3>& points);

  [[nodiscard]] bool empty() const noexcept { return held_.empty(); }

  /// Puts released vertices that have not moved back on their creases.
  /// @return those that have moved
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

// Makes cells positive, then improves the worst ones, then all of them.

class Sweeps {
 public:
  /// Summary of the qualities of all cells: less is better.
  struct Standing {
    std::size_t bad = 0;    ///< cells that are not certified
    std::size_t below = 0;  ///< certified cells below the target
    double depth = 0;       ///< 1 minus the least quality
    auto operator<=>(const Standing&) const = default;
  };
  [[nodiscard]] Standing standing(double target) const;
  /// Per cell: its quality.
  [[nodiscard]] const Array<double>& qualities() const noexcept { return qualities_; }
  /// Cells that do not meet the target, but did earlier.
  /// @param below  cellsBelow() at that time
  [[nodiscard]] std::vector<Index> fallenSince(std::span<const Index> below, double target) const;
  /// All references must outlive this.
  /// @param initial   positions before the first move, to share where vertices are restored
  /// @param diagonal  of the bounding box of the surface
  Sweeps(const Subject& subject, VertexPlaces& places, const Positions& initial, double diagonal,
         Stage& stage);

  /// Moves vertices around cells that are not certified until all are or nothing helps any more.
  /// Restores vertices around cells that are still not certified.
  /// @param slack  maximum distance by which untagged vertices may leave the surface, as a last
  ///         resort
  void untangle(double slack);

  /// For straight cells: moves all vertices of cells below the target, and of many rings around, at
  /// once; repeats this until angles hardly improve. Vertices of boundary quads that get too far
  /// from the surface are put back and held from then on.
  /// @param slack     as for untangle(), used for cells that fold when vertices return to the
  ///         surface
  /// @param isFolded  whether most cells may be inverted
  /// @param farQuads  returns the boundary quads that are too far from the surface
  void moveAtOnce(double target, double slack, bool isFolded,
                  const std::function<Array<Quad>()>& farQuads);

  /// The cells that are not certified or below the target.
  [[nodiscard]] std::vector<Index> cellsBelow(double target) const;
  /// The vertices of cells, and of rings of cells around, ascending.
  [[nodiscard]] std::vector<Index> verticesNear(std::vector<Index> cells, int rings) const;
  [[nodiscard]] std::vector<Index> verticesBelow(double target, int rings) const {
    return verticesNear(cellsBelow(target), rings);
  }

  [[nodiscard]] Positions positions() const { return {mesh_.points, places_}; }
  /// Restores all vertices.
  void putBackAll(const Positions& before);

  /// Moves vertices around cells whose scaled Jacobian is below the target. Cells that meet the
  /// target still do afterwards.
  /// @param slack  maximum distance by which untagged vertices may leave the surface
  void raiseWorst(double target, double slack);

  /// Moves all vertices in each pass. No scaled Jacobian falls below the floor or, if already below
  /// it, below the least around the moving vertex.
  void smooth(int passes, double floor);

  /// Moves vertices that are off the surface towards their places on it, as far as the bounds of
  /// smooth() allow.
  void pullOntoSurface(double floor);

  /// Maximum number of rounds of moveBack() and of pullOntoSurface().
  static constexpr int kReturns = 8;
  /// Moves the vertices of boundary quads back towards earlier points, as far as the bounds of
  /// smooth() allow.
  void moveBack(std::span<const Quad> quads, const Positions& before, double floor);

  /// Moves boundary vertices along the surface towards quads that are far from it, so that these
  /// shrink and others grow; then smooths the vertices inside. Scaled Jacobians stay within the
  /// bounds of smooth().
  /// @param errors  per boundary quad: its distance from the surface, in any unit
  /// @param even    lower bound of these errors: nearer quads have equal weights
  void spread(std::span<const Quad> quads, std::span<const double> errors, double even,
              double floor);

  /// Moves boundary vertices, off the surface as well; then smooths the vertices inside. Scaled
  /// Jacobians stay within the bounds of smooth().
  /// @param moves  per vertex
  void shift(const Array<Vec3>& moves, double floor);

  /// The point lists of the cells that are improved.
  [[nodiscard]] CellPoints cellPoints() const { return cells_->points(); }

 private:
  /// Updates the qualities of the n cells that `cellAt` lists.
  template <class CellAt>
  void measure(std::size_t n, const CellAt& cellAt);
  void measureAll();
  /// Sets the ideal box of each cell to its current mean edge lengths.
  void takeBoxes();
  /// Sum of 1 - quality over some cells.
  [[nodiscard]] double deficitOf(std::span<const Index> cells) const;
  /// The cells whose quality satisfies the predicate.
  template <class Wanted>
  [[nodiscard]] std::vector<Index> cellsThat(const Wanted& isWanted) const;
  /// The same, for cells with a vertex that can move; of all cells, or of a list.
  template <class Wanted>
  [[nodiscard]] std::vector<Index> movableCells(const Wanted& isWanted) const;
  template <class Wanted>
  [[nodiscard]] std::vector<Index> movable(std::vector<Index> list, const Wanted& isWanted) const;
  /// Moves vertices around uncertified cells, and more rings of them if that does not help.
  /// @return cells that are still not certified
  std::vector<Index> untangleCells(Neighbourhoods& near, double slack, std::vector<Index> bad);
  /// Improves cells below exchange.floor, which is the target.
  void raise(const Exchange& exchange, double slack);
  template <class Wanted>
  [[nodiscard]] std::vector<Index> verticesThat(const Wanted& isWanted) const;
  /// Moves vertices. Frees their list once they are grouped by colour.
  template <class Move>
  void sweep(std::vector<Index> vertices, double slack, const Move& move);
  /// Moves the vertices inside once, for ideal boxes of their present lengths.
  void smoothInside(double floor);

  HexMesh& mesh_;
  VertexPlaces& places_;
  const Positions& initial_;
  Stage& stage_;
  adjacency::VertexCells meshAround_;
  std::unique_ptr<const ImprovedCells> cells_;
  Array<IdealBox> boxes_;           ///< per cell
  Array<double> qualities_;         ///< per cell: quality at the current points
  Array<std::uint8_t> boundary_;    ///< per cell of the mesh: HexFaces::boundary
  double chord_;                    ///< ChordError::chord
  std::optional<Colours> colours_;  ///< computed on first use
};

}  // namespace hexhex::improvement
