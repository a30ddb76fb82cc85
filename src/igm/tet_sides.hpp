// Which tets at a vertex a direction in general position leads into (for Section 5.1.2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

#include <base/lanes.hpp>
#include <lattice/rotation.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::igm {

/// How a given direction leads relative to the faces of a tet: bit f if it leads inward from face
/// f.
using TetSides = std::uint8_t;

/// For a tet that may not be positive, or a direction that may not be in general position.
inline constexpr TetSides kUncertainSides = 0;

[[nodiscard]] constexpr bool leadsInward(TetSides sides, int face) noexcept {
  return ((sides >> face) & 1) != 0;
}

namespace detail {

/// Outside coneCorner(), where compilers might rebuild it in every call.
inline constexpr auto kConeCorners = [] {
  std::array<std::uint8_t, 16> corners{};
  corners.fill(4);
  for (std::uint8_t corner = 0; corner < 4; ++corner) corners[lattice::faceMask(corner)] = corner;
  return corners;
}();

}  // namespace detail

/// The corner from which the direction leads into a tet: the one opposite the only face from which
/// the direction leads outward. 4 if there is none.
[[nodiscard]] constexpr std::size_t coneCorner(TetSides sides) noexcept {
  return detail::kConeCorners[sides];
}

/// In general position relative to everything that maps are made of: powers of the plastic number.
inline constexpr Vec3 kGeneralDirection = {1, 0.7548776662466927, 0.5698402909980532};

/// A direction, mirrored along an axis.
[[nodiscard]] constexpr Vec3 mirrored(Vec3 direction, std::size_t axis) noexcept {
  direction[axis] = -direction[axis];
  return direction;
}

/// The image of the general direction under a rotation, or a rotation followed by a reflection
/// along an axis.
struct Ray {
  Vec3 direction = kGeneralDirection;
  Vec3 signs = {1, 1, 1};  ///< of its components
  std::size_t axis = 0;    ///< along which it has a component of 1 or -1
};

/// Instead of an axis of reflection.
inline constexpr std::size_t kNoReflection = 3;

/// By rotation, and by the axis of reflection or kNoReflection.
inline constexpr auto kRays = [] {
  std::array<std::array<Ray, 4>, lattice::Rotation::kCount> rays{};
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    for (std::size_t reflection = 0; reflection < 4; ++reflection) {
      Ray& ray = rays[static_cast<std::size_t>(r)][reflection];
      ray.direction = lattice::Rotation(r)(kGeneralDirection);
      ray.axis =
          static_cast<std::size_t>(lattice::axisOf(lattice::Rotation(r)(lattice::direction(0, 1))));
      if (reflection != kNoReflection) ray.direction = mirrored(ray.direction, reflection);
      for (std::size_t k = 0; k < 3; ++k) ray.signs[k] = ray.direction[k] > 0 ? 1 : -1;
    }
  }
  return rays;
}();

/// The sides of two tets, each for its own direction: kUncertainSides unless, as far as floating
/// point can tell, the tet is positive and the direction is in general position. Two at once take
/// hardly longer than one.
/// @param axisU, axisV  along which the directions have a component of 1 or -1
[[nodiscard]] inline std::array<TetSides, 2> sidesOf(const TetParameters& u, const Vec3& directionU,
                                                     const TetParameters& v, const Vec3& directionV,
                                                     std::size_t axisU = 0,
                                                     std::size_t axisV = 0) noexcept {
  // With u = 2^-53 and edges of at most `size` along each axis: slopes are at most 0.76 and 0.58,
  // projected edges below 1.76 and 1.58 size. Edges carry one rounding, projected ones three more,
  // 4.4 u size in all; cross products are below 5.6 size^2 and off by 40 u size^2, their sum by 150
  // u size^2, the determinant by 180 u size^3. Below the smallest size, products could underflow.
  constexpr double kUncertainty = 0x1p-45;
  constexpr double kSmallestSize = 0x1p-300;
  // Edges from corner 0 are projected along the direction onto a plane across the axis: there, the
  // orientation of a face tells from which side the direction meets it. A shear that takes the
  // direction to the axis preserves determinants.
  Pair size = {0, 0};
  std::array<std::array<Pair, 3>, 3> edges{};  // along the axis, and across
  std::array<Pair, 3> direction{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (axisU + k) % 3;
    const std::size_t b = (axisV + k) % 3;
    direction[k] = Pair{directionU[a], directionV[b]};
    for (std::size_t e = 0; e < 3; ++e) {
      edges[e][k] = Pair{u[e + 1][a], v[e + 1][b]} - Pair{u[0][a], v[0][b]};
      size = larger(size, magnitudeOf(edges[e][k]));
    }
  }
  std::array<Pair, 3> p{};
  std::array<Pair, 3> q{};
  for (std::size_t e = 0; e < 3; ++e) {
    p[e] = edges[e][1] - edges[e][0] * (direction[1] * direction[0]);
    q[e] = edges[e][2] - edges[e][0] * (direction[2] * direction[0]);
  }
  // Triangles at corner 0, opposite corners 1 to 3, and the one opposite corner 0, seen from the
  // other side.
  const Pair cross1 = p[1] * q[2] - q[1] * p[2];
  const Pair cross2 = p[2] * q[0] - q[2] * p[0];
  const Pair cross3 = p[0] * q[1] - q[0] * p[1];
  const Pair cross0 = -(cross1 + cross2 + cross3);
  const Pair determinant = edges[0][0] * cross1 + edges[1][0] * cross2 + edges[2][0] * cross3;
  const Pair smallest = smaller(smaller(magnitudeOf(cross0), magnitudeOf(cross1)),
                                smaller(magnitudeOf(cross2), magnitudeOf(cross3)));
  const Pair uncertainty = kUncertainty * size * size;
  const PairMask isCertain =
      (size > kSmallestSize) & (determinant > uncertainty * size) & (smallest > uncertainty);
  const PairBits outward = signBits(cross0) | signBits(cross1) << 1 | signBits(cross2) << 2 |
                           signBits(cross3) << 3;  // as seen along the axis
  const auto sides = [&](std::size_t i) {
    if (isCertain[i] == 0) return kUncertainSides;
    return static_cast<TetSides>(direction[0][i] < 0 ? outward[i]
                                                     : outward[i] ^ lattice::kWholeTet);
  };
  return {sides(0), sides(1)};
}

/// The same for one tet.
[[nodiscard]] inline TetSides sidesOf(const TetParameters& u, const Ray& ray = {}) noexcept {
  return sidesOf(u, ray.direction, u, ray.direction, ray.axis, ray.axis)[0];
}

}  // namespace hexhex::igm
