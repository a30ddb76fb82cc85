#include <algorithm>

#include <adjacency/edge_fan.hpp>
#include <quantize/polycube/boundary_sides.hpp>

namespace hexhex::quantization {

BoundarySides::BoundarySides(const adjacency::TetTopology& topology) : topology_(topology) {
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.isBoundary(h)) faces_.push_back(h);
  }
  twins_.resize(3 * faces_.size());
  for (BoundarySide side = 0; side < twins_.size(); ++side) {
    const adjacency::HalfFace h = face(side);
    const lattice::CornerMask ends =
        topology.edge(adjacency::tetOf(h), head(side), tail(side)).mask();
    adjacency::EdgeTurn turn(topology, adjacency::tetOf(h), ends,
                             adjacency::otherFaceAtEdge(ends, adjacency::localOf(h)));
    turn.goToBoundary();
    const auto found = std::lower_bound(faces_.begin(), faces_.end(), turn.out());
    BoundarySide there = 3 * static_cast<BoundarySide>(found - faces_.begin());
    while (head(there) != tail(side)) ++there;
    twins_[side] = there;
  }
}

Index BoundarySides::corner(BoundarySide side, std::size_t ahead) const noexcept {
  // Corners of a face are counterclockwise as seen from inside.
  const adjacency::HalfFace h = face(side);
  const auto& corners = lattice::kFaceCorners[h % 4];
  return topology_.tets[adjacency::tetOf(h)][static_cast<std::size_t>(corners[(side + ahead) % 3])];
}

}  // namespace hexhex::quantization
