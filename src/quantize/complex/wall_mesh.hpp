// The tets of a seamless map, split so that walls consist of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <quantize/seamless/seamless_map.hpp>
#include <tetmap/tetmap.hpp>

#include <hexhex/error.hpp>

namespace hexhex::quantization {

/// For faces inside the original tet.
inline constexpr std::uint8_t kInside = 4;

/// Thrown where walls are so close to each other that tets between them would be flat.
class TooThinForWalls : public Error {
 public:
  using Error::Error;
};

/// Splitting edges adds tets; parts keep the chart of the split tet, and one part keeps its number.
class WallMesh : public tetmap::MutableTets {
 public:
  explicit WallMesh(const SeamlessMap& map);

  /// Whether a vertex was added by a split.
  [[nodiscard]] bool isNew(Index vertex) const noexcept { return vertex >= originalVertices_; }
  [[nodiscard]] const lattice::LatticePoint& at(Index tet, std::size_t corner) const noexcept {
    return corners[tet][corner];
  }
  /// Releases spare capacity, and data that only splitting needs.
  void shrink();

  /// Marks a triangle, on both sides.
  void markWall(adjacency::HalfFace h) {
    isWall[h] = true;
    if (mate[h] != kNone) isWall[mate[h]] = true;
  }

  /// Marks an edge as feature edge, from which walls are to start.
  void keepEdge(Index v, Index w);

  /// Splits an edge, and all tets around it, where a coordinate in its tet's chart has a value
  /// between those at its ends. The other coordinates are rounded to the lattice.
  /// @return the new vertex
  /// @throws TooThinForWalls if rounding makes a part flat
  Index split(const adjacency::TetEdge& at, std::size_t axis, std::int64_t value);

  /// Moves a vertex along an axis of its tet's chart into a nearby plane, so that a wall there
  /// creates no flat tets.
  /// @return false, without a change, if the vertex would leave a wall, a curve or a kept edge, or
  ///         a tet would become much smaller
  bool moveInto(Index tet, std::uint8_t corner, std::size_t axis, std::int64_t value);

  std::vector<lattice::LatticeTet> corners;
  FaceMotions change;
  std::vector<bool> isWall;                   ///< per half-face; the boundary is a wall, too
  std::vector<bool> isFeature;                ///< per half-face
  std::set<tetmap::VertexPair> featureEdges;  ///< kept in place only by walls
  std::set<Index> featureVertices;
  std::vector<bool> isHeld;                ///< per vertex: on an edge where walls have yet to start
  std::vector<Index> original;             ///< per tet: the tet of the map that contains it
  std::vector<std::uint8_t> originalFace;  ///< per half-face: which face of that, or kInside

 private:
  /// A tet at a moved vertex, and the displacement in its chart.
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
  std::vector<Index> moved_;  ///< scratch of moveInto(), per tet: its index in the star, else kNone
};

}  // namespace hexhex::quantization
