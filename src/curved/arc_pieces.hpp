// Points and segments of arcs while they are being traced.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <curved/owned_simplex.hpp>

#include <hexhex/curved.hpp>

namespace hexhex {

/// A point at which a hex edge leaves a simplex.
struct ArcExit {
  OwnedSimplex generator;  ///< the simplex that holds it
  Vec3 point;
  double parameter;  ///< along the edge
  double rest;       ///< the same from the other end
};

/// Inner points and segments of consecutive arcs, laid out as in Arcs. Keeps its memory.
class ArcPieces {
 public:
  void clear() noexcept {
    arcs_ = 0;
    points_ = 0;
    segments_ = 0;
  }
  [[nodiscard]] std::size_t points() const noexcept { return points_; }
  [[nodiscard]] std::size_t segments() const noexcept { return segments_; }
  /// Parameters of the points from one on.
  [[nodiscard]] std::span<double> parametersFrom(std::size_t first) noexcept {
    return std::span(parameters_).subspan(first, points_ - first);
  }

  /// Adds an arc whose points and segments have been added.
  /// @param firstPoint  how many points there were before it
  void addArc(const std::array<Index, 2>& ends, std::size_t firstPoint) {
    if (arcs_ == arcRoom_) growArcs();
    ends_[arcs_] = ends;
    pointBegin_[arcs_++] = firstPoint;
  }
  void addPoint(const ArcExit& exit, double parameter) {
    if (points_ == pointRoom_) growPoints();
    position_[points_] = exit.point;
    parameters_[points_] = parameter;
    generatorTet_[points_] = exit.generator.tet;
    generatorCorners_[points_++] = exit.generator.corners;
  }
  void addSegment(const OwnedSimplex& carrier) {
    if (segments_ == segmentRoom_) growSegments();
    segmentTet_[segments_] = carrier.tet;
    segmentCorners_[segments_++] = carrier.corners;
  }

  /// Turns the order of the last ones round.
  void reverseFrom(std::size_t firstPoint, std::size_t firstSegment) {
    // Usually there is hardly anything to do.
    for (std::size_t i = firstPoint, j = points_; i + 1 < j--; ++i) {
      std::swap(position_[i], position_[j]);
      std::swap(parameters_[i], parameters_[j]);
      std::swap(generatorTet_[i], generatorTet_[j]);
      std::swap(generatorCorners_[i], generatorCorners_[j]);
    }
    for (std::size_t i = firstSegment, j = segments_; i + 1 < j--; ++i) {
      std::swap(segmentTet_[i], segmentTet_[j]);
      std::swap(segmentCorners_[i], segmentCorners_[j]);
    }
  }

  /// The number of points of an arc.
  [[nodiscard]] std::size_t pointsOf(std::size_t arc) const noexcept {
    return (arc + 1 < arcs_ ? pointBegin_[arc + 1] : points_) - pointBegin_[arc];
  }
  /// Copies one of the arcs to where it belongs.
  /// @param number      that it has there
  /// @param firstPoint  that it has there
  void copyArc(std::size_t arc, Arcs& to, std::uint64_t number, std::uint64_t firstPoint) const {
    const Range points{pointBegin_[arc], pointsOf(arc)};
    to.ends[number] = ends_[arc];
    copyPoints(points, to, firstPoint);
    copySegments({points.first + arc, points.count + 1}, to, firstPoint + number);
  }

  /// Copies all points and segments to where they belong.
  void copyTo(Arcs& arcs, std::uint64_t firstPoint, std::uint64_t firstSegment) const {
    copyPoints({0, points_}, arcs, firstPoint);
    copySegments({0, segments_}, arcs, firstSegment);
  }

 private:
  void growArcs();
  void growPoints();
  void growSegments();
  struct Range {
    std::size_t first;
    std::size_t count;
  };
  void copyPoints(const Range& from, Arcs& to, std::uint64_t first) const {
    copy(position_, from, to.points, first);
    copy(parameters_, from, to.parameters, first);
    copy(generatorTet_, from, to.generatorTet, first);
    copy(generatorCorners_, from, to.generatorCorners, first);
  }
  void copySegments(const Range& from, Arcs& to, std::uint64_t first) const {
    copy(segmentTet_, from, to.segmentTet, first);
    copy(segmentCorners_, from, to.segmentCorners, first);
  }
  template <class T>
  static void copy(const Array<T>& from, const Range& range, Array<T>& to, std::uint64_t first) {
    std::copy_n(from.data() + range.first, range.count, to.data() + first);
  }

  // Room for more than there are:
  Array<std::array<Index, 2>> ends_;
  Array<std::uint64_t> pointBegin_;
  Array<Vec3> position_;
  Array<double> parameters_;
  Array<Index> generatorTet_;
  Array<CornerSet> generatorCorners_;
  Array<Index> segmentTet_;
  Array<CornerSet> segmentCorners_;
  std::size_t arcs_ = 0;
  std::size_t points_ = 0;
  std::size_t segments_ = 0;
  std::size_t arcRoom_ = 0;
  std::size_t pointRoom_ = 0;
  std::size_t segmentRoom_ = 0;
};

}  // namespace hexhex
