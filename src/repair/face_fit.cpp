#include <algorithm>
#include <cmath>

#include <repair/face_fit.hpp>

namespace hexhex {

namespace {

double largestDifference(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace

FacingTriangles facingTriangles(const TetTopology& topology, const LocalParameters& parameters,
                                HalfFace halfFace) {
  FacingTriangles triangles;
  const Index tet = tetOf(halfFace);
  const Index other = tetOf(topology.mate[halfFace]);
  for (std::size_t k = 0; k < 3; ++k) {
    const int corner = kFaceCorners[halfFace % 4][k];
    const Index vertex = topology.tets[tet][static_cast<std::size_t>(corner)];
    triangles.here[k] = parameters(tet, corner);
    triangles.there[k] = parameters(other, topology.localCorner(other, vertex));
  }
  return triangles;
}

FittedTransition fitTransition(const FacingTriangles& triangles, Rotation rotation) {
  FittedTransition fitted{0, {rotation, {}}};
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      mean += (triangles.there[i][k] - rotation(triangles.here[i])[k]) / 3;
    }
    fitted.transition.translation[k] = static_cast<std::int32_t>(std::nearbyint(mean));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 image = fitted.transition(triangles.here[i], 1.0);
    fitted.residual = std::max(fitted.residual, largestDifference(triangles.there[i], image));
  }
  return fitted;
}

std::vector<FittedTransition> fitAllTransitions(const FacingTriangles& triangles) {
  std::vector<FittedTransition> fits;
  fits.reserve(Rotation::kCount);
  for (int r = 0; r < Rotation::kCount; ++r) fits.push_back(fitTransition(triangles, Rotation(r)));
  std::stable_sort(
      fits.begin(), fits.end(),
      [](const FittedTransition& a, const FittedTransition& b) { return a.residual < b.residual; });
  return fits;
}

}  // namespace hexhex
