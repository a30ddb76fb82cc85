// Certificates of cells against exact subdivision by independent code, and of meshes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>
#include <tuple>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <hexhex/error.hpp>
#include <hexhex/quality.hpp>

#include <mesh/bezier.hpp>
#include <mesh/cell_measures.hpp>
#include <mesh/cell_validity.hpp>
#include <mesh/grid_meshes.hpp>

#include "support/effort.hpp"

namespace hexhex::mesh {
namespace {

using testing::gridMesh;
using testing::Random;
using testing::reversed;
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    1536, 1536, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

/// Corners with integer coordinates in VTK order.
using Cell = std::array<std::array<std::int64_t, 3>, 8>;

constexpr std::array<std::array<int, 3>, 8> kPlaces = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// 8 times the 27 coefficients, by the definition: a sum over triples of edges, whose indices add
/// up along each axis.
using Coefficients = std::array<Integer, 27>;

Coefficients coefficientsOf(const Cell& cell) {
  const auto corner = [&](int i, int j, int k) -> const std::array<std::int64_t, 3>& {
    for (std::size_t c = 0; c < 8; ++c) {
      if (kPlaces[c] == std::array{i, j, k}) return cell[c];
    }
    std::abort();
  };
  const auto edge = [&](int axis, int a, int b) {
    std::array<int, 3> from{};
    std::array<int, 3> to{};
    const int other = axis == 0 ? 1 : 0;
    const int last = axis == 2 ? 1 : 2;
    from[static_cast<std::size_t>(other)] = to[static_cast<std::size_t>(other)] = a;
    from[static_cast<std::size_t>(last)] = to[static_cast<std::size_t>(last)] = b;
    to[static_cast<std::size_t>(axis)] = 1;
    std::array<Integer, 3> d;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = corner(to[0], to[1], to[2])[k] - corner(from[0], from[1], from[2])[k];
    }
    return d;
  };
  std::array<std::array<std::array<Integer, 3>, 4>, 3> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int e = 0; e < 4; ++e) {
      edges[static_cast<std::size_t>(axis)][static_cast<std::size_t>(e)] =
          edge(axis, e & 1, e >> 1);
    }
  }
  Coefficients result{};
  for (std::size_t e = 0; e < 64; ++e) {
    const std::size_t j = e & 1;
    const std::size_t k = e >> 1 & 1;
    const std::size_t i = e >> 2 & 1;
    const std::size_t k2 = e >> 3 & 1;
    const std::size_t i2 = e >> 4 & 1;
    const std::size_t j2 = e >> 5 & 1;
    const auto& u = edges[0][j + 2 * k];
    const auto& v = edges[1][i + 2 * k2];
    const auto& w = edges[2][i2 + 2 * j2];
    const Integer det = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                        u[2] * (v[0] * w[1] - v[1] * w[0]);
    int shift = 3;  // half for each index that is 1, of two ways to reach it
    for (const std::size_t sum : {i + i2, j + j2, k + k2}) shift -= sum == 1 ? 1 : 0;
    result[(i + i2) + 3 * (j + j2) + 9 * (k + k2)] += det << shift;
  }
  return result;
}

/// The parts of a cell on one side of the middle, times 4.
Coefficients half(const Coefficients& whole, std::size_t axis, bool upper) {
  Coefficients part;
  const std::size_t stride = axis == 0 ? 1 : (axis == 1 ? 3 : 9);
  for (std::size_t at = 0; at < 27; ++at) {
    if (at / stride % 3 != 0) continue;
    const std::size_t ends = upper ? 2 * stride : 0;
    const Integer& near = whole[at + ends];
    const Integer& middle = whole[at + stride];
    const Integer& far = whole[at + 2 * stride - ends];
    part[at + ends] = near << 2;
    part[at + stride] = (near + middle) << 1;
    part[at + 2 * stride - ends] = near + (middle << 1) + far;
  }
  return part;
}

/// Whether it is positive everywhere, if so many levels of eight parts tell.
std::optional<bool> isPositive(const Coefficients& c, int levels) {
  if (std::all_of(c.begin(), c.end(), [](const Integer& x) { return x > 0; })) return true;
  for (const std::size_t corner : {0U, 2U, 6U, 8U, 18U, 20U, 24U, 26U}) {
    if (c[corner] <= 0) return false;
  }
  if (levels == 0) return std::nullopt;
  std::optional<bool> all = true;
  for (unsigned octant = 0; octant < 8; ++octant) {
    Coefficients part = c;
    for (std::size_t axis = 0; axis < 3; ++axis)
      part = half(part, axis, (octant >> axis & 1U) != 0);
    const std::optional<bool> known = isPositive(part, levels - 1);
    if (known == std::optional(false)) return false;
    if (!known) all = std::nullopt;
  }
  return all;
}

constexpr std::array<const char*, 10> kKinds = {
    "jitter 0.3", "jitter 0.4", "jitter 0.5",      "jitter 0.6",     "jitter 0.7",
    "sheared",    "thin",       "nearly singular", "small integers", "flat or collapsed"};

/// A random cell of a kind.
Cell draw(std::size_t kind, Random& random) {
  constexpr std::int64_t kUnit = 1 << 30;
  const auto below = [&](std::int64_t n) {
    return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(n)));
  };
  const double amplitude = kind < 5 ? 0.3 + 0.1 * static_cast<double>(kind) : 0.5;
  Cell cell;
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      cell[c][k] = kPlaces[c][k] * kUnit +
                   std::llround((2 * random.real() - 1) * amplitude * static_cast<double>(kUnit));
    }
  }
  const auto smallIntegers = [&](std::int64_t n) {
    for (auto& corner : cell) {
      for (std::int64_t& x : corner) x = below(n);
    }
  };
  if (kind == 5 || kind == 6) {  // integer matrices: of shears, and nearly flat ones
    std::array<std::array<std::int64_t, 3>, 3> matrix = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int step = 0; step < 6; ++step) {
      const std::size_t i = random.below(3);
      const std::size_t j = (i + 1 + random.below(2)) % 3;
      const std::int64_t factor = below(kind == 5 ? 9 : 41) - (kind == 5 ? 4 : 20);
      for (std::size_t k = 0; k < 3; ++k) matrix[i][k] += factor * matrix[j][k];
    }
    for (auto& corner : cell) {
      const auto old = corner;
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = (matrix[k][0] * (old[0] >> 12)) + (matrix[k][1] * (old[1] >> 12)) +
                    (matrix[k][2] * (old[2] >> 12));
      }
    }
  } else if (kind == 7) {  // degenerate and then moved by a few units
    for (std::size_t c = 0; c < 8; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        cell[c][k] = (4 * kPlaces[c][k] + below(4)) * kUnit / 4;
        cell[c][k] += below(5) - 2;
      }
    }
  } else if (kind == 8) {
    for (std::size_t c = 0; c < 8; ++c) {
      for (std::size_t k = 0; k < 3; ++k) cell[c][k] = 3 * kPlaces[c][k] + below(4);
    }
  } else if (kind == 9) {
    const std::uint64_t how = random.below(4);
    if (how == 0) smallIntegers(3);
    if (how == 1) cell[random.below(8)] = cell[random.below(8)];
    if (how == 2) {
      for (auto& corner : cell) corner[2] = corner[0] - 2 * corner[1];
    }
    if (how == 3) cell[1] = cell[0], cell[5] = cell[4];
  }
  return cell;
}

struct Tally {
  std::uint64_t cells = 0;
  std::uint64_t positive = 0;
  std::uint64_t cornersOnly = 0;  ///< refuted, though all values at corners and centre are positive
  std::uint64_t undecided = 0;
  std::uint64_t unknown = 0;  ///< here
  std::uint64_t falsePositive = 0;
  std::uint64_t falseRefuted = 0;
};

/// Cells as they are, far from the origin, and in other units along each axis: powers of two, which
/// change no sign.
Tally compare(std::size_t kind, std::size_t count, Random& random) {
  HexMesh mesh;
  std::vector<std::optional<bool>> truth;
  for (std::size_t i = 0; i < count; ++i) {
    const Cell cell = draw(kind, random);
    truth.push_back(isPositive(coefficientsOf(cell), 24));
    std::array<int, 3> exponents{};
    std::int64_t offset = 0;
    if (i % 16 == 1) offset = std::int64_t{1} << 50;
    if (i % 16 == 2) exponents.fill(static_cast<int>(random.below(1900)) - 1000);
    if (i % 16 == 3) {
      for (int& e : exponents) e = static_cast<int>(random.below(1900)) - 1000;
    }
    Hex corners;
    for (std::size_t c = 0; c < 8; ++c) {
      corners[c] = static_cast<Index>(mesh.points.size());
      Vec3 point{};
      for (std::size_t k = 0; k < 3; ++k) {
        point[k] = std::ldexp(static_cast<double>(cell[c][k] + offset), exponents[k]);
      }
      mesh.points.push_back(point);
    }
    mesh.cells.push_back(corners);
  }
  Context context;
  const Certificate certificate = certify(mesh, context);
  Tally tally;
  tally.cells = count;
  for (std::size_t i = 0; i < count; ++i) {
    const Validity validity = certificate.validity[i];
    if (validity == Validity::Positive) ++tally.positive;
    if (validity == Validity::Refuted && certificate.scaledJacobians[i] > 0) ++tally.cornersOnly;
    if (validity == Validity::Undecided) ++tally.undecided;
    if (!truth[i]) ++tally.unknown;
    if (truth[i] == std::optional(false) && validity == Validity::Positive) ++tally.falsePositive;
    if (truth[i] == std::optional(true) && validity == Validity::Refuted) ++tally.falseRefuted;
  }
  EXPECT_EQ(certificate.positive, tally.positive);
  EXPECT_EQ(certificate.positive + certificate.refuted + certificate.undecided, count);
  EXPECT_EQ(certificate.undecided, tally.undecided);
  return tally;
}

/// HEXHEX_TEST_EFFORT=334 build/release/tests/test_mesh --gtest_filter=Certificates.AreRight: ten
/// million cells.
TEST(Certificates, AreRight) {
  std::cout << "kind, cells, positive, refuted though positive at corners and centre, undecided, "
               "undecided here\n";
  Tally all;
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    Random random(77 + kind);
    Tally sum;
    auto left = static_cast<std::size_t>(3000 * test::effort());
    while (left > 0) {
      const std::size_t count = std::min<std::size_t>(left, 100000);
      left -= count;
      const Tally tally = compare(kind, count, random);
      sum.cells += tally.cells;
      sum.positive += tally.positive;
      sum.cornersOnly += tally.cornersOnly;
      sum.undecided += tally.undecided;
      sum.unknown += tally.unknown;
      EXPECT_EQ(tally.falsePositive, 0U) << kKinds[kind];
      EXPECT_EQ(tally.falseRefuted, 0U) << kKinds[kind];
    }
    std::cout << kKinds[kind] << ", " << sum.cells << ", " << sum.positive << ", "
              << sum.cornersOnly << ", " << sum.undecided << ", " << sum.unknown << "\n";
    all.cells += sum.cells;
    all.undecided += sum.undecided;
    all.cornersOnly += sum.cornersOnly;
  }
  EXPECT_LT(static_cast<double>(all.undecided), 1 + 1e-6 * static_cast<double>(all.cells));
  EXPECT_GT(all.cornersOnly, all.cells / 2000);
}

std::array<Vec3, 8> cube() {
  std::array<Vec3, 8> corners;
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t k = 0; k < 3; ++k) corners[c][k] = kPlaces[c][k];
  }
  return corners;
}

TEST(Measures, AreTheSameInAllRegisters) {
  Random random(8);
  std::vector<Vec3> points(1000);
  for (Vec3& p : points) {
    for (double& x : p) x = std::ldexp(random.real() - 0.5, static_cast<int>(random.below(20)));
  }
  points[7] = {1e200, 0, 0};
  points[8] = {0, std::nan(""), 0};
  std::vector<Hex> cells(CellMeasures::kMost);
  for (int round = 0; round < 200; ++round) {
    for (Hex& cell : cells) {
      for (Index& corner : cell) corner = static_cast<Index>(random.below(points.size()));
    }
    const std::size_t count = 1 + random.below(cells.size());
    std::vector<CellMeasures> all;
    for (const MeasureCells measure : measuresOfCells()) {
      measure(points.data(), std::span(cells).first(count), all.emplace_back());
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto bits = [&](const CellMeasures& of) {
        const bool known = of.inRange[i] != 0;
        return std::tuple(of.inRange[i], std::bit_cast<std::uint64_t>(known ? of.scaled[i] : 0),
                          std::bit_cast<std::uint64_t>(known ? of.corner[i] : 0),
                          std::bit_cast<std::uint64_t>(known ? of.least[i] : 0),
                          std::bit_cast<std::uint64_t>(known ? of.volume[i] : 0));
      };
      for (const CellMeasures& one : all) ASSERT_EQ(bits(one), bits(all[0]));
    }
  }
}
/// All 106 digits of products.
TEST(Twofold, ProductsAreExact) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto a = static_cast<std::int64_t>(random() >> 11U);
    const auto b = -static_cast<std::int64_t>(random() >> (11U + static_cast<unsigned>(i) % 40));
    const Twofold product = exactProduct(static_cast<double>(a), static_cast<double>(b));
    EXPECT_EQ(Integer(product.high) + Integer(product.low), Integer(a) * b);
  }
}

/// Bounds of the least scaled Jacobian are of degree 6 p - 2: up to 52, for which the multiple of
/// all binomials is beyond 64 bits.
TEST(Bezier, WeightsOfHighDegreesCancel) {
  for (const std::size_t size : {3U, 27U, 47U, 53U}) {
    Bezier<double> grid = {{size, 1, 1}, std::vector<double>(size, 1.0)};
    weigh(grid, false);
    EXPECT_GT(grid.values[1], 1);
    weigh(grid, true);
    for (const double value : grid.values) EXPECT_NEAR(value, 1, 1e-15);
  }
}

TEST(Certify, OneCell) {
  const CellCertificate of = certify(cube());
  EXPECT_EQ(of.validity, Validity::Positive);
  EXPECT_NEAR(of.minimum, 1, 1e-9);
  EXPECT_LE(of.minimum, 1);

  std::array<Vec3, 8> flat = cube();
  for (Vec3& corner : flat) corner[2] = 0;
  EXPECT_EQ(certify(flat).validity, Validity::Refuted);
  EXPECT_EQ(certify(flat).scaledJacobian, 0);
  EXPECT_EQ(certify(std::array<Vec3, 8>{}).validity, Validity::Refuted);

  std::array<Vec3, 8> mirrored = cube();
  for (Vec3& corner : mirrored) corner[0] = -corner[0];
  EXPECT_EQ(certify(mirrored).validity, Validity::Refuted);
  EXPECT_DOUBLE_EQ(certify(mirrored).scaledJacobian, -1);
}

TEST(Certify, ZeroAtOnePointIsNotPositive) {
  // One corner in the plane of its three neighbours: zero there and positive elsewhere; and a bit
  // to either side of it.
  std::array<Vec3, 8> corners = cube();
  corners[0] = {1.0 / 4, 1.0 / 4, 1.0 / 2};
  const CellCertificate zero = certify(corners);
  EXPECT_EQ(zero.validity, Validity::Refuted);
  EXPECT_EQ(zero.scaledJacobian, 0);
  EXPECT_EQ(zero.place, (Vec3{0, 0, 0}));
  corners[0][2] = std::nextafter(0.5, 0.0);
  EXPECT_EQ(certify(corners).validity, Validity::Positive);
  corners[0][2] = std::nextafter(0.5, 1.0);
  EXPECT_EQ(certify(corners).validity, Validity::Refuted);
}

TEST(Certify, ZeroAtAThirdOfAnEdge) {
  // Positive but on the edge from corner 0 to corner 1, where the coefficients are 1, -2, 4: the
  // determinant is (3 u - 1)^2, and no halving meets its root.
  constexpr std::array<Vec3, 8> kCorners = {
      {{3, 1, 3}, {4, 2, 1}, {6, 3, 3}, {3, 3, 0}, {2, 1, 4}, {3, 0, 5}, {3, 3, 6}, {0, 3, 6}}};
  const CellCertificate touching = certify(kCorners);
  EXPECT_EQ(touching.validity, Validity::Refuted);
  EXPECT_EQ(touching.scaledJacobian, 0);
  EXPECT_NEAR(touching.place[0], 1 / 3.0, 1e-12);
  EXPECT_EQ(touching.place[1] + touching.place[2], 0);
}

TEST(Certify, AnySizeAndWhatIsNotFinite) {
  for (const double size : {5e-324, 1e-310, 1e-200, 1e-60, 1e60, 1e200, 8e307}) {
    for (const Vec3& sizes : {Vec3{size, size, size}, Vec3{size, 1, 1}, Vec3{1, size, 1 / 3.0}}) {
      std::array<Vec3, 8> corners = cube();
      for (Vec3& corner : corners) {
        for (std::size_t k = 0; k < 3; ++k) corner[k] = (2 * corner[k] - 1) * sizes[k];
      }
      EXPECT_EQ(certify(corners).validity, Validity::Positive) << size;
      std::swap(corners[0], corners[1]);
      EXPECT_EQ(certify(corners).validity, Validity::Refuted) << size;
    }
  }
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    std::array<Vec3, 8> corners = cube();
    corners[6][1] = bad;
    EXPECT_EQ(certify(corners).validity, Validity::Refuted);
    EXPECT_EQ(certify(corners).place, (Vec3{1, 1, 1}));
  }
}

/// Scaled Jacobian at a place, by the definition.
double valueAt(const std::array<Vec3, 8>& corners, const Vec3& place) {
  std::array<std::array<double, 3>, 3> columns{};
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double weight = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        const bool upper = kPlaces[c][a] == 1;
        if (a == axis) {
          weight *= upper ? 1 : -1;
        } else {
          weight *= upper ? place[a] : 1 - place[a];
        }
      }
      for (std::size_t k = 0; k < 3; ++k) columns[axis][k] += weight * corners[c][k];
    }
  }
  const auto& [a, b, c] = columns;
  const double det = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0]);
  return det / (std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]) *
                std::hypot(c[0], c[1], c[2]));
}

TEST(Certify, MinimumIsABoundThatIsReached) {
  Random random(4);
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    std::array<Vec3, 8> corners = cube();
    for (Vec3& corner : corners) {
      for (double& x : corner) x += 0.7 * (random.real() - 0.5);
    }
    const CellCertificate known = certify(corners);
    for (int sample = 0; sample < 300; ++sample) {
      const Vec3 place = {random.real(), random.real(), random.real()};
      ASSERT_LE(known.minimum, valueAt(corners, place) + 1e-12);
    }
    EXPECT_NEAR(valueAt(corners, known.place), known.scaledJacobian, 1e-9);
    EXPECT_EQ(known.validity == Validity::Refuted, known.scaledJacobian <= 0);
    if (known.validity == Validity::Positive) {
      EXPECT_GE(known.minimum, known.scaledJacobian - kMinimumTolerance);
      if (known.scaledJacobian < scaledJacobian(corners) - 1e-3) ++inside;
    }
  }
  EXPECT_GT(inside, 0);
}

TEST(Certify, FirstBoundIsABoundInAnyUnits) {
  Random random(6);
  int positive = 0;
  for (int i = 0; i < 200; ++i) {
    std::array<Vec3, 8> corners = cube();
    for (Vec3& corner : corners) {
      for (double& x : corner) x += 0.6 * (random.real() - 0.5);
    }
    double largest = 0;
    for (Vec3& corner : corners) {
      for (double& x : corner) {
        x -= 0.5;
        largest = std::max(largest, std::abs(x));
      }
    }
    for (Vec3& corner : corners) {
      for (double& x : corner) x *= (i % 2 == 0 ? 0.51 : 0.99) / largest;
    }
    std::array<Vec3, 8> byPlace;
    for (std::size_t c = 0; c < 8; ++c) {
      byPlace[static_cast<std::size_t>(kPlaces[c][0] + 2 * kPlaces[c][1] + 4 * kPlaces[c][2])] =
          corners[c];
    }
    const CellCertificate first = CellValidity(1).examine(byPlace);
    const CellCertificate known = certify(corners);
    if (known.validity == Validity::Positive) ++positive;
    EXPECT_LE(first.minimum, known.scaledJacobian);
  }
  EXPECT_GT(positive, 50);
}

/// A grid with vertices moved at random by up to half of this.
HexMesh jittered(std::size_t n, double amount) {
  HexMesh mesh = gridMesh(n);
  Random random(5);
  for (Vec3& point : mesh.points) {
    for (double& x : point) x += amount * (random.real() - 0.5);
  }
  return mesh;
}

TEST(CertifyMesh, AgreesWithSingleCells) {
  const HexMesh mesh = jittered(12, 1.1);
  Context one(1);
  Context many(3);
  const Certificate certificate = certify(mesh, one);
  const Certificate again = certify(mesh, many);
  EXPECT_EQ(again.scaledJacobians, certificate.scaledJacobians);
  EXPECT_EQ(again.validity, certificate.validity);
  EXPECT_EQ(again.minimum, certificate.minimum);
  EXPECT_EQ(again.quality.mean, certificate.quality.mean);
  EXPECT_EQ(certificate.scaledJacobians, scaledJacobians(mesh, one));
  const QualitySummary summary = summarize(certificate.scaledJacobians);
  EXPECT_EQ(certificate.quality.minimum, summary.minimum);
  EXPECT_NEAR(certificate.quality.mean, summary.mean, 1e-13);
  EXPECT_EQ(certificate.quality.notPositive, summary.notPositive);
  EXPECT_EQ(certificate.quality.histogram, summary.histogram);
  EXPECT_GT(certificate.refuted, summary.notPositive);  // some are positive at corners and centre

  double least = 1;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    std::array<Vec3, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[mesh.cells[c][k]];
    const CellCertificate known = certify(corners);
    EXPECT_EQ(known.validity, certificate.validity[c]);
    least = std::min(least, known.scaledJacobian);
    if (c != certificate.worst.front().cell) continue;
    EXPECT_EQ(known.scaledJacobian, certificate.worst.front().scaledJacobian);
    EXPECT_EQ(known.place, certificate.worst.front().place);
  }
  EXPECT_LE(certificate.minimum, least);
  ASSERT_EQ(certificate.worst.size(), 10U);
  for (const RefutedCell& bad : certificate.worst) {
    EXPECT_EQ(certificate.validity[bad.cell], Validity::Refuted);
    EXPECT_LT(bad.scaledJacobian, 0);
  }
}

TEST(CertifyMesh, SaysWhereTheWorstCellIsBad) {
  HexMesh mesh = gridMesh(3);
  const Index corner = mesh.cells[13][6];
  mesh.points[corner] = {1.1, 1.2, 1.3};  // of the middle cell, moved across it
  Context context;
  const Certificate certificate = certify(mesh, context);
  EXPECT_FALSE(certificate.allPositive());
  EXPECT_EQ(certificate.positive + certificate.refuted, 27U);
  const RefutedCell& bad = certificate.worst.front();
  std::array<Vec3, 8> corners;
  for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[mesh.cells[bad.cell][k]];
  EXPECT_NEAR(valueAt(corners, bad.place), bad.scaledJacobian, 1e-12);
  Vec3 position{};
  for (std::size_t c = 0; c < 8; ++c) {
    double weight = 1;
    for (std::size_t a = 0; a < 3; ++a)
      weight *= kPlaces[c][a] == 1 ? bad.place[a] : 1 - bad.place[a];
    for (std::size_t k = 0; k < 3; ++k) position[k] += weight * corners[c][k];
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(position[k], bad.position[k], 1e-12);
}

TEST(CertifyMesh, MinimumOfAGoodMesh) {
  const HexMesh mesh = jittered(12, 0.4);
  Context context;
  const Certificate certificate = certify(mesh, context);
  EXPECT_TRUE(certificate.allPositive());
  double least = 1;
  for (const Hex& cell : mesh.cells) {
    std::array<Vec3, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[cell[k]];
    least = std::min(least, certify(corners).scaledJacobian);
  }
  EXPECT_LE(certificate.minimum, least);
  EXPECT_GE(certificate.minimum, least - kMinimumTolerance);
}

TEST(CertifyMesh, WithoutCellsOrWithBadOnes) {
  Context context;
  EXPECT_TRUE(certify(HexMesh{}, context).allPositive());
  HexMesh mesh = gridMesh(1);
  mesh.cells[0] = reversed(mesh.cells[0]);
  EXPECT_EQ(certify(mesh, context).refuted, 1U);
  mesh.cells[0].fill(0);
  EXPECT_EQ(certify(mesh, context).refuted, 1U);
  mesh.cells[0][3] = 8;
  EXPECT_THROW(static_cast<void>(certify(mesh, context)), Error);
}

}  // namespace
}  // namespace hexhex::mesh
