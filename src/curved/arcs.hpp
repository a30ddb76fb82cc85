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

/// Traces every hex edge once. Generators refer to the map's tets, not to the caller's.
[[nodiscard]] Arcs traceArcs(const igm::PreparedMap& map, const sweep::VertexTables& vertices,
                             const ElementNumbers& edges, Stage& stage);

/// Interior points and segments of consecutive arcs while these are traced. Reuses its memory.
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
  /// @param firstPoint  number of points before it
  void addArc(const std::array<Index, 2>& ends, std::size_t firstPoint) {
    arcs_.push_back({ends, firstPoint});
  }
  void addPoint(const ArcExit& point) { points_.push_back(point); }
  void addSegment(const OwnedSimplex& carrier) { segments_.push_back(carrier); }

  /// Calls change(parameter) for all points from `firstPoint` on.
  template <class Change>
  void changeParameters(std::size_t first, const Change& change) {
    for (std::size_t i = first; i < points_.size(); ++i) change(points_[i].parameter);
  }
  /// Reverses the order of the latest points and segments.
  void reverseFrom(std::size_t firstPoint, std::size_t firstSegment) {
    std::reverse(points_.begin() + static_cast<std::ptrdiff_t>(firstPoint), points_.end());
    std::reverse(segments_.begin() + static_cast<std::ptrdiff_t>(firstSegment), segments_.end());
  }

  /// Copies everything to its place in the result.
  /// @param to  has room
  /// @param firstArc, firstPoint  the numbers of the first arc and point there
  void copyTo(Arcs& to, std::uint64_t firstArc, std::uint64_t firstPoint) const {
    // Each arc has one segment more than interior points.
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
/// @param done  number of arcs, including these
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
