// Where the labels of a polycube change: the edges of the polycube, and how far around them its
// inside reaches.
//
// At an edge between two labels, a map whose boundary faces where labels say makes one quarter turn
// or three, if their axes differ. Which of these follows from the direction in which the edge runs
// along the third axis, that is, from the places of the planes at its ends. There, at corners of
// the polycube, edges and faces leave along axes; a map with positive tets is injective around a
// corner only if no two of them leave in the same direction. (The map of a corner's link is then an
// immersion of a disk into a sphere whose boundary is a simple curve, hence injective.)
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include <quantize/complex/wall_mesh.hpp>
#include <quantize/polycube/boundary_sides.hpp>
#include <quantize/polycube/labelled_mesh.hpp>

namespace hexhex::quantization {

/// An edge of the mesh between two labels.
struct PolycubeEdge {
  tetmap::VertexPair vertices;  ///< ascending
  std::array<lattice::Direction, 2>
      labels;                ///< to the left of it, as seen from outside, and to the right
  lattice::Direction along;  ///< from the first vertex to the second
  int quarters;              ///< turns that a map makes around it
};

/// "+x", say.
[[nodiscard]] std::string nameOf(lattice::Direction label);

class PolycubeBorders {
 public:
  /// @param mesh  must outlive this
  /// @throws Error InvalidArgument where labels are those of no polycube, wherever planes lie
  explicit PolycubeBorders(const LabelledMesh& mesh);

  /// The coordinate along an axis of a plane with a vertex in it.
  using PlaneAt = std::function<std::int64_t(int axis, Index vertex)>;

  /// How the edges of the polycube run in maps with such planes, or with planes in another order if
  /// faces overlap around corners otherwise: the one that edges have in space, perhaps.
  /// @throws Error FlippedTet where no map with such planes is injective
  [[nodiscard]] std::vector<PolycubeEdge> edges(const PlaneAt& planeAt) const;

 private:
  [[nodiscard]] lattice::Direction label(BoundarySide side) const {
    return mesh_.label(sides_.face(side));
  }
  [[nodiscard]] lattice::Direction labelBeyond(BoundarySide side) const {
    return label(sides_.twin(side));
  }
  [[nodiscard]] bool isBorder(BoundarySide side) const { return label(side) != labelBeyond(side); }
  /// Along which a border runs.
  [[nodiscard]] int axisAlong(BoundarySide side) const {
    return 3 - lattice::axisOf(label(side)) - lattice::axisOf(labelBeyond(side));
  }
  [[nodiscard]] bool isCorner(Index vertex) const { return borderCount_[vertex] > 2; }
  [[nodiscard]] BoundarySide nextBorder(BoundarySide border) const;
  [[nodiscard]] BoundarySide nextBorderAtTail(BoundarySide border) const;

  void requireOtherAxes(BoundarySide border) const;
  void requireFewBorders() const;
  void requireFourEdges() const;
  void requireBorderOnEachPiece() const;
  /// Between two planes of an axis: the border sides that run from one to the other.
  struct Gap {
    std::int64_t width = 0;
    std::vector<BoundarySide> upwards;
    std::vector<BoundarySide> downwards;
    std::vector<BoundarySide> corners;  ///< at their ends, by the first border that begins there
  };
  /// The narrowest first.
  [[nodiscard]] std::vector<Gap> gaps(const PlaneAt& planeAt) const;
  void setDirections(const Gap& gap, std::vector<lattice::Direction>& directions) const;
  [[nodiscard]] BoundarySide cornerAt(BoundarySide border) const;
  /// Corners at its ends around which faces overlap.
  [[nodiscard]] std::size_t countOverlaps(const Gap& gap,
                                          const std::vector<lattice::Direction>& directions) const;
  [[nodiscard]] bool hasRoom(BoundarySide first,
                             const std::vector<lattice::Direction>& directions) const;
  /// Per side of a border: where it runs.
  [[nodiscard]] std::vector<lattice::Direction> directions(std::vector<Gap> gaps) const;
  void turnAsInSpace(Gap& gap) const;
  void requireRoom(BoundarySide first, const std::vector<lattice::Direction>& directions) const;
  struct Turns {
    BoundarySide at;  ///< of a face
    int found;        ///< quarters to the left
    int expected;
  };
  [[nodiscard]] std::optional<Turns> wrongTurns(
      const std::vector<lattice::Direction>& directions) const;
  [[nodiscard]] bool isPolycube(const std::vector<lattice::Direction>& directions) const;
  void requirePolycube(const std::vector<lattice::Direction>& directions) const;

  const LabelledMesh& mesh_;
  BoundarySides sides_;
  std::vector<BoundarySide> borders_;
  std::vector<Index> borderCount_;  ///< per vertex
};

}  // namespace hexhex::quantization
