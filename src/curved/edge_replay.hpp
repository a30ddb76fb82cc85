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

  EdgeKey() = default;
  /// @param edge  in the owner's chart
  EdgeKey(Index owner, const ChartEdge& edge) noexcept
      : tet(owner), axis(axisOf(edge.along)), z(edge.ascending().z) {}
};

/// Where edges cross the interiors of faces, in the order in which they were followed.
struct FollowedCrossings {
  Array<Vec3> points;
  Array<double> parameters;  ///< in the direction in which the edge was followed
  Array<Index> generatorTet;
  Array<CornerSet> generatorCorners;
  Array<Index> behind;  ///< the next tet

  void resize(std::size_t count) {
    points.resize(count);
    parameters.resize(count);
    generatorTet.resize(count);
    generatorCorners.resize(count);
    behind.resize(count);
  }
};

/// What is known of the crossings up to one.
struct CrossingCounts {
  Index unsure = 0;  ///< perhaps not inside the face, behind the end or at the midpoint
  Index jumps = 0;   ///< from chart to chart
  Index early = 0;   ///< before the midpoint
};

/// Computes the points where edges cross faces, in floating point with a proven bound; those of
/// edges that meet edges or vertices of the tets, or lie in faces, by exact arithmetic. Makes what
/// traceArcs() makes of an edge, bit for bit.
class EdgeReplay {
 public:
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices)
      : map_(map),
        exactly_(map, vertices, pieces_),
        tracer_(map, vertices, pieces_),
        star_(map.topology, map.exact) {}
  EdgeReplay(const EdgeReplay&) = delete;
  EdgeReplay& operator=(const EdgeReplay&) = delete;
  EdgeReplay(EdgeReplay&&) = delete;
  EdgeReplay& operator=(EdgeReplay&&) = delete;
  ~EdgeReplay() = default;

  /// Edges of a block, once between calls of clear().
  /// @param followed  stays there until then
  void add(const FollowedEdges& followed);
  void clear() noexcept {
    followed_ = nullptr;
    unsure_.clear();
    pieces_.clear();
    keys_.clear();
  }

  // What has been added:
  [[nodiscard]] std::size_t arcs() const noexcept { return followed_->edges.size(); }
  [[nodiscard]] std::size_t points() const noexcept { return points_; }
  /// Copies all to where it belongs.
  /// @param keys  of all arcs; may be empty
  void copyTo(Arcs& to, std::span<EdgeKey> keys, std::uint64_t firstArc,
              std::uint64_t firstPoint) const;

 private:
  using Faces = std::span<const FollowedFace>;
  /// Where an arc and its points belong.
  struct Place {
    std::uint64_t arc;
    std::uint64_t point;
  };
  /// Consecutive sure edges.
  struct Run {
    std::size_t edge;
    std::size_t end;
    Index crossing;  ///< the first
  };

  /// The tet that owns the midpoint, and the edge in its chart.
  struct Middle {
    Index owner;
    ChartEdge edge;
  };

  void cross(Faces faces);
  /// Whether it is certain that an edge passes through the interiors of faces and tets, and its
  /// midpoint through that of a tet.
  /// @param first  its first crossing
  [[nodiscard]] bool isSure(const FollowedEdge& edge, Index first) const noexcept {
    // Without branches, as whether there are crossings is as good as random.
    const Index end = edge.faceEnd;
    const auto isInside = static_cast<unsigned>(end > first) | static_cast<unsigned>(edge.inside);
    const auto allSure = static_cast<unsigned>(counts_[end].unsure == counts_[first].unsure);
    return (isInside & allSure) != 0;
  }
  void addSure(std::size_t number, Index first);
  [[nodiscard]] Middle middleOf(const FollowedEdge& edge, Index first) const noexcept;
  void addUnsure(const FollowedEdge& edge, Faces faces);
  void traceFromMiddle(const FollowedEdge& followed, Faces faces);
  [[nodiscard]] SimplexInTet findMiddle(const FollowedEdge& followed, Faces faces) const;
  [[nodiscard]] SimplexInTet ownedMiddle(const SimplexInTet& middle);
  [[nodiscard]] ChartEdge behind(const FollowedFace& face) const noexcept {
    return ChartEdge{face.z, face.along}.across(map_.exact.transitions, face.halfFace);
  }
  void addArcOfPieces(const std::array<Index, 2>& ends, std::size_t firstPoint, Index owner,
                      const ChartEdge& middle);
  [[nodiscard]] Place copyRun(const Run& run, Arcs& to, std::span<EdgeKey> keys, Place place) const;
  void reverse(Index first, std::size_t number, std::size_t count);
  void smooth(Index first, std::size_t count);

  const PreparedMap& map_;
  const FollowedEdges* followed_ = nullptr;
  std::size_t points_ = 0;
  FollowedCrossings crossings_;
  Array<CrossingCounts> counts_;  ///< per crossing, and one before the first
  // Of sure edges, in the arcs' direction, as are their crossings in the end:
  Array<std::array<Index, 2>> ends_;
  Array<Index> segmentTet_;
  Array<Index> unsure_;  ///< numbers of edges that are not sure
  ArcPieces pieces_;     ///< of these
  Array<EdgeKey> keys_;  ///< of the same
  ExactReplay exactly_;
  EdgeTracer tracer_;
  SimplexStar star_;
};

}  // namespace hexhex
