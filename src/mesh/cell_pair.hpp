// Two trilinear cells at once: quality, and the Bezier coefficients of their Jacobian determinants.
//
// x(u, v, w) is linear along each axis, so x_u is bilinear in (v, w) with the four u-edges as
// coefficients, and so on. det(x_u, x_v, x_w) has degree 2 along each axis: 27 Bezier coefficients
// b[a][b][c], between the least and the largest of which all values are. Those at corners are the
// values there, [u, v, w] of the three edges. On edges, 2 b is the sum of two such products that
// mix the edges of both ends. The remaining seven follow, as det has no term with two squares
// (u^2 v^2 needs two equal columns): second differences along two axes vanish, whence on faces
// 4 b = 2 (sum over sides) - (sum over corners), and likewise in the middle layer for the centre.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <hexhex/types.hpp>

#include <base/pair.hpp>

namespace hexhex {

using PairVector = std::array<Pair, 3>;

[[nodiscard]] inline PairVector operator+(const PairVector& a, const PairVector& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline PairVector operator-(const PairVector& a, const PairVector& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Pair dot(const PairVector& a, const PairVector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline PairVector cross(const PairVector& a, const PairVector& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Corners in VTK order by their place (u, v, w): bit 0, 1, 2.
inline constexpr std::array<std::size_t, 8> kVtkCorner = {0, 1, 3, 2, 4, 5, 7, 6};

/// What two cells are like; of each the same.
struct PairQuality {
  Pair scaled;  ///< scaled Jacobian, or 0 if `inRange` is not set
  Pair corner;  ///< the least of the eight values at corners
  Pair least;   ///< the least of the 27 coefficients
  Pair error;   ///< `corner` and `least` are nearer than that to the exact numbers
  Pair volume;  ///< of the box of the longest edges along the three axes
  PairMask inRange;
};

/// x -> x |x|, which keeps order and sign, so that one root is taken instead of nine.
[[nodiscard]] inline Pair signedSquare(Pair x) noexcept { return x * magnitudeOf(x); }

/// Edges along the three axes, by the two other coordinates of their place, the lower axis in bit
/// 0.
struct PairEdges {
  std::array<PairVector, 4> u;
  std::array<PairVector, 4> v;
  std::array<PairVector, 4> w;

  /// @param at  points of both cells by place, bits as above
  explicit PairEdges(const std::array<PairVector, 8>& at) noexcept
      : u{at[1] - at[0], at[3] - at[2], at[5] - at[4], at[7] - at[6]},
        v{at[2] - at[0], at[3] - at[1], at[6] - at[4], at[7] - at[5]},
        w{at[4] - at[0], at[5] - at[1], at[6] - at[2], at[7] - at[3]} {}
};

template <std::size_t n>
[[nodiscard]] Pair leastOf(const std::array<Pair, n>& values) noexcept {
  Pair least = values[0];
  for (std::size_t i = 1; i < n; ++i) least = smaller(values[i], least);
  return least;
}

[[nodiscard]] inline Pair largestOf(const std::array<Pair, 4>& s) noexcept {
  return larger(larger(s[0], s[1]), larger(s[2], s[3]));
}

/// The coefficients, times 2 on edges, 4 on faces and 8 at the centre.
struct PairCoefficients {
  std::array<Pair, 8> corners;
  std::array<Pair, 4> u;  ///< on the u-edges, and so on
  std::array<Pair, 4> v;
  std::array<Pair, 4> w;

  explicit PairCoefficients(const PairEdges& edges) noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      std::array<PairVector, 4> normals;
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
    // The w-edges: products that mix both ends are those of sums without those of each end.
    const std::array<PairVector, 2> uSum = {edges.u[0] + edges.u[2], edges.u[1] + edges.u[3]};
    const std::array<PairVector, 2> vSum = {edges.v[0] + edges.v[2], edges.v[1] + edges.v[3]};
    for (std::size_t ij = 0; ij < 4; ++ij) {
      w[ij] =
          dot(cross(uSum[ij >> 1U], vSum[ij & 1U]), edges.w[ij]) - corners[ij] - corners[ij + 4];
    }
  }

  [[nodiscard]] Pair sumOfCorners(std::size_t a, std::size_t b, std::size_t c,
                                  std::size_t d) const noexcept {
    return (corners[a] + corners[b]) + (corners[c] + corners[d]);
  }

  /// Of all 27.
  [[nodiscard]] Pair least() const noexcept {
    const std::array<Pair, 4> upright = {(u[0] + u[2]) + (w[0] + w[1]) - sumOfCorners(0, 1, 4, 5),
                                         (u[1] + u[3]) + (w[2] + w[3]) - sumOfCorners(2, 3, 6, 7),
                                         (v[0] + v[2]) + (w[0] + w[2]) - sumOfCorners(0, 2, 4, 6),
                                         (v[1] + v[3]) + (w[1] + w[3]) - sumOfCorners(1, 3, 5, 7)};
    const std::array<Pair, 2> lying = {(u[0] + u[1]) + (v[0] + v[1]) - sumOfCorners(0, 1, 2, 3),
                                       (u[2] + u[3]) + (v[2] + v[3]) - sumOfCorners(4, 5, 6, 7)};
    const Pair centre =
        (upright[0] + upright[1]) + (upright[2] + upright[3]) - ((w[0] + w[1]) + (w[2] + w[3]));
    const Pair edges = smaller(smaller(leastOf(u), leastOf(v)), leastOf(w));
    const Pair faces = smaller(leastOf(upright), leastOf(lying));
    return smaller(smaller(leastOf(corners), 0.5 * edges), smaller(0.25 * faces, 0.125 * centre));
  }
};

/// @param at  points of both cells by place, bits as above
[[nodiscard]] inline PairQuality measurePair(const std::array<PairVector, 8>& at) noexcept {
  const PairEdges edges(at);
  const PairCoefficients coefficients(edges);
  std::array<Pair, 4> uu;
  std::array<Pair, 4> vv;
  std::array<Pair, 4> ww;
  for (std::size_t e = 0; e < 4; ++e) {
    uu[e] = dot(edges.u[e], edges.u[e]);
    vv[e] = dot(edges.v[e], edges.v[e]);
    ww[e] = dot(edges.w[e], edges.w[e]);
  }

  // The centre, by principal axes, then the corners.
  const PairVector x = (edges.u[0] + edges.u[2]) + (edges.u[1] + edges.u[3]);
  const PairVector y = (edges.v[0] + edges.v[2]) + (edges.v[1] + edges.v[3]);
  const PairVector z = (edges.w[0] + edges.w[1]) + (edges.w[2] + edges.w[3]);
  Pair smallestLengths = dot(x, x) * dot(y, y) * dot(z, z);
  Pair ratio = signedSquare(dot(cross(x, y), z)) / smallestLengths;
  for (std::size_t c = 0; c < 8; ++c) {
    const std::size_t k = c >> 2U;
    const Pair lengths = uu[(c >> 1U & 1U) + 2 * k] * vv[(c & 1U) + 2 * k] * ww[c & 3U];
    smallestLengths = smaller(smallestLengths, lengths);
    ratio = smaller(ratio, signedSquare(coefficients.corners[c]) / lengths);
  }

  PairQuality result;
  result.corner = leastOf(coefficients.corners);
  result.least = coefficients.least();
  const Pair uLongest = largestOf(uu);
  const Pair vLongest = largestOf(vv);
  const Pair wLongest = largestOf(ww);
  // Of numbers in this range, no square, product or ratio above leaves that of double.
  constexpr Pair kLargest = {0x1p300, 0x1p300};
  constexpr Pair kSmallest = {0x1p-300, 0x1p-300};
  result.inRange = (uLongest < kLargest) & (vLongest < kLargest) & (wLongest < kLargest) &
                   (smallestLengths > kSmallest);
  const Pair box = uLongest * vLongest * wLongest;
  for (std::size_t cell = 0; cell < 2; ++cell) {
    result.volume[cell] = std::sqrt(box[cell]);
    result.scaled[cell] = std::copysign(std::sqrt(std::abs(ratio[cell])), ratio[cell]);
  }
  // A product of three edges of which each, as a difference, is rounded once is wrong by less than
  // 10 roundings of the sum of its six terms, which is less than 6 V, V the volume. 2 b of a w-edge
  // takes as much as 10 such products, 4 b of an upright face 2 * 2 + 2 * 10 + 4 = 28, 8 b of the
  // centre 4 * 28 + 4 * 10 = 152, and sums add fewer than 10 roundings of these: 20 * 6 * 152 / 8 *
  // 2^-53 V < 2^-41 V. Twice that.
  constexpr Pair kError = {0x1p-40, 0x1p-40};
  result.error = kError * result.volume;
  return result;
}

}  // namespace hexhex
