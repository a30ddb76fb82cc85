// Tags of the tets on the mesh: as many hex edges on each curve as it is long in the map, as many
// quads on each patch as it is large, whatever engine, scale, charts and number of threads.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>
#include <hexhex/io.hpp>

#include <igm/igm.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

using Counts = std::map<std::int32_t, std::uint64_t>;

template <class Feature>
Counts countByTag(const std::vector<Feature>& features) {
  Counts counts;
  for (const Feature& feature : features) ++counts[feature.tag];
  return counts;
}

Counts scaled(Counts counts, std::uint64_t factor) {
  for (auto& [tag, count] : counts) count *= factor;
  return counts;
}

struct Case {
  SampleKind kind;
  SampleOptions options;
};

std::vector<Case> samples() {
  std::vector<Case> result;
  std::uint64_t seed = 1;
  for (const SampleKindName& kind : sampleKinds()) {
    for (const ChartStyle charts : {ChartStyle::Aligned, ChartStyle::Random}) {
      Case next{kind.kind, {}};
      next.options.cells = seed % 2 == 0 ? 3 : 5;
      next.options.refine = 2;
      next.options.charts = charts;
      next.options.jitter = 0.3;
      next.options.onLattice = charts == ChartStyle::Random ? 0.3 : 0;
      next.options.noise = 0.001;
      next.options.features = true;
      next.options.seed = seed++;
      result.push_back(next);
    }
  }
  return result;
}

HexMesh extractWith(const TetMap& map, Engine engine, int scale, int threads) {
  ExtractOptions options;
  options.engine = engine;
  options.scale = scale;
  Context context(threads);
  return extract(map, options, context);
}

TEST(Features, LengthsAndAreasOfSamples) {
  for (const Case& each : samples()) {
    SCOPED_TRACE(nameOf(each.kind) + ", seed " + std::to_string(each.options.seed));
    const Sample sample = generateSample(each.kind, each.options);
    const FeatureAnswer& answer = sample.answer.features;
    ASSERT_FALSE(answer.quads.empty());
    for (int scale = 1; scale <= 3; ++scale) {
      const HexMesh mesh = extractWith(sample.map, Engine::Atlas, scale, 2);
      const auto s = static_cast<std::uint64_t>(scale);
      EXPECT_EQ(countByTag(mesh.features.vertices), answer.vertices);
      EXPECT_EQ(countByTag(mesh.features.edges), scaled(answer.edges, s));
      EXPECT_EQ(countByTag(mesh.features.quads), scaled(answer.quads, s * s));
      EXPECT_EQ(mesh.regions.size(), mesh.cells.size());
      if (scale > 2) continue;
      const HexMesh other = extractWith(sample.map, Engine::Propeller, scale, 1);
      EXPECT_TRUE(sameBits(mesh, other));
      EXPECT_EQ(mesh.features, other.features);
      EXPECT_EQ(mesh.regions, other.regions);
    }
  }
}

TEST(Features, ThreadsDoNotMatter) {
  SampleOptions options;
  options.cells = 7;
  options.refine = 3;
  options.charts = ChartStyle::Random;
  options.features = true;
  const Sample sample = generateSample(SampleKind::Cylinder, options);
  const HexMesh one = extractWith(sample.map, Engine::Atlas, 2, 1);
  for (const int threads : {2, 3, 8}) {
    const HexMesh many = extractWith(sample.map, Engine::Atlas, 2, threads);
    EXPECT_EQ(one.features, many.features);
    EXPECT_EQ(one.regions, many.regions);
  }
}

// Blocks whose faces are not moved hold the same number of cells each, and their cells are those
// in the block: the means of the vertices of a box's blocks lie in different octants.
TEST(Features, RegionsOfBlocks) {
  SampleOptions options;
  options.cells = 4;
  options.features = true;
  options.charts = ChartStyle::Random;
  const Sample sample = generateSample(SampleKind::Box, options);
  const HexMesh mesh = extractWith(sample.map, Engine::Atlas, 1, 2);
  Vec3 low = mesh.points[0];
  Vec3 high = mesh.points[0];
  for (const Vec3& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  Counts counts;
  std::map<std::int32_t, std::set<int>> octants;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    ++counts[mesh.regions[c]];
    int octant = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      double mean = 0;
      for (const Index v : mesh.cells[c]) mean += mesh.points[v][k] / 8;
      octant += mean > (low[k] + high[k]) / 2 ? 1 << k : 0;
    }
    octants[mesh.regions[c]].insert(octant);
  }
  EXPECT_EQ(counts.size(), 8U);
  for (const auto& [region, count] : counts) EXPECT_EQ(count, 64U) << region;
  for (const auto& [region, seen] : octants) EXPECT_EQ(seen.size(), 1U) << region;
}

/// Distance of a point from a segment.
double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const auto minus = [](const Vec3& x, const Vec3& y) {
    return Vec3{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  };
  const Vec3 d = minus(b, a);
  const Vec3 q = minus(p, a);
  const double length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const double t = std::clamp((q[0] * d[0] + q[1] * d[1] + q[2] * d[2]) / length, 0.0, 1.0);
  return std::hypot(q[0] - t * d[0], q[1] - t * d[1], q[2] - t * d[2]);
}

// An independent look: vertices of tagged hex edges lie, in space, on tet edges of the same tag.
TEST(Features, TaggedEdgesLieOnTaggedTetEdges) {
  SampleOptions options;
  options.cells = 3;
  options.features = true;
  options.jitter = 0.4;
  const Sample sample = generateSample(SampleKind::HandleBody, options);
  const HexMesh mesh = extractWith(sample.map, Engine::Atlas, 2, 2);
  ASSERT_FALSE(mesh.features.edges.empty());
  for (const FeatureEdge& edge : mesh.features.edges) {
    for (const Index v : edge.vertices) {
      double nearest = 1;
      for (const FeatureEdge& candidate : sample.map.features.edges) {
        if (candidate.tag != edge.tag) continue;
        nearest =
            std::min(nearest, distance(mesh.points[v], sample.map.points[candidate.vertices[0]],
                                       sample.map.points[candidate.vertices[1]]));
      }
      EXPECT_LT(nearest, 1e-12);
    }
  }
  const auto isEdge = [&](const FeatureEdge& edge) {
    return std::any_of(mesh.cells.begin(), mesh.cells.end(), [&](const Hex& cell) {
      return std::count(cell.begin(), cell.end(), edge.vertices[0]) == 1 &&
             std::count(cell.begin(), cell.end(), edge.vertices[1]) == 1;
    });
  };
  EXPECT_TRUE(std::all_of(mesh.features.edges.begin(), mesh.features.edges.end(), isEdge));
}

/// Where tags change in the midst of a hex edge, it gets the one at its smaller vertex: here, each
/// edge of a cube of one cell consists of tet edges with tags of their own.
TEST(Features, TagsOfEdgesAreThoseAtTheSmallerVertex) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SampleOptions options;
    options.cells = 1;
    options.refine = 2;
    options.charts = ChartStyle::Random;
    options.features = true;
    options.seed = seed;
    TetMap map = generateSample(SampleKind::Box, options).map;
    std::int32_t next = 1;
    for (FeatureEdge& edge : map.features.edges) edge.tag = next++;
    const HexMesh mesh = extractWith(map, Engine::Atlas, 1, 1);
    ASSERT_EQ(mesh.features.edges.size(), 12 * 2U);
    for (const FeatureEdge& edge : mesh.features.edges) {
      const auto& ends = map.features.edges[static_cast<std::size_t>(edge.tag) - 1].vertices;
      const Index smaller = std::min(edge.vertices[0], edge.vertices[1]);
      EXPECT_LT(distance(mesh.points[smaller], map.points[ends[0]], map.points[ends[1]]), 1e-12);
    }
  }
}

// Inner faces and edges are tagged like those of the boundary: here the planes between the blocks
// of a box, and the lines in which they meet, found by their coordinates.
TEST(Features, InnerFacesAndEdges) {
  SampleOptions options;
  options.cells = 3;
  options.refine = 2;
  options.charts = ChartStyle::Random;
  Sample sample = generateSample(SampleKind::Box, options);
  TetMap& map = sample.map;
  Vec3 low = map.points[0];
  Vec3 high = map.points[0];
  for (const Vec3& p : map.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const auto isMiddle = [&](Index v, std::size_t k) {
    return std::abs(map.points[v][k] - (low[k] + high[k]) / 2) < 1e-9;
  };
  std::set<std::array<Index, 3>> faces;
  std::set<std::array<Index, 2>> edges;
  for (const Tet& tet : map.tets) {
    for (std::size_t f = 0; f < 4; ++f) {
      std::array<Index, 3> face = {tet[(f + 1) % 4], tet[(f + 2) % 4], tet[(f + 3) % 4]};
      std::sort(face.begin(), face.end());
      const auto inX = [&](Index v) { return isMiddle(v, 0); };
      if (!std::all_of(face.begin(), face.end(), inX)) continue;
      faces.insert(face);
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<Index, 2> edge = {face[i], face[(i + 1) % 3]};
        std::sort(edge.begin(), edge.end());
        if (isMiddle(edge[0], 1) && isMiddle(edge[1], 1)) edges.insert(edge);
      }
    }
  }
  for (const auto& face : faces) map.features.faces.push_back({face, 5});
  for (const auto& edge : edges) map.features.edges.push_back({edge, -7});
  for (int scale = 1; scale <= 2; ++scale) {
    const HexMesh mesh = extractWith(map, Engine::Atlas, scale, 2);
    const auto s = static_cast<std::uint64_t>(scale);
    EXPECT_EQ(countByTag(mesh.features.quads), (Counts{{5, 36 * s * s}}));
    EXPECT_EQ(countByTag(mesh.features.edges), (Counts{{-7, 6 * s}}));
    EXPECT_EQ(mesh.features, extractWith(map, Engine::Propeller, scale, 1).features);
  }
}

/// Tags boundary triangles and singular boundary edges, all with 1.
void tagBoundary(TetMap& map) {
  Context context;
  igm::DefectCollector defects;
  const igm::PreparedMap prepared = igm::prepareMap(map, 0.01, 1, context, defects);
  for (adjacency::HalfFace h = 0; h < prepared.topology.mate.size(); ++h) {
    if (!prepared.topology.isBoundary(h)) continue;
    FeatureFace face{{}, 1};
    for (std::size_t i = 0; i < 3; ++i) {
      const int corner = lattice::kFaceCorners[static_cast<std::size_t>(adjacency::localOf(h))][i];
      face.vertices[i] =
          prepared.topology.vertex(4 * adjacency::tetOf(h) + static_cast<Index>(corner));
    }
    map.features.faces.push_back(face);
  }
  for (const igm::SingularEdge& edge : prepared.singularities.edges) {
    if (edge.boundary) map.features.edges.push_back({{edge.vertex0, edge.vertex1}, 1});
  }
}

// Real maps, which carry no tags: their singular boundary edges become the curves, their boundary
// triangles one patch. The numbers follow from the map.
TEST(Features, RealMaps) {
  const std::string folder = std::string(HEXHEX_DATA_DIR) + "/maps/";
  bool found = false;
  for (const char* name : {"fandisk_r1", "n12c_limit_cycle_r10", "double-torus_r1"}) {
    const std::string file = folder + name + ".hexex";
    if (!std::filesystem::exists(file)) continue;
    found = true;
    SCOPED_TRACE(name);
    TetMap map = readMap(file);
    tagBoundary(map);
    for (int scale = 1; scale <= 2; ++scale) {
      CheckOptions options;
      options.scale = scale;
      const Expectation expected = check(map, options).expected;
      std::uint64_t singular = 0;
      for (const auto& [valence, count] : expected.boundarySingularEdges) singular += count;
      const HexMesh mesh = extractWith(map, Engine::Atlas, scale, 2);
      EXPECT_EQ(mesh.features.quads.size(), expected.boundaryQuads);
      EXPECT_EQ(mesh.features.edges.size(), singular);
      EXPECT_EQ(mesh.features, extractWith(map, Engine::Propeller, scale, 1).features);
    }
  }
  if (!found) GTEST_SKIP() << "no real maps in " << folder;
}

TEST(Features, WithoutTagsNothingIsComputed) {
  const Sample sample = generateSample(SampleKind::Sphere);
  Context context;
  const HexMesh mesh = extract(sample.map, {}, context);
  EXPECT_TRUE(mesh.features.empty());
  EXPECT_TRUE(mesh.regions.empty());
  for (const StageTime& stage : context.stageTimes()) EXPECT_NE(stage.stage, "features");
}

void expectRefused(const TetMap& map) {
  try {
    static_cast<void>(extract(map));
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument) << error.what();
  }
}

TEST(Features, RefusesWhatMakesNoSense) {
  const TetMap untouched = generateSample(SampleKind::Box).map;
  const auto points = static_cast<Index>(untouched.points.size());
  TetMap map = untouched;
  map.features.vertices = {{points, 1}};
  expectRefused(map);
  map = untouched;
  map.features.edges = {{{0, points}, 1}};
  expectRefused(map);
  map = untouched;
  map.features.faces = {{{0, 1, points}, 1}};
  expectRefused(map);
  map = untouched;
  map.features.vertices = {{3, 1}, {3, 2}};
  expectRefused(map);
  map = untouched;
  map.features.edges = {{{3, 4}, 1}, {{4, 3}, 2}};
  expectRefused(map);
  map = untouched;
  map.features.faces = {{{3, 4, 5}, 1}, {{5, 3, 4}, 2}};
  expectRefused(map);
  map = untouched;
  map.regions = {1, 2, 3};
  expectRefused(map);
}

TEST(Features, TagsOfNothingHaveNoEffect) {
  TetMap map = generateSample(SampleKind::Box).map;
  const auto last = static_cast<Index>(map.points.size() - 1);
  map.features.vertices = {{0, 0}};
  map.features.edges = {{{0, last}, 3}, {{0, 1}, 0}};
  map.features.faces = {{{0, 1, last}, 3}};
  const HexMesh mesh = extract(map);
  EXPECT_TRUE(mesh.features.empty());
}

}  // namespace

}  // namespace hexhex::test
