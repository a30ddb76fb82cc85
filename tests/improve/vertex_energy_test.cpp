// Energies, derivatives and Bezier coefficients against other ways to compute them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <improve/energy_kernels.hpp>
#include <improve/vertex_energy.hpp>
#include <mesh/cell_measures.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {

using namespace improvement;

namespace {

using hexhex::testing::Random;

/// A unit cube with corners moved by up to so much, by place.
std::array<Vec3, 8> randomCell(Random& random, double amount) {
  std::array<Vec3, 8> corners;
  for (std::size_t place = 0; place < 8; ++place) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners[place][k] = static_cast<double>(place >> k & 1U) + amount * (2 * random.real() - 1);
    }
  }
  return corners;
}

mesh::CellMeasures measured(const std::array<Vec3, 8>& corners) {
  std::array<Vec3, 8> points;
  for (std::size_t place = 0; place < 8; ++place) points[mesh::kVtkCorner[place]] = corners[place];
  const Hex cell = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh::CellMeasures measures;
  mesh::measuresOfCells().back()(points.data(), std::span(&cell, 1), measures);
  return measures;
}

MovingCell moving(const std::array<Vec3, 8>& corners, std::size_t place, const IdealBox& box) {
  std::array<const Vec3*, 8> pointers;
  for (std::size_t i = 0; i < 8; ++i) pointers[i] = &corners[i];
  return movingCell(pointers, place, box);
}

EnergyTerms termsOf(TermKind kind, const std::array<Vec3, 8>& corners, std::size_t place,
                    const IdealBox& box) {
  EnergyTerms terms;
  const MovingCell cell = moving(corners, place, box);
  terms.addCells(std::span(&cell, 1), kind);
  return terms;
}

EnergyTerms cornerTerms(const std::array<Vec3, 8>& corners, std::size_t place,
                        const IdealBox& box) {
  return termsOf(TermKind::Corners, corners, place, box);
}

EnergyTerms bezierTerms(const std::array<Vec3, 8>& corners, std::size_t place,
                        const IdealBox& box) {
  return termsOf(TermKind::Bezier, corners, place, box);
}

}  // namespace

TEST(VertexEnergy, IsOneForEachTermOfTheIdealBox) {
  Random random(1);
  std::array<Vec3, 8> corners = randomCell(random, 0);
  for (Vec3& corner : corners) corner = {2 * corner[0], 3 * corner[1], 0.5 * corner[2]};
  for (std::size_t moving = 0; moving < 8; ++moving) {
    EXPECT_NEAR(energyAt(cornerTerms(corners, moving, {2, 3, 0.5F}), {}, {}), 4, 1e-12);
    EXPECT_NEAR(energyAt(bezierTerms(corners, moving, {2, 3, 0.5F}), {}, {}), 20, 1e-12);
  }
}

/// Each edge has its own: long ones beside short ones cost less than with the means of the cell.
TEST(VertexEnergy, HasIdealEdgesHalfwayToTheirOwnLengths) {
  Random random(7);
  const auto energyOf = [](TermKind kind, const std::array<Vec3, 8>& corners, std::size_t place,
                           const IdealBox& box) {
    return energyAt(termsOf(kind, corners, place, box), {}, {});
  };
  std::array<Vec3, 8> corners = randomCell(random, 0);
  for (Vec3& corner : corners) corner = {1.2 * corner[0], 0.8 * corner[1], corner[2]};
  std::array<Vec3, 8> needle = randomCell(random, 0);
  for (Vec3& corner : needle) corner[2] *= 100;
  for (std::size_t place = 0; place < 8; ++place) {
    EXPECT_NEAR(energyOf(TermKind::OwnCorners, corners, place, {1, 1, 1}),
                energyOf(TermKind::Corners, corners, place, {1.1F, 0.9F, 1}), 3e-3);
    // But twice the length of the box is the most.
    const double longest = energyOf(TermKind::Corners, needle, place, {1, 1, 2});
    EXPECT_NEAR(energyOf(TermKind::OwnCorners, needle, place, {1, 1, 1}), longest, 1e-3 * longest);
  }
  // A frustum: the mean of its horizontal edges is 1.
  corners = randomCell(random, 0);
  for (Vec3& corner : corners) {
    for (std::size_t k = 0; k < 2; ++k) corner[k] *= 1.4 - 0.8 * corner[2];
  }
  for (std::size_t place = 0; place < 8; ++place) {
    EXPECT_LT(energyOf(TermKind::OwnCorners, corners, place, {1, 1, 1}),
              energyOf(TermKind::Corners, corners, place, {1, 1, 1}));
  }
}

/// Their lengths do not follow the vertex, so determinants and their normals are those of the box,
/// by one factor each.
TEST(VertexEnergy, HoldsIdealEdgesWhereTheVertexMoves) {
  Random random(8);
  for (int trial = 0; trial < 100; ++trial) {
    const std::array<Vec3, 8> corners = randomCell(random, 0.3);
    const IdealBox box = {1, 1.5F, 0.7F};
    const std::size_t place = random.below(8);
    const EnergyTerms ofBox = termsOf(TermKind::Corners, corners, place, box);
    const EnergyTerms own = termsOf(TermKind::OwnCorners, corners, place, box);
    ASSERT_EQ(own.blocks().size(), ofBox.blocks().size());
    for (std::size_t i = 0; i < own.blocks().size(); ++i) {
      const TermLanes& a = ofBox.blocks()[i];
      const TermLanes& b = own.blocks()[i];
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(b.normal[k][0] * a.determinant[0], a.normal[k][0] * b.determinant[0], 1e-11);
        // At the other corners, one edge moves.
        if (i == 0) continue;
        EXPECT_NEAR(b.slope[k][0] * a.growth[0], a.slope[k][0] * b.growth[0], 1e-11);
      }
    }
  }
}

TEST(VertexEnergy, KnowsTheLeastBezierCoefficientWhereverTheVertexGoes) {
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    std::array<Vec3, 8> corners = randomCell(random, 0.6);
    const Vec3 step = {random.real() - 0.5, random.real() - 0.5, random.real() - 0.5};
    // All corners together have all coefficients.
    double least = 1e9;
    for (std::size_t moving = 0; moving < 8; ++moving) {
      const EnergyTerms terms = bezierTerms(corners, moving, {1, 1, 1});
      std::array<Vec3, 8> moved = corners;
      moved[moving] = plus(moved[moving], step);
      least = std::min(least, terms.leastDeterminantAt({}));
      EXPECT_GE(terms.leastDeterminantAt(step), measured(moved).least[0] - 1e-12);
    }
    EXPECT_NEAR(least, measured(corners).least[0], 1e-12);
  }
}

TEST(VertexEnergy, HasTheSlopeOfDifferences) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<Vec3, 8> corners = randomCell(random, 0.5);
    const EnergyTerms terms = bezierTerms(corners, random.below(8), {1, 1.5F, 0.7F});
    const EnergyKind kind{trial % 2 == 0 ? 1 : 4, 0.3, trial % 3 == 0 ? 0.1 : 0.0};
    const EnergySlope slope = slopeOf(terms, kind);
    EXPECT_NEAR(slope.energy, energyAt(terms, kind, {}), 1e-9 * slope.energy);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 step{};
      step[k] = 1e-5;
      Vec3 back{};
      back[k] = -1e-5;
      const double difference = (energyAt(terms, kind, step) - energyAt(terms, kind, back)) / 2e-5;
      EXPECT_NEAR(slope.gradient[k], difference, 1e-4 * (slope.energy + std::abs(difference)));
    }
  }
}

TEST(VertexEnergy, HasTheCurvatureOfDifferencesWhereItIsConvex) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const std::array<Vec3, 8> corners = randomCell(random, 0.15);
    const TermKind corner = trial % 3 == 0 ? TermKind::OwnCorners : TermKind::Corners;
    const EnergyTerms terms = termsOf(corner, corners, random.below(8), {1, 1, 1});
    const EnergyKind kind{trial % 2 == 0 ? 1 : 8, 0, 0};
    const EnergySlope slope = slopeOf(terms, kind);
    const Vec3 step = {1e-4 * random.real(), 1e-4 * random.real(), 1e-4 * random.real()};
    const Vec3 back = {-step[0], -step[1], -step[2]};
    const double difference =
        energyAt(terms, kind, step) + energyAt(terms, kind, back) - 2 * slope.energy;
    const auto& h = slope.hessian;
    const double expected =
        h[0] * step[0] * step[0] + h[3] * step[1] * step[1] + h[5] * step[2] * step[2] +
        2 * (h[1] * step[0] * step[1] + h[2] * step[0] * step[2] + h[4] * step[1] * step[2]);
    EXPECT_NEAR(difference, expected, 1e-2 * expected + 1e-12);
    // Hence Newton's step leads downhill.
    const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Vec3 newton = newtonStep(slope, axes);
    EXPECT_LE(dot(newton, slope.gradient), 0);
  }
}

TEST(VertexEnergy, IsTheSameBitsForAllWidthsOfRegisters) {
  Random random(5);
  std::array<std::array<Vec3, 8>, 3> corners;
  std::array<MovingCell, 3> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    corners[i] = randomCell(random, 0.4);
    cells[i] = moving(corners[i], i, {1, 2, 3});
  }
  const EnergyKind kind{2, 0.1, 0.1};
  const Vec3 step = {0.1, -0.2, 0.05};
  const auto results = [&](const EnergyKernels& kernels) {
    std::array<TermLanes, 2 * kCornerTerms + kBezierTerms> terms;
    std::size_t at = 0;
    for (std::size_t i = 0; i < kTermCounts.size(); at += kTermCounts[i++]) {
      kernels.terms[i](cells, &terms[at]);
    }
    EnergySlope slope;
    kernels.slope(terms, kind, slope);
    return std::pair(kernels.energy(terms, kind, step), slope);
  };
  const auto [energy, slope] = results(energyKernels().front());
  for (const EnergyKernels& kernels : energyKernels()) {
    const auto [sameEnergy, sameSlope] = results(kernels);
    EXPECT_EQ(sameEnergy, energy);
    EXPECT_EQ(sameSlope.energy, slope.energy);
    EXPECT_EQ(sameSlope.gradient, slope.gradient);
    EXPECT_EQ(sameSlope.hessian, slope.hessian);
  }
}

/// Lanes that are not used count nothing.
TEST(VertexEnergy, IsTheSumOverCells) {
  Random random(6);
  for (std::size_t n = 1; n <= 9; ++n) {
    std::vector<std::array<Vec3, 8>> corners(n);
    std::vector<MovingCell> cells;
    for (std::array<Vec3, 8>& cell : corners) {
      cell = randomCell(random, 0.2);
      cells.push_back(moving(cell, random.below(8), {1, 1, 1}));
    }
    const EnergyKind kind{4, 0.1, 0.1};
    EnergyTerms together;
    together.addCells(cells, TermKind::Bezier);
    double sum = 0;
    EnergyTerms terms;
    for (const MovingCell& cell : cells) {
      terms.clear();
      terms.addCells(std::span(&cell, 1), TermKind::Bezier);
      sum += energyAt(terms, kind, {});
    }
    EXPECT_NEAR(energyAt(together, kind, {}), sum, 1e-12 * sum);
    EXPECT_NEAR(slopeOf(together, kind).energy, sum, 1e-12 * sum);
  }
}

}  // namespace hexhex::test
