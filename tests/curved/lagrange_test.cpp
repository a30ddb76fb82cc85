// Cells of higher order: their nodes are those of a finer mesh, shared, and in the right places.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

#include "curved/curved_maps.hpp"
#include "mesh/grid_meshes.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex::test::lagrange {

namespace {

LagrangeMesh lagrange(const TetMap& map, int order, int scale = 1, int threads = 0,
                      Engine engine = Engine::Atlas, CurvedNodes nodes = CurvedNodes::Blended) {
  ExtractOptions options;
  options.scale = scale;
  options.engine = engine;
  options.curvedNodes = nodes;
  Context context(threads);
  return extractLagrange(map, order, options, context);
}

HexMesh straight(const TetMap& map, int scale) {
  ExtractOptions options;
  options.scale = scale;
  return extract(map, options);
}

/// The small hexahedra between neighbouring nodes.
HexMesh subdivided(const LagrangeMesh& mesh) {
  HexMesh fine;
  fine.points = mesh.points;
  const auto p = static_cast<std::size_t>(mesh.order);
  const std::size_t n = p + 1;
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    const Index* const nodes = mesh.nodes.data() + c * mesh.nodesPerCell();
    for (std::size_t k = 0; k < p; ++k) {
      for (std::size_t j = 0; j < p; ++j) {
        for (std::size_t i = 0; i < p; ++i) {
          const auto at = [&](std::size_t x, std::size_t y, std::size_t z) {
            return nodes[(i + x) + n * ((j + y) + n * (k + z))];
          };
          fine.cells.push_back({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1),
                                at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
        }
      }
    }
  }
  return fine;
}

/// All that must hold for any map.
void examine(const TetMap& map, int order, int scale) {
  SCOPED_TRACE("order " + std::to_string(order) + ", scale " + std::to_string(scale));
  const LagrangeMesh mesh = lagrange(map, order, scale, 0, Engine::Atlas, CurvedNodes::Exact);
  EXPECT_TRUE(sameBits(straightMesh(mesh), straight(map, scale)));
  // The refined grid's own mesh has the same vertices at the same places, and the cells between
  // nodes are its cells: so nodes are exact, in order, and shared by neighbours.
  const HexMesh fine = straight(map, scale * order);
  ASSERT_EQ(mesh.points.size(), fine.points.size());
  EXPECT_TRUE(sameUpToNumbering(subdivided(mesh), fine));
  VerifyOptions options;
  options.scale = scale * order;
  const VerifyReport report = verify(map, subdivided(mesh), options);
  EXPECT_TRUE(report.passed()) << failures(report);
}

TEST(Lagrange, NodesAreThoseOfTheFinerMesh) {
  int number = 0;
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    examine(map.map, 2 + number++ % 2, 1);
  }
}

TEST(Lagrange, CellsThatMeetThemselves) {
  examine(tightTorus(2), 2, 1);
  examine(tightTorus(1), 3, 1);
}

TEST(Lagrange, RealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    const std::size_t cells = straight(map.map, 1).cells.size();
    if (cells < 3000) examine(map.map, 2, 1);
    if (cells < 300) examine(map.map, 3, 2);
  }
}

TEST(Lagrange, EveryOrder) {
  SampleOptions options;
  options.cells = 1;
  options.jitter = 0.5;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (int order = 1; order <= kMaxOrder; ++order) examine(map, order, 1);
}

TEST(Lagrange, OrderOneIsTheOrdinaryMesh) {
  const TetMap map = generateSample(SampleKind::Star).map;
  const LagrangeMesh mesh = lagrange(map, 1);
  const HexMesh expected = straight(map, 1);
  EXPECT_TRUE(sameBits(straightMesh(mesh), expected));
  EXPECT_EQ(mesh.points, expected.points);
}

TEST(Lagrange, SameForAnyNumberOfThreadsAndEngine) {
  HEXHEX_LARGE_TEST();
  SampleOptions options;
  options.cells = 6;
  options.jitter = 0.5;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  const LagrangeMesh one = lagrange(map, 3, 1, 1);
  for (const LagrangeMesh& other :
       {lagrange(map, 3, 1, 3), lagrange(map, 3, 1, 2, Engine::Propeller)}) {
    EXPECT_EQ(one.points, other.points);
    EXPECT_EQ(one.nodes, other.nodes);
    EXPECT_EQ(one.generatorTet, other.generatorTet);
    EXPECT_EQ(one.generatorCorners, other.generatorCorners);
  }
}

TEST(Lagrange, RefusesOrdersOutOfRange) {
  const TetMap map = generateSample(SampleKind::Box).map;
  for (const int order : {-1, 0, kMaxOrder + 1}) {
    try {
      static_cast<void>(lagrange(map, order));
      ADD_FAILURE() << order;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    }
  }
}

/// One cell with nodes where a function puts them.
template <class F>
LagrangeMesh oneCell(int order, const F& place) {
  LagrangeMesh mesh;
  mesh.order = order;
  for (int k = 0; k <= order; ++k) {
    for (int j = 0; j <= order; ++j) {
      for (int i = 0; i <= order; ++i) {
        mesh.nodes.push_back(static_cast<Index>(mesh.points.size()));
        mesh.points.push_back(place(static_cast<double>(i) / order, static_cast<double>(j) / order,
                                    static_cast<double>(k) / order));
      }
    }
  }
  mesh.vertexCount = static_cast<Index>(mesh.points.size());
  return mesh;
}

/// A file of its own, with a text in it.
class LagrangeFile {
 public:
  explicit LagrangeFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + name)) {}
  ~LagrangeFile() { std::filesystem::remove(path_); }
  LagrangeFile(const LagrangeFile&) = delete;
  LagrangeFile& operator=(const LagrangeFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void write(const std::string& text) const { std::ofstream(path_) << text; }

 private:
  std::filesystem::path path_;
};

TEST(LagrangeReader, GivesBackWhatWasWritten) {
  const LagrangeFile file("-lagrange.vtu");
  Context context;
  for (const int order : {1, 2, 3, 5}) {
    SCOPED_TRACE(order);
    SampleOptions options;
    options.features = true;
    const LagrangeMesh mesh = lagrange(generateSample(SampleKind::Sphere, options).map, order);
    ASSERT_FALSE(mesh.features.vertices.empty() || mesh.features.edges.empty() ||
                 mesh.features.quads.empty() || mesh.regions.empty());
    writeLagrangeMesh(mesh, file.path(), {}, context);
    EXPECT_TRUE(holdsLagrangeCells(file.path(), context));
    const LagrangeMesh read = readLagrangeMesh(file.path(), context);
    EXPECT_EQ(read.order, mesh.order);
    EXPECT_EQ(read.points, mesh.points);
    EXPECT_EQ(read.nodes, mesh.nodes);
    EXPECT_EQ(read.vertexCount, mesh.vertexCount);
    EXPECT_EQ(read.generatorTet, mesh.generatorTet);
    EXPECT_EQ(read.generatorCorners, mesh.generatorCorners);
    EXPECT_EQ(read.features, mesh.features);
    EXPECT_EQ(read.regions, mesh.regions);
  }
}

TEST(LagrangeReader, RenumbersTagsAndLeavesOutThoseBetweenCorners) {
  const LagrangeFile file("-tags.vtu");
  Context context;
  LagrangeMesh mesh = lagrange(generateSample(SampleKind::Box).map, 2);
  const Index* const cell = mesh.nodes.data();
  const Index last = cell[26];  // a corner
  const Index middle = cell[1];
  // Corners come last in the file.
  const auto count = static_cast<Index>(mesh.points.size());
  std::reverse(mesh.points.begin(), mesh.points.end());
  for (Index& node : mesh.nodes) node = count - 1 - node;
  const auto moved = [count](Index node) { return count - 1 - node; };
  mesh.vertexCount = count;
  mesh.generatorTet.clear();
  mesh.generatorCorners.clear();
  mesh.features.vertices = {{moved(last), 3}, {moved(middle), 4}};
  mesh.features.edges = {{{moved(last), moved(middle)}, 5}, {{cell[0], cell[2]}, -6}};
  mesh.features.quads = {{{cell[0], cell[2], cell[8], cell[6]}, 7},
                         {{cell[0], cell[1], cell[4], cell[3]}, 8}};
  writeLagrangeMesh(mesh, file.path(), {}, context);
  const LagrangeMesh read = readLagrangeMesh(file.path(), context);
  const Index* const there = read.nodes.data();
  ASSERT_EQ(read.features.vertices.size(), 1U);
  EXPECT_EQ(read.features.vertices[0], (FeatureVertex{there[26], 3}));
  ASSERT_EQ(read.features.edges.size(), 1U);
  EXPECT_EQ(read.features.edges[0], (FeatureEdge{{there[0], there[2]}, -6}));
  ASSERT_EQ(read.features.quads.size(), 1U);
  EXPECT_EQ(read.features.quads[0], (FeatureQuad{{there[0], there[2], there[8], there[6]}, 7}));
  EXPECT_LT(there[0], read.vertexCount);
}

TEST(LagrangeWriter, RefusesTagsThatNoCellHas) {
  const LagrangeFile file("-wrong.msh");
  Context context;
  const LagrangeMesh good = lagrange(generateSample(SampleKind::Box).map, 2);
  const HexMesh corners = straightMesh(good);
  const auto expectRefused = [&](const HexFeatures& features) {
    LagrangeMesh mesh = good;
    mesh.features = features;
    try {
      writeLagrangeMesh(mesh, file.path(), {}, context);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(file.path()));
  };
  const Hex& cell = corners.cells[0];
  expectRefused({{}, {{{cell[0], cell[2]}, 1}}, {}});                    // a diagonal
  expectRefused({{}, {}, {{{cell[0], cell[1], cell[6], cell[7]}, 1}}});  // across the cell
  expectRefused({{{static_cast<Index>(good.vertexCount), 1}}, {}, {}});  // no hex vertex
}

TEST(LagrangeMesh, ArraysThatDoNotFitAreRefused) {
  const LagrangeMesh good = lagrange(generateSample(SampleKind::Box).map, 2);
  EXPECT_NO_THROW(static_cast<void>(straightMesh(good)));
  const auto expectRefused = [&good](const char* part, const auto& change) {
    LagrangeMesh mesh = good;
    change(mesh);
    const Error error = errorOf([&] { static_cast<void>(straightMesh(mesh)); });
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  };
  expectRefused("order of the cells is 0", [](LagrangeMesh& m) { m.order = 0; });
  expectRefused("order of the cells is 10", [](LagrangeMesh& m) { m.order = kMaxOrder + 1; });
  expectRefused("no multiple", [](LagrangeMesh& m) { m.nodes.pop_back(); });
  expectRefused("cannot be hex vertices",
                [](LagrangeMesh& m) { m.vertexCount = m.points.size() + 1; });
  expectRefused("generators", [](LagrangeMesh& m) { m.generatorTet.pop_back(); });
  expectRefused("generators", [](LagrangeMesh& m) {
    m.generatorTet.pop_back();
    m.generatorCorners.pop_back();
  });
  expectRefused("names node",
                [](LagrangeMesh& m) { m.nodes[30] = static_cast<Index>(m.points.size()); });
  expectRefused("regions", [](LagrangeMesh& m) { m.regions.resize(1); });
  expectRefused("A corner of cell 1 is none of the first",
                [](LagrangeMesh& m) { m.nodes[27] = static_cast<Index>(m.vertexCount); });
}

/// A file with one cell of order 1, whose nodes have these numbers.
std::string vtuOfOneCell(const std::string& connectivity, int end, int type, const char* point) {
  return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"9\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\" format=\"ascii\">9 9 9 " +
         std::string(point) +
         " 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1</DataArray></Points><Cells>"
         "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
         connectivity + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" +
         std::to_string(end) +
         "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
         std::to_string(type) + "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST(LagrangeReader, PutsCornersFirstAndRefusesWhatIsWrong) {
  const LagrangeFile file("-one.vtu");
  Context context;
  file.write(vtuOfOneCell("1 2 3 4 5 6 7 8", 8, 72, "0 0 0"));
  const LagrangeMesh mesh = readLagrangeMesh(file.path(), context);
  EXPECT_EQ(mesh.vertexCount, 8U);
  EXPECT_EQ(mesh.points.back(), (Vec3{9, 9, 9}));  // of no cell
  EXPECT_EQ(mesh.points[mesh.nodes[0]], (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.points[mesh.nodes[3]], (Vec3{1, 1, 0}));
  const auto expectRefused = [&](const std::string& text, ErrorCode code) {
    file.write(text);
    try {
      static_cast<void>(readLagrangeMesh(file.path(), context));
      ADD_FAILURE() << "no error " << name(code);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
    }
  };
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 9", 8, 72, "0 0 0"), ErrorCode::IndexOutOfRange);
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 -1", 8, 72, "0 0 0"), ErrorCode::IndexOutOfRange);
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 8", 9, 72, "0 0 0"), ErrorCode::FileSyntax);
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 8", -3, 72, "0 0 0"), ErrorCode::FileSyntax);
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 8", 7, 72, "0 0 0"), ErrorCode::FileUnsupported);
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 8", 8, 12, "0 0 0"), ErrorCode::FileUnsupported);
  EXPECT_FALSE(holdsLagrangeCells(file.path(), context));
  expectRefused(vtuOfOneCell("1 2 3 4 5 6 7 8", 8, 72, "nan 0 0"), ErrorCode::NotFinite);
}

TEST(LagrangeQuality, KnownCells) {
  Context context;
  for (int order = 1; order <= kMaxOrder; ++order) {
    SCOPED_TRACE(order);
    const auto quality = [&](const auto& place) {
      return scaledJacobians(oneCell(order, place), context).front();
    };
    EXPECT_NEAR(quality([](double x, double y, double z) {
                  return Vec3{3 * x, 2 * y, z};
                }),
                1, 1e-12);
    // Sheared by 45 degrees everywhere.
    EXPECT_NEAR(quality([](double x, double y, double z) {
                  return Vec3{x + y, y, z};
                }),
                std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(quality([](double x, double y, double z) { return Vec3{-x, y, z}; }), -1, 1e-12);
    if (order < 2) continue;
    // x = s - s^2 turns back in the middle: the determinant at the far side is negative.
    EXPECT_NEAR(quality([](double x, double y, double z) {
                  return Vec3{x - x * x, y, z};
                }),
                -1, 1e-12);
    // The column of x is (1, 2 x) and its angle to y's is smallest at x = 1.
    EXPECT_NEAR(quality([](double x, double y, double z) {
                  return Vec3{x, y + x * x, z};
                }),
                1 / std::sqrt(5.0), 1e-12);
  }
}

TEST(LagrangeQuality, VanishingEdgeIsNotPositive) {
  Context context;
  const auto flat = [](double x, double y, double) { return Vec3{x, y, 0}; };
  EXPECT_EQ(scaledJacobians(oneCell(2, flat), context).front(), 0.0);
}

TEST(LagrangeCertificate, AgreesWithStraightCells) {
  Context context;
  hexhex::testing::Random random(9);
  int refuted = 0;
  for (int i = 0; i < 90; ++i) {
    std::array<Vec3, 8> corners;  // by place: bits x, y, z
    for (std::size_t c = 0; c < 8; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[c][k] = static_cast<double>(c >> k & 1U) + 1.1 * (random.real() - 0.5);
      }
    }
    const auto trilinear = [&](double x, double y, double z) {
      Vec3 point{};
      for (std::size_t c = 0; c < 8; ++c) {
        const double weight =
            ((c & 1U) != 0 ? x : 1 - x) * ((c & 2U) != 0 ? y : 1 - y) * ((c & 4U) != 0 ? z : 1 - z);
        for (std::size_t k = 0; k < 3; ++k) point[k] += weight * corners[c][k];
      }
      return point;
    };
    std::array<Vec3, 8> vtk = corners;
    std::swap(vtk[2], vtk[3]);
    std::swap(vtk[6], vtk[7]);
    const CellCertificate straight = certify(vtk);
    if (straight.validity == Validity::Refuted) ++refuted;
    const int order = 1 + i % 5;
    const LagrangeMesh mesh = oneCell(order, trilinear);
    const Certificate certificate = certify(mesh, context);
    EXPECT_EQ(certificate.validity.front(), straight.validity) << "order " << order;
    EXPECT_EQ(certificate.scaledJacobians, scaledJacobians(mesh, context));
    EXPECT_LE(certificate.minimum, straight.scaledJacobian + 1e-9);
    if (certificate.worst.empty()) continue;
    const auto& [cell, place, position, scaled] = certificate.worst.front();
    const Vec3 there = trilinear(place[0], place[1], place[2]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(position[k], there[k], 1e-9);
    EXPECT_LE(scaled, 0);
  }
  EXPECT_GT(refuted, 10);
  EXPECT_LT(refuted, 80);
}

TEST(LagrangeCertificate, EveryOrder) {
  Context context;
  for (int order = 1; order <= kMaxOrder; ++order) {
    const bool between = order > 3 && order < kMaxOrder;
    if (between && test::effort() < test::kEffortOfLargeTests) continue;
    SCOPED_TRACE(order);
    const auto verdict = [&](const auto& place) { return certify(oneCell(order, place), context); };
    const Certificate cube = verdict([](double x, double y, double z) { return Vec3{x, y, z}; });
    EXPECT_TRUE(cube.allPositive());
    EXPECT_GT(cube.minimum, 0.9);
    const auto flat = [](double x, double y, double) { return Vec3{x, y, 0}; };
    EXPECT_EQ(verdict(flat).refuted, 1U);
    const auto mirrored = [](double x, double y, double z) { return Vec3{-x, y, z}; };
    EXPECT_EQ(verdict(mirrored).refuted, 1U);
    if (order < 2) continue;
    const auto bent = [](double x, double y, double z) {
      return Vec3{x, y + x * x, z + 0.2 * x * y};
    };
    EXPECT_TRUE(verdict(bent).allPositive());
    const auto folded = [](double x, double y, double z) { return Vec3{x - x * x, y, z}; };
    EXPECT_EQ(verdict(folded).refuted, 1U);
  }
}

TEST(LagrangeCertificate, FindsWhatSamplesMiss) {
  // dx/ds = 2 (s - 0.3)^2 + c: for c = -0.001, it is negative around 0.3, and positive at the nodes
  // and Gauss points of order 3.
  Context context;
  for (const double c : {-0.001, 0.001}) {
    const LagrangeMesh mesh = oneCell(3, [&](double s, double y, double z) {
      const double d = s - 0.3;
      return Vec3{2 * d * d * d / 3 + c * s, y, z};
    });
    const Certificate certificate = certify(mesh, context);
    EXPECT_GT(certificate.quality.minimum, 0);
    EXPECT_EQ(certificate.positive, c > 0 ? 1U : 0U);
    EXPECT_EQ(certificate.refuted, c < 0 ? 1U : 0U);
    if (c < 0) {
      EXPECT_NEAR(certificate.worst.front().place[0], 0.3, 0.03);
    }
  }
}

}  // namespace
}  // namespace hexhex::test::lagrange
