// Points and segments of arcs while they are being traced.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <curved/owned_simplex.hpp>

#include <hexhex/curved.hpp>

#include <base/prefetch.hpp>

namespace hexhex {

/// A point at which a hex edge leaves a simplex.
struct ArcExit {
  OwnedSimplex generator;  ///< the simplex that holds it
  Vec3 point;
  double parameter;  ///< along the edge
};

/// Inner points and segments of consecutive arcs. Keeps its memory.
class ArcPieces {
 public:
  void clear() noexcept {
    arcs_.clear();
    points_.clear();
    segments_.clear();
  }
  /// Makes room for what is known to come.
  void reserve(std::size_t arcs, std::size_t points, std::size_t segments) {
    arcs_.reserve(arcs);
    points_.reserve(points);
    segments_.reserve(segments);
  }
  /// Takes the last points and segments back.
  void shorten(std::size_t points, std::size_t segments) {
    points_.resize(points);
    segments_.resize(segments);
  }
  [[nodiscard]] std::size_t points() const noexcept { return points_.size(); }
  [[nodiscard]] std::size_t segments() const noexcept { return segments_.size(); }

  /// Adds an arc whose points and segments have been added.
  /// @param firstPoint  how many points there were before it
  void addArc(const std::array<Index, 2>& ends, std::size_t firstPoint) {
    arcs_.push_back({ends, firstPoint});
  }
  void addPoint(const ArcExit& exit, double parameter) {
    addPoint(exit.generator, exit.point, parameter);
  }
  void addPoint(const OwnedSimplex& generator, const Vec3& point, double parameter) {
    points_.push_back({point, parameter, generator});
  }
  void addSegment(const OwnedSimplex& carrier) { segments_.push_back(carrier); }

  /// Calls change(parameter) for the points from one on.
  template <class Change>
  void changeParameters(std::size_t first, const Change& change) {
    for (std::size_t i = first; i < points_.size(); ++i) change(points_[i].parameter);
  }
  /// Turns the order of the last ones round.
  void reverseFrom(std::size_t firstPoint, std::size_t firstSegment) {
    // Usually there is hardly anything to do.
    for (std::size_t i = firstPoint, j = points_.size(); i + 1 < j--; ++i) {
      std::swap(points_[i], points_[j]);
    }
    for (std::size_t i = firstSegment, j = segments_.size(); i + 1 < j--; ++i) {
      std::swap(segments_[i], segments_[j]);
    }
  }

  /// The number of points of an arc.
  [[nodiscard]] std::size_t pointsOf(std::size_t arc) const noexcept {
    const std::size_t end = arc + 1 < arcs_.size() ? arcs_[arc + 1].firstPoint : points_.size();
    return end - arcs_[arc].firstPoint;
  }
  /// Tells memory that an arc will be copied soon.
  void fetchArc(std::size_t arc) const noexcept { prefetch(&arcs_[arc]); }
  void fetchPieces(std::size_t arc) const noexcept {
    const std::size_t first = arcs_[arc].firstPoint;
    prefetch(points_.data() + first);
    prefetch(segments_.data() + first + arc);
  }
  /// Copies one of the arcs to where it belongs.
  /// @param number      that it has there
  /// @param firstPoint  that it has there
  void copyArc(std::size_t arc, Arcs& to, std::uint64_t number, std::uint64_t firstPoint) const {
    const std::size_t first = arcs_[arc].firstPoint;
    const std::size_t count = pointsOf(arc);
    to.ends[number] = arcs_[arc].ends;
    copyPoints(first, count, to, firstPoint);
    copySegments(first + arc, count + 1, to, firstPoint + number);
  }
  /// Copies all points and segments to where they belong.
  void copyTo(Arcs& to, std::uint64_t firstPoint, std::uint64_t firstSegment) const {
    copyPoints(0, points_.size(), to, firstPoint);
    copySegments(0, segments_.size(), to, firstSegment);
  }

 private:
  struct Arc {
    std::array<Index, 2> ends;
    std::size_t firstPoint;
  };
  struct Point {
    Vec3 position;
    double parameter;
    OwnedSimplex generator;
  };

  void copyPoints(std::size_t first, std::size_t count, Arcs& to, std::uint64_t place) const {
    for (std::size_t i = 0; i < count; ++i) {
      const Point& point = points_[first + i];
      to.points[place + i] = point.position;
      to.parameters[place + i] = point.parameter;
      to.generatorTet[place + i] = point.generator.tet;
      to.generatorCorners[place + i] = point.generator.corners;
    }
  }
  void copySegments(std::size_t first, std::size_t count, Arcs& to, std::uint64_t place) const {
    for (std::size_t i = 0; i < count; ++i) {
      to.segmentTet[place + i] = segments_[first + i].tet;
      to.segmentCorners[place + i] = segments_[first + i].corners;
    }
  }

  Array<Arc> arcs_;
  Array<Point> points_;
  Array<OwnedSimplex> segments_;
};

}  // namespace hexhex
