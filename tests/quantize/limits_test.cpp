// Quantization of maps and with options at the ends of what numbers can hold; docs/user/limits.md
// lists them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <quantize/seamless/integer_form.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include <lattice/rotation.hpp>

#include "extract/support.hpp"
#include "lattice/random.hpp"
#include "support/error_of.hpp"
#include "support/scaled_map.hpp"

namespace hexhex::test::limits {

using namespace quantization;

using testing::LatticeRandom;

namespace {

QuantizeOptions scale(double factor) {
  QuantizeOptions options;
  options.scale = factor;
  return options;
}

/// A chart for each tet, up to so far away.
TetMap withChartsUpTo(double distance, TetMap map) {
  LatticeRandom random(24);
  const auto draw = [&] {
    return distance * static_cast<double>(random.between(-1000, 1000)) / 999;
  };
  for (TetParameters& tet : map.parameters) {
    const lattice::Rotation rotation(static_cast<int>(random.below(lattice::Rotation::kCount)));
    const Vec3 move = {draw(), draw(), draw()};
    for (Vec3& u : tet) {
      u = rotation(u);
      for (std::size_t k = 0; k < 3; ++k) u[k] += move[k];
    }
  }
  return map;
}

TEST(QuantizeLimits, ChartsMayLieFarAway) {
  const TetMap map = generateSample(SampleKind::Sphere, {.stretch = 0.5}).map;
  const QuantizedMap near = quantize(map, scale(1));
  for (const double distance : {1e3, 1e6, 1e9}) {
    SCOPED_TRACE(distance);
    const QuantizedMap far = quantize(withChartsUpTo(distance, map), scale(1));
    EXPECT_EQ(far.report.cells, near.report.cells);
    EXPECT_LT(far.report.displacement, 1e-9 + 1e-14 * distance);
    EXPECT_EQ(verifiedExtraction(far.map).cells.size(), near.report.cells);
  }
}

TEST(QuantizeLimits, FarChartsTolerateNoMore) {
  const TetMap noisy = generateSample(SampleKind::Sphere, {.noise = 0.005}).map;
  const TetMap far = withChartsUpTo(1e6, noisy);
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(far, scale(1))); }),
            ErrorCode::TransitionResidual);
  Context context;
  EXPECT_EQ(examineSeamless(far, context).kind, examineSeamless(noisy, context).kind);
}

/// Conditions without end.
TEST(QuantizeLimits, NothingAtRandomIsSeamless) {
  HEXHEX_LARGE_TEST();
  TetMap map = generateSample(SampleKind::Sphere, {.refine = 8}).map;
  ASSERT_GT(map.tets.size(), 40'000U);
  LatticeRandom random(7);
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) {
      for (double& x : u) x = static_cast<double>(random.between(-1000, 1000)) / 999;
    }
  }
  Context context;
  EXPECT_EQ(examineSeamless(map, context).kind, SeamlessKind::Neither);
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(map, scale(1))); }),
            ErrorCode::TransitionResidual);
}

/// Whose map is eight orders longer than wide: each arc gets a cell at least, so that nothing keeps
/// its shape.
TEST(QuantizeLimits, LengthsOfEightOrders) {
  constexpr Vec3 kThickness = {1e-4, 1, 1e4};
  for (const SampleKind kind : {SampleKind::Box, SampleKind::HandleBody}) {
    TetMap map = generateSample(kind, {.cells = 2, .refine = 3}).map;
    for (TetParameters& tet : map.parameters) {
      for (Vec3& u : tet) {
        for (std::size_t k = 0; k < 3; ++k) u[k] *= kThickness[k];
      }
    }
    const QuantizedMap result = quantize(map, {.cells = 1000});
    EXPECT_EQ(verifiedExtraction(result.map).cells.size(), result.report.cells);
    EXPECT_LE(result.report.attempts, 2U);
  }
}

/// A vertex whose coordinates are none of those of the boundary.
Index innerVertex(const TetMap& map) {
  const auto [low, high] = std::minmax_element(map.parameters[0].begin(), map.parameters[0].end());
  Vec3 least = *low;
  Vec3 most = *high;
  for (const TetParameters& tet : map.parameters) {
    for (const Vec3& u : tet) {
      for (std::size_t k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], u[k]);
        most[k] = std::max(most[k], u[k]);
      }
    }
  }
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3& u = map.parameters[t][i];
      bool isInner = true;
      for (std::size_t k = 0; k < 3; ++k) isInner = isInner && least[k] < u[k] && u[k] < most[k];
      if (isInner) return map.tets[t][i];
    }
  }
  throw Error(ErrorCode::InvalidArgument, "The map has no vertex inside.");
}

/// Around a curve from (0, 0, 0) to (1, 1, 1), the grid turns by a third.
TetMap withADiagonalCurve() {
  const std::array<Vec3, 3> along = {{{0, 0, 0}, {0.5, 0.5, 0.5}, {1, 1, 1}}};
  const std::array<Vec3, 4> around = {{{1, 0, 0}, {1, 0.6, 0.2}, {0.6, 1, 0.1}, {0, 1, 0}}};
  TetMap map;
  map.points = {{0, 0, 0}, {0, 0, 0.5}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}};
  for (Index k = 0; k < 3; ++k) {
    for (Index i = 0; i < 2; ++i) {
      map.tets.push_back({i, i + 1, 3 + k, 3 + (k + 1) % 3});
      map.parameters.push_back({along[i], along[i + 1], around[k], around[k + 1]});
    }
  }
  return map;
}

TEST(QuantizeLimits, SingularCurvesThatAreParallelToNoAxisAreNamed) {
  const TetMap map = withADiagonalCurve();
  const std::string sentence = "a singular curve is parallel to no axis";
  const Error error = errorOf([&] { static_cast<void>(quantize(map, scale(1))); });
  EXPECT_EQ(error.code(), ErrorCode::TransitionResidual);
  EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  EXPECT_EQ(toString(error.place()), "edge 0-1");
  Context context;
  const SeamlessReport report = examineSeamless(map, context);
  EXPECT_EQ(report.kind, SeamlessKind::Neither);
  EXPECT_NE(report.problem.find(sentence), std::string::npos) << report.problem;
  EXPECT_NE(report.problem.find("edge 0-1"), std::string::npos) << report.problem;
}

/// Far from the nearest map without them: what they turn is not what the error is about.
TEST(QuantizeLimits, FlippedTetsAreNamedBeforeWhatFollowsFromThem) {
  TetMap map =
      generateSample(SampleKind::Box, {.cells = 2, .refine = 2, .charts = ChartStyle::Aligned}).map;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (double& x : map.parameters[t][i]) x *= 1.3;
    }
  }
  // One vertex far away, in all its tets: the map stays seamless.
  const Index v = innerVertex(map);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (map.tets[t][i] == v) map.parameters[t][i][0] += 2.9;
    }
  }
  const Error error = errorOf([&] { static_cast<void>(quantize(map, scale(1))); });
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet) << error.what();
  EXPECT_NE(std::string(error.what()).find(toString(error.place())), std::string::npos)
      << error.what();
  Context context;
  const SeamlessReport report = examineSeamless(map, context);
  EXPECT_EQ(report.kind, SeamlessKind::Neither);
  EXPECT_NE(report.problem.find("flipped"), std::string::npos) << report.problem;
}

/// Arcs are as long as edges of tets, which are flat if these have no length.
TEST(QuantizeLimits, ArcsWithoutALengthAreRefused) {
  TetMap map = generateSample(SampleKind::Box, {.stretch = 0.5}).map;
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) u[2] = 0;
  }
  const ErrorCode code = codeOf([&] { static_cast<void>(quantize(map, scale(1))); });
  EXPECT_TRUE(code == ErrorCode::TransitionResidual || code == ErrorCode::FlippedTet) << name(code);
  Context context;
  EXPECT_EQ(examineSeamless(map, context).kind, SeamlessKind::Neither);
}

/// Left from a map are tets that hang together at edges and vertices only.
TEST(QuantizeLimits, PartsThatTouchAreNoManifold) {
  LatticeRandom random(11);
  int refused = 0;
  for (int round = 0; round < 40; ++round) {
    TetMap map = generateSample(SampleKind::Star, {.cells = 2, .stretch = 0.5}).map;
    const std::uint64_t oneIn = 2 + random.below(20);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      if (random.oneIn(oneIn)) continue;
      map.tets[kept] = map.tets[t];
      map.parameters[kept++] = map.parameters[t];
    }
    map.tets.resize(kept);
    map.parameters.resize(kept);
    Context context;
    EXPECT_EQ(examineSeamless(map, context).kind, SeamlessKind::Neither);
    const ErrorCode code = codeOf([&] { static_cast<void>(quantize(map, scale(1))); });
    refused += code == ErrorCode::NonManifoldEdge || code == ErrorCode::NonManifoldVertex ? 1 : 0;
  }
  EXPECT_GT(refused, 30);
}

TEST(QuantizeLimits, OptionsBeyondAnyMeshAreRefused) {
  TetMap map = generateSample(SampleKind::Box, {.stretch = 0.5}).map;
  const auto code = [&map](const QuantizeOptions& options) {
    return codeOf([&] { static_cast<void>(quantize(map, options)); });
  };
  for (const double huge : {1e4, 1e100, 1e300}) {
    SCOPED_TRACE(huge);
    EXPECT_EQ(code(scale(huge)), ErrorCode::TooLarge);
    EXPECT_EQ(code({.cells = 1e6 * huge}), ErrorCode::TooLarge);
    EXPECT_EQ(code({.edgeLength = 1 / huge}), ErrorCode::TooLarge);
  }
  for (Vec3& p : map.points) p = {1, 1, 1};  // no volume, whatever it is divided by
  EXPECT_EQ(code({.edgeLength = 1e-200}), ErrorCode::TooLarge);
}

TEST(QuantizeLimits, ArraysThatDoNotFitAreRefused) {
  const TetMap map = generateSample(SampleKind::Star, {.stretch = 0.5}).map;
  const auto codeWith = [&map](const auto& damage) {
    TetMap damaged = map;
    damage(damaged);
    Context context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(check(damaged, {}, context)); }),
              codeOf([&] { static_cast<void>(quantize(damaged, scale(1))); }));
    return codeOf([&] { static_cast<void>(quantize(damaged, scale(1))); });
  };
  constexpr Index kBeyond = 0x7fffffff;
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.features.vertices = {{kBeyond, 1}};
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.features.edges = {{{0, kBeyond}, 1}};
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) {
              m.features.faces = {{{0, 1, kBeyond}, 1}};
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](TetMap& m) { m.regions = {1, 2, 3}; }), ErrorCode::InvalidArgument);
}

TEST(QuantizeLimits, SmallAndLargeMapsAreTheSameButForTheirScale) {
  const TetMap map = generateSample(SampleKind::Star, {.stretch = 0.5}).map;
  const QuantizedMap expected = quantize(map, {.cells = 300});
  for (const double factor : {0x1p-90, 0x1p-60, 0x1p40, 0x1p90}) {
    SCOPED_TRACE(factor);
    EXPECT_EQ(quantize(scaled(map, factor), {.cells = 300}).map.parameters,
              expected.map.parameters);
  }
  for (const double factor : {0.0, 0x1p-1000, 0x1p-300, 0x1p300, 0x1p900}) {
    SCOPED_TRACE(factor);
    const TetMap other = scaled(map, factor);
    EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(other, {.cells = 300})); }),
              ErrorCode::TooLarge);
    Context context;
    EXPECT_EQ(examineSeamless(other, context).kind, SeamlessKind::Neither);
  }
}

TEST(IntegerForms, SayWhatDoesNotFit) {
  IntegerForm form(0, std::int64_t{1} << 40);
  const std::vector<std::int64_t> values = {std::int64_t{1} << 61};
  EXPECT_EQ(codeOf([&] { static_cast<void>(form(values)); }), ErrorCode::TooLarge);
  EXPECT_EQ(codeOf([&] { form.multiply(-3); }), ErrorCode::TooLarge);
  EXPECT_EQ(codeOf([&] { form.add(form, 1); }), ErrorCode::TooLarge);
  form.multiply(-1);
  EXPECT_EQ(form.coefficient(0), -(std::int64_t{1} << 40));
  const std::size_t many = 20'000;
  const IntegerSystem system(many, {});
  EXPECT_EQ(codeOf([&] { static_cast<void>(system.nearest(std::vector<double>(many))); }),
            ErrorCode::TooLarge);
}

TEST(IntegerForms, OfASolutionVanish) {
  LatticeRandom random(3);
  int solved = 0;
  for (int round = 0; round < 200; ++round) {
    const auto count = static_cast<Index>(2 + random.below(20));
    std::vector<IntegerForm> equations(random.below(count));
    for (IntegerForm& form : equations) {
      for (int term = 0; term < 3; ++term) {
        form.add({static_cast<Index>(random.below(count)), 1}, random.between(-2, 2));
      }
    }
    const IntegerSystem system(count, equations);
    std::vector<double> wanted(count);
    for (double& x : wanted) x = static_cast<double>(random.between(-1'000'000, 1'000'000));
    const std::vector<std::int64_t> values = system.roundedTo(system.nearest(wanted), 5040);
    EXPECT_GE(system.freeVariables().size() + equations.size(), count);
    if (values.empty()) continue;
    ++solved;
    for (const IntegerForm& form : equations) EXPECT_EQ(form(values), 0);
  }
  EXPECT_GT(solved, 100);
}

}  // namespace

}  // namespace hexhex::test::limits
