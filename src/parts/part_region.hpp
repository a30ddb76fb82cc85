// How far a part reaches: the tets that its cells and the cells around them may touch, and where in
// these tets.
//
// Consider a chain of cells that starts in the part, each cell sharing a vertex with the previous
// one, and a path from centre to centre through their common vertices. Where it leaves the part's
// tets for the last time, it crosses a face (or is in a block of a tet that several parts share),
// and the rest lies within a box around that face (or block), developed along the path. So such
// boxes are carried from tet to tet, across all faces that they meet.
#pragma once

#include <vector>

#include <parts/partition.hpp>

#include <hexhex/types.hpp>

#include <atlas/grid_region.hpp>

namespace hexhex::parts {

/// Finds the regions of one part after another.
class RegionFinder {
 public:
  /// @param cells  number of cells of the mesh
  RegionFinder(const igm::PreparedMap& map, const Partition& partition, std::uint64_t cells);

  /// @param layers  of cells around the part's own
  [[nodiscard]] atlas::GridRegion find(std::uint32_t part, std::uint32_t layers);

 private:
  struct Reached {
    Index tet;
    std::size_t box;  ///< index in boxes_ of the tet
  };
  struct Entry {
    Index tet = kNone;
    bool whole = false;      ///< a tet of the part
    std::uint8_t faces = 0;  ///< as in GridRegion
    std::vector<lattice::GridBox> boxes;
  };

  void enterWhole(std::span<const Index> tets);
  void startAtFaces(Index tet, std::int32_t reach);
  void startAtBlocks(const TetBlocks& blocks, std::uint32_t part, std::int32_t reach);
  void reach(Index tet, const lattice::GridBox& box);
  void cross(Index tet, const lattice::GridBox& box);
  void through(adjacency::HalfFace halfFace, const lattice::GridBox& box);
  void enterAll();
  Entry& entryOf(Index tet);

  const igm::PreparedMap& map_;
  const Partition& partition_;
  /// Beyond this number of boxes, the region is all tets. Around the singularities of a coarse map,
  /// boxes keep turning: on a ball of 7 x 27 cells in 4 parts they took 6 s instead of 0.05.
  std::uint64_t mostBoxes_;
  std::vector<Index> entryOfTet_;  ///< kNone except for tets of the current part's region
  std::vector<Entry> entries_;
  std::vector<Reached> queue_;
};

}  // namespace hexhex::parts
