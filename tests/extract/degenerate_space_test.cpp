// Objects without volume in space, and of any size: connectivity is that of the map, and positions
// are as good as there are numbers.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

TetMap sampleWith(const std::function<Vec3(const Vec3&)>& place, SampleKind kind) {
  SampleOptions options;
  options.cells = 3;
  options.jitter = 0.4;
  options.charts = ChartStyle::Blocks;
  TetMap map = generateSample(kind, options).map;
  for (Vec3& p : map.points) p = place(p);
  return map;
}

/// What `hexhex verify` sees: a mesh that names no tets.
void expectVerified(const TetMap& map) {
  HexMesh mesh = verifiedExtraction(map);
  mesh.generatorTet.clear();
  const VerifyReport report = verify(map, mesh);
  EXPECT_TRUE(report.passed()) << failures(report);
}

TEST(DegenerateSpace, OfAnyShapeIsVerified) {
  for (const SampleKind kind : {SampleKind::Box, SampleKind::Sphere, SampleKind::Star}) {
    SCOPED_TRACE(nameOf(kind));
    expectVerified(sampleWith([](const Vec3&) { return Vec3{5, 5, 5}; }, kind));
    expectVerified(sampleWith([](const Vec3&) { return Vec3{}; }, kind));
    expectVerified(sampleWith([](const Vec3& p) { return Vec3{p[0], p[1], 7}; }, kind));
    expectVerified(sampleWith([](const Vec3& p) { return Vec3{0, p[1], 0}; }, kind));
    // Half of it.
    expectVerified(sampleWith(
        [](const Vec3& p) {
          return Vec3{std::max(p[0], 0.1), p[1], p[2]};
        },
        kind));
    expectVerified(sampleWith([](const Vec3& p) { return Vec3{p[0], p[1], 1e-9 * p[2]}; }, kind));
    expectVerified(sampleWith([](const Vec3& p) { return Vec3{p[0], p[1], 1e-13 * p[2]}; }, kind));
  }
}

TEST(DegenerateSpace, OfAnySizeIsVerified) {
  for (const double size : {1e90, 1e30, 1e-30, 1e-90, 1e-96, 1e-100, 1e-106, 1e-150, 1e-300, 1e-307,
                            1e-310, 1e-316, 1e-320, 5e-324}) {
    SCOPED_TRACE(size);
    expectVerified(sampleWith(
        [&](const Vec3& p) {
          return Vec3{size * p[0], size * p[1], size * p[2]};
        },
        SampleKind::Cylinder));
  }
}

TEST(DegenerateSpace, WrongPositionsAreFound) {
  for (const double size : {1.0, 1e-150, 1e-300, 1e-310}) {
    SCOPED_TRACE(size);
    const TetMap map = sampleWith(
        [&](const Vec3& p) {
          return Vec3{size * p[0], size * p[1], 0};
        },
        SampleKind::Cylinder);
    HexMesh mesh = extract(map);
    mesh.generatorTet.clear();
    mesh.points[20][0] += 1e-3 * size;
    EXPECT_FALSE(verify(map, mesh).passed());
  }
}

TEST(DegenerateSpace, TooLargeForVolumesIsRefused) {
  for (const double size : {1e91, 1e150, 1e307}) {
    const TetMap map = sampleWith(
        [&](const Vec3& p) {
          return Vec3{size * p[0], size * p[1], size * p[2]};
        },
        SampleKind::Box);
    EXPECT_EQ(codeOf([&] { static_cast<void>(extract(map)); }), ErrorCode::TooLarge);
    const CheckReport report = check(map);
    ASSERT_EQ(report.defects.size(), 1U);
    EXPECT_EQ(report.defects[0].code, ErrorCode::TooLarge);
    EXPECT_FALSE(verify(map, {}).passed());
  }
}

}  // namespace

}  // namespace hexhex::test
