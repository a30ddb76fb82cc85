// Polycubes of bodies that are far from them: turned, wound up, thin, pierced, rough, or large.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <quantize/polycube/polycube.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test {

namespace {

using Cell = CubeBody::Cell;
using Deformation = std::function<Vec3(const Vec3&)>;

CubeBody block(const Cell& size) {
  return {size, [](const Cell&) { return true; }};
}
CubeBody frame(int length) {
  return {{3, 3, length}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
}

void expectPolycube(const CubeBody& body, int fineness, const Deformation& place, int handles = 0) {
  expectPolycube(body, body.labelled(fineness, place), handles);
}

/// Borders between labels take detours around triangles that get the label beyond.
/// @param share  of the triangles where that is possible
void roughenBorders(Labelled& input, double share) {
  struct Triangle {
    std::array<Index, 3> vertices;
    std::int8_t* label;
  };
  std::vector<Triangle> triangles;
  std::map<std::array<Index, 2>, std::vector<std::size_t>> trianglesAt;
  std::map<Index, std::set<int>> labelsAt;
  for (std::size_t t = 0; t < input.flags.size(); ++t) {
    for (std::size_t face = 0; face < 4; ++face) {
      if (input.flags[t][face] < 0) continue;
      Triangle triangle{{}, &input.flags[t][face]};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.vertices[k] = input.tets.tets[t][(face + k + 1) % 4];
        labelsAt[triangle.vertices[k]].insert(*triangle.label);
      }
      std::sort(triangle.vertices.begin(), triangle.vertices.end());
      const auto& [a, b, c] = triangle.vertices;
      for (const auto& edge : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) {
        trianglesAt[edge].push_back(triangles.size());
      }
      triangles.push_back(triangle);
    }
  }
  std::mt19937 random(3);
  std::set<Index> taken;  // vertices, so that detours do not meet
  for (const auto& [edge, two] : trianglesAt) {
    const Triangle& triangle = triangles[two[0]];
    const std::int8_t beyond = *triangles[two[1]].label;
    std::size_t inFace = 0;
    bool isFree = static_cast<double>(random() % 1000) < 1000 * share;
    for (const Index v : triangle.vertices) {
      inFace += labelsAt[v].size() == 1 ? 1 : 0;
      isFree = isFree && labelsAt[v].size() < 3 && !taken.contains(v);
    }
    if (beyond == *triangle.label || inFace != 1 || !isFree) continue;
    *triangle.label = beyond;
    taken.insert(triangle.vertices.begin(), triangle.vertices.end());
  }
  EXPECT_FALSE(taken.empty());
}

Vec3 ballOf(const Vec3& p) { return rounded<3>({2 * p[0] - 1, 2 * p[1] - 1, 2 * p[2] - 1}); }

TEST(PolycubesFromAfar, AreBallsTurnedByAnyAngle) {
  for (const double turn : {0.8, 1.6, 2.4, std::numbers::pi}) {
    SCOPED_TRACE(turn);
    expectPolycube(block({1, 1, 1}), 4, [&](const Vec3& p) { return turned(ballOf(p), turn); });
  }
}

TEST(PolycubesFromAfar, AreWoundBarrels) {
  for (const double twist : {0.5, 1.0, 1.5}) {
    SCOPED_TRACE(twist);
    expectPolycube(block({1, 1, 1}), 4, [&](const Vec3& p) {
      const double x = 2 * p[0] - 1;
      const double y = 2 * p[1] - 1;
      const double angle = twist * p[2];
      const double width = 1.5 - p[2] * p[2];
      return turned({width * (x * std::cos(angle) - y * std::sin(angle)),
                     width * (x * std::sin(angle) + y * std::cos(angle)), 2 * p[2]},
                    0.5);
    });
  }
}

TEST(PolycubesFromAfar, AreBarsBentToAlmostARing) {
  for (const double angle : {3.0, 4.5, 5.8, 9.0}) {
    for (const int fineness : {1, 2, 3}) {
      SCOPED_TRACE(angle);
      expectPolycube(block({12, 1, 1}), fineness, [&](const Vec3& p) {
        const double at = angle * p[0] / 12;
        const double radius = 12 / angle + p[1];
        return turned({radius * std::sin(at), radius * std::cos(at), p[2] + 0.3 * p[0]}, 0.4);
      });
    }
  }
}

TEST(PolycubesFromAfar, AreTwistedBars) {
  for (const double angle : {1.0, 2.0, 3.1, 5.0, 7.0}) {
    SCOPED_TRACE(angle);
    expectPolycube(block({8, 1, 1}), 3, [&](const Vec3& p) {
      const double at = angle * p[0] / 8;
      const double y = p[1] - 0.5;
      const double z = p[2] - 0.5;
      return Vec3{p[0], y * std::cos(at) - z * std::sin(at), y * std::sin(at) + z * std::cos(at)};
    });
  }
}

TEST(PolycubesFromAfar, AreTori) {
  for (const double turn : {0.5, 1.5, 3.0}) {
    SCOPED_TRACE(turn);
    expectPolycube(
        frame(1), 3,
        [&](const Vec3& p) {
          const Vec3 q = {2 * p[0] - 3, 2 * p[1] - 3, 2 * p[2] - 1};
          const double radius = std::max(std::abs(q[0]), std::abs(q[1]));  // 1 to 3
          const double length = std::hypot(q[0], q[1]);
          const auto [out, up] = rounded<2>({radius - 2, q[2]});
          return turned({(3 + out) * q[0] / length, (3 + out) * q[1] / length, up}, turn);
        },
        1);
  }
}

TEST(PolycubesFromAfar, AreBallsWithAHole) {
  for (const double turn : {0.0, 0.7}) {
    SCOPED_TRACE(turn);
    expectPolycube(
        frame(3), 2,
        [&](const Vec3& p) {
          const Vec3 q = {2 * p[0] / 3 - 1, 2 * p[1] / 3 - 1, 2 * p[2] / 3 - 1};
          return turned(rounded<3>(q), turn);
        },
        1);
  }
}

TEST(PolycubesFromAfar, AreThinPlates) {
  for (const double bend : {0.01, 0.5, 1.5, 3.0}) {
    for (const int fineness : {1, 2}) {
      SCOPED_TRACE(bend);
      expectPolycube(block({8, 8, 1}), fineness, [&](const Vec3& p) {
        const double at = bend * p[0] / 8;
        const double radius = 8 / bend + 0.02 * p[2];
        return turned({radius * std::sin(at), p[1], radius * std::cos(at) - 8 / bend}, 0.3);
      });
    }
  }
}

TEST(PolycubesFromAfar, AreRough) {
  for (const double noise : {0.1, 0.2, 0.25}) {
    SCOPED_TRACE(noise);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-noise, noise);
    expectPolycube(
        {{2, 2, 2},
         [](const Cell& c) {
           return c != Cell{1, 1, 1};
         }},
        3, [&](const Vec3& p) {
          return turned(
              {p[0] + shift(random) / 3, p[1] + shift(random) / 3, p[2] + shift(random) / 3}, 0.6);
        });
  }
}

TEST(PolycubesFromAfar, HaveBordersWithDetours) {
  const CubeBody notched({2, 2, 2}, [](const Cell& c) { return c != Cell{1, 1, 1}; });
  for (const double turn : {0.0, 0.6}) {
    for (const CubeBody& body : {block({1, 1, 1}), notched}) {
      SCOPED_TRACE(turn);
      Labelled input = body.labelled(5, [&](const Vec3& p) { return turned(p, turn); });
      roughenBorders(input, 0.8);
      expectPolycube(body, input);
    }
  }
}

/// Without boundary triangles and edges in the energy, some of these stay folded over.
TEST(PolycubesFromAfar, AreShearedWithDetours) {
  Labelled input = block({1, 1, 1}).labelled(6, [](const Vec3& p) {
    return turned({p[0] + 2 * p[1], p[1] + 2 * p[2], p[2]}, 0.4);
  });
  roughenBorders(input, 1);
  expectPolycube(block({1, 1, 1}), input);
}

TEST(PolycubesFromAfar, MayHaveFiftyThousandTets) {
  HEXHEX_LARGE_TEST();
  expectPolycube(block({1, 1, 1}), 20, [&](const Vec3& p) { return turned(ballOf(p), 0.7); });
}

TEST(PolycubesFromAfar, CanBeCancelledAtEachStep) {
  const Labelled ball =
      block({1, 1, 1}).labelled(8, [](const Vec3& p) { return turned(ballOf(p), 1.2); });
  for (const std::string step : {"labels", "planes", "untangling"}) {
    Context* running = nullptr;
    Context context(1, [&](std::string_view stage, double) {
      if (stage.starts_with(step)) running->cancel();
    });
    running = &context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(mapFromFlags(ball.tets, ball.flags, context)); }),
              ErrorCode::Cancelled)
        << step;
  }
}

TEST(PolycubesFromAfar, SayWhatTheyTook) {
  const Labelled ball =
      block({1, 1, 1}).labelled(8, [](const Vec3& p) { return turned(ballOf(p), 1.2); });
  const auto tets = static_cast<double>(ball.tets.tets.size());
  std::vector<double> steps;
  for (const double given : {1.0, 5e7}) {
    Context context;
    double left = given;
    static_cast<void>(quantization::mapFromLabels(ball.tets, ball.flags, left, context));
    steps.push_back((given - left) / tets);
  }
  EXPECT_GT(steps[0], 1);
  EXPECT_LT(steps[0], 200);
  EXPECT_LE(steps[0], steps[1]);
}

}  // namespace

}  // namespace hexhex::test
