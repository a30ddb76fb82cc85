// Hex edges that pass through the interiors of tets and faces; in a map in general position these
// are nearly all.
#pragma once

#include <array>
#include <cstdint>

#include <curved/simplex_star.hpp>
#include <igm/igm.hpp>

namespace hexhex::curved {

/// On which side of a tet's edges a hex edge passes, looking along it.
struct EdgeSides {
  /// @param seen  the tet in a frame whose first axis runs along the hex edge
  explicit EdgeSides(const lattice::LatticeTet& seen) noexcept;

  /// Bit e (of kEdges in face_walk.cpp): the second corner is to the left of the first.
  unsigned left = 0;
  bool touches = false;  ///< the hex edge meets the line of some edge
};

/// Along the first axis of a frame, or against it.
enum class Heading : std::uint8_t { Forward, Backward };

/// Walks from face to face.
///
/// Seen along the hex edge, which then appears as a point, the corners of the face through which it
/// leaves a tet surround it counter-clockwise. The next tet has one more corner; it replaces the
/// corner that the next face lacks, and the other two stay in place.
class FaceWalk {
 public:
  explicit FaceWalk(const igm::PreparedMap& map) : topology_(map.topology), exact_(map.exact) {}

  /// Leaves a tet.
  /// @param at       the tet, whose interior meets the edge
  /// @param seen     the tet in a frame with the edge along its first axis
  /// @param sides    of `seen`
  /// @param heading  in that frame
  /// @return false if the edge does not leave through the interior of a face, or meets the line of
  ///         an edge of the tet elsewhere
  [[nodiscard]] bool start(const SimplexInTet& at, const lattice::LatticeTet& seen,
                           const EdgeSides& sides, Heading heading);

  /// The face through which the edge leaves the tet; after cross(), the one through which it
  /// entered.
  [[nodiscard]] int face() const noexcept { return face_; }

  /// Crosses the face.
  /// @param at  in a frame with the edge along its first axis, in the direction of the walk
  /// @return false on the boundary
  [[nodiscard]] bool cross(SimplexInTet& at);

  /// Leaves the tet that was entered.
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
  std::array<lattice::LatticePoint, 3> seen_{};  ///< in the frame's coordinates
};

}  // namespace hexhex::curved
