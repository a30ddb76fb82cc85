// Hex edges that pass through the interiors of tets and faces, which is nearly all of them where a
// map is in general position.
#pragma once

#include <array>

#include <curved/arc_pieces.hpp>
#include <curved/owned_simplex.hpp>
#include <curved/simplex_star.hpp>
#include <curved/tet_faces.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// On which side of the edges of a tet a hex edge passes, looking along it.
struct EdgeSides {
  /// @param seen  the tet in a frame that has the hex edge along its first axis
  explicit EdgeSides(const LatticeTet& seen) noexcept;

  /// Bit e (of kEdges in face_walk.cpp): the second corner is to the left of the first.
  unsigned left = 0;
  bool touches = false;  ///< the line of some edge is met
};

enum class Way : std::uint8_t { Forward, Backward };

/// Goes from face to face.
///
/// Seen along the edge, which is a point then, the corners of the face that it leaves a tet through
/// stand counter-clockwise around it. The next tet has one corner more; it takes the place of the
/// corner that the next face lacks, and the others stay where they are.
class FaceWalk {
 public:
  explicit FaceWalk(const PreparedMap& map)
      : map_(map), topology_(map.topology), exact_(map.exact) {}

  /// Leaves a tet.
  /// @param at     the tet, with a frame that has the edge along its first axis; its interior meets
  ///               the edge
  /// @param seen   the tet in the frame
  /// @param sides  of `seen`
  /// @return false if the edge does not leave through the interior of a face, or touches the line
  ///         of an edge of the tet elsewhere
  [[nodiscard]] bool start(const SimplexInTet& at, const LatticeTet& seen, const EdgeSides& sides) {
    return start(at, seen, sides, Way::Forward);
  }
  /// The same from what the reverse of the frame shows, if the way is backward.
  [[nodiscard]] bool start(const SimplexInTet& at, const LatticeTet& seen, const EdgeSides& sides,
                           Way way);

  /// Goes on from a point inside a face that the edge is known to leave a tet through.
  /// @param at  the tet, in a frame that has the edge along its first axis
  void resume(const SimplexInTet& at, int face);

  /// Where the edge leaves a tet, for later.
  struct Exit {
    SimplexInTet carrier;
    int face;  ///< of the tet

    [[nodiscard]] ArcExit through(const PreparedMap& map) const {
      return exitThrough(map, carrier.tet, face, {carrier.frame.origin, carrier.frame.axes[0]});
    }
  };
  /// Through the face at hand.
  [[nodiscard]] Exit exit(const SimplexInTet& at) const noexcept { return {at, face_}; }

  /// Crosses the face.
  /// @return false on the boundary
  [[nodiscard]] bool cross(SimplexInTet& at);

  /// Leaves the tet that it came into.
  /// @return false if the edge does not leave through the interior of a face
  [[nodiscard]] bool leave(const SimplexInTet& at);

 private:
  void leaveThrough(Index tet, int face) noexcept;
  void look(const Frame& frame) noexcept;
  [[nodiscard]] LatticePoint seen(const LatticePoint& corner) const noexcept {
    LatticePoint seen;
    for (std::size_t k = 0; k < 3; ++k) {
      seen[k] = ((corner[axis_[k]] - zero_[k]) ^ flip_[k]) - flip_[k];
    }
    return seen;
  }

  const PreparedMap& map_;
  const TetTopology& topology_;
  const ExactMap& exact_;
  int face_ = 0;           ///< of the tet at hand
  HalfFace mate_ = kNone;  ///< of that face

  // The frame, if it has been looked at: coordinate k is p[axis_[k]] - zero_[k], negated if
  // flip_[k] is -1.
  bool looked_ = false;
  std::array<std::size_t, 3> axis_{};
  std::array<std::int64_t, 3> zero_{};
  std::array<std::int64_t, 3> flip_{};

  // Per corner of the face:
  std::array<Index, 3> vertices_{};
  std::array<LatticePoint, 3> seen_{};
};

}  // namespace hexhex
