// The table of all edges of a tet mesh, each with its tets.
#include <algorithm>

#include <adjacency/edge_fan.hpp>

namespace hexhex::adjacency {

namespace {

/// Numbers the six edges of a tet by the set of their corners.
constexpr std::array<std::uint8_t, 16> kEdgeOfCorners = {0, 0, 0, 0, 0, 1, 2, 0,
                                                         0, 3, 4, 0, 5, 0, 0, 0};

}  // namespace

EdgeFans::EdgeFans(const TetTopology& topology) : topology_(topology), edges_(topology.tetCount()) {
  // As many edges as Euler's formula gives if no component is a closed space.
  const auto boundary =
      static_cast<std::size_t>(std::count(topology.mate.begin(), topology.mate.end(), kNone));
  begin_.reserve(topology.pointCount + topology.tetCount() + boundary / 2 + 1);
  corners_.reserve(6 * topology.tetCount());
  std::vector<EdgeCorner> scratch;
  for (Index v = 0; v < topology.pointCount; ++v) {
    forEachEdge(topology, v, scratch, [this](Index /*w*/, std::span<const EdgeCorner> fan) {
      for (const EdgeCorner& at : fan) {
        edges_[at.tet][kEdgeOfCorners[at.mask()]] = static_cast<Index>(size());
      }
      corners_.insert(corners_.end(), fan.begin(), fan.end());
      begin_.push_back(corners_.size());
    });
  }
}

Index EdgeFans::edgeOf(Index tet, lattice::CornerMask ends) const noexcept {
  return edges_[tet][kEdgeOfCorners[ends]];
}

}  // namespace hexhex::adjacency
