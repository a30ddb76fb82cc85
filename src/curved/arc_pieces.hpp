// Points and segments of arcs while they are being traced.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hexhex/curved.hpp>

#include <base/output_batches.hpp>
#include <curved/arc_columns.hpp>
#include <curved/owned_simplex.hpp>

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

  /// Copies all to where it belongs, but keys.
  /// @param firstArc, firstPoint  among those there
  void copyTo(const ArcColumns& to, std::size_t firstArc, std::size_t firstPoint) const {
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      to.ends[firstArc + i] = arcs_[i].ends;
      to.pointBegin[firstArc + i] = to.firstPoint + firstPoint + arcs_[i].firstPoint;
    }
    for (std::size_t i = 0, place = firstPoint; i < points_.size(); ++i, ++place) {
      const Point& point = points_[i];
      to.points[place] = point.position;
      to.parameters[place] = point.parameter;
      to.generatorTet[place] = point.generator.tet;
      to.generatorCorners[place] = point.generator.corners;
    }
    for (std::size_t i = 0, place = firstPoint + firstArc; i < segments_.size(); ++i, ++place) {
      to.segmentTet[place] = segments_[i].tet;
      to.segmentCorners[place] = segments_[i].corners;
    }
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

  Array<Arc> arcs_;
  Array<Point> points_;
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

}  // namespace hexhex
