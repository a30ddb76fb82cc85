// What a repair changes of a map: edges are split, the last resort where moving parameters cannot
// work; and a backup of what was there before.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/vertex_star.hpp>

namespace hexhex::repairs {

class MapBackup {
 public:
  MapBackup() = default;
  /// Of a map that nothing has been changed of.
  explicit MapBackup(const TetMap& map)
      : pointCount_(map.points.size()), tetCount_(map.tets.size()) {}

  [[nodiscard]] std::size_t pointCount() const noexcept { return pointCount_; }
  [[nodiscard]] std::size_t tetCount() const noexcept { return tetCount_; }

  /// To be called before the corners or parameters of a tet change.
  void keep(const TetMap& map, Index tet);

  /// To be called before tagged edges and faces, or known valences, change.
  void keepLists(const TetMap& map);

  /// The parameters that a tet had; nothing if they never changed.
  [[nodiscard]] const TetParameters* parametersOf(Index tet) const;

  /// Makes the map what it was.
  void restore(TetMap& map) const;

 private:
  struct KeptTet {
    Tet tet;
    TetParameters parameters;
    std::array<std::int8_t, 4> rotations;
  };
  struct KeptLists {
    Features features;
    std::vector<EdgeValence> edgeValences;
  };

  std::size_t pointCount_ = 0;
  std::size_t tetCount_ = 0;
  std::map<Index, KeptTet> tets_;
  std::optional<KeptLists> lists_;  ///< once edges are split
};

/// The tets with both vertices, ascending; none if there is no such edge.
/// @param star  reused between calls
[[nodiscard]] std::vector<Index> tetsAtEdge(const adjacency::TetTopology& topology,
                                            const std::array<Index, 2>& edge,
                                            igm::VertexStar& star);

/// Puts a vertex in the middle of each edge, in space and in all charts, and cuts the tets at it in
/// two. The map stays the same function. Edges that share a tet with one before them are left out.
/// One of the two tets keeps its number, the others, and the vertices, are appended; what is known
/// about the map (rotations, valences, features) is carried over.
/// @param topology  of the map; must not be used afterwards
/// @param backup  keeps what is changed
/// @return the number of edges that were split
std::size_t splitEdges(TetMap& map, const adjacency::TetTopology& topology,
                       std::span<const std::array<Index, 2>> edges, MapBackup& backup);

}  // namespace hexhex::repairs
