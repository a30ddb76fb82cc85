// The faces of a tet for several hex edges that leave through them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <curved/arc_pieces.hpp>
#include <curved/face_crossing.hpp>

#include <map/prepare.hpp>

namespace hexhex {

class TetFaces {
 public:
  explicit TetFaces(const PreparedMap& map) : map_(map) {}

  /// Goes to a tet.
  void enter(Index tet) noexcept {
    tet_ = tet;
    for (std::optional<Face>& face : faces_) face.reset();
  }
  /// As exitThrough().
  [[nodiscard]] ArcExit exit(int face, const ChartEdge& edge) {
    std::optional<Face>& entry = faces_[static_cast<std::size_t>(face)];
    if (!entry) entry.emplace(map_, tet_, face);
    const ChartEdge carried = entry->owned.carry(edge, map_.exact.transitions);
    const FaceCrossing crossing = crossFace(entry->crossed, carried, map_.exact.unit);
    return {entry->owned.simplex(), pointInFace(crossing.shares, entry->corners),
            crossing.parameter};
  }

 private:
  struct Face {
    FaceOfOwner owned;
    CrossedFace crossed;
    FacePoints corners;

    Face(const PreparedMap& map, Index tet, int face) noexcept
        : owned(map.topology, tet, face),
          crossed(map.exact.corners[owned.tet], owned.local),
          corners(pointsOf(map.topology.tets[owned.tet], owned.local, map.input.view.points)) {}
  };

  const PreparedMap& map_;
  Index tet_ = kNone;
  std::array<std::optional<Face>, 4> faces_;  ///< as soon as they are crossed
};

}  // namespace hexhex
