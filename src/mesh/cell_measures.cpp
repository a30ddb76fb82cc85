// Compiled for several register widths: everything takes the compiler's vector type as a parameter,
// and all functions called for one width are inlined.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <base/register_widths.hpp>
#include <mesh/cell_measures.hpp>
#include <mesh/jacobian_lanes.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex::mesh {
namespace {

/// Numbers processed at once. Each gives the same result as it would alone.
using Two = Lanes<double, 2>;
using Four = Lanes<double, 4>;

/// One mask per number: 0 or -1.
template <class V>
using Mask = decltype(V{} < V{});

/// x -> x |x| preserves order and sign, so that one square root suffices instead of nine.
template <class V>
[[gnu::always_inline]] inline V signedSquare(const V& x) noexcept {
  return x * bitsAs<V>(bitsAs<Mask<V>>(x) & std::int64_t{0x7fffffffffffffff});
}

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

/// The least of all 27 coefficients.
template <class V>
[[gnu::always_inline]] inline V leastOf(const JacobianCoefficients<V>& all) noexcept {
  const std::array<V, 4> upright = all.upright();
  const V edges = smaller(smaller(leastOf(all.u), leastOf(all.v)), leastOf(all.w));
  const V faces = smaller(leastOf(upright), leastOf(all.lying()));
  return smaller(smaller(leastOf(all.corners), 0.5 * edges),
                 smaller(0.25 * faces, 0.125 * all.centre(upright)));
}

template <class V>
void store(const V& values, double* to) noexcept {
  std::memcpy(to, &values, sizeof values);
}

/// Measures some cells, everything but the square roots.
/// @param at  points of the cells by place, with bits as above
template <class V>
void measure(const std::array<LaneVector<V>, 8>& at, std::size_t first, CellMeasures& measures) {
  const CellEdges<V> edges(at);
  const JacobianCoefficients<V> coefficients(edges);
  std::array<V, 4> uu;
  std::array<V, 4> vv;
  std::array<V, 4> ww;
  for (std::size_t e = 0; e < 4; ++e) {
    uu[e] = dot(edges.u[e], edges.u[e]);
    vv[e] = dot(edges.v[e], edges.v[e]);
    ww[e] = dot(edges.w[e], edges.w[e]);
  }

  // The centre, by principal axes, then the corners.
  const LaneVector<V> x = (edges.u[0] + edges.u[2]) + (edges.u[1] + edges.u[3]);
  const LaneVector<V> y = (edges.v[0] + edges.v[2]) + (edges.v[1] + edges.v[3]);
  const LaneVector<V> z = (edges.w[0] + edges.w[1]) + (edges.w[2] + edges.w[3]);
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
  // For numbers in this range, no square, product or ratio above leaves the range of double.
  const Mask<V> inRange = (uLongest < 0x1p300) & (vLongest < 0x1p300) & (wLongest < 0x1p300) &
                          (smallestLengths > 0x1p-300);
  store(ratio, &measures.scaled[first]);
  store(leastOf(coefficients.corners), &measures.corner[first]);
  store(leastOf(coefficients), &measures.least[first]);
  store(V(uLongest * vLongest * wLongest), &measures.volume[first]);
  std::memcpy(&measures.inRange[first], &inRange, sizeof inRange);
}

template <class V, std::size_t... lane>
[[gnu::always_inline]] inline V gathered(const std::array<const Vec3*, sizeof...(lane)>& points,
                                         std::size_t k, std::index_sequence<lane...> /*lanes*/) {
  return V{(*points[lane])[k]...};
}

template <class V>
void measureAll(const Vec3* points, std::span<const Hex> cells, CellMeasures& measures) {
  constexpr std::size_t kLanes = sizeof(V) / sizeof(double);
  for (std::size_t first = 0; first < cells.size(); first += kLanes) {
    std::array<LaneVector<V>, 8> at;
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
    measures.scaled[i] = std::clamp(root, -1.0, 1.0);  // rounding may exceed the bounds
    measures.volume[i] = std::sqrt(std::abs(measures.volume[i]));
  }
}

}  // namespace

std::span<const MeasureCells> measuresOfCells() noexcept {
  static constexpr std::array<MeasureCells, 2> kBoth = {measureAll<Two>, kWide<measureAll<Four>>};
  return runnable(kBoth);
}

}  // namespace hexhex::mesh
