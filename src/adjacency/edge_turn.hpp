// Around an edge of the tet mesh.
#pragma once

#include <adjacency/tet_topology.hpp>

namespace hexhex {

/// From tet to tet around an edge.
class EdgeTurn {
 public:
  /// @param edge  two corners of the tet
  /// @param face  at the edge, through which it goes first
  EdgeTurn(const TetTopology& topology, Index tet, CornerMask edge, int face) noexcept
      : topology_(topology),
        tet_(tet),
        edge_(edge),
        out_(halfFaceOf(tet, face)),
        ahead_(topology.tets[tet][static_cast<std::size_t>(otherFaceAtEdge(edge, face))]) {}

  [[nodiscard]] Index tet() const noexcept { return tet_; }
  /// The edge, as corners of the tet.
  [[nodiscard]] CornerMask edge() const noexcept { return edge_; }
  /// The half-face that it leaves the tet through.
  [[nodiscard]] HalfFace out() const noexcept { return out_; }
  /// The same in the next tet, or kNone.
  [[nodiscard]] HalfFace next() const noexcept { return topology_.mate[out_]; }

  /// Enters the next tet, of which there must be one.
  void step() noexcept {
    const HalfFace in = next();
    tet_ = tetOf(in);
    // The third corner of the face behind is the one opposite the face ahead.
    const int opposite = topology_.localCorner(tet_, ahead_);
    edge_ = static_cast<CornerMask>(kWholeTet ^ cornerBit(opposite) ^ cornerBit(localOf(in)));
    ahead_ = topology_.tets[tet_][static_cast<std::size_t>(localOf(in))];
    out_ = halfFaceOf(tet_, opposite);
  }

 private:
  const TetTopology& topology_;
  Index tet_;
  CornerMask edge_;
  HalfFace out_;
  Index ahead_;  ///< third corner of the face that it leaves through
};

}  // namespace hexhex
