// The faces of a tet that hex edges leave through.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <curved/arc_pieces.hpp>
#include <curved/face_crossing.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// A face as its owner has it, for edges that leave a tet through it.
/// @tparam Face  CrossedFace for several edges, OwnersFace for one
template <class Face>
class FaceExit {
 public:
  FaceExit(const PreparedMap& map, Index tet, int face) noexcept
      : owned_(map.topology, tet, face),
        crossed_(map.exact.corners[owned_.tet], owned_.local),
        corners_(pointsOf(map.topology.tets[owned_.tet], owned_.local, map.input.view.points)) {}

  /// The point inside the face.
  /// @param edge  in the chart of the tet
  [[nodiscard]] ArcExit of(const PreparedMap& map, const ChartEdge& edge) const noexcept {
    const FaceCrossing crossing =
        crossFace(crossed_, owned_.carry(edge, map.exact.transitions), map.exact.unit);
    return {owned_.simplex(), pointInFace(crossing.shares, corners_), crossing.parameter};
  }

 private:
  FaceOfOwner owned_;
  Face crossed_;
  FacePoints corners_;
};

/// The point inside a face through which an edge leaves a tet.
/// @param edge  in the chart of the tet
[[nodiscard]] inline ArcExit exitThrough(const PreparedMap& map, Index tet, int face,
                                         const ChartEdge& edge) noexcept {
  return FaceExit<OwnersFace>(map, tet, face).of(map, edge);
}

/// The faces of one tet after the other, for several edges each.
class TetFaces {
 public:
  explicit TetFaces(const PreparedMap& map) : map_(map) {}

  /// Goes to a tet.
  void enter(Index tet) noexcept {
    tet_ = tet;
    for (std::optional<FaceExit<CrossedFace>>& face : faces_) face.reset();
  }
  /// As exitThrough().
  [[nodiscard]] ArcExit exit(int face, const ChartEdge& edge) {
    std::optional<FaceExit<CrossedFace>>& entry = faces_[static_cast<std::size_t>(face)];
    if (!entry) entry.emplace(map_, tet_, face);
    return entry->of(map_, edge);
  }

 private:
  const PreparedMap& map_;
  Index tet_ = kNone;
  std::array<std::optional<FaceExit<CrossedFace>>, 4> faces_;  ///< as soon as they are crossed
};

}  // namespace hexhex
