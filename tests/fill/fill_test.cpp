// Runs of meshers: scripts that stand in for them, and those that are installed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/fill.hpp>

#include "io/io_test_support.hpp"
#include "support/error_of.hpp"
#include "surfaces.hpp"

namespace hexhex::test {
namespace {

/// Sets a variable of the environment for a moment.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) {
      before_ = before;
      isSet_ = true;
    }
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { isSet_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
  bool isSet_ = false;
};

/// A shell script in place of Python.
class FakeMesher {
 public:
  explicit FakeMesher(const std::string& script) {
    const std::filesystem::path file = folder_ / "python";
    writeText(file, "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    python_.emplace("HEXHEX_PYTHON", file.string());
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }

 private:
  TemporaryFolder folder_;
  std::optional<Variable> python_;
};

constexpr const char* kTwoTets =
    "MeshVersionFormatted 2\\nDimension 3\\nVertices\\n5\\n0 0 0 0\\n1 0 0 0\\n0 1 0 0\\n0 0 1 0\\n"
    "9 9 9 0\\nTetrahedra\\n2\\n1 2 3 4 0\\n1 2 4 3 0\\nEnd\\n";

TriangleMesh tetSurface() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
}

FilledPart fill(const TriangleMesh& surface, const FillOptions& options = {}) {
  Context context(1);
  return fillSurface(surface, options, context);
}

std::string sentence(const Error& error) { return error.what(); }

void expectWords(const Error& error, const std::vector<std::string>& all) {
  for (const std::string& words : all) {
    EXPECT_NE(sentence(error).find(words), std::string::npos) << words << " in: " << error.what();
  }
}

TEST(Fill, ShowsWhatAMesherSays) {
  const FakeMesher mesher("echo Fake 1.0; echo 'no way to fill' >&2; exit 5\n");
  const Error error = errorOf([] { return fill(boxSurface()); });
  EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
  expectWords(error, {"Fake 1.0 failed with exit code 5", "It said: Fake 1.0 | no way to fill"});
}

TEST(Fill, RefusesBadOutput) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "wrote no mesh"},
      {"echo rubbish > part.mesh", "cannot be read"},
      {"kill -9 $$", "exit code 137"},
      // Two tets in one place: twice the volume.
      {"printf '" + std::string(kTwoTets) + "' > part.mesh", "volume of 0.333"}};
  for (const auto& [script, words] : cases) {
    SCOPED_TRACE(script);
    const FakeMesher mesher("echo Fake\n" + script + "\n");
    const Error error = errorOf([] { return fill(tetSurface()); });
    EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
    expectWords(error, {words});
  }
}

TEST(Fill, TurnsTetsAndLeavesPointsOut) {
  const std::string one = replaced(kTwoTets, "\\n2\\n1 2 3 4 0", "\\n1");  // the negative one
  const FakeMesher mesher("echo Fake 2; printf '" + one + "' > part.mesh; cp part.stl \"$OUT\"\n");
  const Variable out("OUT", (mesher / "seen.stl").string());
  const FilledPart part = fill(tetSurface(), {.tetSize = 0.5});
  ASSERT_EQ(part.tets.tets.size(), 1U);
  EXPECT_EQ(part.tets.points.size(), 4U);
  ASSERT_TRUE(part.report);
  EXPECT_EQ(part.report->mesher, "Fake 2");
  EXPECT_NEAR(part.report->filledVolume, 1.0 / 6, 1e-15);
  EXPECT_EQ(part.report->tetSize, 0.5);
  // What the mesher got is the surface, to the last digit.
  Context context(1);
  const TriangleMesh seen = readTriangleMesh(mesher / "seen.stl", context);
  EXPECT_EQ(seen.points.size(), 4U);
  EXPECT_EQ(seen.triangles.size(), 4U);
}

TEST(Fill, TakesNoTetsOfAnotherShape) {
  // One mesher adds a body of a thousandth of the volume; the next one does not.
  const std::string right = replaced(kTwoTets, "\\n2\\n1 2 3 4 0", "\\n1");
  const std::string wrong =
      "MeshVersionFormatted 2\\nDimension 3\\nVertices\\n8\\n0 0 0 0\\n1 0 0 0\\n0 1 0 0\\n0 0 1 "
      "0\\n"
      "2 0 0 0\\n2.1 0 0 0\\n2 .1 0 0\\n2 0 .1 0\\nTetrahedra\\n2\\n1 2 3 4 0\\n5 6 7 8 0\\nEnd\\n";
  const FakeMesher mesher("echo Fake $3; case $3 in tetwild) printf '" + wrong + "';; *) printf '" +
                          right + "';; esac > part.mesh\n");
  const FilledPart part = fill(tetSurface());
  EXPECT_EQ(part.tets.tets.size(), 1U);
  EXPECT_EQ(part.report->mesher, "Fake netgen");
  ASSERT_EQ(part.warnings.size(), 1U);
  const std::string reason =
      "Fake tetwild changed the shape, as by closing a gap or losing a thin wall or void: the "
      "boundary of its tets has 2 components and the Euler number 4, the surface has 1 and 2.";
  EXPECT_NE(part.warnings[0].find(reason), std::string::npos) << part.warnings[0];
  const Error error = errorOf([] { return fill(tetSurface(), {.mesher = Mesher::TetWild}); });
  EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
  expectWords(error, {reason, "--mesher netgen or gmsh", "--tet-size"});
}

TEST(Fill, WarnsOfTetsThatTouchWithoutSharingVertices) {
  TemporaryFolder folder;
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices\n";
  const std::string first = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  writeText(folder / "apart.mesh", head + "8\n" + first +
                                       "1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n"
                                       "Tetrahedra\n2\n1 2 3 4 0\n5 6 7 8 0\nEnd\n");
  writeText(folder / "glued.mesh",
            head + "5\n" + first + "1 1 1 0\nTetrahedra\n2\n1 2 3 4 0\n2 3 4 5 0\nEnd\n");
  Context context(1);
  const FilledPart apart = readPart(folder / "apart.mesh", {}, context);
  ASSERT_EQ(apart.warnings.size(), 1U);
  EXPECT_NE(apart.warnings[0].find("in 2 components, of which some touch, as at (0, 0, 1)"),
            std::string::npos)
      << apart.warnings[0];
  EXPECT_TRUE(readPart(folder / "glued.mesh", {}, context).warnings.empty());
}

TEST(Fill, SaysHowToInstallAMesher) {
  const FakeMesher mesher("exit 3\n");
  const Variable path("PATH", "/nowhere");
  const Error error = errorOf([] { return fill(boxSurface()); });
  EXPECT_EQ(error.code(), ErrorCode::FileUnsupported);
  expectWords(error, {"`pip install pytetwild`", "HEXHEX_PYTHON"});
  expectWords(errorOf([] { return fill(boxSurface(), {.mesher = Mesher::Netgen}); }),
              {"`pip install netgen-mesher`"});
}

TEST(Fill, EndsTheMesherWhenCancelled) {
  const FakeMesher mesher("echo $$ > \"$OUT\"\nexec sleep 600\n");
  const std::filesystem::path file = mesher / "id";
  const Variable out("OUT", file.string());
  Context context(1);
  std::thread other([&] {
    while (contentOf(file).empty()) std::this_thread::yield();
    context.cancel();
  });
  EXPECT_EQ(codeOf([&] { return fillSurface(boxSurface(), {}, context); }), ErrorCode::Cancelled);
  other.join();
  EXPECT_FALSE(std::filesystem::exists("/proc/" + std::to_string(std::stoi(contentOf(file)))));
}

TEST(Fill, RefusesOptionsThatMeanNothing) {
  TemporaryFolder folder;
  writeText(folder / "tets.mesh",
            "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
            "0 0 1 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n");
  Context context(1);
  EXPECT_FALSE(readPart(folder / "tets.mesh", {}, context).report);
  EXPECT_EQ(codeOf([&] { return readPart(folder / "tets.mesh", {.tetSize = 1}, context); }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(
      codeOf([&] { return readPart(folder / "a.step", {.mesher = Mesher::TetWild}, context); }),
      ErrorCode::InvalidArgument);
  EXPECT_EQ(codeOf([&] { return readPart(folder / "missing.step", {}, context); }),
            ErrorCode::FileNotFound);
  EXPECT_EQ(codeOf([] { return fill(boxSurface(), {.tetSize = -1}); }), ErrorCode::InvalidArgument);
}

// ---- Real meshers ------------------------------------------------------------------------------

/// What tets are, by their faces.
struct Shape {
  double volume = 0;
  double least = 1;     ///< volume of a tet
  double sharp = 0;     ///< length of edges where the boundary turns by more than 40 degrees
  double sharpest = 0;  ///< turn there, in degrees
  double leastSharp = 180;
  long euler = 0;  ///< of the boundary
  bool isClosed = true;
};

Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 crossProduct(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double innerProduct(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Shape shapeOf(const TetMesh& mesh) {
  Shape shape;
  std::map<Triangle, std::pair<int, Triangle>> faces;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const Vec3& o = mesh.points[a];
    const double volume =
        innerProduct(difference(mesh.points[b], o),
                     crossProduct(difference(mesh.points[c], o), difference(mesh.points[d], o))) /
        6;
    shape.volume += volume;
    shape.least = std::min(shape.least, volume);
    for (const Triangle& t : {Triangle{b, c, d}, {a, d, c}, {a, b, d}, {a, c, b}}) {
      Triangle sorted = t;
      std::sort(sorted.begin(), sorted.end());
      auto& [count, face] = faces[sorted];
      ++count;
      face = t;
    }
  }
  std::map<std::pair<Index, Index>, std::vector<Vec3>> edges;
  std::map<Index, int> vertices;
  for (const auto& [sorted, found] : faces) {
    if (found.first != 1) continue;
    ++shape.euler;
    const Triangle& t = found.second;
    Vec3 normal = crossProduct(difference(mesh.points[t[1]], mesh.points[t[0]]),
                               difference(mesh.points[t[2]], mesh.points[t[0]]));
    const double length = std::sqrt(innerProduct(normal, normal));
    for (double& x : normal) x /= length;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[std::minmax(t[i], t[(i + 1) % 3])].push_back(normal);
      vertices[t[i]] = 1;
    }
  }
  shape.euler += static_cast<long>(vertices.size()) - static_cast<long>(edges.size());
  for (const auto& [ends, normals] : edges) {
    if (normals.size() != 2) {
      shape.isClosed = false;
      continue;
    }
    const double turn = std::acos(std::clamp(innerProduct(normals[0], normals[1]), -1.0, 1.0)) *
                        180 / std::numbers::pi;
    if (turn < 40) continue;
    const Vec3 edge = difference(mesh.points[ends.first], mesh.points[ends.second]);
    shape.sharp += std::sqrt(innerProduct(edge, edge));
    shape.sharpest = std::max(shape.sharpest, turn);
    shape.leastSharp = std::min(shape.leastSharp, turn);
  }
  return shape;
}

class RealMesher : public testing::TestWithParam<std::pair<Mesher, const char*>> {
 protected:
  /// Fills a surface, or skips the test.
  std::optional<FilledPart> filled(const TriangleMesh& surface, double size) {
    try {
      return fill(surface, {.mesher = GetParam().first, .tetSize = size});
    } catch (const Error& error) {
      if (error.code() != ErrorCode::FileUnsupported) throw;
      return {};
    }
  }
  static void expectMesh(const Shape& shape, double volume, long euler) {
    EXPECT_TRUE(shape.isClosed);
    EXPECT_GT(shape.least, 0);
    EXPECT_NEAR(shape.volume, volume, 0.1 * volume);  // coarse tets cut round surfaces
    EXPECT_EQ(shape.euler, euler);
  }
};

TEST_P(RealMesher, KeepsEdgesOfACube) {
  const auto part = filled(boxSurface(), 0.25);
  if (!part) GTEST_SKIP() << "not installed";
  const Shape shape = shapeOf(part->tets);
  expectMesh(shape, 1, 2);
  EXPECT_NEAR(shape.sharp, 12, 1e-6);
  EXPECT_NEAR(shape.sharpest, 90, 2);
  EXPECT_NEAR(shape.leastSharp, 90, 2);
}

TEST_P(RealMesher, KeepsCapsOfACylinder) {
  const auto part = filled(cylinderSurface(), 0.25);
  if (!part) GTEST_SKIP() << "not installed";
  const Shape shape = shapeOf(part->tets);
  expectMesh(shape, 32 * std::sin(std::numbers::pi / 16), 2);
  EXPECT_NEAR(shape.sharp, 128 * std::sin(std::numbers::pi / 32), 0.1);
}

TEST_P(RealMesher, KeepsVoidsHandlesAndBodiesApart) {
  const double size = 0.3;
  const auto shell = filled(joined(ballSurface(), ballSurface(0.5)), size);
  if (!shell) GTEST_SKIP() << "not installed";
  EXPECT_EQ(shell->report->voids, 1U);
  expectMesh(shapeOf(shell->tets), shell->report->volume, 4);
  const auto torus = filled(torusSurface(), size);
  expectMesh(shapeOf(torus->tets), torus->report->volume, 0);
  const auto two = filled(joined(boxSurface(), boxSurface({1, 1, 1}, {3, 0, 0})), size);
  EXPECT_EQ(two->report->bodies, 2U);
  expectMesh(shapeOf(two->tets), 2, 4);
}

TEST_P(RealMesher, KeepsASlitOrRefuses) {
  try {
    const auto part = filled(splitRingSurface(0.004), 0.5);
    if (!part) GTEST_SKIP() << "not installed";
    expectMesh(shapeOf(part->tets), 8, 2);
  } catch (const Error& error) {
    EXPECT_EQ(GetParam().first, Mesher::TetWild);
    expectWords(error, {"changed the shape", "has 1 components and the Euler number 0"});
  }
}

TEST_P(RealMesher, WorksFarFromTheOrigin) {
  const auto part = filled(boxSurface({2, 1, 0.5}, {1e6, 1e6, -1e6}), 0.25);
  if (!part) GTEST_SKIP() << "not installed";
  expectMesh(shapeOf(part->tets), 1, 2);
}

TEST(Fill, TriesGmshFirstForAssemblies) {
  TemporaryFolder folder;
  writeText(folder / "part.step", "#1 = PRODUCT('part');\n");
  writeText(folder / "machine.step",
            "#1 = NEXT_ASSEMBLY_USAGE_OCCURRENCE('2','pin','',#5,#3,$);\n");
  const FakeMesher mesher("printf \"$3 \" >> \"$OUT\"; exit 3\n");
  const Variable out("OUT", (mesher / "order").string());
  const Variable path("PATH", "/nowhere");
  const auto orderFor = [&](const char* name) {
    writeText(mesher / "order", "");
    Context context(1);
    EXPECT_EQ(codeOf([&] { return readPart(folder / name, {}, context); }),
              ErrorCode::FileUnsupported);
    return contentOf(mesher / "order");
  };
  EXPECT_EQ(orderFor("part.step"), "netgen gmsh ");
  EXPECT_EQ(orderFor("machine.step"), "gmsh netgen ");
}

/// Writes a STEP file by statements in Python.
/// @return whether a Gmsh is there that does it
bool writeStep(const std::filesystem::path& file, const std::string& statements) {
  const char* const python = std::getenv("HEXHEX_PYTHON");
  const std::string command = (python == nullptr ? std::string("python3") : std::string(python)) +
                              " -c \"import gmsh; gmsh.initialize(interruptible=False); " +
                              statements + "; gmsh.model.occ.synchronize(); gmsh.write('" +
                              file.string() + "')\" > /dev/null 2>&1";
  return std::system(command.c_str()) == 0;  // NOLINT(cert-env33-c): names are our own
}

/// Empty if the mesher is not installed.
std::optional<FilledPart> filledStep(const std::filesystem::path& file, Mesher mesher) {
  Context context(1);
  try {
    return readPart(file, {.mesher = mesher, .tetSize = 0.3}, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::FileUnsupported) throw;
    return {};
  }
}

/// Two boxes of STEP, the second of volume 1.5, moved: filled. Empty if no Gmsh is there to write
/// it.
std::optional<FilledPart> filledBoxes(Mesher mesher, const std::string& placeAndSize) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder / "boxes.step";
  const bool isThere = writeStep(
      file, "gmsh.model.occ.addBox(0,0,0, 1,1,1); gmsh.model.occ.addBox(" + placeAndSize + ")");
  return isThere ? filledStep(file, mesher) : std::nullopt;
}

std::map<std::int32_t, int> regionsOf(const TetMesh& mesh) {
  std::map<std::int32_t, int> regions;
  for (const std::int32_t region : mesh.regions) ++regions[region];
  return regions;
}

TEST(Fill, GluesSolidsOfStepFiles) {
  for (const Mesher mesher : {Mesher::Netgen, Mesher::Gmsh}) {
    SCOPED_TRACE(static_cast<int>(mesher));
    const auto touching = filledBoxes(mesher, "1,0,0, 1.5,1,1");
    if (!touching) GTEST_SKIP() << "not installed";
    EXPECT_TRUE(touching->warnings.empty());
    EXPECT_EQ(regionsOf(touching->tets).size(), 2U);
    const Shape one = shapeOf(touching->tets);
    EXPECT_NEAR(one.volume, 2.5, 1e-6);
    EXPECT_EQ(one.euler, 2);
    const auto overlapping = filledBoxes(mesher, "0.5,0.3,0.2, 1.1,1,1");
    ASSERT_TRUE(overlapping);
    ASSERT_EQ(overlapping->warnings.size(), 1U);
    EXPECT_NE(overlapping->warnings[0].find("Solids overlap"), std::string::npos);
    EXPECT_EQ(regionsOf(overlapping->tets).size(), 3U);
    EXPECT_NEAR(shapeOf(overlapping->tets).volume, 1 + 1.1 - 0.5 * 0.7 * 0.8, 1e-6);
  }
}

/// An assembly of two instances of a box, from a file of one.
std::string asAssembly(const std::string& box) {
  // Entities of Open CASCADE's files: #5 is what a product is, #10 its shape, #11 its axes.
  std::string more =
      "#1000 = SHAPE_DEFINITION_REPRESENTATION(#1001,#1005);\n"
      "#1001 = PRODUCT_DEFINITION_SHAPE('','',#1002);\n"
      "#1002 = PRODUCT_DEFINITION('design','',#1003,#9);\n"
      "#1003 = PRODUCT_DEFINITION_FORMATION('','',#1004);\n"
      "#1004 = PRODUCT('machine','machine','',(#8));\n"
      "#1005 = SHAPE_REPRESENTATION('',(#11,#1016,#1026),#345);\n";
  int id = 1010;
  for (const auto& [name, x] : {std::pair("left_pin", "0."), std::pair("right_pin", "3.")}) {
    const auto ref = [&](int i) { return "#" + std::to_string(id + i); };
    more += ref(0) + " = CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + ref(1) + "," + ref(3) + ");\n" +
            ref(1) + " = ( REPRESENTATION_RELATIONSHIP('','',#10,#1005)\n" +
            "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + ref(2) + ")\n" +
            "SHAPE_REPRESENTATION_RELATIONSHIP() );\n" + ref(2) +
            " = ITEM_DEFINED_TRANSFORMATION('','',#11," + ref(6) + ");\n" + ref(3) +
            " = PRODUCT_DEFINITION_SHAPE('Placement',''," + ref(4) + ");\n" + ref(4) +
            " = NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','" + name + "','',#1002,#5,$);\n" + ref(5) +
            " = CARTESIAN_POINT('',(" + x + ",0.,0.));\n" + ref(6) + " = AXIS2_PLACEMENT_3D(''," +
            ref(5) + ",#13,#14);\n";
    id += 10;
  }
  return replaced(box, "ENDSEC;\nEND-ISO", more + "ENDSEC;\nEND-ISO");
}

TEST(Fill, NamesRegionsByInstancesOfAnAssembly) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder / "machine.step";
  if (!writeStep(file, "gmsh.model.occ.addBox(0,0,0, 1,1,1)")) GTEST_SKIP() << "not installed";
  writeText(file, asAssembly(contentOf(file)));
  const auto machine = filledStep(file, Mesher::Auto);
  ASSERT_TRUE(machine);
  EXPECT_NE(machine->report->mesher.find("gmsh"), std::string::npos) << machine->report->mesher;
  EXPECT_NEAR(shapeOf(machine->tets).volume, 2, 1e-6);
  std::vector<std::string> names;
  for (const TagName& name : machine->tets.features.names) names.push_back(name.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"left_pin", "right_pin"}));
}

INSTANTIATE_TEST_SUITE_P(All, RealMesher,
                         testing::Values(std::pair(Mesher::TetWild, "TetWild"),
                                         std::pair(Mesher::Netgen, "Netgen"),
                                         std::pair(Mesher::Gmsh, "Gmsh"),
                                         std::pair(Mesher::TetGen, "TetGen")),
                         [](const auto& mesher) { return mesher.param.second; });

}  // namespace
}  // namespace hexhex::test
