// The blocks into which walls cut a seamless map, and the arcs and patches between them: a
// decomposition into boxes whose sides meet in T-junctions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <quantize/complex/walls.hpp>

namespace hexhex::quantization {

/// Between two nodes: edges in a line where walls meet other than flat.
struct Arc {
  std::array<Index, 2> nodes{};
  std::int64_t length = 0;  ///< in units
  bool isFeature = false;   ///< which has to stay an arc
};

/// A corner of the mesh on a feature, and what fixes it: its two coordinates across an arc, or all
/// three of a node.
struct FeatureCorner {
  Index tet = 0;
  std::size_t corner = 0;
  std::size_t freeAxis = 3;      ///< of its block, or 3
  lattice::LatticePoint node{};  ///< of the arc, in its block's chart
};

/// An arc as it borders a patch on one side, or a block: from where to where it goes in the block's
/// chart.
struct ArcSide {
  Index arc = 0;
  std::uint8_t axis = 0;  ///< along which it goes
  std::int8_t sign = 1;   ///< up or down that axis
  lattice::LatticePoint start{};
  lattice::LatticePoint end{};
  [[nodiscard]] auto operator<=>(const ArcSide&) const = default;
};

/// A rectangle between two blocks, or between a block and nothing, as seen from the first of them.
struct PatchSide {
  Index block = 0;
  adjacency::HalfFace first = 0;  ///< one of its triangles
  std::vector<ArcSide> border;    ///< anticlockwise, from inside of the block
};

struct MotorcycleComplex {
  WallMesh mesh;
  std::vector<Index> blockOf = {};  ///< per tet of the mesh
  std::vector<lattice::LatticeMotion> toBlock =
      {};  ///< per tet: from its chart to that of its block
  std::size_t blockCount = 0;
  std::vector<Arc> arcs = {};
  std::vector<Index> patchOf = {};  ///< per half-face on a wall: the side of a patch, else kNone
  std::vector<PatchSide> patches = {};  ///< each side
  std::vector<FeatureCorner> featureCorners = {};

  /// The other side of a patch, or kNone on the boundary.
  [[nodiscard]] Index acrossPatch(Index side) const {
    const adjacency::HalfFace mate = mesh.mate[patches[side].first];
    return mate == kNone ? kNone : patchOf[mate];
  }
  /// From the chart of a tet's block into that beyond one of its faces.
  [[nodiscard]] lattice::LatticeMotion across(adjacency::HalfFace h) const {
    return toBlock[adjacency::tetOf(mesh.mate[h])] * mesh.change[h] *
           toBlock[adjacency::tetOf(h)].inverse();
  }
};

/// A box, from its lowest corner to its highest one.
struct Extent {
  lattice::LatticePoint low{};
  lattice::LatticePoint high{};
  bool isEmpty = true;

  void add(const lattice::LatticePoint& point) {
    if (isEmpty) low = high = point;
    isEmpty = false;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  void add(const PatchSide& patch) {
    for (const ArcSide& side : patch.border) add(side.start);
  }
};

/// Walls, and blocks between them that all are boxes.
/// @param reduced  without walls between two blocks that are one box without them
/// @throws Error if the map cannot be cut so
[[nodiscard]] MotorcycleComplex traceComplex(const SeamlessMap& map, bool reduced,
                                             Context& context);

}  // namespace hexhex::quantization
