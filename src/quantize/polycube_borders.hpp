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

#include <functional>

#include <quantize/bend.hpp>
#include <quantize/polycube_labels.hpp>
#include <quantize/wall_mesh.hpp>

namespace hexhex::quantization {

/// The sides of boundary triangles, counterclockwise as seen from outside.
class BoundarySides {
 public:
  using Side = std::size_t;  ///< 3 * triangle + 0 to 2

  explicit BoundarySides(const adjacency::TetTopology& topology);

  [[nodiscard]] std::size_t size() const noexcept { return twins_.size(); }
  [[nodiscard]] adjacency::HalfFace face(Side side) const noexcept { return faces_[side / 3]; }
  [[nodiscard]] Index head(Side side) const noexcept { return corner(side, 0); }
  [[nodiscard]] Index tail(Side side) const noexcept { return corner(side, 1); }
  /// Of the same triangle, from the head on.
  [[nodiscard]] static Side next(Side side) noexcept { return side / 3 * 3 + (side + 2) % 3; }
  /// Of the triangle beyond: from head to tail.
  [[nodiscard]] Side twin(Side side) const noexcept { return twins_[side]; }

 private:
  [[nodiscard]] Index corner(Side side, std::size_t ahead) const noexcept;

  const adjacency::TetTopology& topology_;
  std::vector<adjacency::HalfFace> faces_;  ///< ascending
  std::vector<Side> twins_;
};

class PolycubeBorders {
 public:
  /// @param mesh  must outlive this
  /// @throws Error InvalidArgument where labels are those of no polycube, wherever planes lie
  explicit PolycubeBorders(const LabelledMesh& mesh);

  /// The coordinate along an axis of a plane with a vertex in it.
  using PlaneAt = std::function<std::int64_t(int axis, Index vertex)>;

  /// How often maps with such planes turn around the edges of the polycube.
  /// @throws Error FlippedTet where no map with such planes is injective
  [[nodiscard]] IrregularEdges turns(const PlaneAt& planeAt) const;

 private:
  using Side = BoundarySides::Side;

  [[nodiscard]] lattice::Direction label(Side side) const { return mesh_.label(sides_.face(side)); }
  [[nodiscard]] lattice::Direction labelBeyond(Side side) const { return label(sides_.twin(side)); }
  [[nodiscard]] bool isBorder(Side side) const { return label(side) != labelBeyond(side); }
  /// Along which a border runs.
  [[nodiscard]] int axisAlong(Side side) const {
    return 3 - lattice::axisOf(label(side)) - lattice::axisOf(labelBeyond(side));
  }
  [[nodiscard]] bool isCorner(Index vertex) const { return borderCount_[vertex] > 2; }
  [[nodiscard]] Side nextBorder(Side border) const;
  [[nodiscard]] Side nextBorderAtTail(Side border) const;

  void requireOtherAxes(Side border) const;
  void requireFewBorders() const;
  void requireFourEdges() const;
  void requireBorderOnEachPiece() const;
  /// Per side of a border: where it runs.
  [[nodiscard]] std::vector<lattice::Direction> directions(const PlaneAt& planeAt) const;
  void requireRoom(Side first, const std::vector<lattice::Direction>& directions) const;
  void requireFlatFaces(const std::vector<lattice::Direction>& directions) const;

  const LabelledMesh& mesh_;
  BoundarySides sides_;
  std::vector<Side> borders_;
  std::vector<Index> borderCount_;  ///< per vertex
};

}  // namespace hexhex::quantization
