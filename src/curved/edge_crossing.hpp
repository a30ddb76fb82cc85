// Where a hex edge crosses an edge of the tets, or goes through a vertex.
//
// Every way to trace a hex edge finds the same point, bit for bit: nothing here depends on the
// chart, on the order of corners, or on which end the edge is followed from.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <curved/arc_pieces.hpp>
#include <igm/prepare.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// The point inside an edge of the tets at which a hex edge crosses it.
struct EdgeCrossing {
  std::array<double, 2> shares;  ///< of the corners, with sum 1
  double parameter;              ///< along the hex edge; 1 minus it, exactly, from the other end
};

/// @param a, b   the corners, seen from where the hex edge begins
/// @param axis   along which the hex edge ascends; its line passes between the corners
/// @param unit   its length
[[nodiscard]] inline EdgeCrossing crossTetEdge(const LatticePoint& a, const LatticePoint& b,
                                               std::size_t axis, std::int64_t unit) noexcept {
  // Both corners and the line are in one plane, so any distance across the axis will do; this one
  // is exact, and the same in all charts.
  const std::size_t p = (axis + 1) % 3;
  const std::size_t q = (axis + 2) % 3;
  const auto fromA = static_cast<double>(std::abs(a[p]) + std::abs(a[q]));
  const auto fromB = static_cast<double>(std::abs(b[p]) + std::abs(b[q]));
  const double ofA = fromB / (fromA + fromB);
  const double ofB = fromA / (fromA + fromB);
  const auto between = [&](std::int64_t atA, std::int64_t atB) {
    return ofA * static_cast<double>(atA) + ofB * static_cast<double>(atB);
  };
  const double begun = between(a[axis], b[axis]);
  const double left = between(unit - a[axis], unit - b[axis]);
  // From the nearer end: a multiple of 2^-53, so that the way back is as exact as the way there.
  const double rest = 1 - std::min(begun, left) / (begun + left);
  return {{ofA, ofB}, begun <= left ? 1 - rest : rest};
}

/// The point inside an edge of the tets, or at a vertex, at which a hex edge leaves a simplex.
/// @param generator  the edge or vertex
/// @param tet, at    the same in a tet
/// @param seen       that tet, seen from where the hex edge begins, which ascends along axis 0
[[nodiscard]] inline ArcExit exitAtCorners(const PreparedMap& map, const OwnedSimplex& generator,
                                           Index tet, CornerMask at,
                                           const LatticeTet& seen) noexcept {
  const std::size_t i = firstCorner(at);
  const std::size_t j = lastCorner(at);
  const Tet& vertices = map.topology.tets[tet];
  const Vec3& first = map.input.view.points[vertices[i]];
  const Vec3& last = map.input.view.points[vertices[j]];
  const std::int64_t unit = map.exact.unit;
  if (i == j) {
    return {generator, first, static_cast<double>(seen[i][0]) / static_cast<double>(unit)};
  }
  const EdgeCrossing crossing = crossTetEdge(seen[i], seen[j], 0, unit);
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = crossing.shares[0] * first[k] + crossing.shares[1] * last[k];
  }
  return {generator, point, crossing.parameter};
}

}  // namespace hexhex
