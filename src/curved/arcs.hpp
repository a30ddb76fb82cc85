// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include <hexhex/curved.hpp>

#include <curved/batches.hpp>
#include <curved/element_numbers.hpp>
#include <curved/intersections.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::curved {

/// Traces every hex edge once. Generators are in terms of the tets in the map, not of the caller's.
[[nodiscard]] Arcs traceArcs(const igm::PreparedMap& map, const sweep::VertexTables& vertices,
                             const ElementNumbers& edges, Stage& stage);

/// Inner points and segments of consecutive arcs while they are being traced. Keeps its memory.
class ArcPieces {
 public:
  void clear() noexcept {
    arcs_.clear();
    points_.clear();
    segments_.clear();
  }
  [[nodiscard]] std::size_t points() const noexcept { return points_.size(); }
  [[nodiscard]] std::size_t segments() const noexcept { return segments_.size(); }

  /// Adds an arc whose points and segments have been added.
  /// @param firstPoint  how many points there were before it
  void addArc(const std::array<Index, 2>& ends, std::size_t firstPoint) {
    arcs_.push_back({ends, firstPoint});
  }
  void addPoint(const ArcExit& point) { points_.push_back(point); }
  void addSegment(const OwnedSimplex& carrier) { segments_.push_back(carrier); }

  /// Calls change(parameter) for the points from one on.
  template <class Change>
  void changeParameters(std::size_t first, const Change& change) {
    for (std::size_t i = first; i < points_.size(); ++i) change(points_[i].parameter);
  }
  /// Turns the order of the last ones round.
  void reverseFrom(std::size_t firstPoint, std::size_t firstSegment) {
    std::reverse(points_.begin() + static_cast<std::ptrdiff_t>(firstPoint), points_.end());
    std::reverse(segments_.begin() + static_cast<std::ptrdiff_t>(firstSegment), segments_.end());
  }

  /// Copies all to where it belongs.
  /// @param to  has room
  /// @param firstArc, firstPoint  the numbers that the first ones have there
  void copyTo(Arcs& to, std::uint64_t firstArc, std::uint64_t firstPoint) const {
    // Each arc has a segment more than inner points.
    assert(segments_.size() == points_.size() + arcs_.size());
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      to.ends[firstArc + i] = arcs_[i].ends;
      to.pointBegin[firstArc + i] = firstPoint + arcs_[i].firstPoint;
    }
    for (std::uint64_t place = firstPoint; const ArcExit& point : points_) {
      to.points[place] = point.point;
      to.parameters[place] = point.parameter;
      to.generatorTet[place] = point.generator.tet;
      to.generatorCorners[place++] = point.generator.corners;
    }
    for (std::uint64_t place = firstPoint + firstArc; const OwnedSimplex& segment : segments_) {
      to.segmentTet[place] = segment.tet;
      to.segmentCorners[place++] = segment.corners;
    }
  }

 private:
  struct Arc {
    std::array<Index, 2> ends;
    std::size_t firstPoint;
  };
  Array<Arc> arcs_;
  Array<ArcExit> points_;
  Array<OwnedSimplex> segments_;
};

/// Makes room for the pieces of more arcs.
/// @param arcs  receives them; has room for all arcs
/// @param done  how many arcs there are then
inline void lengthenForPieces(Arcs& arcs, std::uint64_t points, std::uint64_t done) {
  const double share = static_cast<double>(done) / static_cast<double>(arcs.count());
  lengthen(arcs.points, points, share);
  lengthen(arcs.parameters, points, share);
  lengthen(arcs.generatorTet, points, share);
  lengthen(arcs.generatorCorners, points, share);
  lengthen(arcs.segmentTet, points + done, share);
  lengthen(arcs.segmentCorners, points + done, share);
}

}  // namespace hexhex::curved
