// Compiled for several widths of registers: a vector type of the compiler goes through all of it,
// and what is called for one width takes everything inline.
//
// x(u, v, w) is linear along each axis, so x_u is bilinear in (v, w) with the four u-edges as
// coefficients, and so on. det(x_u, x_v, x_w) has degree 2 along each axis: 27 Bezier coefficients
// b[a][b][c], between the least and the largest of which all values are. Those at corners are the
// values there, [u, v, w] of the three edges. On edges, 2 b is the sum of two such products that
// mix the edges of both ends. The remaining seven follow, as det has no term with two squares
// (u^2 v^2 needs two equal columns): second differences along two axes vanish, whence on faces
// 4 b = 2 (sum over sides) - (sum over corners), and likewise in the middle layer for the centre.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <base/lanes.hpp>
#include <mesh/cell_measures.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex {
namespace {

/// Numbers that are worked with at once. Each behaves as it would alone.
using Two = Lanes<double, 2>;
using Four = Lanes<double, 4>;

/// One truth value for each: 0 or -1.
template <class V>
using Mask = decltype(V{} < V{});

template <class V>
using Vector = std::array<V, 3>;

template <class V>
Vector<V> operator+(const Vector<V>& a, const Vector<V>& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class V>
Vector<V> operator-(const Vector<V>& a, const Vector<V>& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class V>
[[gnu::always_inline]] inline V dot(const Vector<V>& a, const Vector<V>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class V>
Vector<V> cross(const Vector<V>& a, const Vector<V>& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// x -> x |x|, which keeps order and sign, so that one root is taken instead of nine.
template <class V>
[[gnu::always_inline]] inline V signedSquare(const V& x) noexcept {
  return x * bitsAs<V>(bitsAs<Mask<V>>(x) & std::int64_t{0x7fffffffffffffff});
}

/// Edges along the three axes, by the two other coordinates of their place, the lower axis in bit
/// 0.
template <class V>
struct Edges {
  std::array<Vector<V>, 4> u;
  std::array<Vector<V>, 4> v;
  std::array<Vector<V>, 4> w;

  /// @param at  points of both cells by place, bits as above
  explicit Edges(const std::array<Vector<V>, 8>& at) noexcept
      : u{at[1] - at[0], at[3] - at[2], at[5] - at[4], at[7] - at[6]},
        v{at[2] - at[0], at[3] - at[1], at[6] - at[4], at[7] - at[5]},
        w{at[4] - at[0], at[5] - at[1], at[6] - at[2], at[7] - at[3]} {}
};

template <class V, std::size_t n>
[[gnu::always_inline]] inline V leastOf(const std::array<V, n>& values) noexcept {
  V least = values[0];
  for (std::size_t i = 1; i < n; ++i) least = smaller(values[i], least);
  return least;
}

template <class V>
[[gnu::always_inline]] inline V largestOf(const std::array<V, 4>& s) noexcept {
  return larger(larger(s[0], s[1]), larger(s[2], s[3]));
}

/// The coefficients, times 2 on edges, 4 on faces and 8 at the centre.
template <class V>
struct Coefficients {
  std::array<V, 8> corners;
  std::array<V, 4> u;  ///< on the u-edges, and so on
  std::array<V, 4> v;
  std::array<V, 4> w;

  explicit Coefficients(const Edges<V>& edges) noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      std::array<Vector<V>, 4> normals;
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
    const std::array<Vector<V>, 2> uSum = {edges.u[0] + edges.u[2], edges.u[1] + edges.u[3]};
    const std::array<Vector<V>, 2> vSum = {edges.v[0] + edges.v[2], edges.v[1] + edges.v[3]};
    for (std::size_t ij = 0; ij < 4; ++ij) {
      w[ij] =
          dot(cross(uSum[ij >> 1U], vSum[ij & 1U]), edges.w[ij]) - corners[ij] - corners[ij + 4];
    }
  }

  [[gnu::always_inline]] V sumOfCorners(std::size_t a, std::size_t b, std::size_t c,
                                        std::size_t d) const noexcept {
    return (corners[a] + corners[b]) + (corners[c] + corners[d]);
  }

  /// Of all 27.
  [[gnu::always_inline]] V least() const noexcept {
    const std::array<V, 4> upright = {(u[0] + u[2]) + (w[0] + w[1]) - sumOfCorners(0, 1, 4, 5),
                                      (u[1] + u[3]) + (w[2] + w[3]) - sumOfCorners(2, 3, 6, 7),
                                      (v[0] + v[2]) + (w[0] + w[2]) - sumOfCorners(0, 2, 4, 6),
                                      (v[1] + v[3]) + (w[1] + w[3]) - sumOfCorners(1, 3, 5, 7)};
    const std::array<V, 2> lying = {(u[0] + u[1]) + (v[0] + v[1]) - sumOfCorners(0, 1, 2, 3),
                                    (u[2] + u[3]) + (v[2] + v[3]) - sumOfCorners(4, 5, 6, 7)};
    const V centre =
        (upright[0] + upright[1]) + (upright[2] + upright[3]) - ((w[0] + w[1]) + (w[2] + w[3]));
    const V edges = smaller(smaller(leastOf(u), leastOf(v)), leastOf(w));
    const V faces = smaller(leastOf(upright), leastOf(lying));
    return smaller(smaller(leastOf(corners), 0.5 * edges), smaller(0.25 * faces, 0.125 * centre));
  }
};

template <class V>
void store(const V& values, double* to) noexcept {
  std::memcpy(to, &values, sizeof values);
}

/// Measures some cells, all but the roots.
/// @param at  points of the cells by place, bits as above
template <class V>
void measure(const std::array<Vector<V>, 8>& at, std::size_t first, CellMeasures& measures) {
  const Edges<V> edges(at);
  const Coefficients<V> coefficients(edges);
  std::array<V, 4> uu;
  std::array<V, 4> vv;
  std::array<V, 4> ww;
  for (std::size_t e = 0; e < 4; ++e) {
    uu[e] = dot(edges.u[e], edges.u[e]);
    vv[e] = dot(edges.v[e], edges.v[e]);
    ww[e] = dot(edges.w[e], edges.w[e]);
  }

  // The centre, by principal axes, then the corners.
  const Vector<V> x = (edges.u[0] + edges.u[2]) + (edges.u[1] + edges.u[3]);
  const Vector<V> y = (edges.v[0] + edges.v[2]) + (edges.v[1] + edges.v[3]);
  const Vector<V> z = (edges.w[0] + edges.w[1]) + (edges.w[2] + edges.w[3]);
  V smallestLengths = dot(x, x) * dot(y, y) * dot(z, z);
  V ratio = signedSquare(dot(cross(x, y), z)) / smallestLengths;
  for (std::size_t c = 0; c < 8; ++c) {
    const std::size_t k = c >> 2U;
    const V lengths = uu[(c >> 1U & 1U) + 2 * k] * vv[(c & 1U) + 2 * k] * ww[c & 3U];
    smallestLengths = smaller(smallestLengths, lengths);
    ratio = smaller(ratio, signedSquare(coefficients.corners[c]) / lengths);
  }

  const V uLongest = largestOf(uu);
  const V vLongest = largestOf(vv);
  const V wLongest = largestOf(ww);
  // Of numbers in this range, no square, product or ratio above leaves that of double.
  const Mask<V> inRange = (uLongest < 0x1p300) & (vLongest < 0x1p300) & (wLongest < 0x1p300) &
                          (smallestLengths > 0x1p-300);
  store(ratio, &measures.scaled[first]);
  store(leastOf(coefficients.corners), &measures.corner[first]);
  store(coefficients.least(), &measures.least[first]);
  store(V(uLongest * vLongest * wLongest), &measures.volume[first]);
  std::memcpy(&measures.inRange[first], &inRange, sizeof inRange);
}

template <class V, std::size_t... lane>
[[gnu::always_inline]] inline V gathered(const std::array<const Vec3*, sizeof...(lane)>& points,
                                         std::size_t k, std::index_sequence<lane...> /*lanes*/) {
  return V{(*points[lane])[k]...};
}

template <class V>
void measureAll(const Vec3* points, std::span<const Hex> cells, CellMeasures& measures) noexcept {
  constexpr std::size_t kLanes = sizeof(V) / sizeof(double);
  for (std::size_t first = 0; first < cells.size(); first += kLanes) {
    std::array<Vector<V>, 8> at;
    for (std::size_t place = 0; place < 8; ++place) {
      std::array<const Vec3*, kLanes> corners;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const Hex& cell = cells[std::min(first + lane, cells.size() - 1)];
        corners[lane] = &points[cell[kVtkCorner[place]]];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        at[place][k] = gathered<V>(corners, k, std::make_index_sequence<kLanes>());
      }
    }
    measure(at, first, measures);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double root = std::copysign(std::sqrt(std::abs(measures.scaled[i])), measures.scaled[i]);
    measures.scaled[i] = std::clamp(root, -1.0, 1.0);  // rounding may lead beyond
    measures.volume[i] = std::sqrt(std::abs(measures.volume[i]));
  }
}

// Windows aligns stacks too little for wide registers.
#if defined(__x86_64__) && !defined(_WIN32) && !defined(HEXHEX_PLAIN_VECTORS)
#define HEXHEX_FOUR_LANES 1
[[gnu::target("avx2"), gnu::flatten]] void measureFour(const Vec3* points,
                                                       std::span<const Hex> cells,
                                                       CellMeasures& measures) noexcept {
  measureAll<Four>(points, cells, measures);
}
#endif

}  // namespace

std::span<const MeasureCells> measuresOfCells() noexcept {
#if defined(HEXHEX_FOUR_LANES)
  static const std::array<MeasureCells, 2> all = {measureAll<Two>, measureFour};
  return std::span(all).first(__builtin_cpu_supports("avx2") ? 2 : 1);
#else
  static const std::array<MeasureCells, 1> all = {measureAll<Two>};
  return all;
#endif
}

}  // namespace hexhex
