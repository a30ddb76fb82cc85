// Points and segments of arcs while they are being traced.
#pragma once

#include <algorithm>
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
};

/// Inner points and segments of consecutive arcs, laid out as in Arcs. Keeps its memory.
class ArcPieces {
 public:
  void clear() noexcept {
    points_ = 0;
    segments_ = 0;
  }
  [[nodiscard]] std::size_t points() const noexcept { return points_; }
  [[nodiscard]] std::size_t segments() const noexcept { return segments_; }
  /// Parameters of the points from one on.
  [[nodiscard]] std::span<double> parametersFrom(std::size_t first) noexcept {
    return std::span(parameters_).subspan(first, points_ - first);
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

  /// Copies all to where they belong.
  void copyTo(Arcs& arcs, std::uint64_t firstPoint, std::uint64_t firstSegment) const {
    copy(position_, points_, arcs.points, firstPoint);
    copy(parameters_, points_, arcs.parameters, firstPoint);
    copy(generatorTet_, points_, arcs.generatorTet, firstPoint);
    copy(generatorCorners_, points_, arcs.generatorCorners, firstPoint);
    copy(segmentTet_, segments_, arcs.segmentTet, firstSegment);
    copy(segmentCorners_, segments_, arcs.segmentCorners, firstSegment);
  }

 private:
  void growPoints();
  void growSegments();
  template <class T>
  static void copy(const Array<T>& from, std::size_t count, Array<T>& to, std::uint64_t first) {
    std::copy_n(from.data(), count, to.data() + first);
  }

  // Room for more than there are:
  Array<Vec3> position_;
  Array<double> parameters_;
  Array<Index> generatorTet_;
  Array<CornerSet> generatorCorners_;
  Array<Index> segmentTet_;
  Array<CornerSet> segmentCorners_;
  std::size_t points_ = 0;
  std::size_t segments_ = 0;
  std::size_t pointRoom_ = 0;
  std::size_t segmentRoom_ = 0;
};

}  // namespace hexhex
