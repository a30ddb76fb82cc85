// A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Transactions on
// Biomedical Engineering 30 (1983).
#include <algorithm>
#include <cmath>
#include <numbers>

#include <shape/label_winding.hpp>

namespace hexhex::shape {

namespace {

Vec3 unitVector(lattice::Direction label) {
  Vec3 v{};
  v[static_cast<std::size_t>(lattice::axisOf(label))] = lattice::signOf(label);
  return v;
}

/// The area between three points of the sphere, positive if they are counterclockwise.
double areaBetween(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 2 * std::atan2(tripleProduct(a, b, c), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

/// Labels around half of a circle leave the other half open: half a sphere counts as none.
double wholeOf(double spheres) { return std::trunc(spheres + std::copysign(0.25, spheres)); }

/// The angle of a triangle at the tail of a side.
double angleAt(const Surface& surface, Side side) {
  return std::acos(std::clamp(
      -dot(surface.directions[side], surface.directions[Surface::next(Surface::next(side))]), -1.0,
      1.0));
}

}  // namespace

LabelWinding::LabelWinding(const Surface& surface)
    : surface_(surface),
      curvature_(surface.pointCount),
      swept_(surface.tails.size()),
      borderCount_(surface.pointCount) {
  for (const Index v : surface.tails) curvature_[v] = 2 * std::numbers::pi;
  for (Side side = 0; side < surface.tails.size(); ++side) {
    curvature_[surface.tails[side]] -= angleAt(surface, side);
    if (side > surface.twins[side]) continue;
    for (lattice::Direction label = 0; label < lattice::kDirections; ++label) {
      swept_[side][label] =
          areaBetween(surface.normals[surface.beyond(side)],
                      surface.normals[Surface::triangleOf(side)], unitVector(label));
    }
  }
}

/// The area between the labels around the tail of a border.
double LabelWinding::areaAround(const Labels& labels, Side border) const {
  double area = 0;
  const Vec3 first = unitVector(labels[Surface::triangleOf(border)]);
  Side side = border;
  do {
    const Side next = surface_.twins[Surface::next(Surface::next(side))];
    area += areaBetween(first, unitVector(labels[Surface::triangleOf(side)]),
                        unitVector(labels[Surface::triangleOf(next)]));
    side = next;
  } while (side != border);
  return area;
}

const std::vector<double>& LabelWinding::operator()(const Labels& labels) {
  for (const Side border : borders_) borderCount_[surface_.tails[border]] = 0;
  borders_.clear();
  spheres_.assign(curvature_.size(), 0.0);
  for (Side side = 0; side < surface_.tails.size(); ++side) {
    const Index here = Surface::triangleOf(side);
    const Index beyond = surface_.beyond(side);
    if (labels[here] != labels[beyond]) {
      borders_.push_back(side);
      ++borderCount_[surface_.tails[side]];
    }
    if (side > surface_.twins[side]) continue;
    double swept = swept_[side][labels[here]];
    if (labels[here] != labels[beyond]) {
      swept += areaBetween(surface_.normals[beyond], unitVector(labels[here]),
                           unitVector(labels[beyond]));
    }
    spheres_[surface_.tails[side]] += swept;
    spheres_[surface_.head(side)] -= swept;
  }
  for (const Side border : borders_) {
    const Index vertex = surface_.tails[border];
    if (borderCount_[vertex] > 2) {
      spheres_[vertex] += areaAround(labels, border) / borderCount_[vertex];
    }
  }
  for (std::size_t v = 0; v < spheres_.size(); ++v) {
    spheres_[v] = wholeOf((spheres_[v] - curvature_[v]) / (4 * std::numbers::pi));
  }
  return spheres_;
}

}  // namespace hexhex::shape
