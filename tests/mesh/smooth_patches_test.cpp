// Patches between sharp edges, on meshes whose patches are known.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>
#include <hexhex/patches.hpp>

#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

std::map<std::int32_t, std::size_t> sizes(const std::vector<FeatureQuad>& quads) {
  std::map<std::int32_t, std::size_t> counts;
  for (const FeatureQuad& quad : quads) ++counts[quad.tag];
  return counts;
}

std::vector<FeatureQuad> patchesOf(const HexMesh& mesh, double angle, int threads = 2) {
  Context context(threads);
  return boundaryPatches(mesh, angle, context);
}

/// A box of unit cubes.
HexMesh gridMesh(std::size_t x, std::size_t y, std::size_t z) {
  HexMesh mesh;
  const auto at = [&](std::size_t i, std::size_t j, std::size_t k) {
    return static_cast<Index>((k * (y + 1) + j) * (x + 1) + i);
  };
  for (std::size_t k = 0; k <= z; ++k) {
    for (std::size_t j = 0; j <= y; ++j) {
      for (std::size_t i = 0; i <= x; ++i) {
        mesh.points.push_back(
            {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        if (i == x || j == y || k == z) continue;
        mesh.cells.push_back({at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1),
                              at(i, j + 1, k + 1)});
      }
    }
  }
  return mesh;
}

/// A grid of n x 1 x 1 cells, bent so that its top turns by `degrees` at each of its n - 1 seams.
HexMesh bent(std::size_t n, double degrees) {
  HexMesh mesh;
  for (std::size_t i = 0; i <= n; ++i) {
    const double angle = static_cast<double>(i) * degrees * std::numbers::pi / 180;
    for (std::size_t j = 0; j < 4; ++j) {
      const double radius = j / 2 == 0 ? 1 : 2;
      mesh.points.push_back(
          {radius * std::sin(angle), static_cast<double>(j % 2), radius * std::cos(angle)});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = 4 * i;
    const Index b = a + 4;
    mesh.cells.push_back({a, b, b + 1, a + 1, a + 2, b + 2, b + 3, a + 3});
  }
  return mesh;
}

TEST(SmoothPatches, ABoxHasSix) {
  const HexMesh mesh = gridMesh(3, 4, 5);
  const auto counts = sizes(patchesOf(mesh, 40));
  ASSERT_EQ(counts.size(), 6U);
  std::multimap<std::size_t, std::int32_t> bySize;
  for (const auto& [tag, size] : counts) bySize.emplace(size, tag);
  EXPECT_EQ(bySize.count(12), 2U);
  EXPECT_EQ(bySize.count(15), 2U);
  EXPECT_EQ(bySize.count(20), 2U);
  EXPECT_EQ(patchesOf(mesh, 0).size(), 94U);
  EXPECT_EQ(sizes(patchesOf(mesh, 0)).size(), 6U);
  EXPECT_EQ(sizes(patchesOf(mesh, 89.9)).size(), 6U);
  EXPECT_EQ(sizes(patchesOf(mesh, 90.1)).size(), 1U);
  EXPECT_EQ(sizes(patchesOf(mesh, 180)).size(), 1U);
}

TEST(SmoothPatches, TheAngleDecides) {
  const HexMesh mesh = bent(3, 30);
  // Two ends and two flanks; inside and outside are one patch each, or one per cell.
  EXPECT_EQ(sizes(patchesOf(mesh, 31)).size(), 6U);
  EXPECT_EQ(sizes(patchesOf(mesh, 29)).size(), 10U);
}

TEST(SmoothPatches, PatchesAreNumberedInOrder) {
  std::int32_t largest = 0;
  for (const FeatureQuad& quad : patchesOf(bent(4, 30), 10)) {
    EXPECT_LE(quad.tag, largest + 1);
    largest = std::max(largest, quad.tag);
  }
  EXPECT_EQ(largest, 12);
}

TEST(SmoothPatches, SeamsSeparate) {
  HexMesh mesh = gridMesh(2, 1, 1);
  EXPECT_EQ(sizes(patchesOf(mesh, 40)).size(), 6U);
  // One edge across the middle of one face splits that face.
  const auto quads = patchesOf(mesh, 40);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (quads[i].tag != quads[j].tag) continue;
      std::vector<std::uint32_t> common;
      for (const auto v : quads[i].vertices) {
        if (std::count(quads[j].vertices.begin(), quads[j].vertices.end(), v) > 0) {
          common.push_back(v);
        }
      }
      ASSERT_EQ(common.size(), 2U);
      mesh.features.edges = {{{common[0], common[1]}, 4}};
      EXPECT_EQ(sizes(patchesOf(mesh, 40)).size(), 7U);
      EXPECT_EQ(sizes(patchesOf(mesh, 180)).size(), 1U) << "the way round is open";
      mesh.features.edges[0].tag = 0;
      EXPECT_EQ(sizes(patchesOf(mesh, 40)).size(), 6U);
    }
  }
}

TEST(SmoothPatches, ThreadsDoNotMatter) {
  const HexMesh mesh = gridMesh(40, 40, 40);
  const auto one = patchesOf(mesh, 40, 1);
  EXPECT_EQ(sizes(one).size(), 6U);
  for (const int threads : {2, 5}) EXPECT_EQ(one, patchesOf(mesh, 40, threads));
}

TEST(SmoothPatches, RefusesWhatMakesNoSense) {
  HexMesh mesh = gridMesh(1, 1, 1);
  for (const double angle : {-1.0, 180.5, std::nan("")}) {
    EXPECT_EQ(codeOf([&] { static_cast<void>(patchesOf(mesh, angle)); }),
              ErrorCode::InvalidArgument);
  }
  mesh.features.edges = {{{0, 99}, 1}};
  EXPECT_EQ(codeOf([&] { static_cast<void>(patchesOf(mesh, 40)); }), ErrorCode::InvalidArgument);
  mesh.features.edges.clear();
  mesh.cells[0][3] = 8;
  EXPECT_EQ(codeOf([&] { static_cast<void>(patchesOf(mesh, 40)); }), ErrorCode::InvalidArgument);
  EXPECT_TRUE(patchesOf(HexMesh{}, 40).empty());
}

}  // namespace

}  // namespace hexhex::test
