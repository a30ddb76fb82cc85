// Hex edges that meet edges or vertices of the tets, or lie in faces, along the tets that an engine
// has followed them through.
#pragma once

#include <cstddef>
#include <span>

#include <curved/arc_pieces.hpp>
#include <curved/face_crossing.hpp>
#include <igm/prepare.hpp>
#include <propeller/trace_guest.hpp>

namespace hexhex {

/// By exact arithmetic: an engine goes around what it meets, so several of the faces that it
/// crosses may meet the edge in the same point, and some at its ends.
class ExactReplay {
 public:
  /// @param pieces  receives points and segments
  ExactReplay(const PreparedMap& map, ArcPieces& pieces) : map_(map), pieces_(pieces) {}

  /// Adds points and segments in the direction of an edge.
  /// @return false if the edge lies inside an edge of the tets, or its midpoint inside an edge or
  ///         at a vertex, or if it takes other tets; some may have been added then
  [[nodiscard]] bool follow(const FollowedEdge& edge, std::span<const FollowedFace> faces);

  /// The tet that owns the midpoint, and the edge in its chart.
  [[nodiscard]] Index owner() const noexcept { return owner_; }
  [[nodiscard]] const ChartEdge& middle() const noexcept { return middle_; }

 private:
  enum class Passed { On, ToEnd, Failed };

  [[nodiscard]] Passed pass(HalfFace halfFace);
  [[nodiscard]] bool addSegment(CornerMask to, bool behindMiddle);
  void goThrough(HalfFace halfFace, CornerMask exit);

  const PreparedMap& map_;
  ArcPieces& pieces_;
  Index tet_ = kNone;                ///< at hand
  ChartEdge at_{};                   ///< the edge in its chart
  CornerMask entered_ = kNoSimplex;  ///< where it was entered
  Index owner_ = kNone;
  ChartEdge middle_{};
};

}  // namespace hexhex
