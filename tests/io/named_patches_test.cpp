// The boundary by name: which quads, how large, where, and what of it files hold.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/samples.hpp>

#include <io/io_test_support.hpp>

#include "support/error_of.hpp"

namespace hexhex::test::named_patches {
namespace {

std::vector<NamedPatch> patchesOf(const HexMesh& mesh, double angle = 40) {
  Context context;
  return namedPatches(mesh, angle, context);
}

/// 2 x 2 x 2 unit cubes.
HexMesh boxMesh() { return extract(generateSample(SampleKind::Box, {.cells = 1}).map); }

TEST(NamedPatches, OfABox) {
  HexMesh mesh = boxMesh();
  for (Vec3& point : mesh.points) point = {3 * point[0], 2 * point[1], point[2]};
  const std::vector<NamedPatch> patches = patchesOf(mesh);
  ASSERT_EQ(patches.size(), 6U);
  double area = 0;
  for (const NamedPatch& patch : patches) {
    EXPECT_EQ(patch.quads.size(), 4U);
    EXPECT_EQ(patch.tag, 0);
    EXPECT_NEAR(std::hypot(patch.normal[0], patch.normal[1], patch.normal[2]), 1, 1e-12);
    area += patch.area;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The middle of a side, as far outwards as it goes.
      const Vec3 half = {3, 2, 1};
      EXPECT_NEAR(patch.centre[axis], half[axis] * (1 + patch.normal[axis]), 1e-12);
    }
  }
  EXPECT_DOUBLE_EQ(area, 2 * (6 * 4 + 4 * 2 + 2 * 6));
  EXPECT_EQ(patches.front().name, "patch_1");
  const std::vector<NamedPatch> whole = patchesOf(mesh, 0);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(whole[0].name, "boundary");
  EXPECT_NEAR(std::hypot(whole[0].normal[0], whole[0].normal[1], whole[0].normal[2]), 0, 1e-12);
}

TEST(NamedPatches, TheCentreIsThatOfTheArea) {
  HexMesh mesh = boxMesh();
  for (Vec3& point : mesh.points) point[0] *= 1 - point[1] / 4;  // trapezoids, of widths 2 and 1
  std::size_t trapezoids = 0;
  for (const NamedPatch& patch : patchesOf(mesh, 10)) {
    if (std::abs(patch.normal[2]) < 0.5) continue;
    ++trapezoids;
    EXPECT_DOUBLE_EQ(patch.area, 3);
    EXPECT_NEAR(patch.centre[1], 2 * (2 + 2 * 1) / (3 * 3.0), 1e-12);
  }
  EXPECT_EQ(trapezoids, 2U);
}

TEST(NamedPatches, TagsComeFirst) {
  HexMesh mesh = boxMesh();
  const std::vector<Quad> side = patchesOf(mesh)[2].quads;
  for (const Quad& quad : side) mesh.features.quads.push_back({quad, -3});
  // The face of the first cell inside, where x is 1.
  FeatureQuad inner{{}, 8};
  std::size_t found = 0;
  for (const Index v : mesh.cells[0]) {
    if (mesh.points[v][0] == 1) inner.vertices[found++ % 4] = v;
  }
  ASSERT_EQ(found, 4U);
  mesh.features.quads.push_back(inner);
  mesh.features.names = {{2, -3, "inlet"}};
  const std::vector<NamedPatch> patches = patchesOf(mesh);
  ASSERT_EQ(patches.size(), 2U);
  EXPECT_EQ(patches[0].name, "inlet");
  EXPECT_EQ(patches[0].tag, -3);
  EXPECT_EQ(patches[0].quads, side);
  EXPECT_EQ(patches[1].name, "boundary");
  EXPECT_EQ(patches[1].tag, 0);
  EXPECT_EQ(patches[1].quads.size(), 20U);
  // Tags inside alone leave smooth patches, without one.
  mesh.features.quads.erase(mesh.features.quads.begin(), mesh.features.quads.end() - 1);
  ASSERT_EQ(patchesOf(mesh).size(), 6U);
  EXPECT_EQ(patchesOf(mesh)[5].name, "patch_6");
  EXPECT_EQ(patchesOf(mesh)[5].tag, 0);
}

TEST(NamedPatches, RefusesWhatMakesNoSense) {
  HexMesh mesh = boxMesh();
  EXPECT_EQ(codeOf([&] { static_cast<void>(patchesOf(mesh, -1)); }), ErrorCode::InvalidArgument);
  mesh.cells[0][0] = 50;
  EXPECT_EQ(codeOf([&] { static_cast<void>(patchesOf(mesh)); }), ErrorCode::InvalidArgument);
}

/// Whether writesPatches() is right: the angle changes a file if and only if it says so.
TEST(NamedPatches, FilesHoldThemWhereItSaysSo) {
  const TemporaryFolder folder;
  const HexMesh mesh = boxMesh();
  Context context;
  std::size_t with = 0;
  std::size_t without = 0;
  for (const FileFormat& format : fileFormats()) {
    if (!format.writesHexMeshes || format.name == "openfoam") continue;  // which is a folder
    const auto written = [&](double angle) {
      const std::filesystem::path file = folder / "mesh.any";
      WriteOptions options;
      options.format = format.name;
      options.patchAngle = angle;
      writeHexMesh(mesh, file, options, context);
      std::ifstream input(file, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(input), {});
    };
    const bool changes = written(0) != written(40);
    ++(changes ? with : without);
    EXPECT_EQ(writesPatches(folder / "mesh.any", {.format = format.name}), changes) << format.name;
  }
  EXPECT_GE(with, 8U);
  EXPECT_GE(without, 5U);
}

}  // namespace
}  // namespace hexhex::test::named_patches
