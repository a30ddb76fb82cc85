// Costs of labels per triangle, and of pairs of labels per edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <shape/surface.hpp>

#include <lattice/direction.hpp>

namespace hexhex::shape {

/// Per boundary triangle: the direction that it faces in the polycube.
using Labels = std::vector<lattice::Direction>;

[[nodiscard]] inline double cosine(const Vec3& unit, lattice::Direction label) {
  return lattice::signOf(label) * unit[static_cast<std::size_t>(lattice::axisOf(label))];
}

/// How much labels agree with each other instead of following the normal of each triangle.
struct Compactness {
  double weight = 1;
  double straightness = 0;  ///< how strongly borders are aligned with the third axis
};

class LabelCosts {
 public:
  /// @param surface  must outlive this
  explicit LabelCosts(const Surface& surface);

  /// The cost of the angle between a triangle and its label.
  [[nodiscard]] std::int64_t ofTriangle(Index triangle, lattice::Direction label) const {
    return ofTriangles_[triangle][label];
  }
  /// The cost of the labels on both sides of an edge.
  [[nodiscard]] std::int64_t ofSide(Side side, lattice::Direction here, lattice::Direction beyond,
                                    const Compactness& compactness) const;
  /// The cost of a border along a side, in mean edges: the side's length on flat parts, nearly 0
  /// where the surface turns.
  [[nodiscard]] double weight(Side side) const { return weights_[side]; }

  /// Makes corners of charts costly near a point where no map was found.
  void avoidCornersAt(const Vec3& point);
  [[nodiscard]] double ofCorner(Index triangle) const { return ofCorners_[triangle]; }

 private:
  const Surface& surface_;
  std::vector<std::array<std::int64_t, lattice::kDirections>> ofTriangles_;
  std::vector<double> weights_;    ///< per side, in mean edges
  std::vector<double> ofCorners_;  ///< per triangle
};

/// Unit of integer costs: the cost of a mean area, or of a mean edge on a flat part.
inline constexpr double kCostUnit = 1e5;

}  // namespace hexhex::shape
