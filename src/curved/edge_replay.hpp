// Arcs of hex edges that an engine has followed from tet to tet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <curved/arc_pieces.hpp>
#include <curved/edge_tracer.hpp>
#include <curved/exact_replay.hpp>
#include <curved/face_crossing.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/simplex_star.hpp>

#include <hexhex/types.hpp>

#include <extract/trace_guest.hpp>
#include <map/prepare.hpp>

namespace hexhex {

/// What an edge has its canonical number from: the owner of its midpoint, the axis of its chart,
/// and where the edge begins there.
struct EdgeKey {
  Index tet;
  std::int32_t axis;
  GridPoint z;
};

/// Computes the points where edges cross faces, and traces those anew that meet edges or vertices
/// of the tets or lie in faces. Makes what traceArcs() makes of an edge, bit for bit.
class EdgeReplay {
 public:
  /// @param withKeys  whether keys() will be asked for
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices, bool withKeys)
      : map_(map),
        unit_(map.exact.unit),
        vertices_(vertices),
        withKeys_(withKeys),
        exactly_(map, vertices, pieces_),
        tracer_(map, vertices, pieces_),
        star_(map.topology, map.exact) {}
  EdgeReplay(const EdgeReplay&) = delete;
  EdgeReplay& operator=(const EdgeReplay&) = delete;
  EdgeReplay(EdgeReplay&&) = delete;
  EdgeReplay& operator=(EdgeReplay&&) = delete;
  ~EdgeReplay() = default;

  void clear() noexcept;
  void add(const FollowedEdges& followed);

  // What has been added:
  [[nodiscard]] std::size_t arcs() const noexcept { return arcs_.size(); }
  [[nodiscard]] std::size_t points() const noexcept { return points_; }
  /// Copies all to where it belongs.
  void copyTo(Arcs& to, std::uint64_t firstArc, std::uint64_t firstPoint) const;
  /// Per arc.
  [[nodiscard]] std::span<const EdgeKey> keys() const noexcept { return keys_; }

 private:
  /// Where an edge crosses the interior of a face.
  struct Crossing {
    Vec3 point;
    double parameter;  ///< in the direction in which the edge was followed
    OwnedSimplex generator;
    Index behind;  ///< the next tet
  };
  /// Of the crossings up to one.
  struct Counts {
    Index unsure = 0;  ///< perhaps not inside the face, behind the end or at the midpoint
    Index jumps = 0;   ///< from chart to chart
    Index early = 0;   ///< before the midpoint
  };
  struct Arc {
    std::array<Index, 2> ends;
    Index first;  ///< its first crossing, or its number among `pieces_`
    Index count;  ///< of crossings
    Index tet;    ///< in which it was followed first; kNone if it is among `pieces_`
    bool reversed;
  };
  using Faces = std::span<const FollowedFace>;

  void cross(Faces faces);
  [[nodiscard]] Counts cross(const FollowedFace& face, Crossing& crossing) const;
  void addSure(const FollowedEdge& edge, Index first, const FollowedEdges& followed);
  void addUnsure(const FollowedEdge& edge, Faces faces);
  void traceFromMiddle(const FollowedEdge& edge, Faces faces);
  void addArcOfPieces(const std::array<Index, 2>& ends, std::size_t firstPoint);
  [[nodiscard]] SimplexInTet findMiddle(const FollowedEdge& edge, Faces faces) const;
  [[nodiscard]] SimplexInTet ownedMiddle(const SimplexInTet& middle);
  [[nodiscard]] ChartEdge behind(const FollowedFace& face) const noexcept {
    return ChartEdge{face.z, face.along}.across(map_.exact.transitions, face.halfFace);
  }
  /// @param edge  in the chart of the owner
  void addKey(Index owner, const ChartEdge& edge) {
    if (withKeys_) keys_.push_back({owner, axisOf(edge.along), edge.ascending().z});
  }
  void copySure(const Arc& arc, Arcs& to, std::uint64_t number, std::uint64_t firstPoint) const;

  const PreparedMap& map_;
  std::int64_t unit_;
  const LatticeNumbers& vertices_;
  bool withKeys_;
  Array<Arc> arcs_;
  Array<EdgeKey> keys_;
  std::size_t points_ = 0;
  Array<Crossing> crossings_;
  Array<Counts> counts_;  ///< per crossing, and one before the first
  ArcPieces pieces_;      ///< of edges that are not in general position
  ExactReplay exactly_;
  EdgeTracer tracer_;
  SimplexStar star_;
};

}  // namespace hexhex
