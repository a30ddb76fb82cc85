// Follows hex edges from simplex to simplex.
#pragma once

#include <array>

#include <curved/arcs.hpp>
#include <curved/face_walk.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>
#include <igm/prepare.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::curved {

/// Traces hex edges from their midpoints to both ends. One per thread. Frames have the edge along
/// their first axis.
///
/// A hex edge is straight in every tet, so inside a closed tet it stays in one simplex, its
/// carrier, from where it enters to where it leaves.
class ArcTracer {
 public:
  /// @param pieces  receives the arcs
  ArcTracer(const igm::PreparedMap& map, const sweep::VertexTables& vertices, ArcPieces& pieces)
      : map_(map),
        exact_(map.exact),
        topology_(map.topology),
        vertices_(vertices),
        pieces_(pieces),
        walk_(map),
        star_(map.topology, map.exact) {}

  /// Adds the arc of an edge.
  /// @param middle  the simplex that holds the midpoint, with the edge's frame
  void trace(const SimplexInTet& middle);

 private:
  using Found = sweep::VertexTables::Found;
  using Ends = std::array<Index, 2>;

  [[nodiscard]] Ends traceFromInside(const SimplexInTet& middle, const Found& from,
                                     const Found& to);
  [[nodiscard]] Ends traceFromBoundary(const SimplexInTet& middle, const Found& from);
  template <class Follow>
  [[nodiscard]] Index traceBack(const SimplexInTet& carrier, const Follow& follow);

  [[nodiscard]] Index follow(const SimplexInTet& at);
  [[nodiscard]] Index followBeyond(SimplexInTet at, bool walking);
  [[nodiscard]] Index walkOn(SimplexInTet& at);
  [[nodiscard]] bool startWalk(const SimplexInTet& at);

  /// The simplex at whose inner point a part ends, and the carrier of the next part.
  struct HandOver {
    OwnedSimplex exit;
    SimplexInTet carrier;
  };
  [[nodiscard]] HandOver leave(const SimplexInTet& at, lattice::CornerMask exit);
  [[nodiscard]] HandOver leaveAlongBoundary(const SimplexInTet& at, lattice::CornerMask edge) const;
  [[nodiscard]] SimplexInTet carrierBehind(const SimplexInTet& point);
  [[nodiscard]] ArcExit exitAt(const OwnedSimplex& generator, const SimplexInTet& carrier,
                               const lattice::LatticeTet& seen, const SimplexPoint& point) const;

  /// The hex vertex at the end of the edge, if the closed tet has it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) const {
    return vertices_.find(at.tet, lattice::step(at.frame.origin(), at.frame.axis(0))).vertex;
  }
  [[nodiscard]] lattice::LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(exact_.corners[at.tet], exact_.unit);
  }
  void addSegment(const SimplexInTet& carrier) {
    pieces_.addSegment(ownedBy(topology_, carrier.tet, carrier.simplex));
  }
  [[noreturn]] static void fail(Index tet, const char* what);

  const igm::PreparedMap& map_;
  const igm::ExactMap& exact_;
  const adjacency::TetTopology& topology_;
  const sweep::VertexTables& vertices_;
  ArcPieces& pieces_;
  FaceWalk walk_;
  SimplexStar star_;
};

}  // namespace hexhex::curved
