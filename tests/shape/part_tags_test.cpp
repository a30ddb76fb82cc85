// Tags of tets, on their way to the groups of a hex mesh: generated parts with known groups, whose
// files other programs' readers would understand, through files and back.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <pipeline/groups.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "io/io_test_support.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test::part_tags {
namespace {

using Cell = CubeBody::Cell;

/// The tag of a place on the boundary.
using TagAt = std::function<std::int32_t(const Vec3& centre)>;

Vec3 centreOf(const std::vector<Vec3>& points, std::span<const Index> vertices) {
  Vec3 centre{};
  for (const Index v : vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] += points[v][k] / static_cast<double>(vertices.size());
    }
  }
  return centre;
}

/// The triangles of one tet alone.
std::vector<std::array<Index, 3>> boundaryOf(const TetMesh& mesh) {
  std::map<std::array<Index, 3>, int> seen;
  for (const Tet& tet : mesh.tets) {
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      std::array<Index, 3> face{};
      std::size_t k = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != skipped) face[k++] = tet[i];
      }
      std::sort(face.begin(), face.end());
      ++seen[face];
    }
  }
  std::vector<std::array<Index, 3>> faces;
  for (const auto& [face, count] : seen) {
    if (count == 1) faces.push_back(face);
  }
  return faces;
}

/// Tags triangles of the boundary by their centres, tets by theirs, and all edges where tags of
/// triangles differ.
void tag(TetMesh& mesh, const TagAt& sideAt, const TagAt& regionAt) {
  std::map<std::array<Index, 2>, std::set<std::int32_t>> around;
  for (const std::array<Index, 3>& face : boundaryOf(mesh)) {
    const std::int32_t side = sideAt(centreOf(mesh.points, face));
    if (side != 0) mesh.features.faces.push_back({face, side});
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = face[i];
      const Index b = face[(i + 1) % 3];
      around[{std::min(a, b), std::max(a, b)}].insert(side);
    }
  }
  for (const auto& [edge, sides] : around) {
    if (sides.size() > 1) mesh.features.edges.push_back({edge, 9});
  }
  for (const Tet& tet : mesh.tets) mesh.regions.push_back(regionAt(centreOf(mesh.points, tet)));
}

constexpr std::array<const char*, 7> kSides = {"",     "inlet", "outlet", "front",
                                               "back", "below", "above"};

/// Of a box from the origin.
std::int32_t sideOfBox(const Vec3& p, const Vec3& size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p[axis] < 1e-9) return static_cast<std::int32_t>(1 + 2 * axis);
    if (p[axis] > size[axis] - 1e-9) return static_cast<std::int32_t>(2 + 2 * axis);
  }
  return 0;
}

TetMesh plainBox(const Cell& size = {2, 2, 1}, int fineness = 3) {
  return CubeBody{size, [](const Cell&) { return true; }}
      .labelled(fineness, [](const Vec3& p) { return p; })
      .tets;
}

TetMesh boxWithSides() {
  TetMesh box = plainBox();
  tag(
      box,
      [](const Vec3& p) {
        return sideOfBox(p, {2, 2, 1});
      },
      [](const Vec3&) { return 1; });
  for (std::int32_t side = 1; side <= 6; ++side) {
    box.features.names.push_back({2, side, kSides[static_cast<std::size_t>(side)]});
  }
  box.features.names.push_back({3, 1, "water"});
  return box;
}

/// Half of it is of another region; its skin has a tag.
TetMesh ballInTwo() {
  TetMesh ball = CubeBody{
      {2, 2, 1}, [](const Cell&) {
        return true;
      }}.labelled(4, [](const Vec3& p) {
          return rounded<3>({p[0] - 1, p[1] - 1, 2 * p[2] - 1});
        }).tets;
  tag(
      ball, [](const Vec3&) { return 5; },
      [](const Vec3& p) { return p[0] + 0.3 * p[1] < 0 ? 2 : 7; });
  return ball;
}

// Files as other programs write them.

void writeGmsh(const TetMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << mesh.features.names.size();
  for (const TagName& name : mesh.features.names) {
    out << '\n' << name.dimension << ' ' << name.tag << " \"" << name.name << '"';
  }
  out << "\n$EndPhysicalNames\n$Nodes\n" << mesh.points.size() << '\n';
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3& p = mesh.points[v];
    out << v + 1 << ' ' << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  std::size_t number = 0;
  out << "$EndNodes\n$Elements\n" << mesh.features.faces.size() + mesh.tets.size() << '\n';
  const auto put = [&](int type, std::int32_t tag, const auto& vertices) {
    out << ++number << ' ' << type << " 2 " << tag << " 1";
    for (const Index v : vertices) out << ' ' << v + 1;
    out << '\n';
  };
  for (const FeatureFace& face : mesh.features.faces) put(2, face.tag, face.vertices);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    put(4, mesh.regions.empty() ? 0 : mesh.regions[t], mesh.tets[t]);
  }
  out << "$EndElements\n";
}

void writeMedit(const TetMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.points.size() << '\n';
  for (const Vec3& p : mesh.points) out << p[0] << ' ' << p[1] << ' ' << p[2] << " 0\n";
  const auto put = [&](const auto& vertices, std::int32_t tag) {
    for (const Index v : vertices) out << v + 1 << ' ';
    out << tag << '\n';
  };
  out << "Edges\n" << mesh.features.edges.size() << '\n';
  for (const FeatureEdge& edge : mesh.features.edges) put(edge.vertices, edge.tag);
  out << "Triangles\n" << mesh.features.faces.size() << '\n';
  for (const FeatureFace& face : mesh.features.faces) put(face.vertices, face.tag);
  out << "Tetrahedra\n" << mesh.tets.size() << '\n';
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) put(mesh.tets[t], mesh.regions[t]);
  out << "End\n";
}

/// Faces of Abaqus' C3D4: 1-2-3, 1-4-2, 2-4-3, 3-4-1.
void writeAbaqus(const TetMesh& mesh, const std::filesystem::path& file) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
      {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  std::ofstream out(file);
  out.precision(17);
  out << "*Heading\n a part\n*Node\n";
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3& p = mesh.points[v];
    out << v + 1 << ", " << p[0] << ", " << p[1] << ", " << p[2] << '\n';
  }
  out << "*Element, type=C3D4, elset=Water\n";
  std::map<std::array<Index, 3>, std::pair<std::size_t, std::size_t>> sides;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    out << t + 1;
    for (const Index v : mesh.tets[t]) out << ", " << v + 1;
    out << '\n';
    for (std::size_t face = 0; face < 4; ++face) {
      std::array<Index, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = mesh.tets[t][kFaces[face][k]];
      std::sort(key.begin(), key.end());
      sides[key] = {t + 1, face + 1};
    }
  }
  for (const TagName& name : mesh.features.names) {
    if (name.dimension != 2) continue;
    out << "*Surface, type=ELEMENT, name=" << name.name << '\n';
    for (const FeatureFace& face : mesh.features.faces) {
      if (face.tag != name.tag) continue;
      const auto& [tet, side] = sides.at(face.vertices);
      out << tet << ", S" << side << '\n';
    }
  }
}

MeshedPart meshed(const TetMesh& tets, double cells, ShapeMethod method = ShapeMethod::Polycube) {
  Context context;
  MeshOptions options;
  options.shape.method = method;
  options.quantize = {.cells = cells, .densify = true};
  MeshedPart part = meshFromTets(tets, options, context);
  EXPECT_TRUE(part.improvement.after.allPositive());
  return part;
}

TetMesh throughFile(const std::filesystem::path& file) {
  Context context;
  return readTetMesh(file, {}, context);
}

/// The names of groups of quads in a file of Gmsh, as text: of each, its number.
std::map<std::string, int> namesIn(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::map<std::string, int> names;
  for (std::string line; std::getline(in, line) && line != "$EndPhysicalNames";) {
    const std::size_t quote = line.find('"');
    if (quote == std::string::npos) continue;
    names[line.substr(quote + 1, line.rfind('"') - quote - 1)] = std::stoi(line.substr(2));
  }
  return names;
}

/// All boundary quads of a box are tagged as where they are.
void expectSides(const HexMesh& mesh, const std::function<std::int32_t(const Vec3&)>& sideAt) {
  std::map<std::int32_t, std::size_t> counts;
  for (const FeatureQuad& quad : mesh.features.quads) {
    Vec3 centre{};
    for (const Index v : quad.vertices) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += mesh.points[v][k] / 4;
    }
    EXPECT_EQ(quad.tag, sideAt(centre));
    ++counts[quad.tag];
  }
  EXPECT_EQ(counts.size(), 6U);
}

TEST(PartTags, OfABoxReachTheFilesOfEveryFormat) {
  const TetMesh box = boxWithSides();
  const TemporaryFolder folder;
  writeGmsh(box, folder / "box.msh");
  const TetMesh read = throughFile(folder / "box.msh");
  EXPECT_EQ(read.features.names, box.features.names);
  EXPECT_EQ(read.regions, box.regions);
  const MeshedPart part = meshed(read, 600);
  const auto sideAt = [](const Vec3& p) { return sideOfBox(p, {2, 2, 1}); };
  expectSides(part.mesh, sideAt);
  for (const char* const name : {"out.msh", "out.mesh", "out.inp", "out.exo", "out.vtu"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path file = folder / name;
    const bool isGmsh = std::string(name) == "out.msh";
    Context context;
    writeHexMesh(part.mesh, file, {.format = isGmsh ? "gmsh22" : ""}, context);
    const HexMesh back = readHexMesh(file);
    if (std::string(name) != "out.inp") {
      expectSides(back, sideAt);  // .inp numbers surfaces in their order, which are by tag
    }
    EXPECT_EQ(back.features.quads.size(), part.mesh.features.quads.size());
  }
  const std::map<std::string, int> names = namesIn(folder / "out.msh");
  for (int side = 1; side <= 6; ++side) {
    EXPECT_EQ(names.at(kSides[static_cast<std::size_t>(side)]), side);
  }
  EXPECT_EQ(names.count("water"), 1U);
  std::ifstream inp(folder / "out.inp");
  const std::string text{std::istreambuf_iterator<char>(inp), {}};
  EXPECT_NE(text.find("NAME=S_INLET"), std::string::npos);
  EXPECT_NE(text.find("ELSET=E_WATER"), std::string::npos);
  const HexMesh again = readHexMesh(folder / "out.inp");
  EXPECT_EQ(again.features.names.front().name, "water");
  EXPECT_EQ(readHexMesh(folder / "out.vtu").features.names, part.mesh.features.names);
}

TEST(PartTags, OfMeditAndAbaqusAreThoseOfGmsh) {
  const TetMesh box = boxWithSides();
  const TemporaryFolder folder;
  writeMedit(box, folder / "box.mesh");
  const TetMesh medit = throughFile(folder / "box.mesh");
  EXPECT_EQ(medit.features.faces, box.features.faces);
  EXPECT_EQ(medit.features.edges, box.features.edges);
  EXPECT_TRUE(medit.regions.empty());  // references that are all 1 say nothing
  writeAbaqus(box, folder / "box.inp");
  const TetMesh abaqus = throughFile(folder / "box.inp");
  EXPECT_EQ(abaqus.features.faces.size(), box.features.faces.size());
  const auto sideAt = [](const Vec3& p) { return sideOfBox(p, {2, 2, 1}); };
  for (const FeatureFace& face : abaqus.features.faces) {
    EXPECT_EQ(face.tag, sideAt(centreOf(box.points, face.vertices)));
  }
  EXPECT_EQ(abaqus.regions, box.regions);
  const auto hasName = [&](const char* name) {
    return std::any_of(abaqus.features.names.begin(), abaqus.features.names.end(),
                       [&](const TagName& known) { return known.name == name; });
  };
  EXPECT_TRUE(hasName("inlet"));
  EXPECT_TRUE(hasName("water"));
}

TEST(PartTags, OfShellsOfAnAbaqusFileAreTheirSets) {
  const TemporaryFolder folder;
  writeText(folder / "gmsh.inp",
            "*Heading\n x\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, type=CPS3, "
            "ELSET=Surface1\n1, 1, 2, 3\n2, 1, 2, 4\n*ELEMENT, type=T3D2, ELSET=Line1\n4, 1, 2\n"
            "*ELEMENT, type=C3D4, ELSET=Volume1\n3, 1, 2, 3, 4\n*ELSET,ELSET=inlet\n1\n"
            "*ELSET,ELSET=all\n1, 2, 3\n");
  const TetMesh read = throughFile(folder / "gmsh.inp");
  const std::vector<FeatureFace> faces = {{{0, 1, 2}, 1}, {{0, 1, 3}, 2}};
  EXPECT_EQ(read.features.faces, faces);
  ASSERT_EQ(read.features.edges.size(), 1U);
  const std::vector<TagName> names = {
      {3, 1, "volume1"}, {2, 1, "inlet"}, {2, 2, "surface1"}, {1, 3, "line1"}};
  EXPECT_EQ(read.features.names, names);
}

TEST(PartTags, OfRegionsAreThoseOfCellsCentres) {
  HEXHEX_LARGE_TEST();
  const TetMesh ball = ballInTwo();
  for (const ShapeMethod method : {ShapeMethod::Polycube, ShapeMethod::Frames}) {
    const MeshedPart part = meshed(ball, 800, method);
    ASSERT_EQ(part.mesh.regions.size(), part.mesh.cells.size());
    EXPECT_EQ(std::set<std::int32_t>(part.mesh.regions.begin(), part.mesh.regions.end()),
              (std::set<std::int32_t>{2, 7}));
    std::size_t wrong = 0;
    for (std::size_t c = 0; c < part.mesh.cells.size(); ++c) {
      Vec3 centre{};
      for (const Index v : part.mesh.cells[c]) {
        for (std::size_t k = 0; k < 3; ++k) centre[k] += part.mesh.points[v][k] / 8;
      }
      const double side = centre[0] + 0.3 * centre[1];
      if (std::abs(side) > 0.15 && (side < 0) != (part.mesh.regions[c] == 2)) ++wrong;
    }
    EXPECT_EQ(wrong, 0U);
    // The slanted face between them is no plane of any map, which the report says.
    EXPECT_GT(part.shape.innerFaces, 0U);
    EXPECT_LT(part.shape.alignedFaces, part.shape.innerFaces);
    EXPECT_LT(part.shape.alignedArea, 1);
    // All of the skin, and nothing else.
    for (const FeatureQuad& quad : part.mesh.features.quads) EXPECT_EQ(quad.tag, 5);
    Context context;
    const std::size_t quads = boundaryPatches(part.mesh, 0, context).size();
    EXPECT_EQ(part.mesh.features.quads.size(), quads);
  }
}

TEST(PartTags, OfAlignedRegionsAreFollowed) {
  TetMesh box = plainBox();
  tag(
      box, [](const Vec3&) { return 0; }, [](const Vec3& p) { return p[0] < 1 ? 1 : 2; });
  const MeshedPart part = meshed(box, 500);
  EXPECT_GT(part.shape.innerFaces, 0U);
  EXPECT_EQ(part.shape.alignedFaces, part.shape.innerFaces);
  EXPECT_EQ(part.shape.alignedArea, 1);
  for (std::size_t c = 0; c < part.mesh.cells.size(); ++c) {
    for (const Index v : part.mesh.cells[c]) {
      const double x = part.mesh.points[v][0];
      EXPECT_TRUE(part.mesh.regions[c] == 1 ? x < 1 + 1e-9 : x > 1 - 1e-9);
    }
  }
}

/// Triangles between tets of two regions.
void tagInterface(TetMesh& mesh, std::int32_t tag) {
  std::map<std::array<Index, 3>, std::set<std::int32_t>> around;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      std::vector<Index> face;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != skipped) face.push_back(mesh.tets[t][i]);
      }
      std::sort(face.begin(), face.end());
      around[{face[0], face[1], face[2]}].insert(mesh.regions[t]);
    }
  }
  for (const auto& [face, regions] : around) {
    if (regions.size() > 1) mesh.features.faces.push_back({face, tag});
  }
}

/// How many faces of cells lie between regions, and how many of these have a tag.
std::array<std::size_t, 2> interfaceOf(const HexMesh& mesh, std::int32_t tag) {
  constexpr std::array<Quad, 6> kFaces = {
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};
  std::map<Quad, std::set<std::int32_t>> around;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (Quad face : kFaces) {
      for (Index& v : face) v = mesh.cells[c][v];
      std::sort(face.begin(), face.end());
      around[face].insert(mesh.regions[c]);
    }
  }
  std::array<std::size_t, 2> counts{};
  for (const auto& [face, regions] : around) counts[0] += regions.size() > 1 ? 1 : 0;
  for (const FeatureQuad& quad : mesh.features.quads) {
    Quad face = quad.vertices;
    std::sort(face.begin(), face.end());
    if (quad.tag == tag && around.at(face).size() > 1) ++counts[1];
  }
  return counts;
}

TEST(PartTags, OfInterfacesArriveWhereTheyAreNoPlanes) {
  HEXHEX_LARGE_TEST();
  // Two halves of a box, along a plane of the map and across; a ball in a ball.
  const std::array<TagAt, 2> halves = {[](const Vec3& p) { return p[0] < 1 ? 1 : 2; },
                                       [](const Vec3& p) { return p[0] + p[1] < 2 ? 1 : 2; }};
  std::vector<TetMesh> parts;
  for (const TagAt& half : halves) {
    parts.push_back(plainBox());
    tag(
        parts.back(), [](const Vec3&) { return 0; }, half);
  }
  parts.push_back(ballInTwo());
  const std::vector<Vec3>& points = parts.back().points;
  double radius = 0;
  for (const Vec3& p : points) radius = std::max(radius, std::hypot(p[0], p[1], p[2]));
  for (std::size_t t = 0; t < parts.back().tets.size(); ++t) {
    const Vec3 centre = centreOf(points, parts.back().tets[t]);
    const bool isInner = std::hypot(centre[0], centre[1], centre[2]) < radius / 2;
    parts.back().regions[t] = isInner ? 1 : 2;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    tagInterface(parts[i], 11);
    parts[i].features.names.push_back({2, 11, "contact"});
    const MeshedPart part = meshed(parts[i], 500);
    const auto [faces, tagged] = interfaceOf(part.mesh, 11);
    EXPECT_GT(faces, 0U);
    EXPECT_EQ(tagged, faces);
    EXPECT_EQ(part.shape.alignedArea == 1, i == 0);
    EXPECT_GT(1 - part.shape.alignedArea, i == 0 ? -1 : 0.2);
    EXPECT_EQ(part.mesh.features.names.front().name, "contact");
  }
}

/// A border on a flat side, along no line of the mesh.
TEST(PartTags, OfPatchesAcrossTheGridAreThoseOfQuadsCentres) {
  TetMesh box = plainBox({2, 2, 1}, 6);
  const TagAt isNear = [](const Vec3& p) {
    return std::hypot(p[0] - 1, p[1] - 1) < 0.6 && p[2] > 1 - 1e-9 ? 3 : 0;
  };
  tag(box, isNear, [](const Vec3&) { return 0; });
  ASSERT_FALSE(box.features.edges.empty());
  const MeshedPart part = meshed(box, 3000);
  ASSERT_FALSE(part.mesh.features.quads.empty());
  double area = 0;
  for (const FeatureQuad& quad : part.mesh.features.quads) {
    EXPECT_EQ(quad.tag, 3);
    Vec3 centre{};
    for (const Index v : quad.vertices) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += part.mesh.points[v][k] / 4;
    }
    EXPECT_LT(std::hypot(centre[0] - 1, centre[1] - 1), 0.75);
    const Vec3& a = part.mesh.points[quad.vertices[0]];
    const Vec3& c = part.mesh.points[quad.vertices[2]];
    area += std::abs((c[0] - a[0]) * (c[1] - a[1]));
  }
  EXPECT_NEAR(area, 3.14159 * 0.36, 0.25);
  // The circle is beside a closed path of edges.
  EXPECT_EQ(part.missingCurves, 0U);
  EXPECT_TRUE(part.missingGroups.empty());
  std::map<Index, int> ends;
  for (const FeatureEdge& edge : part.mesh.features.edges) {
    if (edge.tag != 9) continue;
    for (const Index v : edge.vertices) {
      ++ends[v];
      const Vec3& p = part.mesh.points[v];
      EXPECT_NEAR(std::hypot(p[0] - 1, p[1] - 1), 0.6, 0.25);
    }
  }
  EXPECT_GT(ends.size(), 8U);
  for (const auto& [vertex, count] : ends) EXPECT_EQ(count, 2);
}

TEST(PartTags, OfSurfacesTooSmallForQuadsAreReported) {
  TetMesh box = plainBox({1, 1, 1}, 8);
  const TagAt isSmall = [](const Vec3& p) {
    return p[2] < 1 - 1e-9 ? 0 : std::hypot(p[0] - 0.5, p[1] - 0.5) < 0.15 ? 3 : 4;
  };
  tag(box, isSmall, [](const Vec3&) { return 0; });
  box.features.edges.clear();  // which edges of the mesh would follow
  box.features.names = {{2, 3, "inlet"}};
  EXPECT_EQ(meshed(box, 8).missingGroups, (std::vector<TagName>{{2, 3, "inlet"}}));
}

TEST(PartTags, OfRegionsWithoutCellsAreMissing) {
  TetMap map;
  map.regions = {0, 5, 6, 5};
  map.features.names = {{3, 5, "sensor"}, {3, 6, "body"}};
  HexMesh mesh;
  mesh.regions = {6, 6};
  EXPECT_EQ(pipeline::missingGroups(map, mesh), (std::vector<TagName>{{3, 5, "sensor"}}));
}

TEST(PartTags, AreInTheMapOfTheCommandMap) {
  const TetMesh ball = ballInTwo();
  Context context;
  for (const ShapeMethod method : {ShapeMethod::Polycube, ShapeMethod::Frames}) {
    const TetMap map = mapFromTets(ball, {.method = method}, context).map;
    ASSERT_EQ(map.regions.size(), map.tets.size());
    // The boundary of the map is that of the ball, in parts of its triangles.
    const TetMesh tets = {map.points, map.tets};
    EXPECT_EQ(map.features.faces.size(), boundaryOf(tets).size());
    EXPECT_GE(map.features.faces.size(), ball.features.faces.size());
    std::size_t wrong = 0;
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      const Vec3 p = centreOf(map.points, map.tets[t]);
      if (std::abs(p[0] + 0.3 * p[1]) > 0.15 && (p[0] + 0.3 * p[1] < 0) != (map.regions[t] == 2)) {
        ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0U);
  }
}

}  // namespace
}  // namespace hexhex::test::part_tags
