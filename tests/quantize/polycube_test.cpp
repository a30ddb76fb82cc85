// Polycubes by labels: from a tet mesh whose boundary triangles say which way they are to face.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/tet_topology.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <hexhex/hexhex.hpp>

#include <base/stage.hpp>
#include <io/io_test_support.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test {

namespace {

/// What a sample with one chart says.
Labelled labelled(const TetMap& map) {
  Labelled result{{map.points, map.tets}, {}};
  Context context;
  Stage stage(context, "test");
  const adjacency::TetTopology topology =
      adjacency::manifoldTopology(map.tets, map.points.size(), stage).value();
  result.flags.assign(map.tets.size(), {-1, -1, -1, -1});
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (!topology.isBoundary(h)) continue;
    const TetParameters& u = map.parameters[adjacency::tetOf(h)];
    const auto& c = lattice::kFaceCorners[h % 4];
    const auto corner = [&](std::size_t k) { return u[static_cast<std::size_t>(c[k])]; };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (corner(0)[axis] != corner(1)[axis] || corner(0)[axis] != corner(2)[axis]) continue;
      const bool isUpwards = u[h % 4][axis] < corner(0)[axis];
      result.flags[adjacency::tetOf(h)][h % 4] =
          static_cast<std::int8_t>(2 * axis + (isUpwards ? 0 : 1));
    }
  }
  return result;
}

/// Bends space around an axis, and twists it.
void distort(std::vector<Vec3>& points, double bending, double twist) {
  for (Vec3& p : points) {
    const double angle = bending * p[0];
    const double radius = 4 + p[1];
    p = {radius * std::sin(angle), radius * std::cos(angle) - 4, p[2]};
    const double turn = twist * p[0];
    p = {p[0], std::cos(turn) * p[1] - std::sin(turn) * p[2],
         std::sin(turn) * p[1] + std::cos(turn) * p[2]};
  }
}

Labelled polycube(SampleKind kind, int refine) {
  SampleOptions options;
  options.cells = 2;
  options.refine = refine;
  return labelled(generateSample(kind, options).map);
}

RC_GTEST_PROP(Polycube, HasTheMeshThatItsLabelsImply, ()) {
  const SampleKind kind = *rc::gen::element(SampleKind::Box, SampleKind::HandleBody);
  SampleOptions options;
  options.cells = 2;
  options.refine = *rc::gen::inRange(1, 4);
  const Sample sample = generateSample(kind, options);
  Labelled input = labelled(sample.map);
  distort(input.tets.points, *rc::gen::element(0.05, 0.2, 0.3), *rc::gen::element(0.0, 0.1, 0.2));
  const TetMap map = mapOf(input);
  const QuantizedMap quantized = quantize(map, {.cells = *rc::gen::element(30.0, 300.0, 3000.0)});
  ExtractOptions exact;
  exact.tolerance = 0;
  verifiedExtraction(quantized.map, exact);
  const Expectation expected = check(quantized.map).expected;
  const auto valences = [](const auto& counts) {
    std::vector<int> list;
    for (const auto& [valence, count] : counts) list.push_back(valence);
    return list;
  };
  RC_ASSERT(expected.eulerCharacteristic == sample.answer.expected.eulerCharacteristic);
  RC_ASSERT(expected.innerSingularEdges.empty());
  RC_ASSERT(valences(expected.boundarySingularEdges) ==
            valences(sample.answer.expected.boundarySingularEdges));
}

TEST(Polycube, IsTheObjectItselfWhereThatIsOne) {
  const Labelled input = polycube(SampleKind::Box, 2);
  const TetMap map = mapOf(input);
  EXPECT_TRUE(std::equal(input.tets.points.begin(), input.tets.points.end(), map.points.begin()));
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        // Up to a motion of all, which nothing fixes.
        const Vec3& first = map.points[map.tets[0][0]];
        EXPECT_NEAR(map.parameters[t][i][k] - map.parameters[0][0][k],
                    map.points[map.tets[t][i]][k] - first[k], 1e-5);
      }
    }
  }
}

TEST(Polycube, DoesNotDependOnThreadsOrOrientation) {
  Labelled input = polycube(SampleKind::HandleBody, 2);
  distort(input.tets.points, 0.2, 0.1);
  Context one(1);
  Context two(2);
  const TetMap map = mapFromFlags(input.tets, input.flags, one);
  EXPECT_EQ(map.parameters, mapFromFlags(input.tets, input.flags, two).parameters);
  for (std::size_t t = 0; t < input.tets.tets.size(); ++t) {
    std::swap(input.tets.tets[t][2], input.tets.tets[t][3]);
    std::swap(input.flags[t][2], input.flags[t][3]);
  }
  EXPECT_EQ(map.parameters, mapFromFlags(input.tets, input.flags, one).parameters);
}

TEST(Polycube, RefusesLabelsThatMakeNoSense) {
  const Labelled good = polycube(SampleKind::Box, 2);
  const auto codeWith = [&](const auto& change) {
    Labelled bad = good;
    change(bad);
    return codeOf([&] { static_cast<void>(mapOf(bad)); });
  };
  std::size_t boundary = 0;
  while (good.flags[boundary / 4][boundary % 4] < 0) ++boundary;
  const auto set = [](std::size_t face, std::int8_t flag) {
    return [=](Labelled& bad) { bad.flags[face / 4][face % 4] = flag; };
  };
  EXPECT_EQ(codeWith([](Labelled& bad) { bad.flags.pop_back(); }), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith(set(boundary, 6)), ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith(set(boundary, -1)), ErrorCode::InvalidArgument);
  std::size_t inner = 0;
  while (good.flags[inner / 4][inner % 4] >= 0) ++inner;
  EXPECT_EQ(codeWith(set(inner, 2)), ErrorCode::InvalidArgument);
  // All the same way.
  EXPECT_EQ(codeWith([](Labelled& bad) {
              for (FaceFlags& flags : bad.flags) {
                for (std::int8_t& flag : flags) flag = flag < 0 ? flag : 0;
              }
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(codeWith([](Labelled& bad) { bad.tets.points[0] = bad.tets.points[1]; }),
            ErrorCode::FlippedTet);
  EXPECT_EQ(codeWith([](Labelled& bad) { bad.tets.tets[0][0] = 1'000'000; }),
            ErrorCode::IndexOutOfRange);
}

/// Writes text into a file of a folder of its own.
class FlagFiles : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  std::vector<FaceFlags> read(const FlagsFile& file) const {
    Context context;
    return readFlags(file, input_.tets, context);
  }
  /// Calls visit(face, vertices) for labelled faces.
  template <class Visit>
  void forEachLabelled(const Visit& visit) const {
    for (std::size_t t = 0; t < input_.flags.size(); ++t) {
      for (std::size_t face = 0; face < 4; ++face) {
        if (input_.flags[t][face] < 0) continue;
        std::array<Index, 3> vertices{};
        for (std::size_t k = 0; k < 3; ++k) {
          vertices[k] =
              input_.tets.tets[t][static_cast<std::size_t>(lattice::kFaceCorners[face][k])];
        }
        visit(int{input_.flags[t][face]}, vertices);
      }
    }
  }
  std::string legacy(const std::string& type, const std::string& name) const {
    std::string points;
    for (const Vec3& p : input_.tets.points) {
      for (const double x : p) points += std::to_string(x) + ' ';
    }
    std::string cells;
    std::string types;
    std::string labels;
    std::size_t count = 0;
    for (const Tet& tet : input_.tets.tets) {
      cells += "4";
      for (const Index v : tet) cells += ' ' + std::to_string(v);
      cells += '\n', types += "10\n", labels += "-1\n", ++count;
    }
    std::size_t triangles = 0;
    forEachLabelled([&](int label, const std::array<Index, 3>& vertices) {
      cells += "3";
      for (const Index v : vertices) cells += ' ' + std::to_string(v);
      cells += '\n', types += "5\n", labels += std::to_string(label) + '\n', ++triangles;
    });
    return "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
           std::to_string(input_.tets.points.size()) + " double\n" + points + "\nCELLS " +
           std::to_string(count + triangles) + ' ' + std::to_string(5 * count + 4 * triangles) +
           '\n' + cells + "CELL_TYPES " + std::to_string(count + triangles) + '\n' + types +
           "CELL_DATA " + std::to_string(count + triangles) + "\nSCALARS " + name + ' ' + type +
           " 1\nLOOKUP_TABLE default\n" + labels;
  }

  TemporaryFolder folder_;
  Labelled input_ = polycube(SampleKind::Box, 1);
};

TEST_F(FlagFiles, HaveFourNumbersPerTet) {
  std::string text;
  for (const FaceFlags& flags : input_.flags) {
    for (const std::int8_t flag : flags) text += std::to_string(flag) + '\n';
  }
  EXPECT_EQ(read({write("flags.txt", text)}), input_.flags);
  for (const std::string& bad : {text + "0\n", text.substr(text.find('\n')), "7" + text,
                                 std::string("nothing"), std::string()}) {
    EXPECT_NE(codeOf([&] { static_cast<void>(read({write("bad.txt", bad)})); }),
              ErrorCode::Internal);
    EXPECT_ANY_THROW(static_cast<void>(read({write("bad.txt", bad)})));
  }
}

TEST_F(FlagFiles, BelongToTheTrianglesOfASurface) {
  // Vertices in another order, with few digits.
  std::string obj = "# made by a test\n";
  for (std::size_t i = input_.tets.points.size(); i-- > 0;) {
    obj += "v";
    for (const double x : input_.tets.points[i]) obj += ' ' + std::to_string(x);
    obj += '\n';
  }
  std::string labels;
  forEachLabelled([&](int label, const std::array<Index, 3>& vertices) {
    labels += std::to_string(label) + '\n';
    obj += "f";
    for (const Index v : vertices) {
      obj += ' ' + std::to_string(input_.tets.points.size() - v) + "//1";
    }
    obj += '\n';
  });
  const auto file = write("labels.txt", labels);
  EXPECT_EQ(read({file, write("surface.obj", obj)}), input_.flags);
  const auto codeOfSurface = [&](const std::string& text) {
    return codeOf([&] { static_cast<void>(read({file, write("bad.obj", text)})); });
  };
  EXPECT_EQ(codeOf([&] { static_cast<void>(read({file})); }), ErrorCode::FileUnsupported);
  EXPECT_EQ(codeOfSurface(obj + "f 1 2 3\n"), ErrorCode::FileUnsupported);
  EXPECT_EQ(codeOfSurface(obj + "f 1 2 3 4\n"), ErrorCode::FileUnsupported);
  EXPECT_EQ(codeOfSurface(obj + "f 1 2 1000\n"), ErrorCode::FileSyntax);
  EXPECT_EQ(codeOfSurface(obj + "v 1 2\n"), ErrorCode::FileSyntax);
  EXPECT_EQ(codeOfSurface("v 77 77 77\n" + obj), ErrorCode::FileUnsupported);
  // A corner of the box.
  const std::size_t vertex = obj.rfind("\nv") + 1;
  for (const char* const place : {"v 1e300 0 0", "v -1e18 -1e18 1e18", "v 0 -1e308 1e-320"}) {
    const std::string moved = obj.substr(0, vertex) + place + obj.substr(obj.find('\n', vertex));
    EXPECT_EQ(codeOfSurface(moved), ErrorCode::FileUnsupported) << place;
  }
  // A vertex of the tets that is nowhere is that of no surface.
  std::vector<Index> onBoundary;
  forEachLabelled([&](int /*label*/, const std::array<Index, 3>& vertices) {
    onBoundary.push_back(vertices[0]);
  });
  for (const Index v : onBoundary) {
    double& y = input_.tets.points[v][1];
    const double before = std::exchange(y, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(codeOfSurface(obj), ErrorCode::FileUnsupported);
    y = before;
  }
}

/// Programs of Windows put a mark in front of UTF-8, others count vertices from the last one.
TEST_F(FlagFiles, BelongToSurfacesWithAMarkAndRelativeNumbers) {
  const auto count = static_cast<std::int64_t>(input_.tets.points.size());
  std::string obj = "\xef\xbb\xbf";
  for (const Vec3& point : input_.tets.points) {
    obj += "v";
    for (const double x : point) obj += ' ' + std::to_string(x);
    obj += '\n';
  }
  std::string labels = "\xef\xbb\xbf";
  forEachLabelled([&](int label, const std::array<Index, 3>& vertices) {
    labels += std::to_string(label) + '\n';
    obj += "f";
    for (const Index v : vertices) obj += ' ' + std::to_string(v - count) + "/1/-1";
    obj += '\n';
  });
  const auto file = write("labels.txt", labels);
  EXPECT_EQ(read({file, write("surface.obj", obj)}), input_.flags);
  for (const std::string& corner :
       {std::to_string(-count - 1), std::string("0"), std::string("-9223372036854775808"),
        std::string("1x"), std::to_string(count + 1), std::string("-")}) {
    const auto bad = write("bad.obj", obj + "f 1 2 " + corner + '\n');
    EXPECT_EQ(codeOf([&] {
                static_cast<void>(read({file, bad}));
              }),
              ErrorCode::FileSyntax)
        << corner;
  }
}

/// In whatever units, within those of positions.
TEST_F(FlagFiles, BelongToSurfacesOfAnySize) {
  const auto original = input_.tets.points;
  for (const double factor : {1e-200, 1e-30, 1e30, 1e200}) {
    std::string obj;
    for (std::size_t v = 0; v < original.size(); ++v) {
      obj += "v";
      for (std::size_t k = 0; k < 3; ++k) {
        input_.tets.points[v][k] = factor * original[v][k];
        std::array<char, 40> digits{};
        std::snprintf(digits.data(), digits.size(), " %.9g", input_.tets.points[v][k]);
        obj += digits.data();
      }
      obj += '\n';
    }
    std::string labels;
    forEachLabelled([&](int label, const std::array<Index, 3>& vertices) {
      labels += std::to_string(label) + '\n';
      obj += "f";
      for (const Index v : vertices) obj += ' ' + std::to_string(v + 1);
      obj += '\n';
    });
    EXPECT_EQ(read({write("labels.txt", labels), write("surface.obj", obj)}), input_.flags);
  }
  input_.tets.points = original;
}

TEST_F(FlagFiles, AreTrianglesOfVtkFiles) {
  const auto file = write("labelled.vtk", legacy("int", "flags"));
  EXPECT_EQ(read({file}), input_.flags);
  EXPECT_EQ(read({.file = write("chart.vtk", legacy("short", "chart")), .array = "chart"}),
            input_.flags);
  for (const char* const type : {"double", "bit"}) {
    EXPECT_EQ(codeOf([&] { static_cast<void>(read({write("bad.vtk", legacy(type, "flags"))})); }),
              ErrorCode::FileUnsupported);
  }
  EXPECT_EQ(codeOf([&] { static_cast<void>(read({.file = file, .array = "labels"})); }),
            ErrorCode::FileUnsupported);
  // The tets are read of the same file.
  Context context;
  EXPECT_EQ(readTetMesh(file, {}, context).tets, input_.tets.tets);
}

}  // namespace

}  // namespace hexhex::test
