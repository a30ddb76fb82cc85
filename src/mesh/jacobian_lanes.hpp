// Edges of several cells at once, and the Bezier coefficients of their Jacobian determinants.
//
// x(u, v, w) is linear along each axis, so x_u is bilinear in (v, w) with the four u-edges as
// coefficients, and so on. det(x_u, x_v, x_w) has degree 2 along each axis: all its values lie
// between the least and the largest of 27 Bezier coefficients b[a][b][c]. Those at corners are the
// values there, [u, v, w] of the three edges. On edges, 2 b is the sum of two such products that
// mix the edges of both ends. The remaining seven follow, since det has no term with two squares
// (u^2 v^2 needs two equal columns): second differences along two axes vanish, so on faces 4 b = 2
// (sum over sides) - (sum over corners), and likewise in the middle layer for the centre.
#pragma once

#include <array>
#include <cstddef>

#include <base/lanes.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // everything is inline
#endif

namespace hexhex::mesh {

template <class V>
[[gnu::always_inline]] inline LaneVector<V> operator+(const LaneVector<V>& a,
                                                      const LaneVector<V>& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class V>
[[gnu::always_inline]] inline LaneVector<V> operator-(const LaneVector<V>& a,
                                                      const LaneVector<V>& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class V>
[[gnu::always_inline]] inline LaneVector<V> scaled(const V& factor,
                                                   const LaneVector<V>& a) noexcept {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
/// Edges along the three axes, indexed by the other two coordinates of their place, the lower axis
/// in bit 0.
template <class V>
struct alignas(sizeof(V)) CellEdges {
  std::array<LaneVector<V>, 4> u;
  std::array<LaneVector<V>, 4> v;
  std::array<LaneVector<V>, 4> w;

  /// @param at  points of the cells by place, with bits as above
  explicit CellEdges(const std::array<LaneVector<V>, 8>& at) noexcept
      : u{at[1] - at[0], at[3] - at[2], at[5] - at[4], at[7] - at[6]},
        v{at[2] - at[0], at[3] - at[1], at[6] - at[4], at[7] - at[5]},
        w{at[4] - at[0], at[5] - at[1], at[6] - at[2], at[7] - at[3]} {}
};

/// The coefficients, times 2 on edges, 4 on faces and 8 at the centre.
template <class V>
struct alignas(sizeof(V)) JacobianCoefficients {
  std::array<V, 8> corners;
  std::array<V, 4> u;  ///< on the u-edges, and so on
  std::array<V, 4> v;
  std::array<V, 4> w;

  explicit JacobianCoefficients(const CellEdges<V>& edges) noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      std::array<LaneVector<V>, 4> normals;
      for (std::size_t ij = 0; ij < 4; ++ij) {
        normals[ij] = cross(edges.u[(ij >> 1U) + 2 * k], edges.v[(ij & 1U) + 2 * k]);
        corners[ij + 4 * k] = dot(normals[ij], edges.w[ij]);
      }
      for (std::size_t e = 0; e < 2; ++e) {
        const std::size_t f = 2 * e;
        u[e + 2 * k] = dot(normals[f], edges.w[f + 1]) + dot(normals[f + 1], edges.w[f]);
        v[e + 2 * k] = dot(normals[e], edges.w[e + 2]) + dot(normals[e + 2], edges.w[e]);
      }
    }
    // The w-edges: products that mix both ends are those of the sums minus those of each end.
    const std::array<LaneVector<V>, 2> uSum = {edges.u[0] + edges.u[2], edges.u[1] + edges.u[3]};
    const std::array<LaneVector<V>, 2> vSum = {edges.v[0] + edges.v[2], edges.v[1] + edges.v[3]};
    for (std::size_t ij = 0; ij < 4; ++ij) {
      w[ij] =
          dot(cross(uSum[ij >> 1U], vSum[ij & 1U]), edges.w[ij]) - corners[ij] - corners[ij + 4];
    }
  }

  [[gnu::always_inline]] V sumOfCorners(std::size_t a, std::size_t b, std::size_t c,
                                        std::size_t d) const noexcept {
    return (corners[a] + corners[b]) + (corners[c] + corners[d]);
  }

  /// On the faces v = 0, v = 1, u = 0 and u = 1.
  [[gnu::always_inline]] std::array<V, 4> upright() const noexcept {
    return {(u[0] + u[2]) + (w[0] + w[1]) - sumOfCorners(0, 1, 4, 5),
            (u[1] + u[3]) + (w[2] + w[3]) - sumOfCorners(2, 3, 6, 7),
            (v[0] + v[2]) + (w[0] + w[2]) - sumOfCorners(0, 2, 4, 6),
            (v[1] + v[3]) + (w[1] + w[3]) - sumOfCorners(1, 3, 5, 7)};
  }
  /// On the faces w = 0 and w = 1.
  [[gnu::always_inline]] std::array<V, 2> lying() const noexcept {
    return {(u[0] + u[1]) + (v[0] + v[1]) - sumOfCorners(0, 1, 2, 3),
            (u[2] + u[3]) + (v[2] + v[3]) - sumOfCorners(4, 5, 6, 7)};
  }
  /// At the centre.
  [[gnu::always_inline]] V centre(const std::array<V, 4>& upright) const noexcept {
    return (upright[0] + upright[1]) + (upright[2] + upright[3]) - ((w[0] + w[1]) + (w[2] + w[3]));
  }
};

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

}  // namespace hexhex::mesh
