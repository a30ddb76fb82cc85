#include <algorithm>
#include <bit>
#include <utility>

#include <quantize/bend/tightness.hpp>
#include <quantize/bend/vertex_unknowns.hpp>

namespace hexhex::quantization {

namespace {

enum class Binding : std::uint8_t { Plane, Curve, Point, None };

/// The fixed coordinates of a tet's corners, in its chart.
class BoundCorners {
 public:
  BoundCorners(const VertexUnknowns& unknowns, const adjacency::TetTopology& topology, Index tet) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Index v = topology.tets[tet][i];
      const lattice::Transition& way = unknowns.toCorner[4 * std::size_t{tet} + i];
      fixed_[i] = lattice::imageOf(unknowns.fixed[v], way.rotation);
      positions_[i] = way(unknowns.fixedPosition[v], 1.0);
    }
  }

  [[nodiscard]] std::size_t fixedCount(std::size_t corner) const {
    return static_cast<std::size_t>(std::popcount(fixed_[corner]));
  }

  [[nodiscard]] Binding binding() const {
    if (shared({0, 1, 2, 3}) > 0) return Binding::Plane;
    const bool isOnLine = shared({0, 1, 2, 2}) > 1 || shared({0, 1, 3, 3}) > 1 ||
                          shared({0, 2, 3, 3}) > 1 || shared({1, 2, 3, 3}) > 1;
    if (isOnLine || areParallel(0, 1, 2, 3) || areParallel(0, 2, 1, 3) || areParallel(0, 3, 1, 2)) {
      return Binding::Curve;
    }
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        if (shared({a, b, b, b}) == 3) return Binding::Point;
      }
    }
    return Binding::None;
  }

 private:
  /// Axes along which these corners are fixed at the same coordinate.
  [[nodiscard]] unsigned sharedAxes(const std::array<std::size_t, 4>& corners) const {
    unsigned axes = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool isShared = std::all_of(corners.begin(), corners.end(), [&](std::size_t i) {
        return (fixed_[i] >> k & 1U) != 0 && positions_[i][k] == positions_[corners[0]][k];
      });
      if (isShared) axes |= 1U << k;
    }
    return axes;
  }
  [[nodiscard]] int shared(const std::array<std::size_t, 4>& corners) const {
    return std::popcount(sharedAxes(corners));
  }
  /// Whether two edges without a common corner are fixed to lines along the same axis.
  [[nodiscard]] bool areParallel(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
    return std::popcount(sharedAxes({a, b, b, b}) & sharedAxes({c, d, d, d})) > 1;
  }

  std::array<lattice::AxisSet, 4> fixed_{};
  std::array<Vec3, 4> positions_{};
};

std::string tetCount(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " tet is" : " tets are");
}

}  // namespace

Tightness findTightness(const VertexUnknowns& unknowns, const adjacency::TetTopology& topology,
                        std::span<const Index> tets) {
  Tightness found;
  Binding best = Binding::None;
  for (const Index t : tets) {
    const BoundCorners corners(unknowns, topology, t);
    const Binding binding = corners.binding();
    if (found.tet == kNone || binding < best) {
      found.tet = t;
      best = binding;
    }
    if (binding == Binding::Plane) ++found.inPlane;
    if (binding == Binding::Curve) ++found.onCurve;
    if (binding == Binding::Point) ++found.atPoint;
    if (binding != Binding::None) continue;
    ++found.others;
    for (std::size_t i = 0; i < 4; ++i) ++found.corners[corners.fixedCount(i)];
  }
  return found;
}

std::string Tightness::describe() const {
  std::string text;
  const auto add = [&text](std::size_t count, const std::string& what) {
    if (count > 0) text += (text.empty() ? ": " : ", ") + tetCount(count) + ' ' + what;
  };
  add(inPlane, "kept flat by a plane of the boundary or of features that all corners lie in");
  add(onCurve, "kept flat by curves that the corners lie on");
  add(atPoint, "kept flat by two vertices at one place");
  add(others, "without room between " + std::to_string(corners[3]) + " corners at vertices, " +
                  std::to_string(corners[2]) + " on curves and " + std::to_string(corners[1]) +
                  " in planes that integers fix");
  return text;
}

}  // namespace hexhex::quantization
