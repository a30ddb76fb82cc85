// A map as two tet meshes, in every format that holds tets.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include <io/io_test_support.hpp>

namespace hexhex::test {
namespace {

const TetMesh kTets = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.3, 1e-7, 1.0 / 3}},
                       {{0, 1, 2, 3}, {1, 2, 3, 4}}};

TetMesh polycube() {
  TetMesh mesh = kTets;
  for (Vec3& point : mesh.points) {
    for (double& coordinate : point) coordinate = 3 * coordinate - 0.1;
  }
  return mesh;
}

/// Numbers of a text with spaces between them.
std::string join(const auto& numbers, int add = 0) {
  std::string text;
  for (const auto number : numbers) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.17g ", static_cast<double>(number) + add);
    text += digits;
  }
  return text;
}

std::string meditText(const TetMesh& mesh) {
  std::string text =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n" + std::to_string(mesh.points.size()) + "\n";
  for (const Vec3& point : mesh.points) text += join(point) + "0\n";
  text += "Triangles\n1\n1 2 3 1\nTetrahedra\n" + std::to_string(mesh.tets.size()) + "\n";
  for (const Tet& tet : mesh.tets) text += join(tet, 1) + "7\n";
  return text + "End\n";
}

template <class T>
void append(std::string& bytes, T number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string meditBytes(const TetMesh& mesh) {
  std::string bytes;
  const auto section = [&bytes](std::int32_t keyword, std::size_t size) {
    append(bytes, keyword);
    append(bytes, static_cast<std::int32_t>(bytes.size() + 4 + size));
  };
  append(bytes, std::int32_t{1});
  append(bytes, std::int32_t{2});
  section(3, 4);
  append(bytes, std::int32_t{3});
  section(4, 4 + 28 * mesh.points.size());
  append(bytes, static_cast<std::int32_t>(mesh.points.size()));
  for (const Vec3& point : mesh.points) {
    for (const double coordinate : point) append(bytes, coordinate);
    append(bytes, std::int32_t{0});
  }
  section(8, 4 + 20 * mesh.tets.size());
  append(bytes, static_cast<std::int32_t>(mesh.tets.size()));
  for (const Tet& tet : mesh.tets) {
    for (const Index vertex : tet) append(bytes, static_cast<std::int32_t>(vertex + 1));
    append(bytes, std::int32_t{7});
  }
  append(bytes, std::int32_t{54});
  append(bytes, std::int32_t{0});
  return bytes;
}

std::string gmsh22Text(const TetMesh& mesh) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.points.size()) + "\n";
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    text += std::to_string(i + 1) + " " + join(mesh.points[i]) + "\n";
  }
  text += "$EndNodes\n$Elements\n" + std::to_string(mesh.tets.size() + 1) + "\n1 2 2 1 1 1 2 3\n";
  for (const Tet& tet : mesh.tets) text += "2 4 2 1 1 " + join(tet, 1) + "\n";
  return text + "$EndElements\n";
}

std::string gmsh41Text(const TetMesh& mesh) {
  const std::string n = std::to_string(mesh.points.size());
  std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 " + n + " 1 " + n + "\n3 1 0 " + n + "\n";
  for (std::size_t i = 0; i < mesh.points.size(); ++i) text += std::to_string(i + 1) + "\n";
  for (const Vec3& point : mesh.points) text += join(point) + "\n";
  const std::string m = std::to_string(mesh.tets.size());
  text += "$EndNodes\n$Elements\n1 " + m + " 1 " + m + "\n3 1 4 " + m + "\n";
  for (const Tet& tet : mesh.tets) text += "9 " + join(tet, 1) + "\n";
  return text + "$EndElements\n";
}

void writeEverywhere(const TemporaryFolder& folder, const std::string& name, const TetMesh& mesh) {
  writeText(folder / (name + ".mesh"), meditText(mesh));
  writeText(folder / (name + ".meshb"), meditBytes(mesh));
  writeText(folder / (name + ".2.msh"), gmsh22Text(mesh));
  writeText(folder / (name + ".4.msh"), gmsh41Text(mesh));
  // Formats that hold maps: the map is ignored.
  TetMap map{mesh.points, mesh.tets, std::vector<TetParameters>(mesh.tets.size())};
  for (const std::string extension : {".vtk", ".vtu", ".ovm", ".ovmb", ".hexex"}) {
    writeMap(map, folder / (name + extension));
  }
}

const std::vector<std::string> kExtensions = {".mesh", ".meshb", ".2.msh", ".4.msh", ".vtk",
                                              ".vtu",  ".ovm",   ".ovmb",  ".hexex"};

TEST(TetPairs, AnyTwoFormats) {
  const TemporaryFolder folder;
  writeEverywhere(folder, "tets", kTets);
  writeEverywhere(folder, "cube", polycube());
  Context context;
  for (const std::string& first : kExtensions) {
    for (const std::string& second : kExtensions) {
      SCOPED_TRACE(first + " and " + second);
      const TetMap map =
          readMapPair(folder / ("tets" + first), folder / ("cube" + second), context);
      expectSameBits(map.points, kTets.points);
      EXPECT_EQ(map.tets, kTets.tets);
      for (std::size_t t = 0; t < 2; ++t) {
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_TRUE(sameBits(map.parameters[t][i], polycube().points[kTets.tets[t][i]]));
        }
      }
    }
  }
}

TEST(TetPairs, GeneratedPolycubesAreValidMaps) {
  // In an aligned box without transitions, parameters belong to vertices.
  const Sample sample = generateSample(SampleKind::Box, {.cells = 3, .jitter = 0.5});
  const TetMesh tets{sample.map.points, sample.map.tets};
  TetMesh cube = tets;
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      cube.points[tets.tets[t][i]] = sample.map.parameters[t][i];
    }
  }
  Context context;
  const TetMap map = mapFromPair(tets, cube, context);
  EXPECT_EQ(map.parameters, sample.map.parameters);
  const CheckReport report = check(map);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.expected.cells, sample.answer.expected.cells);
}

TEST(TetPairs, CornersMayBeListedInAnotherOrder) {
  Context context;
  TetMesh cube = polycube();
  cube.tets[1] = {4, 2, 1, 3};
  EXPECT_EQ(mapFromPair(kTets, cube, context).parameters,
            mapFromPair(kTets, polycube(), context).parameters);
}

TEST(TetPairs, WhatDoesNotBelongTogether) {
  Context context;
  const auto failure = [&](const TetMesh& cube) {
    return failureOf([&] { static_cast<void>(mapFromPair(kTets, cube, context)); });
  };
  TetMesh cube = polycube();
  cube.points.push_back({});
  EXPECT_NE(failure(cube).sentence.find("has 5 vertices, but the polycube has 6"),
            std::string::npos);
  cube = polycube();
  cube.tets.pop_back();
  EXPECT_NE(failure(cube).sentence.find("has 2 tets, but the polycube has 1"), std::string::npos);
  cube = polycube();
  cube.tets[1] = {0, 2, 3, 4};
  const Failure other = failure(cube);
  EXPECT_EQ(other.code, ErrorCode::InvalidArgument);
  EXPECT_EQ(toString(other.place), "tet 1");
  EXPECT_NE(other.sentence.find("1 2 3 4 in The mesh, but 0 2 3 4 in the polycube"),
            std::string::npos)
      << other.sentence;
  TetMesh wild = kTets;
  wild.tets[0][2] = 99;
  EXPECT_EQ(failureOf([&] { static_cast<void>(mapFromPair(wild, wild, context)); }).code,
            ErrorCode::IndexOutOfRange);

  EXPECT_NE(failureOf([] { static_cast<void>(readMap("a.mesh")); }).sentence.find("--polycube"),
            std::string::npos);
  const TemporaryFolder folder;
  writeText(folder / "a.mesh", meditText(kTets));
  writeText(folder / "b.mesh", meditText(cube));
  const auto fileFailure = [&](const char* first, const char* second) {
    return failureOf(
        [&] { static_cast<void>(readMapPair(folder / first, folder / second, context)); });
  };
  EXPECT_EQ(fileFailure("a.mesh", "b.mesh").code, ErrorCode::FileUnsupported);
  EXPECT_NE(fileFailure("a.mesh", "b.mesh").sentence.find("b.mesh"), std::string::npos);
  for (const std::string name :
       {"h.mesh", "h.meshb", "h.msh", "h.vtk", "h.vtu", "h.ovm", "h.ovmb"}) {
    writeHexMesh(gridMesh(1, 1, 1), folder / name);
    const Failure noTets = fileFailure("a.mesh", name.c_str());
    EXPECT_EQ(noTets.code, ErrorCode::FileUnsupported) << noTets.sentence;
    EXPECT_NE(noTets.sentence.find("tetrahedra"), std::string::npos) << noTets.sentence;
  }
}

}  // namespace
}  // namespace hexhex::test
