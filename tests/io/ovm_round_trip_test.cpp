// Maps and hex meshes through `.ovm` and `.ovmb`: back bit for bit, and the same bytes again.
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <rapidcheck.h>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>

#include <io/formats/formats.hpp>

#include "ovm_test_support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {
namespace {

constexpr std::array<const char*, 2> kFiles = {"a.ovm", "a.ovmb"};

/// Writes, reads, compares, and writes again.
void roundTrip(const TetMap& map) {
  const TemporaryFolder folder;
  for (const char* name : kFiles) {
    writeMap(map, folder / name);
    const TetMap read = readMap(folder / name);
    expectSameMap(map, read);
    expectSameFeatures(map.features, read.features);
    const std::string again = std::string("again") + name;
    writeMap(read, folder / again);
    EXPECT_EQ(contentOf(folder / name), contentOf(folder / again));
  }
}

void roundTrip(const HexMesh& mesh) {
  const TemporaryFolder folder;
  for (const char* name : kFiles) {
    writeHexMesh(mesh, folder / name);
    const HexMesh read = readHexMesh(folder / name);
    expectSameMesh(mesh, read);
    const std::string again = std::string("again") + name;
    writeHexMesh(read, folder / again);
    EXPECT_EQ(contentOf(folder / name), contentOf(folder / again));
  }
}

TEST(OvmRoundTrip, Samples) {
  rc::check("maps come back bit for bit", [] {
    const auto kinds = sampleKinds();
    const SampleKind kind = kinds[*rc::gen::inRange<std::size_t>(0, kinds.size())].kind;
    SampleOptions options;
    options.cells = 2;
    options.refine = *rc::gen::inRange(1, 3);
    options.charts = *rc::gen::element(ChartStyle::Aligned, ChartStyle::Blocks, ChartStyle::Random,
                                       ChartStyle::Scattered);
    options.jitter = *rc::gen::element(0.0, 0.5);
    options.offset = *rc::gen::element(0.0, 1e9);
    options.seed = *rc::gen::arbitrary<std::uint64_t>();
    TetMap map = generateSample(kind, options).map;
    Random random(options.seed);
    if (*rc::gen::arbitrary<bool>()) rotateSome(map, random);
    if (*rc::gen::arbitrary<bool>()) tagSome(map, random);
    if (*rc::gen::arbitrary<bool>()) {
      // Most tets inside out.
      for (std::size_t t = 0; t < map.tets.size(); ++t) {
        std::swap(map.tets[t][1], map.tets[t][3]);
        std::swap(map.parameters[t][1], map.parameters[t][3]);
      }
    }
    roundTrip(map);
    RC_ASSERT(!::testing::Test::HasFailure());
  });
}

TEST(OvmRoundTrip, FeaturesAndRegions) {
  SampleOptions options;
  options.features = true;
  options.cells = 2;
  TetMap map = generateSample(SampleKind::Cylinder, options).map;
  map.regions[5] = -3;
  map.regions[6] = 0;
  const TemporaryFolder folder;
  const HexMesh mesh = extract(map);
  for (const char* name : kFiles) {
    writeMap(map, folder / name);
    const TetMap read = readMap(folder / name);
    EXPECT_EQ(read.regions, map.regions);
    const HexMesh again = extract(read);
    EXPECT_EQ(again.features, mesh.features);
    EXPECT_EQ(again.regions, mesh.regions);
    writeHexMesh(mesh, folder / name);
    const HexMesh readMesh = readHexMesh(folder / name);
    EXPECT_EQ(readMesh.regions, mesh.regions);
    EXPECT_EQ(readMesh.features.edges.size(), mesh.features.edges.size());
    EXPECT_EQ(readMesh.features.quads.size(), mesh.features.quads.size());
    EXPECT_EQ(readMesh.features.vertices, mesh.features.vertices);
    TetMap tooFew = map;
    tooFew.regions.pop_back();
    EXPECT_EQ(codeOf([&] { writeMap(tooFew, folder / name); }), ErrorCode::InvalidArgument);
  }
}

TEST(OvmRoundTrip, AnyCornerOrder) {
  // All 24 orders (12 for each orientation of the whole) of a tet and its neighbour.
  const TetMap original = smallMap();
  for (std::size_t t = 0; t < 2; ++t) {
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    do {
      TetMap map = original;
      for (std::size_t i = 0; i < 4; ++i) {
        map.tets[t][i] = original.tets[t][order[i]];
        map.parameters[t][i] = original.parameters[t][order[i]];
      }
      const TemporaryFolder folder;
      try {
        writeMap(map, folder / "a.ovmb");
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Orientation) << error.what();
        EXPECT_EQ(folder.fileCount(), 0U);
        continue;
      }
      roundTrip(map);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(OvmRoundTrip, AwkwardNumbers) {
  TetMap map = smallMap();
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    for (Vec3& point : map.points) point = {random.anyDouble(), -0.0, 5e-324};
    for (TetParameters& tet : map.parameters) {
      for (Vec3& corner : tet) corner = {random.anyDouble(), 1.7976931348623157e308, -0.0};
    }
    roundTrip(map);
  }
}

TEST(OvmRoundTrip, HexMeshes) {
  rc::check("hex meshes come back bit for bit", [] {
    const auto size = [] { return *rc::gen::inRange<Index>(1, 5); };
    HexMesh mesh = gridMesh(size(), size(), size());
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    // A random one of the 24 orders of corners that keep the orientation; of 48 with both.
    const bool insideOut = *rc::gen::arbitrary<bool>();
    const bool turned = *rc::gen::arbitrary<bool>();
    for (Hex& cell : mesh.cells) {
      if (insideOut)
        cell = {cell[0], cell[3], cell[2], cell[1], cell[4], cell[7], cell[6], cell[5]};
      for (std::size_t i = 0; turned && i < random.below(4); ++i) {
        cell = {cell[1], cell[2], cell[3], cell[0], cell[5], cell[6], cell[7], cell[4]};
        if (random.below(2) == 0) {
          cell = {cell[0], cell[1], cell[5], cell[4], cell[3], cell[2], cell[6], cell[7]};
          cell = {cell[0], cell[3], cell[2], cell[1], cell[4], cell[7], cell[6], cell[5]};
        }
      }
    }
    if (*rc::gen::arbitrary<bool>()) {
      for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        mesh.generatorTet.push_back(random.below(9) == 0 ? kNone : static_cast<Index>(v));
        mesh.generatorCorners.push_back(static_cast<CornerSet>(1 + random.below(15)));
      }
    }
    if (*rc::gen::arbitrary<bool>()) {
      mesh.features.vertices = {{0, 4}, {2, -1}};
      mesh.features.edges = {{{mesh.cells[0][4], mesh.cells[0][0]}, 7}};
      const Hex& last = mesh.cells.back();
      mesh.features.quads = {{{last[6], last[7], last[4], last[5]}, 12}};
    }
    roundTrip(mesh);
    RC_ASSERT(!::testing::Test::HasFailure());
  });
}

TEST(OvmRoundTrip, ExtractedMeshes) {
  for (const SampleKindName& kind : sampleKinds()) {
    SampleOptions options;
    options.charts = ChartStyle::Random;
    options.jitter = 0.3;
    roundTrip(extract(generateSample(kind.kind, options).map));
  }
}

TEST(OvmRoundTrip, EmptyMeshes) {
  const TemporaryFolder folder;
  for (const char* name : kFiles) {
    writeHexMesh(HexMesh{}, folder / name);
    EXPECT_TRUE(readHexMesh(folder / name).cells.empty());
    writeMap(TetMap{}, folder / name);
    EXPECT_TRUE(readMap(folder / name).tets.empty());
  }
}

/// Tets around an axis, whose ends are joined to all other vertices.
TEST(OvmRoundTrip, VerticesWithManyEdges) {
  constexpr Index kAround = 100;
  TetMap map;
  map.points = {{0, 0, -1}, {0, 0, 1}};
  for (Index i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    map.points.push_back({std::cos(angle), std::sin(angle), 0});
    map.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % kAround});
    const Tet& tet = map.tets.back();
    map.parameters.push_back({Vec3{1, 0, 0}, Vec3{2, 0, 0}, Vec3{0, static_cast<double>(tet[2]), 0},
                              Vec3{0, static_cast<double>(tet[3]), 0}});
  }
  // Every edge but those of the circle has a tag, so that all of them have to be found.
  for (Index i = 1; i < kAround + 2; ++i) {
    map.features.edges.push_back({{0, i}, static_cast<std::int32_t>(i)});
  }
  roundTrip(map);
  // The same with the axis behind all others: no vertex has many edges to larger ones.
  const auto moved = [](Index v) { return (v + kAround) % (kAround + 2); };
  TetMap other = map;
  for (Index v = 0; v < map.points.size(); ++v) other.points[moved(v)] = map.points[v];
  for (Tet& tet : other.tets) {
    for (Index& v : tet) v = moved(v);
  }
  for (FeatureEdge& edge : other.features.edges) {
    for (std::uint32_t& v : edge.vertices) v = moved(v);
  }
  roundTrip(other);
}

TEST(OvmRoundTrip, NumberOfThreadsDoesNotMatter) {
  SampleOptions options;
  options.refine = 6;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  const HexMesh mesh = gridMesh(30, 20, 10);
  const TemporaryFolder folder;
  for (const char* name : kFiles) {
    std::array<std::string, 2> maps;
    std::array<std::string, 2> meshes;
    for (const int threads : {1, 2}) {
      Context context(threads);
      const auto i = static_cast<std::size_t>(threads - 1);
      writeMap(map, folder / name, context);
      maps[i] = contentOf(folder / name);
      expectSameMap(map, readMap(folder / name, context));
      writeHexMesh(mesh, folder / name, context);
      meshes[i] = contentOf(folder / name);
    }
    EXPECT_EQ(maps[0], maps[1]);
    EXPECT_EQ(meshes[0], meshes[1]);
  }
}

/// What the slots of a hex cell must fulfil, told from a text file alone.
TEST(OvmRoundTrip, HexSlotsAreAsDescribed) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(1, 1, 1), folder / "a.ovm");
  const std::string text = contentOf(folder / "a.ovm");
  EXPECT_NE(text.find("Edges\n12\n"), std::string::npos);
  // Along the first loop, 0 1 3 2, lie the edges 0 1, 1 3, 2 3 and 0 2 (numbers 0, 3, 5 and 1);
  // across them the slots 2, 4, 3 and 5.
  EXPECT_NE(text.find("Faces\n6\n4 0 6 11 3\n4 18 22 21 17\n4 4 16 9 1\n4 10 14 23 13\n"
                      "4 8 20 15 7\n4 2 12 19 5\nPolyhedra\n1\n6 0 2 4 6 8 10\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("corner_order"), std::string::npos);  // not needed
  EXPECT_TRUE(text.starts_with("OVM ASCII\nVertices\n8\n0 0 0\n")) << text;
}

/// A cell's half-faces point into it, so the first face's loop and the opposite vertex are
/// positive.
TEST(OvmRoundTrip, WritesInwardHalfFaces) {
  const TemporaryFolder folder;
  TetMap map;
  map.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  map.parameters = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  for (const Tet& tet : {Tet{0, 1, 2, 3}, Tet{0, 2, 1, 3}}) {
    map.tets = {tet};
    writeMap(map, folder / "a.ovm");
    const std::string text = contentOf(folder / "a.ovm");
    // Edges 0: 0-1, 1: 0-2, 2: 0-3, 3: 1-2, ...; the first face is 0 -> 1 -> 2 in both cases.
    EXPECT_NE(text.find("Edges\n6\n0 1\n0 2\n0 3\n1 2\n1 3\n2 3\nFaces\n4\n3 0 6 3\n"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("corner_order") == std::string::npos, tet[1] == 1);
    expectSameMap(map, readMap(folder / "a.ovm"));
  }
}

TEST(OvmRoundTrip, GeneratorsHaveTheNamesOfTheField) {
  const TemporaryFolder folder;
  const HexMesh mesh = extract(generateSample(SampleKind::Cylinder, {}).map);
  writeHexMesh(mesh, folder / "mesh.ovm");
  expectSameMesh(mesh, readHexMesh(folder / "mesh.ovm"));
  const std::string text = contentOf(folder / "mesh.ovm");
  const std::string title = "VProp int \"v_tet_generator_type\"\n";
  ASSERT_NE(text.find(title), std::string::npos);
  std::istringstream stream(text.substr(text.find(title) + title.size()));
  std::map<int, int> counts;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    int type = -1;
    ASSERT_TRUE(stream >> type);
    EXPECT_EQ(type, static_cast<int>(generatorKind(mesh.generatorCorners[v])));
    ++counts[type];
  }
  EXPECT_GT(counts[0], 0);
  EXPECT_GT(counts[1], 0);
  // Without the map, which the arrays of a mesh do not hold, there are no indices.
  EXPECT_EQ(text.find("v_tet_generator_index"), std::string::npos);
}

TEST(OvmRoundTrip, WhatTheFormatCannotHoldIsRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const TetMap& map) {
    const Failure failure = failureOf([&] { writeMap(map, folder / "a.ovmb"); });
    EXPECT_EQ(folder.fileCount(), 0U);
    return failure;
  };
  const TetMap good = generateSample(SampleKind::Box, {}).map;
  TetMap bad = good;
  bad.features.edges = {{{0, static_cast<Index>(bad.points.size() - 1)}, 1}};
  EXPECT_EQ(refused(bad).code, ErrorCode::InvalidArgument);
  bad.features.edges = {{{4000000000U, 1}, 1}};
  EXPECT_EQ(refused(bad).code, ErrorCode::InvalidArgument);
  bad = good;
  bad.features.vertices = {{static_cast<Index>(bad.points.size()), 1}};
  EXPECT_EQ(refused(bad).code, ErrorCode::InvalidArgument);
  bad.features.vertices = {{1, 1}, {1, 2}};
  EXPECT_NE(refused(bad).sentence.find("twice"), std::string::npos);
  bad = good;
  bad.features.faces = {{{0, 1, 999}, 1}};
  EXPECT_NE(refused(bad).sentence.find("feature face 0 1 999"), std::string::npos);
  bad = good;
  bad.parameters.pop_back();
  EXPECT_EQ(refused(bad).code, ErrorCode::InvalidArgument);
  bad = good;
  bad.rotations.resize(3);
  EXPECT_EQ(refused(bad).code, ErrorCode::InvalidArgument);
  bad = good;
  bad.tets[3][1] = static_cast<Index>(bad.points.size());
  EXPECT_EQ(toString(refused(bad).place), "tet 3");
  bad = good;
  bad.tets[3][1] = bad.tets[3][0];
  EXPECT_EQ(refused(bad).code, ErrorCode::RepeatedVertex);
  bad = good;
  bad.parameters[5][2][1] = std::nan("");
  EXPECT_EQ(refused(bad).code, ErrorCode::NotFinite);
  bad = good;
  bad.points[5][2] = INFINITY;
  EXPECT_EQ(toString(refused(bad).place), "vertex 5");
  bad = good;
  std::swap(bad.tets[7][0], bad.tets[7][1]);
  EXPECT_EQ(refused(bad).code, ErrorCode::Orientation);
  bad = good;
  for (int i = 0; i < 2; ++i) {
    bad.points.push_back({5, 5, 5.0 + i});
    bad.tets.push_back({bad.tets[0][0], bad.tets[0][1], bad.tets[0][2],
                        static_cast<Index>(bad.points.size() - 1)});
    bad.parameters.push_back(bad.parameters[0]);
  }
  EXPECT_EQ(refused(bad).code, ErrorCode::NonManifoldFace);
}

}  // namespace
}  // namespace hexhex::test
