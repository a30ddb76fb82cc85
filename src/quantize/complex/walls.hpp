// Walls of the motorcycle complex (Brückler et al. 2022, "The 3D Motorcycle Complex for Structured
// Volume Decomposition"): planes that grow from singular edges until they meet others.
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include <quantize/complex/wall_mesh.hpp>
#include <quantize/seamless/cut_graph.hpp>

namespace hexhex::quantization {

/// A plane perpendicular to an axis, in the chart of some tet.
struct AxisPlane {
  std::size_t axis = 0;
  std::int64_t value = 0;

  [[nodiscard]] int sideOf(const lattice::LatticePoint& u) const noexcept {
    return (u[axis] > value ? 1 : 0) - (u[axis] < value ? 1 : 0);
  }
  /// The same plane in the chart that `change` leads to.
  [[nodiscard]] AxisPlane beyond(const lattice::LatticeMotion& change) const noexcept;
};

/// Where a turn around an edge meets a plane.
struct PlaneMeeting {
  enum class Kind : std::uint8_t { Boundary, Face, Inside } kind = Kind::Boundary;
  adjacency::HalfFace face = kNone;  ///< in the plane
  adjacency::TetEdge crossed{};      ///< crosses the plane inside its tet
  AxisPlane plane{};                 ///< in that tet's chart
  bool wallBefore = false;           ///< whether the turn passed a wall
};

/// Grows walls, always the one nearest to its singular edge first.
class WallTracer {
 public:
  explicit WallTracer(WallMesh& mesh) : mesh_(mesh) {}

  /// Starts walls in all grid directions from a (possibly split) edge parallel to an axis: a
  /// singular edge, or one that is to become part of the complex.
  void startAlong(Index v, Index w, Index tet);

  /// Starts a wall at an aligned triangle.
  void startAt(adjacency::HalfFace feature);

  /// Starts a wall along a plane that crosses a tet or contains one of its faces.
  /// @return false if the plane does neither
  bool startIn(Index tet, const AxisPlane& plane);

  /// Grows all walls until they end at others or at the boundary.
  void grow();

 private:
  /// An edge of a wall, with the distances of its ends from where the wall began.
  struct Front {
    double distance = 0;
    std::uint64_t order = 0;
    std::array<Index, 2> vertices{};
    std::array<double, 2> distances{};
    Index tet = 0;
    friend bool operator<(const Front& a, const Front& b) noexcept {
      return a.distance != b.distance ? a.distance > b.distance : a.order > b.order;
    }
  };
  /// @param face  of the edge's tet, at the edge: on the boundary if the edge is
  void startAt(const adjacency::TetEdge& edge, int face);
  void grow(const Front& front);
  /// Moves an end of an edge into a plane that crosses the edge close to it.
  /// @return the moved corner, or -1 if neither end is close or may move
  int moveEnd(const adjacency::TetEdge& edge, const AxisPlane& plane);
  /// Splits an edge where a plane crosses it. If it ends at a vertex made by another wall, also
  /// splits all other edges that the plane crosses in tets around the edge: otherwise two walls
  /// that cross an edge could split each other's results without end.
  void split(const adjacency::TetEdge& edge, const AxisPlane& plane);
  adjacency::HalfFace wallAt(const PlaneMeeting& meeting);
  void push(adjacency::HalfFace wall, const std::array<Index, 2>& edge,
            const std::array<double, 2>& distances);
  void push(const std::array<Index, 2>& edge, const std::array<double, 2>& distances, Index tet);
  [[nodiscard]] adjacency::HalfFace someWall(const adjacency::TetEdge& edge) const;

  WallMesh& mesh_;
  std::priority_queue<Front> fronts_;
  std::uint64_t order_ = 0;
};

/// The plane of a wall's triangle, in the chart of the half-face's tet.
[[nodiscard]] AxisPlane planeOf(const WallMesh& mesh, adjacency::HalfFace wall);

/// The triangle that continues a wall in its plane beyond an edge (v, w), on the same side; kNone
/// if there is none or the edge is on the boundary.
[[nodiscard]] adjacency::HalfFace wallOpposite(const WallMesh& mesh, adjacency::HalfFace wall,
                                               Index v, Index w);

/// Traces the walls of a map's motorcycle complex.
[[nodiscard]] WallMesh traceWalls(const SeamlessMap& map, const adjacency::EdgeFans& edges);

}  // namespace hexhex::quantization
