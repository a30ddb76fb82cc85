// What the tests of the extraction share: verified extraction of samples, and comparison of meshes
// up to numbering.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/extract.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/verify.hpp>

#include "support/effort.hpp"

namespace hexhex::test {

/// The text of all failed items, for messages.
inline std::string failures(const VerifyReport& report) {
  std::string text;
  for (const VerifyItem& item : report.items) {
    if (!item.passed) text += item.name + ": expected " + item.expected + ", " + item.found + "; ";
  }
  return text;
}

inline bool sameBits(const HexMesh& a, const HexMesh& b) {
  return a.points == b.points && a.cells == b.cells && a.generatorTet == b.generatorTet &&
         a.generatorCorners == b.generatorCorners;
}

/// The same with the other engine.
inline ExtractOptions withOtherEngine(ExtractOptions options) {
  options.engine = options.engine == Engine::Atlas ? Engine::Propeller : Engine::Atlas;
  return options;
}

/// The same map with rotations that say nothing, which is why no chart is changed.
inline TetMap withChartsKept(TetMap map) {
  map.rotations.assign(map.tets.size(), {-1, -1, -1, -1});
  return map;
}

/// Extracts with both engines, which must agree in every bit, and verifies against the map itself.
inline HexMesh verifiedExtraction(const TetMapView& map, const ExtractOptions& options = {},
                                  int threads = 0) {
  Context context(threads);
  HexMesh mesh = extract(map, options, context);
  VerifyOptions verifyOptions;
  verifyOptions.scale = options.scale;
  verifyOptions.tolerance = options.tolerance;
  verifyOptions.countElements = true;
  const VerifyReport report = verify(map, mesh, verifyOptions);
  EXPECT_TRUE(report.passed()) << failures(report);
  Context other(threads);
  EXPECT_TRUE(sameBits(mesh, extract(map, withOtherEngine(options), other)));
  return mesh;
}

/// A name on the command line, e.g. for SCOPED_TRACE.
inline std::string nameOf(SampleKind kind) {
  for (const SampleKindName& entry : sampleKinds()) {
    if (entry.kind == kind) return std::string(entry.name);
  }
  return "?";
}

/// Numbers the points of mesh `b` like those of `a`, by position: result[i of b] = j of a.
/// Positions may differ by rounding. Points without a partner get kNone.
class PointMatcher {
 public:
  explicit PointMatcher(const HexMesh& mesh) : mesh_(mesh) {
    for (Index i = 0; i < mesh.points.size(); ++i) buckets_[key(mesh.points[i])].push_back(i);
  }
  [[nodiscard]] Index find(const Vec3& p) const {
    const Key home = key(p);
    for (int n = 0; n < 27; ++n) {
      const auto bucket =
          buckets_.find({home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1});
      if (bucket == buckets_.end()) continue;
      for (const Index i : bucket->second) {
        const Vec3& q = mesh_.points[i];
        if (std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < kSame) return i;
      }
    }
    return kNone;
  }

 private:
  // Far above rounding, far below the distance of two vertices of the samples used here.
  static constexpr double kSame = 1e-9;
  using Key = std::array<long long, 3>;
  static Key key(const Vec3& p) {
    return {std::llround(p[0] / (2 * kSame)), std::llround(p[1] / (2 * kSame)),
            std::llround(p[2] / (2 * kSame))};
  }
  const HexMesh& mesh_;
  std::map<Key, std::vector<Index>> buckets_;
};

/// The cell with its corners renumbered, in a form that does not depend on which corner is first:
/// the smallest of the 24 orders of corners of a hexahedron.
inline Hex canonicalCell(const Hex& cell) {
  // Quarter turns about the axis through the bottom face, and about one across it, generate all 24.
  const auto spin = [](const Hex& c) {
    return Hex{c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]};
  };
  const auto tilt = [](const Hex& c) {
    return Hex{c[3], c[2], c[6], c[7], c[0], c[1], c[5], c[4]};
  };
  Hex best = cell;
  std::vector<Hex> seen = {cell};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (const Hex& next : {spin(seen[i]), tilt(seen[i])}) {
      if (std::find(seen.begin(), seen.end(), next) == seen.end()) seen.push_back(next);
    }
    best = std::min(best, seen[i]);
  }
  EXPECT_LE(seen.size(), 24U);
  return best;
}

/// Whether two meshes are the same but for the numbering of vertices and cells.
inline ::testing::AssertionResult sameUpToNumbering(const HexMesh& a, const HexMesh& b) {
  if (a.points.size() != b.points.size() || a.cells.size() != b.cells.size()) {
    return ::testing::AssertionFailure() << "different sizes";
  }
  const PointMatcher matcher(a);
  std::vector<Index> number(b.points.size());
  std::vector<bool> taken(a.points.size(), false);
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    number[i] = matcher.find(b.points[i]);
    if (number[i] == kNone) return ::testing::AssertionFailure() << "point " << i << " is new";
    if (taken[number[i]]) return ::testing::AssertionFailure() << "point " << i << " twice";
    taken[number[i]] = true;
  }
  std::vector<Hex> cellsA;
  std::vector<Hex> cellsB;
  for (const Hex& cell : a.cells) cellsA.push_back(canonicalCell(cell));
  for (Hex cell : b.cells) {
    for (Index& corner : cell) corner = number[corner];
    cellsB.push_back(canonicalCell(cell));
  }
  std::sort(cellsA.begin(), cellsA.end());
  std::sort(cellsB.begin(), cellsB.end());
  if (cellsA != cellsB) return ::testing::AssertionFailure() << "different cells";
  return ::testing::AssertionSuccess();
}

}  // namespace hexhex::test
