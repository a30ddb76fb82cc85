// The edges of a polycube, where labels change, and the dihedral angles at them.
//
// At an edge between two labels of different axes, a map that fits the labels makes one quarter
// turn or three. Which of the two follows from the direction of the edge along the third axis, that
// is, from the order of the planes at its ends. At a corner of the polycube, all edges and faces
// leave along axes; a map with positive tets is injective around the corner only if no two of them
// leave in the same direction. (The map of the corner's link is then an immersion of a disk into a
// sphere whose boundary is a simple curve, hence injective.)
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
      labels;                ///< to the left of the edge and to the right, as seen from outside
  lattice::Direction along;  ///< from the first vertex to the second
  int quarters;              ///< interior dihedral angle in the map, in quarter turns: 1 or 3
};

/// For example "+x".
[[nodiscard]] std::string nameOf(lattice::Direction label);

class PolycubeBorders {
 public:
  /// @param mesh  must outlive this
  /// @throws Error InvalidArgument if no polycube has these labels, whatever its planes
  explicit PolycubeBorders(const LabelledMesh& mesh);

  /// The coordinate along an axis of the plane that contains a vertex.
  using PlaneAt = std::function<std::int64_t(int axis, Index vertex)>;

  /// Directions and dihedral angles of the edges of the polycube, given its planes. Where faces
  /// would overlap around corners, planes are reordered: starting with the order given or, if that
  /// fails, with the one in space.
  /// @throws Error FlippedTet if neither order admits an injective map
  [[nodiscard]] std::vector<PolycubeEdge> edges(const PlaneAt& planeAt) const;

 private:
  [[nodiscard]] lattice::Direction label(BoundarySide side) const {
    return mesh_.label(sides_.face(side));
  }
  [[nodiscard]] lattice::Direction labelBeyond(BoundarySide side) const {
    return label(sides_.twin(side));
  }
  [[nodiscard]] bool isBorder(BoundarySide side) const { return label(side) != labelBeyond(side); }
  /// The axis of a border.
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
  /// Borders that run between the same two planes of an axis.
  struct Gap {
    std::int64_t width = 0;
    std::vector<BoundarySide> upwards;
    std::vector<BoundarySide> downwards;
    std::vector<BoundarySide> corners;  ///< at their ends, as returned by cornerAt()
  };
  /// Ascending by width.
  [[nodiscard]] std::vector<Gap> gaps(const PlaneAt& planeAt) const;
  void setDirections(const Gap& gap, std::vector<lattice::Direction>& directions) const;
  [[nodiscard]] BoundarySide cornerAt(BoundarySide border) const;
  /// Number of corners of the gap around which faces overlap.
  [[nodiscard]] std::size_t countOverlaps(const Gap& gap,
                                          const std::vector<lattice::Direction>& directions) const;
  [[nodiscard]] bool hasRoom(BoundarySide first,
                             const std::vector<lattice::Direction>& directions) const;
  /// The direction of each border side.
  [[nodiscard]] std::vector<lattice::Direction> directions(std::vector<Gap> gaps) const;
  void turnAsInSpace(Gap& gap) const;
  void requireRoom(BoundarySide first, const std::vector<lattice::Direction>& directions) const;
  struct Turns {
    BoundarySide at;  ///< a side of the face
    int found;        ///< number of quarter turns to the left
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
