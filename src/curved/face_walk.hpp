// Hex edges that pass through the interiors of tets and faces, which is nearly all of them where a
// map is in general position.
#pragma once

#include <array>
#include <cstdint>

#include <curved/simplex_star.hpp>
#include <igm/prepare.hpp>

namespace hexhex::curved {

/// On which side of the edges of a tet a hex edge passes, looking along it.
struct EdgeSides {
  /// @param seen  the tet in a frame that has the hex edge along its first axis
  explicit EdgeSides(const lattice::LatticeTet& seen) noexcept;

  /// Bit e (of kEdges in face_walk.cpp): the second corner is to the left of the first.
  unsigned left = 0;
  bool touches = false;  ///< the line of some edge is met
};

/// Along the first axis of a frame, or against it.
enum class Heading : std::uint8_t { Forward, Backward };

/// Goes from face to face.
///
/// Seen along the edge, which is a point then, the corners of the face that it leaves a tet through
/// stand counter-clockwise around it. The next tet has one corner more; it takes the place of the
/// corner that the next face lacks, and the others stay where they are.
class FaceWalk {
 public:
  explicit FaceWalk(const igm::PreparedMap& map) : topology_(map.topology), exact_(map.exact) {}

  /// Leaves a tet.
  /// @param at       the tet, whose interior meets the edge
  /// @param seen     the tet in a frame that has the edge along its first axis
  /// @param sides    of `seen`
  /// @param heading  in that frame
  /// @return false if the edge does not leave through the interior of a face, or touches the line
  ///         of an edge of the tet elsewhere
  [[nodiscard]] bool start(const SimplexInTet& at, const lattice::LatticeTet& seen,
                           const EdgeSides& sides, Heading heading);

  /// The face of the tet that the edge leaves it through; after cross(), that it came through.
  [[nodiscard]] int face() const noexcept { return face_; }

  /// Crosses the face.
  /// @param at  in a frame that has the edge along its first axis, in the direction of the walk
  /// @return false on the boundary
  [[nodiscard]] bool cross(SimplexInTet& at);

  /// Leaves the tet that it came into.
  /// @return false if the edge does not leave through the interior of a face
  [[nodiscard]] bool leave(const SimplexInTet& at);

 private:
  void leaveThrough(Index tet, int face) noexcept;

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  int face_ = 0;
  adjacency::HalfFace mate_ = kNone;  ///< on the other side of the face
  // Per corner of the face:
  std::array<Index, 3> vertices_{};
  std::array<lattice::LatticePoint, 3> seen_{};  ///< as the frame shows them
};

}  // namespace hexhex::curved
