// Freedoms of vertices, against all positions in a small grid.
#include <random>

#include <gtest/gtest.h>
#include <tetmap/freedom.hpp>

#include <lattice/grid_motion.hpp>

namespace hexhex::tetmap {
namespace {

using Equations = PointEquations<KnownRest>;

/// Charts with random transitions; planes and agreements of some of them that a hidden point
/// fulfils.
struct RandomVertex {
  struct Plane {
    lattice::Transition chart;
    std::size_t axis;
    std::int64_t coordinate;
  };
  std::vector<Plane> planes;
  std::vector<std::array<lattice::Transition, 2>> agreements;

  explicit RandomVertex(std::mt19937& random) {
    const auto number = [&random] { return static_cast<std::int32_t>(random() % 5) - 2; };
    const auto chart = [&] {
      return lattice::Transition{lattice::Rotation(static_cast<int>(random() % 24)),
                                 {number(), number(), number()}};
    };
    const lattice::GridPoint hidden = {number(), number(), number()};
    for (auto count = random() % 3; count > 0; --count) {
      const lattice::Transition plane = chart();
      const std::size_t axis = random() % 3;
      planes.push_back({plane, axis, plane(hidden)[axis]});
    }
    for (auto count = random() % 2; count > 0; --count) {
      const lattice::Transition one = chart();
      lattice::Transition other = chart();
      for (std::size_t k = 0; k < 3; ++k) {
        other.translation[k] += one(hidden)[k] - other(hidden)[k];
      }
      agreements.push_back({one, other});
    }
  }

  [[nodiscard]] bool fulfils(const lattice::GridPoint& u) const {
    return std::all_of(planes.begin(), planes.end(),
                       [&](const Plane& p) { return p.chart(u)[p.axis] == p.coordinate; }) &&
           std::all_of(agreements.begin(), agreements.end(),
                       [&](const auto& charts) { return charts[0](u) == charts[1](u); });
  }

  [[nodiscard]] Equations equations() const {
    Equations equations;
    for (const Plane& p : planes) {
      equations.addPlane(p.chart.rotation, p.axis, {p.chart.translation[p.axis] - p.coordinate});
    }
    for (const auto& [one, other] : agreements) {
      for (std::size_t k = 0; k < 3; ++k) {
        equations.addAgreement(one.rotation, other.rotation, k,
                               {std::int64_t{one.translation[k]} - other.translation[k]});
      }
    }
    return equations;
  }
};

TEST(PointEquations, HaveTheSolutionsOfWhatTheyWereMadeOf) {
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    const RandomVertex vertex(random);
    const Equations::Solution solution = vertex.equations().solve();
    for (const KnownRest& rest : solution.left) EXPECT_EQ(rest.value, 0);
    for (std::int32_t i = 0; i < 343; ++i) {
      const lattice::GridPoint u = {i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3};
      bool isSolution = true;
      for (const auto& [coefficients, rest] : solution.coordinates) {
        std::int64_t sum = rest.value;
        for (std::size_t k = 0; k < 3; ++k) sum += coefficients[k] * u[k];
        isSolution = isSolution && sum == 0;
      }
      ASSERT_EQ(isSolution, vertex.fulfils(u));
    }
  }
}

TEST(PointEquations, KeepContradictions) {
  Equations equations;
  equations.addPlane(lattice::Rotation(), 1, {-3});
  equations.addPlane(lattice::Rotation(), 1, {-4});
  const Equations::Solution solution = std::move(equations).solve();
  ASSERT_EQ(solution.left.size(), 1U);
  EXPECT_NE(solution.left[0].value, 0);
  EXPECT_EQ(solution.coordinates[0].coefficients, (std::array<std::int64_t, 3>{}));
}

/// Axes along which a point of the first chart may move, by moving it.
TEST(FixedAxes, AreThoseAlongWhichAMoveIsSeen) {
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    const lattice::Rotation rotation(r);
    for (int axis = 0; axis < 3; ++axis) {
      FixedAxes plane;
      plane.addPlane(axis, rotation);
      FixedAxes edge;
      edge.addSingularEdge(axis, rotation);
      edge.addSingularEdge(axis, rotation);
      FixedAxes turn;
      turn.addTurn(rotation);
      for (int k = 0; k < 3; ++k) {
        const lattice::Direction move = lattice::direction(k, 1);
        const bool isAlong = lattice::axisOf(rotation(move)) == axis;
        EXPECT_EQ((plane.axes() >> k & 1U) != 0, isAlong);
        EXPECT_EQ((edge.axes() >> k & 1U) != 0, !isAlong);
        EXPECT_EQ((turn.axes() >> k & 1U) != 0, rotation(move) != move);
      }
      FixedAxes node;
      node.addSingularEdge(axis, rotation);
      EXPECT_EQ(node.axes(), lattice::kAllAxes);
    }
  }
}

}  // namespace
}  // namespace hexhex::tetmap
