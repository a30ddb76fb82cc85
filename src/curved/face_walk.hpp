// Hex edges that pass through the interiors of tets and faces, which is nearly all of them where a
// map is in general position.
#pragma once

#include <array>

#include <curved/arc_pieces.hpp>
#include <curved/owned_simplex.hpp>
#include <curved/simplex_star.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A wide number as memory should hold it: compilers write a whole one by way of vector registers,
/// which wait for both halves to be in memory.
struct Halves {
  std::uint64_t low;
  std::int64_t high;

  Halves() = default;  // not cleared
  constexpr explicit Halves(Int128 number) noexcept
      : low(static_cast<std::uint64_t>(number)), high(static_cast<std::int64_t>(number >> 64)) {}
  [[nodiscard]] constexpr Int128 whole() const noexcept {
    return static_cast<Int128>(high) << 64 | static_cast<Int128>(low);
  }
};

/// On which side of the edges of a tet a hex edge passes, looking along it.
struct EdgeSides {
  /// @param seen  the tet in a frame that has the hex edge along its first axis
  explicit EdgeSides(const LatticeTet& seen) noexcept;

  /// Edge e (kEdges of face_walk.cpp) as a cross product of its corners, across the first axis.
  std::array<Halves, 6> products;
  unsigned left = 0;     ///< bit e: the second corner is to the left of the first
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
      : topology_(map.topology),
        exact_(map.exact),
        points_(map.input.view.points),
        unit_(static_cast<double>(map.exact.unit)),
        perUnit_(1 / unit_) {}

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
  /// @param at      the tet, in a frame that has the edge along its first axis
  /// @param shares  of the tet's corners in the point, with sum 1
  void resume(const SimplexInTet& at, int face, const std::array<double, 4>& shares);

  /// The point in the face at hand, on its side in the tet.
  [[nodiscard]] ArcExit exit(Index tet) const {
    ArcExit exit{{tet, faceMask(face_)}, {}, place_ * perUnit_};
    if (tetOf(mate_) < tet) exit.generator = {tetOf(mate_), faceMask(localOf(mate_))};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) exit.point[k] += shares_[i] * positions_[i][k];
    }
    return exit;
  }

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
  void place(std::size_t i, Index vertex, const LatticePoint& seen) noexcept;
  void measure() noexcept;

  const TetTopology& topology_;
  const ExactMap& exact_;
  std::span<const Vec3> points_;
  double unit_;
  double perUnit_;
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
  std::array<double, 3> places_{};   ///< coordinate along the edge, times unit
  std::array<double, 3> weights_{};  ///< of the point, up to a common factor
  std::array<double, 3> shares_{};   ///< the same with sum 1
  std::array<Vec3, 3> positions_{};

  double place_ = 0;  ///< of the point, times unit
};

}  // namespace hexhex
