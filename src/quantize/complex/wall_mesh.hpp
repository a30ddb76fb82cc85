// A seamless map's tets, split so that walls run along triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <quantize/seamless/seamless_map.hpp>
#include <tetmap/mutable_tets.hpp>

#include <hexhex/error.hpp>

namespace hexhex::quantization {

/// Not on a face of the tet that it is a part of.
inline constexpr std::uint8_t kInside = 4;

/// Walls that pass very near to each other leave nothing of a tet between them.
class TooThinForWalls : public Error {
 public:
  using Error::Error;
};

/// Grows as edges are split; tets that were there before keep their numbers, as one of the parts
/// into which they were split, and their charts.
class WallMesh : public tetmap::MutableTets {
 public:
  explicit WallMesh(const SeamlessMap& map);

  /// Whether a vertex is none of the map's.
  [[nodiscard]] bool isNew(Index vertex) const noexcept { return vertex >= originalVertices_; }
  [[nodiscard]] const lattice::LatticePoint& at(Index tet, std::size_t corner) const noexcept {
    return corners[tet][corner];
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
  Index split(const adjacency::TetEdge& at, std::size_t axis, std::int64_t value);

  /// Moves a vertex along an axis of its tet's chart, into a plane close by, so that no flat tets
  /// arise where a wall passes it.
  /// @return false, and nothing is moved, if a wall, a curve or a kept edge would be left, or a tet
  ///         became much smaller
  bool moveInto(Index tet, std::uint8_t corner, std::size_t axis, std::int64_t value);

  std::vector<lattice::LatticeTet> corners;
  FaceMotions change;
  std::vector<bool> isWall;                   ///< per half-face; the boundary is a wall, too
  std::vector<bool> isFeature;                ///< per half-face
  std::set<tetmap::VertexPair> featureEdges;  ///< that walls alone keep where they are
  std::set<Index> featureVertices;
  std::vector<bool> isHeld;     ///< per vertex: on an edge that walls are still to start at
  std::vector<Index> original;  ///< per tet: of which tet of the map it is a part
  std::vector<std::uint8_t> originalFace;  ///< per half-face: on which face of that, or kInside

 private:
  /// A tet at a vertex that is moved, and by what in its chart.
  struct MovedCorner {
    Index tet;
    std::uint8_t corner;
    lattice::LatticePoint by;
  };
  [[nodiscard]] bool leavesKeptEdge(const MovedCorner& moved) const;
  [[nodiscard]] bool mayMove(const MovedCorner& moved) const;
  void requirePositive(Index tet) const;
  /// @param middle  the new vertex, in the chart of the tet that was cut
  void carryCut(const tetmap::Cut& cut, const lattice::LatticePoint& middle);

  Index originalVertices_;
  std::vector<Index> moved_;  ///< per tet: its place in a list, while one is made; else kNone
};

}  // namespace hexhex::quantization
