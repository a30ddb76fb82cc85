// Cells of orders 1 to 4 as Gmsh, MFEM and VTK understand them, each through Python and only if it
// is installed (see other_programs.hpp): lengths, areas and volumes of all groups, integrated with
// the shape functions of that program, against those of this file, which knows nothing of the order
// in which a format lists nodes.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include <base/vector3.hpp>
#include <io/io_test_support.hpp>
#include <io/other_programs.hpp>

namespace hexhex::test::measures {
namespace {

/// How many elements a group has, and how large they are together.
struct Measure {
  std::size_t count = 0;
  double size = 0;
};

/// By kind and name.
using Measures = std::map<std::pair<std::string, std::string>, Measure>;

/// Places in [0, 1] and weights of Gauss's integration.
struct GaussRule {
  std::vector<double> places;
  std::vector<double> weights;

  explicit GaussRule(int n) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
      double slope = 0;
      for (int step = 0; step < 50; ++step) {
        double before = 1;
        double value = x;
        for (int k = 2; k <= n; ++k) {
          before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
        }
        slope = n * (x * value - before) / (x * x - 1);
        x -= value / slope;
      }
      places.push_back((1 - x) / 2);
      weights.push_back(1 / ((1 - x * x) * slope * slope));
    }
  }
};
constexpr int kGaussPoints = 7;  // as in measure_with.py

/// Polynomials of equidistant nodes: values and derivatives.
struct Line {
  std::vector<double> value;
  std::vector<double> derivative;

  Line(int order, double x) {
    for (int i = 0; i <= order; ++i) {
      double product = 1;
      double sum = 0;
      for (int j = 0; j <= order; ++j) {
        if (j == i) continue;
        product *= (x * order - j) / (i - j);
        double term = static_cast<double>(order) / (i - j);
        for (int k = 0; k <= order; ++k) {
          if (k != i && k != j) term *= (x * order - k) / (i - k);
        }
        sum += term;
      }
      value.push_back(product);
      derivative.push_back(sum);
    }
  }
};

/// The three derivatives of a cell's position.
std::array<Vec3, 3> jacobian(const LagrangeMesh& mesh, std::size_t cell, const Vec3& at) {
  const std::array<Line, 3> lines = {Line(mesh.order, at[0]), Line(mesh.order, at[1]),
                                     Line(mesh.order, at[2])};
  const auto n = static_cast<std::size_t>(mesh.order) + 1;
  std::array<Vec3, 3> columns{};
  for (std::size_t node = 0; node < n * n * n; ++node) {
    const std::array<std::size_t, 3> place = {node % n, node / n % n, node / n / n};
    const Vec3& point = mesh.points[mesh.nodes[cell * n * n * n + node]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double factor = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        factor *= k == axis ? lines[k].derivative[place[k]] : lines[k].value[place[k]];
      }
      for (std::size_t k = 0; k < 3; ++k) columns[axis][k] += factor * point[k];
    }
  }
  return columns;
}

constexpr std::array<Vec3, 8> kCorners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// A part of a cell: where it begins, and along which axes it goes on, forwards.
struct Part {
  Vec3 from{};
  std::vector<std::size_t> axes;

  explicit Part(const std::vector<std::uint8_t>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double first = kCorners[corners[0]][k];
      const bool fixed = std::all_of(corners.begin(), corners.end(),
                                     [&](std::uint8_t c) { return kCorners[c][k] == first; });
      if (fixed) {
        from[k] = first;
      } else {
        axes.push_back(k);
      }
    }
  }
};

/// Length, area or volume of a part, and the smallest determinant on the way.
std::pair<double, double> measure(const LagrangeMesh& mesh, std::size_t cell, const Part& part) {
  const GaussRule rule(kGaussPoints);
  std::size_t count = 1;
  for (std::size_t i = 0; i < part.axes.size(); ++i) count *= kGaussPoints;
  double sum = 0;
  double smallest = 1e300;
  for (std::size_t q = 0; q < count; ++q) {
    Vec3 at = part.from;
    double weight = 1;
    std::size_t rest = q;
    for (const std::size_t axis : part.axes) {
      at[axis] = rule.places[rest % kGaussPoints];
      weight *= rule.weights[rest % kGaussPoints];
      rest /= kGaussPoints;
    }
    const std::array<Vec3, 3> columns = jacobian(mesh, cell, at);
    const double determinant = dot(columns[0], hexhex::cross(columns[1], columns[2]));
    smallest = std::min(smallest, determinant);
    double size = determinant;
    if (part.axes.size() == 1) size = length(columns[part.axes[0]]);
    if (part.axes.size() == 2) {
      size = length(hexhex::cross(columns[part.axes[0]], columns[part.axes[1]]));
    }
    sum += weight * size;
  }
  return {sum, smallest};
}

/// The size of the part of a cell that has these vertices.
template <std::size_t n, std::size_t slots>
double sizeOf(const LagrangeMesh& mesh, const HexMesh& straight, std::array<Index, n> vertices,
              const std::array<std::array<std::uint8_t, n>, slots>& table) {
  std::sort(vertices.begin(), vertices.end());
  for (std::size_t c = 0; c < straight.cells.size(); ++c) {
    for (const auto& corners : table) {
      std::array<Index, n> here;
      for (std::size_t i = 0; i < n; ++i) here[i] = straight.cells[c][corners[i]];
      std::sort(here.begin(), here.end());
      if (here == vertices) {
        return measure(mesh, c, Part({corners.begin(), corners.end()})).first;
      }
    }
  }
  ADD_FAILURE() << "not in the mesh";
  return 0;
}

double volumeOf(const LagrangeMesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    sum += measure(mesh, c, Part({0, 1, 2, 3, 4, 5, 6, 7})).first;
  }
  return sum;
}

/// The map has a kink at every triangle, and polynomials through equidistant nodes do not approach
/// a kink as their order grows. With smaller cells, all orders approach the tets.
TEST(Volume, OfEveryOrderConvergesToThatOfTheTets) {
  SampleOptions options;
  options.cells = 1;
  options.refine = 4;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  double expected = 0;
  for (const Tet& t : map.tets) {
    const Vec3& origin = map.points[t[0]];
    expected +=
        dot(minus(map.points[t[1]], origin),
            hexhex::cross(minus(map.points[t[2]], origin), minus(map.points[t[3]], origin))) /
        6;
  }
  for (const int order : {1, 2, 3, 4}) {
    SCOPED_TRACE(order);
    const auto error = [&](int scale) {
      ExtractOptions extraction;
      extraction.scale = scale;
      Context context;
      return std::abs(volumeOf(extractLagrange(map, order, extraction, context)) / expected - 1);
    };
    const double fine = error(4);
    EXPECT_LT(fine, error(1) / 10);
    EXPECT_LT(fine, 2e-3);
  }
}

std::string nameOf(const std::string& kind, std::int32_t tag) {
  return kind + (tag < 0 ? "_m" : "_") + std::to_string(std::abs(tag));
}

/// What must come out, with names of groups as the file calls them.
Measures expected(const LagrangeMesh& mesh, double& smallest) {
  const HexMesh straight = straightMesh(mesh);
  Measures all;
  const auto add = [&](const char* kind, const std::string& name, double size) {
    ++all[{kind, name}].count;
    all[{kind, name}].size += size;
  };
  for (const FeatureVertex& vertex : mesh.features.vertices) {
    add("vertices", nameOf("point", vertex.tag), 0);
  }
  for (const FeatureEdge& edge : mesh.features.edges) {
    add("edges", nameOf("curve", edge.tag),
        sizeOf(mesh, straight, edge.vertices, adjacency::kHexEdges));
  }
  for (const FeatureQuad& quad : mesh.features.quads) {
    add("quads", nameOf("surface", quad.tag),
        sizeOf(mesh, straight, quad.vertices, adjacency::kHexFaces));
  }
  smallest = 1e300;
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    const auto [volume, least] = measure(mesh, c, Part({0, 1, 2, 3, 4, 5, 6, 7}));
    add("cells", nameOf("region", mesh.regions[c]), volume);
    smallest = std::min(smallest, least);
  }
  all[{"nodes", "all"}].count = mesh.points.size();
  return all;
}

/// A curved mesh with tags of all kinds, also negative ones, and no region 1.
LagrangeMesh taggedMesh(int order) {
  SampleOptions options;
  options.cells = 1;
  options.refine = 3;
  options.charts = ChartStyle::Random;
  options.features = true;
  TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (std::int32_t& region : map.regions) region = 3 * region + 2;
  ExtractOptions extraction;
  extraction.scale = 2;
  Context context;
  LagrangeMesh mesh = extractLagrange(map, order, extraction, context);
  const HexMesh straight = straightMesh(mesh);
  // All boundary quads have a tag; tag one inside, too, and give some others.
  for (std::size_t i = 0; i < mesh.features.quads.size(); ++i) {
    mesh.features.quads[i].tag = static_cast<std::int32_t>(1 + i % 3);
  }
  const Quad inside = adjacency::faceVertices(straight.cells[0], [&] {
    for (std::size_t face = 0;; ++face) {
      const Quad quad = adjacency::faceVertices(straight.cells[0], face);
      const bool tagged = std::any_of(
          mesh.features.quads.begin(), mesh.features.quads.end(), [&](const FeatureQuad& other) {
            return std::is_permutation(quad.begin(), quad.end(), other.vertices.begin());
          });
      if (!tagged) return face;
    }
  }());
  mesh.features.quads.push_back({{inside[2], inside[1], inside[0], inside[3]}, 9});
  for (FeatureEdge& edge : mesh.features.edges) std::swap(edge.vertices[0], edge.vertices[1]);
  mesh.features.edges.front().tag = -4;
  return mesh;
}

Measures readMeasures(const std::filesystem::path& file, double& smallest) {
  std::ifstream in(file.string() + ".measures");
  Measures all;
  std::string kind;
  while (in >> kind && kind != "jacobian") {
    std::string name;
    Measure measure;
    in >> name >> measure.count >> measure.size;
    all[{kind, name}] = measure;
  }
  in >> smallest;
  EXPECT_TRUE(in) << "no measures";
  return all;
}

/// Names of groups without the word in front of the tag, for formats that hold numbers only.
Measures numbered(const Measures& named) {
  Measures all;
  for (const auto& [key, measure] : named) {
    std::string name = key.second.substr(key.second.find('_') + 1);
    if (name.starts_with('m')) name.replace(0, 1, "-");
    all[{key.first, name}] = measure;
  }
  return all;
}

void expectSame(const Measures& measured, Measures expected, bool sizesOfCellsOnly) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& [key, measure] : expected) {
    names.push_back(key);
    ASSERT_TRUE(measured.contains(key)) << key.first << ' ' << key.second;
    const Measure& other = measured.at(key);
    EXPECT_EQ(other.count, measure.count) << key.first << ' ' << key.second;
    if (sizesOfCellsOnly && key.first != "cells") continue;
    EXPECT_NEAR(other.size, measure.size, 1e-12) << key.first << ' ' << key.second;
  }
  EXPECT_EQ(measured.size(), names.size());
}

/// All quads of the boundary face outwards. Removes what says so.
void expectOutwards(Measures& measured) {
  double volume = 0;
  double flux = 0;
  for (const auto& [key, measure] : measured) {
    if (key.first == "cells") volume += measure.size;
    if (key.first == "flux" && key.second != "surface_9") flux += measure.size;  // 9 is inside
  }
  EXPECT_NEAR(flux, volume, 1e-12);
  std::erase_if(measured, [](const auto& entry) { return entry.first.first == "flux"; });
}

struct Program {
  std::string name;
  std::string extension;
};

void PrintTo(const Program& program, std::ostream* stream) { *stream << program.name; }

class Measured : public testing::TestWithParam<Program> {};

TEST_P(Measured, AgreesOnAllGroups) {
  const Program& program = GetParam();
  const TemporaryFolder folder;
  Context context;
  std::vector<LagrangeMesh> meshes;
  std::vector<std::filesystem::path> files;
  std::string arguments = program.name;
  const auto addFile = [&](const std::string& name) {
    files.push_back(folder / (name + program.extension));
    arguments += " '" + files.back().string() + "'";
    return files.back();
  };
  for (const int order : {1, 2, 3, 4}) {
    meshes.push_back(taggedMesh(order));
    writeLagrangeMesh(meshes.back(), addFile("order" + std::to_string(order)), {}, context);
  }
  // What the writer of straight meshes makes of the same.
  meshes.push_back(meshes.front());
  WriteOptions options;
  if (program.name == "mfem") options.format = "mfem";
  writeHexMesh(straightMesh(meshes.front()), addFile("straight"), options, context);

  const int code = runScript("measure_with.py", arguments, (folder / "errors").string());
  if (isMissing(code)) {
    GTEST_SKIP() << program.name << " for " << interpreter() << " is not installed";
  }
  ASSERT_EQ(code, 0) << contentOf(folder / "errors");
  for (std::size_t i = 0; i < files.size(); ++i) {
    SCOPED_TRACE(files[i].filename().string());
    double smallest = 0;
    double expectedSmallest = 0;
    Measures all = expected(meshes[i], expectedSmallest);
    if (program.name != "gmsh") all = numbered(all);
    if (program.name == "mfem") {  // holds quads and cells, and has nodes cell by cell
      std::erase_if(all, [](const auto& entry) {
        return entry.first.first != "cells" && entry.first.first != "quads";
      });
    }
    Measures measured = readMeasures(files[i], smallest);
    if (program.name == "gmsh") expectOutwards(measured);
    ASSERT_NO_FATAL_FAILURE(expectSame(measured, all, program.name == "vtk"));
    EXPECT_NEAR(smallest, expectedSmallest, 1e-12);
    EXPECT_GT(smallest, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Programs, Measured,
                         testing::Values(Program{"gmsh", ".msh"}, Program{"mfem", ".mesh"},
                                         Program{"vtk", ".vtu"}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace hexhex::test::measures
