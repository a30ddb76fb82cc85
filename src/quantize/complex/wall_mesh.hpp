// A seamless map's tets, split so that walls run along triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <quantize/seamless/seamless_map.hpp>

#include <hexhex/error.hpp>

namespace hexhex::quantization {

/// An edge of the mesh as seen from a tet: two of its corners.
struct TetEdge {
  Index tet;
  std::uint8_t corner0;
  std::uint8_t corner1;

  [[nodiscard]] lattice::CornerMask mask() const noexcept {
    return static_cast<lattice::CornerMask>(lattice::cornerBit(corner0) |
                                            lattice::cornerBit(corner1));
  }
};

/// The vertices of an edge, in ascending order.
using VertexPair = std::array<Index, 2>;
[[nodiscard]] constexpr VertexPair pairOf(Index a, Index b) noexcept {
  return a < b ? VertexPair{a, b} : VertexPair{b, a};
}

/// Not on a face of the tet that it is a part of.
inline constexpr std::uint8_t kInside = 4;

/// Walls that pass very near to each other leave nothing of a tet between them.
class TooThinForWalls : public Error {
 public:
  using Error::Error;
};

/// Grows as edges are split; tets that were there before keep their numbers, as one of the parts
/// into which they were split, and their charts.
class WallMesh {
 public:
  explicit WallMesh(const SeamlessMap& map);

  [[nodiscard]] std::size_t tetCount() const noexcept { return tets.size(); }
  [[nodiscard]] std::size_t vertexCount() const noexcept { return isHeld.size(); }
  [[nodiscard]] bool isBoundary(adjacency::HalfFace h) const noexcept { return mate[h] == kNone; }
  /// Whether a vertex is none of the map's.
  [[nodiscard]] bool isNew(Index vertex) const noexcept { return vertex >= originalVertices_; }
  [[nodiscard]] const lattice::LatticePoint& at(Index tet, std::size_t corner) const noexcept {
    return corners[tet][corner];
  }
  [[nodiscard]] std::uint8_t cornerOf(Index tet, Index vertex) const noexcept {
    return static_cast<std::uint8_t>(adjacency::localCorner(tets[tet], vertex));
  }

  /// Leaves what is asked of a mesh that will not be split again, without room to grow.
  void shrink();

  /// Marks a triangle, on both sides.
  void markWall(adjacency::HalfFace h) {
    isWall[h] = true;
    if (mate[h] != kNone) isWall[mate[h]] = true;
  }

  /// Makes an edge one of a feature, at which walls are to start.
  void keepEdge(Index v, Index w);

  /// Splits an edge, and all tets around it, where a coordinate of its tet's chart has a value that
  /// lies between those at its ends. The other coordinates are rounded to the lattice.
  /// @return the new vertex
  /// @throws TooThinForWalls if rounding leaves nothing of a part
  Index split(const TetEdge& edge, std::size_t axis, std::int64_t value);

  /// Moves a vertex along an axis of its tet's chart, into a plane close by, so that no flat tets
  /// arise where a wall passes it.
  /// @return false, and nothing is moved, if a wall, a curve or a kept edge would be left, or a tet
  ///         became much smaller
  bool moveInto(Index tet, std::uint8_t corner, std::size_t axis, std::int64_t value);

  /// The edge between two vertices, in a part of a tet of which it was once an edge; or the vertex
  /// that has split it.
  struct Found {
    std::optional<TetEdge> edge;
    Index middle = kNone;
  };
  [[nodiscard]] Found find(Index v, Index w, Index tet) const;

  /// Calls visit(edge) for all parts of what was once an edge of a tet. They must not be split
  /// meanwhile, but other edges may.
  template <class Visit>
  void forEachPart(Index v, Index w, Index tet, const Visit& visit) {
    const Found found = find(v, w, tet);
    if (found.edge) {
      visit(*found.edge);
    } else {
      forEachPart(v, found.middle, tet, visit);
      forEachPart(found.middle, w, tet, visit);
    }
  }

  std::vector<Tet> tets;
  std::vector<lattice::LatticeTet> corners;
  std::vector<adjacency::HalfFace> mate;
  FaceChanges change;
  std::vector<bool> isWall;           ///< per half-face; the boundary is a wall, too
  std::vector<bool> isFeature;        ///< per half-face
  std::set<VertexPair> featureEdges;  ///< that walls alone keep where they are
  std::set<Index> featureVertices;
  std::vector<bool> isHeld;     ///< per vertex: on an edge that walls are still to start at
  std::vector<Index> original;  ///< per tet: of which tet of the map it is a part
  std::vector<std::uint8_t> originalFace;  ///< per half-face: on which face of that, or kInside

 private:
  struct Part {
    Index tet;
    Index next;                 ///< another part, in `parts_`, of the same tet, or kNone
    Index kept, given, middle;  ///< the edge that was split: its end here, that there, its middle
  };
  /// A tet at an edge, and a point of the edge in its chart.
  struct Around {
    TetEdge edge;
    lattice::LatticePoint point;
  };
  [[nodiscard]] std::vector<Around> tetsAround(const TetEdge& edge,
                                               const lattice::LatticePoint& u) const;
  /// A tet at a vertex that is moved, and by what in its chart.
  struct MovedCorner {
    Index tet;
    std::uint8_t corner;
    lattice::LatticePoint by;
  };
  [[nodiscard]] bool leavesKeptEdge(const MovedCorner& moved) const;
  [[nodiscard]] bool mayMove(const MovedCorner& moved) const;
  void requirePositive(Index tet) const;
  void appendCopy(Index tet);
  void joinInside(adjacency::HalfFace a, adjacency::HalfFace b);

  Index originalVertices_;
  std::vector<Index> moved_;  ///< per tet: its place in a list, while one is made; else kNone
  std::vector<Part> parts_;
  std::vector<Index> firstPart_;  ///< per tet
};

/// Walks around an edge of a WallMesh through its tets.
class WallTurn {
 public:
  /// @param face  at the edge, through which it leaves the tet first
  WallTurn(const WallMesh& mesh, const TetEdge& edge, int face) noexcept
      : mesh_(mesh), edge_(edge), face_(face) {}

  [[nodiscard]] const TetEdge& edge() const noexcept { return edge_; }
  /// The half-face that it leaves the tet through.
  [[nodiscard]] adjacency::HalfFace out() const noexcept {
    return adjacency::halfFaceOf(edge_.tet, face_);
  }
  [[nodiscard]] bool isAtBoundary() const noexcept { return mesh_.isBoundary(out()); }
  /// The corner that is on that face, beside the edge.
  [[nodiscard]] std::size_t ahead() const noexcept {
    return static_cast<std::size_t>(adjacency::otherFaceAtEdge(edge_.mask(), face_));
  }
  /// Enters the next tet.
  void step() noexcept;

 private:
  const WallMesh& mesh_;
  TetEdge edge_;
  int face_;
};

}  // namespace hexhex::quantization
