// The motorcycle complex (Brückler et al. 2022, "The 3D Motorcycle Complex for Structured Volume
// Decomposition"): walls cut a seamless map into boxes, which meet in patches and arcs, possibly at
// T-junctions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <quantize/complex/walls.hpp>

namespace hexhex::quantization {

/// Collinear edges between two nodes at which walls meet that do not form one plane.
struct Arc {
  std::array<Index, 2> nodes{};
  std::int64_t length = 0;  ///< in lattice units
  bool isFeature = false;   ///< must remain an arc
};

/// A corner of the mesh on a feature. Two of its coordinates are fixed on an arc, all three at a
/// node.
struct FeatureCorner {
  Index tet = 0;
  std::size_t corner = 0;
  std::size_t freeAxis = 3;      ///< free axis of its block's chart, or 3
  lattice::LatticePoint node{};  ///< a node of the arc, in its block's chart
};

/// An arc on the border of a patch, in the chart of the block.
struct ArcSide {
  Index arc = 0;
  std::uint8_t axis = 0;  ///< along which it runs
  std::int8_t sign = 1;   ///< of its direction along the axis
  lattice::LatticePoint start{};
  lattice::LatticePoint end{};
  [[nodiscard]] auto operator<=>(const ArcSide&) const = default;
};

/// A rectangle between two blocks, or between a block and the outside, as seen from one block.
struct PatchSide {
  Index block = 0;
  adjacency::HalfFace first = 0;  ///< one of its triangles
  std::vector<ArcSide> border;    ///< counter-clockwise as seen from inside the block
};

struct MotorcycleComplex {
  WallMesh mesh;
  std::vector<Index> blockOf = {};                   ///< per tet of the mesh
  std::vector<lattice::LatticeMotion> toBlock = {};  ///< per tet: from its chart to its block's
  std::size_t blockCount = 0;
  std::vector<Arc> arcs = {};
  std::vector<Index> patchOf = {};  ///< per half-face on a wall: the side of a patch, else kNone
  std::vector<PatchSide> patches = {};  ///< both sides of each
  std::vector<FeatureCorner> featureCorners = {};

  /// The other side of a patch, or kNone on the boundary.
  [[nodiscard]] Index acrossPatch(Index side) const {
    const adjacency::HalfFace mate = mesh.mate[patches[side].first];
    return mate == kNone ? kNone : patchOf[mate];
  }
  /// From the chart of a tet's block to the block chart beyond one of its faces.
  [[nodiscard]] lattice::LatticeMotion across(adjacency::HalfFace h) const {
    return toBlock[adjacency::tetOf(mesh.mate[h])] * mesh.change[h] *
           toBlock[adjacency::tetOf(h)].inverse();
  }
};

/// An axis-aligned box.
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

/// Traces walls so that all blocks between them are boxes.
/// @param reduced  whether to remove walls between two blocks that together are one box
/// @throws Error if the map has no motorcycle complex
[[nodiscard]] MotorcycleComplex traceComplex(const SeamlessMap& map, bool reduced,
                                             Context& context);

}  // namespace hexhex::quantization
