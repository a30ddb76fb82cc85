// Hex edges that pass through the interiors of tets and faces, which is nearly all of them where a
// map is in general position.
#pragma once

#include <array>

#include <curved/owned_simplex.hpp>
#include <curved/simplex_star.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A point at which a hex edge leaves a simplex.
struct ArcExit {
  /// The simplex that holds it.
  OwnedSimplex generator{};
  std::size_t count = 0;            ///< its vertices
  std::array<Index, 3> vertices{};  ///< in any order
  // Per vertex:
  std::array<double, 3> weights{};  ///< up to a common factor: within 2^-52 of their values
  std::array<double, 3> places{};   ///< coordinate along the edge, times unit
};

/// Goes from face to face.
///
/// Seen along the edge, which is a point then, the corners of the face that it leaves a tet through
/// stand counter-clockwise around it. The next tet has one corner more; it takes the place of the
/// corner that the next face lacks, and the others stay where they are.
class FaceWalk {
 public:
  explicit FaceWalk(const PreparedMap& map) : topology_(map.topology), exact_(map.exact) {}

  /// Leaves a tet.
  /// @param at    the tet, with a frame that has the edge along its first axis; its interior meets
  ///              the edge
  /// @param seen  the tet in the frame
  /// @return false if the edge does not leave through the interior of a face, or touches the line
  ///         of an edge of the tet elsewhere
  [[nodiscard]] bool start(const SimplexInTet& at, const LatticeTet& seen);

  /// The point in the face at hand, on its side in the tet.
  [[nodiscard]] ArcExit exit(Index tet) const {
    ArcExit exit{ownedFace(topology_, tet, face_), 3, vertices_, weights_, {}};
    for (std::size_t i = 0; i < 3; ++i) exit.places[i] = static_cast<double>(seen_[i][0]);
    return exit;
  }

  /// Crosses the face.
  /// @return false on the boundary
  [[nodiscard]] bool cross(SimplexInTet& at);

  /// Leaves the tet that it came into.
  /// @return false if the edge does not leave through the interior of a face
  [[nodiscard]] bool leave(const SimplexInTet& at);

 private:
  const TetTopology& topology_;
  const ExactMap& exact_;
  int face_ = 0;  ///< of the tet at hand
  // Per corner of the face:
  std::array<Index, 3> vertices_{};
  std::array<LatticePoint, 3> seen_{};
  std::array<double, 3> weights_{};
};

}  // namespace hexhex
