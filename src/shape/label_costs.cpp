// M. Livesu et al., "PolyCut: Monotone graph-cuts for polycube base-complex construction" (2013).
#include <shape/label_costs.hpp>

namespace hexhex::shape {

namespace {

/// A Gaussian of 1 minus the cosine of an angle. With a width of 0.2, it is 1/2 at about 40
/// degrees.
double bell(double distance, double width) {
  return std::exp(-0.5 * (distance / width) * (distance / width));
}

std::int64_t asInteger(double cost) { return std::llround(kCostUnit * cost); }

/// Extra cost of more than a right angle: such triangles are upside down in the polycube.
double costBeyond(double distance, double area) {
  return distance > 1 ? 3 * (distance - 1) * area + 0.5 : 0;
}

}  // namespace

LabelCosts::LabelCosts(const Surface& surface)
    : surface_(surface),
      ofTriangles_(surface.triangleCount()),
      ofCorners_(surface.triangleCount()) {
  for (Index t = 0; t < ofTriangles_.size(); ++t) {
    const double area = surface.areas[t] / surface.meanArea;
    for (lattice::Direction label = 0; label < lattice::kDirections; ++label) {
      const double distance = 1 - cosine(surface.normals[t], label);
      ofTriangles_[t][label] =
          asInteger(area * (1 - bell(distance, 0.2)) + costBeyond(distance, area));
    }
  }
  constexpr double kLeast = 0.02;  // for sharp edges, so that borders are short there, too
  for (Side side = 0; side < surface.tails.size(); ++side) {
    const double turn =
        1 - dot(surface.normals[Surface::triangleOf(side)], surface.normals[surface.beyond(side)]);
    weights_.push_back(surface.lengths[side] / surface.meanEdge *
                       std::max(kLeast, bell(turn, 0.25)));
  }
}

void LabelCosts::avoidCornersAt(const Vec3& point) {
  constexpr double kMost = 0.3;  // the cost of a turning point
  constexpr double kReach = 4;   // in mean edges
  for (Index t = 0; t < ofCorners_.size(); ++t) {
    const double distance = length(minus(surface_.centres[t], point)) / surface_.meanEdge;
    ofCorners_[t] += kMost * std::max(0.0, 1 - distance / kReach);
  }
}

std::int64_t LabelCosts::ofSide(Side side, lattice::Direction here, lattice::Direction beyond,
                                const Compactness& compactness) const {
  if (here == beyond) return 0;
  const int axis = lattice::axisOf(here);
  const int axisBeyond = lattice::axisOf(beyond);
  double cost = weights_[side];
  if (axis == axisBeyond) {
    cost = 2 * cost + 3;  // never in a polycube
  } else {
    const double along =
        std::abs(surface_.directions[side][static_cast<std::size_t>(3 - axis - axisBeyond)]);
    cost *= 1 + compactness.straightness * (1 - along);
  }
  return asInteger(compactness.weight * cost);
}

}  // namespace hexhex::shape
