// Arcs of hex edges that an engine has followed from tet to tet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/branchless.hpp>
#include <curved/arc_columns.hpp>
#include <curved/arc_pieces.hpp>
#include <curved/edge_tracer.hpp>
#include <curved/exact_replay.hpp>
#include <curved/face_crossing.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/simplex_star.hpp>
#include <igm/prepare.hpp>
#include <propeller/trace_guest.hpp>

namespace hexhex {

/// Computes the points where edges cross faces, in floating point with a proven bound; those of
/// edges that meet edges or vertices of the tets, or lie in faces, by exact arithmetic. Makes what
/// traceArcs() makes of an edge, bit for bit.
class EdgeReplay {
 public:
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices)
      : map_(map),
        exactly_(map, pieces_),
        tracer_(map, vertices, pieces_),
        star_(map.topology, map.exact) {}
  EdgeReplay(const EdgeReplay&) = delete;
  EdgeReplay& operator=(const EdgeReplay&) = delete;
  EdgeReplay(EdgeReplay&&) = delete;
  EdgeReplay& operator=(EdgeReplay&&) = delete;
  ~EdgeReplay() = default;

  /// Makes the arcs of the edges of a block.
  /// @param to  has room for as many points as there are faces
  /// @return the number of points
  std::size_t add(const FollowedEdges& followed, const ArcColumns& to);

 private:
  using Faces = std::span<const FollowedFace>;
  /// The tet that owns the midpoint, and the edge in its chart.
  struct Middle {
    Index owner;
    ChartEdge edge;
  };

  void cross(Faces faces, const ArcColumns& to);
  /// Whether it is certain that an edge passes through the interiors of faces and tets, and its
  /// midpoint through that of a tet.
  [[nodiscard]] bool isSure(const FollowedEdge& edge) const noexcept {
    // Without branches, as whether there are crossings is as good as random.
    return allOf(anyOf(edge.faceEnd > edge.faceBegin, (edge.begin | edge.end) == kWholeTet),
                 unsure_[edge.faceEnd] == unsure_[edge.faceBegin]);
  }
  void move(const ArcColumns& to, std::size_t first, std::size_t end, std::size_t distance) const;
  void addSure(const ArcColumns& to, std::size_t number, std::size_t place);
  [[nodiscard]] Middle middleOf(const ArcColumns& to, std::size_t number) const noexcept;
  void addInFace(const ArcColumns& to, std::size_t number, std::size_t place) const;
  std::size_t addUnsure(const ArcColumns& to, std::size_t number, std::size_t place);
  void followExactly(const FollowedEdge& edge, Faces faces);
  void traceFromMiddle(const FollowedEdge& followed, Faces faces);
  [[nodiscard]] SimplexInTet findMiddle(const FollowedEdge& followed, Faces faces) const;
  [[nodiscard]] SimplexInTet ownedMiddle(const SimplexInTet& middle);
  [[nodiscard]] ChartEdge behind(const FollowedFace& face) const noexcept {
    return ChartEdge{face.z, face.along}.across(map_.exact.transitions, face.halfFace);
  }
  void addArcOfPieces(const std::array<Index, 2>& ends, Index owner, const ChartEdge& middle);

  const PreparedMap& map_;
  const FollowedEdges* followed_ = nullptr;
  Array<Index> unsure_;  ///< how many crossings before each are not certain, and in all
  ArcPieces pieces_;     ///< of an edge that is not sure
  EdgeKey key_{};        ///< of the same
  ExactReplay exactly_;
  EdgeTracer tracer_;
  SimplexStar star_;
};

}  // namespace hexhex
