#include <algorithm>
#include <cmath>

#include <atlas/diagonals.hpp>
#include <sweep/cell_seeds.hpp>

namespace hexhex {

namespace {

using Vector = std::array<double, 3>;

/// Signs of the diagonals' components, by axis, then corner.
constexpr std::array<std::array<double, 8>, 3> makeDiagonals() {
  std::array<std::array<double, 8>, 3> diagonals{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 8; ++c) diagonals[k][c] = 2.0 * kCellCorners[c][k] - 1;
  }
  return diagonals;
}
constexpr std::array<std::array<double, 8>, 3> kDiagonals = makeDiagonals();

/// v . d for all eight diagonals d.
std::array<double, 8> alongDiagonals(const Vector& v) {
  std::array<double, 8> products;
  for (std::size_t c = 0; c < 8; ++c) {
    products[c] = v[0] * kDiagonals[0][c] + v[1] * kDiagonals[1][c] + v[2] * kDiagonals[2][c];
  }
  return products;
}

/// A vector with a bound of the error of its products with diagonals.
struct Bounded {
  Vector v;
  double error;
};

/// a x b for vectors with relative errors of 2^-52 in each component.
Bounded crossProduct(const Vector& a, const Vector& b) {
  Bounded result{};
  double magnitude = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    const double first = a[i] * b[j];
    const double second = a[j] * b[i];
    result.v[k] = first - second;
    magnitude += std::abs(first) + std::abs(second);
  }
  result.error = 0x1p-48 * magnitude;
  return result;
}

/// A face near a cell, in the chart of the tet from which the cell is seen, relative to the cell's
/// centre.
struct NearFace {
  /// Cross products of neighbouring corners: their signs along a line through the centre tell on
  /// which sides of the edges it passes.
  std::array<Vector, 3> sides;
  double error;  ///< of products of sides, and of the normal, with diagonals
  Vector normal;
  double center;       ///< the plane's value at the cell's centre
  double centerError;  ///< also covers half a diagonal times the normal

  NearFace(const PreparedMap& map, const Charts& charts, const SeenCell& cell,
           HalfFace halfFace) noexcept {
    const Gauge& gauge = charts.gauge(tetOf(halfFace));
    const GridPoint z = gauge.inverseCell(cell.smallest);
    const LatticeTet& corners = map.exact.corners[tetOf(halfFace)];
    const double scale = 1.0 / static_cast<double>(map.exact.unit);
    const std::int64_t half = map.exact.unit / 2;
    std::array<Vector, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) {
      const LatticePoint& corner = corners[static_cast<std::size_t>(kFaceCorners[halfFace % 4][i])];
      for (std::size_t k = 0; k < 3; ++k) {
        p[i][k] = static_cast<double>(corner[k] - z[k] * map.exact.unit - half) * scale;
      }
    }
    const std::array<Bounded, 3> products = {crossProduct(p[0], p[1]), crossProduct(p[1], p[2]),
                                             crossProduct(p[2], p[0])};
    error = products[0].error + products[1].error + products[2].error;
    center = 0;
    centerError = error;
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] = products[0].v[k] + products[1].v[k] + products[2].v[k];
      center -= normal[k] * p[0][k];
      centerError += error * std::abs(p[0][k]);
    }
    if (gauge.rotation == charts.gauge(cell.tet).rotation) {
      for (std::size_t i = 0; i < 3; ++i) sides[i] = products[i].v;
      return;
    }
    const Rotation toTet = charts.gauge(cell.tet).rotation.inverse() * gauge.rotation;
    for (std::size_t i = 0; i < 3; ++i) sides[i] = toTet(products[i].v);
    normal = toTet(normal);
  }

  /// A line meets the triangle only if it passes all three edges on one side, the diagonal only if
  /// its ends are on different sides of the plane.
  [[nodiscard]] CellCornerSet crossedDiagonals() const noexcept {
    const std::array<double, 8> a = alongDiagonals(sides[0]);
    const std::array<double, 8> b = alongDiagonals(sides[1]);
    const std::array<double, 8> c = alongDiagonals(sides[2]);
    const std::array<double, 8> n = alongDiagonals(normal);
    CellCornerSet crossed = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const double most = std::max(std::max(a[i], b[i]), c[i]);
      const double least = std::min(std::min(a[i], b[i]), c[i]);
      const double corner = center + 0.5 * n[i];
      const bool beside = most > error && least < -error;
      const bool above = std::min(center, corner) > centerError;
      const bool below = std::max(center, corner) < -centerError;
      if (!beside && !above && !below) crossed |= 1U << i;
    }
    return crossed;
  }

  [[nodiscard]] bool hasOnOneSide(CellCornerSet corners) const noexcept {
    const std::array<double, 8> n = alongDiagonals(normal);
    bool above = true;
    bool below = true;
    for (std::size_t i = 0; i < 8; ++i) {
      if (((corners >> i) & 1U) == 0) continue;
      const double corner = center + 0.5 * n[i];
      above = above && corner > centerError;
      below = below && corner < -centerError;
    }
    return above || below;
  }
};

}  // namespace

CellCornerSet crossedDiagonals(const PreparedMap& map, const Charts& charts,
                               const SeenCell& cell) noexcept {
  constexpr CellCornerSet kAll = 0xff;
  CellCornerSet crossed = 0;
  for (const Crossing& crossing : cell.crossings) {
    crossed |= NearFace(map, charts, cell, crossing.halfFace).crossedDiagonals();
    if (crossed == kAll) break;
  }
  return crossed;
}

bool areTogether(const PreparedMap& map, const Charts& charts, const SeenCell& cell,
                 CellCornerSet corners) noexcept {
  return std::all_of(cell.crossings.begin(), cell.crossings.end(), [&](const Crossing& crossing) {
    return NearFace(map, charts, cell, crossing.halfFace).hasOnOneSide(corners);
  });
}

}  // namespace hexhex
