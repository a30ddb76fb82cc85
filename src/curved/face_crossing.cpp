#include <algorithm>
#include <cmath>

#include <curved/face_crossing.hpp>

namespace hexhex {

namespace {

/// The corners of a face relative to where an edge begins: along it, then across.
using SeenCorners = std::array<LatticePoint, 3>;

/// Cross products of pairs of corners, by exact arithmetic.
/// @return whether the line crosses the interior of the face
bool weighExactly(const SeenCorners& seen, std::array<double, 3>& weights) noexcept {
  unsigned positive = 0;
  unsigned negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 product = crossComponent(seen[(i + 1) % 3], seen[(i + 2) % 3], 0);
    positive += product > 0 ? 1 : 0;
    negative += product < 0 ? 1 : 0;
    weights[i] = toDouble(product);
  }
  return positive == 3 || negative == 3;
}

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate across the edge: coordinates carry one
/// rounding, so products are known to 3 M^2 and their differences to 8 M^2, or 2^-50 M^2. Where the
/// sum, which is known to three times that and its own roundings, is above M^2 / 2^8, shares of it
/// are known to 2^-39.
/// @return whether that is certain to be inside, and so well known
bool weighRoughly(const SeenCorners& seen, std::array<double, 3>& weights) noexcept {
  std::array<double, 3> p;
  std::array<double, 3> q;
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = static_cast<double>(seen[i][1]);
    q[i] = static_cast<double>(seen[i][2]);
    most = std::max(most, std::max(std::abs(p[i]), std::abs(q[i])));
  }
  weights[0] = p[1] * q[2] - p[2] * q[1];
  weights[1] = p[2] * q[0] - p[0] * q[2];
  weights[2] = p[0] * q[1] - p[1] * q[0];
  const double least = std::min(std::min(weights[0], weights[1]), weights[2]);
  const double greatest = std::max(std::max(weights[0], weights[1]), weights[2]);
  const double square = most * most;
  const bool hasOneSign = least > 0x1p-49 * square || greatest < -0x1p-49 * square;
  return hasOneSign && std::abs(weights[0] + weights[1] + weights[2]) > 0x1p-8 * square;
}

}  // namespace

FaceCrossing crossFace(const LatticeTet& corners, int face, const ChartEdge& edge,
                       std::int64_t unit) noexcept {
  const auto along = static_cast<std::size_t>(axisOf(edge.along));
  const std::array<std::size_t, 3> axes = {along, along == 2 ? 0 : along + 1,
                                           along == 0 ? 2 : along - 1};
  SeenCorners seen;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t zero = edge.z[axes[k]] * unit;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(kFaceCorners[static_cast<std::size_t>(face)][i]);
      seen[i][k] = corners[corner][axes[k]] - zero;
    }
  }
  FaceCrossing crossing;
  std::array<double, 3> weights;
  crossing.inside = weighRoughly(seen, weights) || weighExactly(seen, weights);
  if (!crossing.inside) return crossing;
  const double perSum = 1 / (weights[0] + weights[1] + weights[2]);
  for (std::size_t i = 0; i < 3; ++i) crossing.shares[i] = weights[i] * perSum;
  const std::int64_t sign = signOf(edge.along);
  const auto first = static_cast<double>(sign * (seen[1][0] - seen[0][0]));
  const auto second = static_cast<double>(sign * (seen[2][0] - seen[0][0]));
  crossing.place = {sign * seen[0][0], crossing.shares[1] * first + crossing.shares[2] * second};
  crossing.error = 0x1p-38 * (std::abs(first) + std::abs(second)) +
                   0x1p-50 * std::abs(static_cast<double>(seen[0][0]));
  return crossing;
}

}  // namespace hexhex
