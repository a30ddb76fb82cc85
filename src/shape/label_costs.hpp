// What a label costs a triangle, and two labels an edge between triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <shape/surface.hpp>

#include <lattice/direction.hpp>

namespace hexhex::shape {

/// Per triangle of the boundary: which way it is to face in the polycube.
using Labels = std::vector<lattice::Direction>;

[[nodiscard]] inline double cosine(const Vec3& unit, lattice::Direction label) {
  return lattice::signOf(label) * unit[static_cast<std::size_t>(lattice::axisOf(label))];
}

/// How much labels are to agree instead of following each triangle.
struct Compactness {
  double weight = 1;
  double straightness = 0;  ///< how much borders are to run along the third axis
};

class LabelCosts {
 public:
  /// @param surface  outlives this
  explicit LabelCosts(const Surface& surface);

  /// Of the angle between a triangle and its label.
  [[nodiscard]] std::int64_t ofTriangle(Index triangle, lattice::Direction label) const {
    return ofTriangles_[triangle][label];
  }
  /// Of the labels on both sides.
  [[nodiscard]] std::int64_t ofSide(Side side, lattice::Direction here, lattice::Direction beyond,
                                    const Compactness& compactness) const;
  /// How natural a border is there: from 0 where the surface turns to the side's length.
  [[nodiscard]] double weight(Side side) const { return weights_[side]; }

  /// From now on, corners between labels cost something near to a point where no map was found.
  void avoidCornersAt(const Vec3& point);
  [[nodiscard]] double ofCorner(Index triangle) const { return ofCorners_[triangle]; }

 private:
  const Surface& surface_;
  std::vector<std::array<std::int64_t, lattice::kDirections>> ofTriangles_;
  std::vector<double> weights_;    ///< per side, in mean edges
  std::vector<double> ofCorners_;  ///< per triangle
};

/// Costs are integers: so many are one mean area, or one mean edge on a flat place.
inline constexpr double kCostUnit = 1e5;

}  // namespace hexhex::shape
