// Where hex edges cross faces and edges of tets, or pass through vertices.
//
// All traces of a hex edge find the same point, bit for bit. On a face it is computed from the face
// as its owner sees it: chart and direction of travel only permute and negate the integers that the
// computation starts from. On an edge nothing depends on the chart, the order of corners, or the
// direction of travel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <hexhex/types.hpp>

#include <curved/simplex_star.hpp>
#include <igm/igm.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::curved {

/// A point at which a hex edge leaves a simplex.
struct ArcExit {
  OwnedSimplex generator;  ///< the simplex that holds it
  Vec3 point;
  double parameter;  ///< along the hex edge
};

/// A face in its owner's chart.
class OwnersFace {
 public:
  OwnersFace(const lattice::LatticeTet& ofOwner, int face) noexcept
      : corners_(ofOwner), indices_(lattice::kFaceCorners[static_cast<std::size_t>(face)]) {}

  [[nodiscard]] const lattice::LatticePoint& corner(std::size_t i) const noexcept {
    return corners_[static_cast<std::size_t>(indices_[i])];
  }
  /// Coordinate k of the second corner, relative to the first.
  [[nodiscard]] double second(std::size_t k) const noexcept {
    return static_cast<double>(corner(1)[k] - corner(0)[k]);
  }
  /// Coordinate k of the third corner, relative to the first.
  [[nodiscard]] double third(std::size_t k) const noexcept {
    return static_cast<double>(corner(2)[k] - corner(0)[k]);
  }

 private:
  const lattice::LatticeTet& corners_;
  const std::array<int, 3>& indices_;
};

/// The barycentric weights of a point in a face, with sum 1, and whether all are known to be
/// positive.
struct FaceShares {
  std::array<double, 3> of{};
  bool inside = false;
};

/// Where the line of an edge meets the plane of a face, in exact arithmetic up to the final
/// roundings.
/// @return outside if it does not cross the interior of the face
[[nodiscard]] inline FaceShares shareExactly(const OwnersFace& face, const ChartEdge& edge,
                                             std::int64_t unit) noexcept {
  lattice::LatticePoint line;
  for (std::size_t k = 0; k < 3; ++k) line[k] = edge.z[k] * unit;
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  const auto weight = [&](std::size_t i, std::size_t j) {
    return lattice::crossComponent(face.corner(i) - line, face.corner(j) - line, axis);
  };
  const std::array<lattice::Int128, 3> weights = {weight(1, 2), weight(2, 0), weight(0, 1)};
  unsigned positive = 0;
  unsigned negative = 0;
  double sum = 0;
  FaceShares shares;
  for (std::size_t i = 0; i < 3; ++i) {
    positive += weights[i] > 0 ? 1 : 0;
    negative += weights[i] < 0 ? 1 : 0;
    shares.of[i] = lattice::signedToDouble(weights[i]);
    sum += shares.of[i];
  }
  shares.inside = positive == 3 || negative == 3;
  if (!shares.inside) return {};
  for (double& share : shares.of) share /= sum;
  return shares;
}

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate of a corner across the edge, relative to
/// the first corner; no such coordinate of the line is larger, as the line meets the closed face.
/// Coordinates carry one rounding, so products are known to within 3 M^2 and their differences to
/// within 8 M^2. M^2 is less than the sum of squares. If the sum of all weights exceeds 2^-10 of
/// that, the weights of the second and third corner are known to within 2^14 plus their own
/// roundings, and the remaining weight to within twice that: less than 2^-37.
/// @return outside if it is not certain, or not known that precisely
[[nodiscard]] inline FaceShares shareRoughly(const OwnersFace& face, const ChartEdge& edge,
                                             std::int64_t unit) noexcept {
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  const std::size_t m = (axis + 1) % 3;
  const std::size_t n = (axis + 2) % 3;
  const auto p = static_cast<double>(edge.z[m] * unit - face.corner(0)[m]);
  const auto q = static_cast<double>(edge.z[n] * unit - face.corner(0)[n]);
  const double p2 = face.second(m);
  const double q2 = face.second(n);
  const double p3 = face.third(m);
  const double q3 = face.third(n);
  const double squares = p2 * p2 + q2 * q2 + p3 * p3 + q3 * q3;
  const double perSum = 1 / (p2 * q3 - p3 * q2);
  const double second = (p * q3 - p3 * q) * perSum;
  const double third = (p2 * q - p * q2) * perSum;
  const double first = 1 - second - third;
  constexpr double kLeastShare = 0x1p-36;
  const bool inside =
      squares * std::abs(perSum) < 0x1p10 && std::min(std::min(first, second), third) > kLeastShare;
  return {{first, second, third}, inside};
}

/// The interior point of a face at which an edge crosses it.
struct FaceIntersection {
  std::array<double, 3> shares{};  ///< of the face's corners
  double parameter = 0;            ///< along the edge; exactly 1 minus this from the other end
};

/// @param edge  in the owner's chart; its line crosses the interior of the face
/// @param unit  a power of two
[[nodiscard]] inline FaceIntersection crossFace(const OwnersFace& face, const ChartEdge& edge,
                                                std::int64_t unit) noexcept {
  FaceShares shares = shareRoughly(face, edge, unit);
  if (!shares.inside) shares = shareExactly(face, edge, unit);
  // Along the axis, whichever way the edge runs.
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  const bool backward = lattice::signOf(edge.along) < 0;
  const std::int64_t begin = std::int64_t{edge.z[axis]} - (backward ? 1 : 0);
  const auto first = static_cast<double>(face.corner(0)[axis] - begin * unit);
  const double beyond = shares.of[1] * face.second(axis) + shares.of[2] * face.third(axis);
  // A multiple of 2^-53, so that its complement from the other end is exact.
  const double rest = 1 - (first + beyond) * (1 / static_cast<double>(unit));
  return {shares.of, backward ? rest : 1 - rest};
}

/// The interior point of a face at which an edge crosses it.
/// @param face  by its owner
/// @param edge  in the owner's chart
[[nodiscard]] inline ArcExit exitThrough(const igm::PreparedMap& map, const OwnedSimplex& face,
                                         const ChartEdge& edge) noexcept {
  const int local = lattice::oppositeCorner(face.corners);
  const FaceIntersection intersection =
      crossFace(OwnersFace(map.exact.corners[face.tet], local), edge, map.exact.unit);
  const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(local)];
  const auto corner = [&](std::size_t i) -> const Vec3& {
    return map.input.view.points[map.topology.tets[face.tet][static_cast<std::size_t>(f[i])]];
  };
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = intersection.shares[0] * corner(0)[k] + intersection.shares[1] * corner(1)[k] +
               intersection.shares[2] * corner(2)[k];
  }
  return {face, point, intersection.parameter};
}

/// The same from either tet of the face.
/// @param edge  in that tet's chart
[[nodiscard]] inline ArcExit exitThrough(const igm::PreparedMap& map, Index tet, int face,
                                         const ChartEdge& edge) noexcept {
  const OwnedSimplex owned = ownedFace(map.topology, tet, face);
  if (owned.tet == tet) return exitThrough(map, owned, edge);
  return exitThrough(map, owned,
                     edge.across(map.exact.transitions, adjacency::halfFaceOf(tet, face)));
}

/// The interior point of a tet edge at which a hex edge crosses it.
struct EdgeIntersection {
  std::array<double, 2> shares;  ///< of the corners, with sum 1
  double parameter;              ///< along the hex edge; exactly 1 minus this from the other end
};

/// @param a, b   the corners, as seen from the start of the hex edge
/// @param axis   along which the hex edge ascends; its line passes between the corners
/// @param unit   its length
[[nodiscard]] inline EdgeIntersection crossTetEdge(const lattice::LatticePoint& a,
                                                   const lattice::LatticePoint& b, std::size_t axis,
                                                   std::int64_t unit) noexcept {
  // Both corners and the line are in one plane, so any distance across the axis will do; this one
  // is exact and the same in all charts.
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
  // From the nearer end: a multiple of 2^-53, so that its complement from the other end is exact.
  const double rest = 1 - std::min(begun, left) / (begun + left);
  return {{ofA, ofB}, begun <= left ? 1 - rest : rest};
}

/// The point at which a hex edge leaves a simplex through a vertex or the interior of an edge of
/// the tets.
/// @param generator  the edge or vertex
/// @param tet, at    the same, in a tet
/// @param seen       that tet as seen from the start of the hex edge, which ascends along axis 0
[[nodiscard]] inline ArcExit exitAtCorners(const igm::PreparedMap& map,
                                           const OwnedSimplex& generator, Index tet,
                                           lattice::CornerMask at,
                                           const lattice::LatticeTet& seen) noexcept {
  const std::size_t i = lattice::firstCorner(at);
  const std::size_t j = lattice::lastCorner(at);
  const Tet& vertices = map.topology.tets[tet];
  const Vec3& first = map.input.view.points[vertices[i]];
  const Vec3& last = map.input.view.points[vertices[j]];
  const std::int64_t unit = map.exact.unit;
  if (i == j) {
    return {generator, first, static_cast<double>(seen[i][0]) / static_cast<double>(unit)};
  }
  const EdgeIntersection intersection = crossTetEdge(seen[i], seen[j], 0, unit);
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = intersection.shares[0] * first[k] + intersection.shares[1] * last[k];
  }
  return {generator, point, intersection.parameter};
}

}  // namespace hexhex::curved
