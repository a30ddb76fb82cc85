// Pages that show a mesh: the packed tables, and what the page holds and refuses.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>
#include <zlib.h>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/view.hpp>

#include <base/parallel.hpp>
#include <mesh/grid_meshes.hpp>
#include <view/cut_tets.hpp>
#include <view/mesh_tables.hpp>

#include "support/error_of.hpp"

namespace hexhex::view {
namespace {

using testing::gridMesh;

std::string inflated(const std::string& packed) {
  std::string bytes(std::size_t{1} << 21U, '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  bytes.resize(size);
  return bytes;
}

/// The numbers of a table, unpacked as the page does it.
std::vector<std::uint32_t> unpacked(const PackedTable& table) {
  std::vector<std::uint32_t> numbers;
  for (const std::string& chunk : table.chunks) {
    const std::string bytes = inflated(chunk);
    const std::size_t begin = numbers.size();
    const std::size_t rows = std::min(table.rowsPerChunk, table.rows - begin / table.columns);
    const auto planes = static_cast<std::size_t>(bytes.at(0));
    EXPECT_EQ(bytes.size(), 1 + planes * rows * table.columns);
    numbers.resize(begin + rows * table.columns);
    for (std::size_t column = 0; column < table.columns; ++column) {
      std::uint32_t value = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        std::uint32_t code = 0;
        for (std::size_t plane = 0; plane < planes; ++plane) {
          const std::size_t place =
              table.byRows ? row * table.columns + column : column * rows + row;
          const std::size_t at = 1 + plane * rows * table.columns + place;
          code |= std::uint32_t{static_cast<unsigned char>(bytes.at(at))} << (8 * plane);
        }
        value += (code >> 1U) ^ (0U - (code & 1U));
        numbers[begin + row * table.columns + column] = value;
      }
    }
  }
  return numbers;
}

PackedTable packed(const std::vector<std::uint32_t>& numbers, std::size_t columns, int threads) {
  Context context(threads);
  Stage stage(context, "test");
  PackedTable table;
  withThreads(threads, [&] {
    table = packTable(
        "test", numbers.size() / columns, columns,
        [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
          std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(begin * columns),
                    numbers.begin() + static_cast<std::ptrdiff_t>(end * columns), to);
        },
        stage);
  });
  return table;
}

TEST(TableCodec, KeepsAllNumbers) {
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  const std::vector<std::uint32_t> extremes = {0, most, most, 0, 1, most - 1, 1U << 31U, 7};
  for (const std::size_t columns : {1U, 2U, 4U, 8U}) {
    EXPECT_EQ(unpacked(packed(extremes, columns, 1)), extremes) << columns;
  }
  EXPECT_TRUE(unpacked(packed({}, 3, 1)).empty());
}

TEST(TableCodec, KeepsTablesOfSeveralChunksWithAnyNumberOfThreads) {
  std::vector<std::uint32_t> numbers(3 * 250001);
  std::uint32_t state = 1;
  for (std::uint32_t& number : numbers) number = (state = state * 1664525U + 1013904223U) >> 7U;
  const PackedTable one = packed(numbers, 3, 1);
  EXPECT_GT(one.chunks.size(), 2U);
  EXPECT_EQ(unpacked(one), numbers);
  EXPECT_EQ(packed(numbers, 3, 4).chunks, one.chunks);
}

TEST(TableCodec, TakesTheOrderThatPacksBetter) {
  std::vector<std::uint32_t> alike;   // the columns of a row are the same
  std::vector<std::uint32_t> steady;  // all columns but one stay as they are
  std::uint32_t state = 1;
  for (std::uint32_t row = 0; row < 40000; ++row) {
    state = state * 1664525U + 1013904223U;
    for (std::uint32_t column = 0; column < 8; ++column) {
      alike.push_back(state >> 8U);
      steady.push_back(column == 0 ? state >> 8U : column);
    }
  }
  EXPECT_TRUE(packed(alike, 8, 1).byRows);
  EXPECT_FALSE(packed(steady, 8, 1).byRows);
  EXPECT_EQ(unpacked(packed(alike, 8, 1)), alike);
  EXPECT_EQ(unpacked(packed(steady, 8, 1)), steady);
}

TEST(Base64, FollowsItsStandard) {
  // The test vectors of RFC 4648.
  const std::array<std::array<const char*, 2>, 7> known = {{{"", ""},
                                                            {"f", "Zg=="},
                                                            {"fo", "Zm8="},
                                                            {"foo", "Zm9v"},
                                                            {"foob", "Zm9vYg=="},
                                                            {"fooba", "Zm9vYmE="},
                                                            {"foobar", "Zm9vYmFy"}}};
  for (const auto& [bytes, text] : known) EXPECT_EQ(toBase64(bytes), text);
  EXPECT_EQ(toBase64("\xff\xff\xfe"), "///+");
}

TEST(Quantization, RoundsToAMillionthOfTheLongestSide) {
  HexMesh mesh = gridMesh(3);
  for (Vec3& point : mesh.points) {
    point = {1e6 + 0.1 * point[0], -7 + point[1] / 3, 1e-3 * point[2]};
  }
  const Quantization quantization = quantizationOf(mesh);
  EXPECT_NEAR(quantization.step, 1e-6, 1e-7);
  Context context;
  Stage stage(context, "test");
  const Array<double> quality = scaledJacobians(mesh, context);
  const std::vector<PackedTable> tables = packMesh(mesh, quantization, {quality}, {}, stage);
  const std::vector<std::uint32_t> stored = unpacked(tables.at(0));
  ASSERT_EQ(stored.size(), 3 * mesh.points.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const double place = quantization.lower[i % 3] + quantization.step * stored[i];
    EXPECT_NEAR(place, mesh.points[i / 3][i % 3], 0.501 * quantization.step);
  }
  const std::vector<std::uint32_t> values = unpacked(tables.at(2));
  for (std::size_t c = 0; c < values.size(); ++c) {
    EXPECT_NEAR(values[c] / kQualitySteps * 2 - 1, quality[c], 2e-5);
  }
}

TEST(Quantization, TakesPointsAtOnePlaceAndHugeOnes) {
  HexMesh mesh = gridMesh(1);
  for (Vec3& point : mesh.points) point = {3, 3, 3};
  EXPECT_EQ(quantizationOf(mesh).step, 1);
  mesh.points[0] = {-8e307, 0, 0};
  mesh.points[1] = {8e307, 0, 0};
  EXPECT_TRUE(std::isfinite(quantizationOf(mesh).step));
  for (Vec3& point : mesh.points) point = {0, 0, 0};
  mesh.points[0] = {4e-320, 0, 0};
  EXPECT_GT(quantizationOf(mesh).step, 0);
}

/// A page in a file of its own.
class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("hexhex-view-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// @param mesh  straight or curved
  std::string write(const auto& mesh, const ViewOptions& options = {}, int threads = 0) {
    Context context(threads);
    writeViewPage(mesh, folder_ / "page.html", options, context);
    std::ostringstream text;
    text << std::ifstream(folder_ / "page.html").rdbuf();
    std::filesystem::remove(folder_ / "page.html");
    return text.str();
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  void expectRefused(const auto& mesh, ErrorCode code, const ViewOptions& options = {}) {
    try {
      write(mesh, options);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
  }

 private:
  std::filesystem::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Page, HoldsCountsAndForbidsTheNetwork) {
  const std::string page = write(gridMesh(3));
  EXPECT_TRUE(contains(page, "\"cells\":27,"));
  EXPECT_TRUE(contains(page, "\"boundaryQuads\":54,"));
  // A cube of 3^3 cells has 12 edges of 3 hex edges with one cell each.
  EXPECT_TRUE(contains(page, "\"boundary\":[[1,36]],\"inner\":[]"));
  EXPECT_TRUE(contains(page, "default-src 'none'"));
  EXPECT_FALSE(contains(page, "connect-src"));
  EXPECT_TRUE(contains(page, "id=\"data-cells-0\""));
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST_F(Page, DoesNotDependOnTheNumberOfThreads) {
  const HexMesh mesh = gridMesh(40);
  EXPECT_EQ(write(mesh, {}, 1), write(mesh, {}, 4));
}

TEST_F(Page, TakesAnyTitle) {
  ViewOptions options;
  options.title = "</script><script>alert(1)</script>&\xff";
  const std::string page = write(gridMesh(1), options);
  EXPECT_FALSE(contains(page, "<script>alert"));
  EXPECT_TRUE(contains(page, "&lt;script>alert"));
}

TEST_F(Page, TellsOfTheVerification) {
  const VerifyReport report{{{"cells", "28", "27", false}}};
  ViewOptions options;
  options.verification = &report;
  options.mapName = "a.hexex";
  const std::string page = write(gridMesh(3), options);
  EXPECT_TRUE(contains(page, "\"expected\":\"28\",\"found\":\"27\""));
  EXPECT_TRUE(contains(page, "\"map\":\"a.hexex\",\"passed\":false"));
}

TEST_F(Page, RefusesWhatCannotBeShown) {
  expectRefused(HexMesh{}, ErrorCode::EmptyMesh);
  HexMesh mesh = gridMesh(2);
  mesh.cells[3][2] = 1000;
  expectRefused(mesh, ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  mesh.points[5][1] = std::nan("");
  expectRefused(mesh, ErrorCode::NotFinite);
  mesh = gridMesh(2);
  mesh.points[0][0] = -1.7e308;  // the box is longer than the largest double
  mesh.points[1][0] = 1.7e308;
  expectRefused(mesh, ErrorCode::TooLarge);
  mesh = gridMesh(2);
  mesh.features.quads.push_back({{0, 1, 2, 1000}, 7});
  expectRefused(mesh, ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  mesh.regions.resize(3);
  expectRefused(mesh, ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  const std::array<double, 3> tooFew = {1, 1, 1};
  ViewOptions options;
  options.scaledJacobians = tooFew;
  expectRefused(mesh, ErrorCode::InvalidArgument, options);
  mesh.generatorCorners.resize(1);
  expectRefused(mesh, ErrorCode::InvalidArgument);
  mesh = gridMesh(1);
  mesh.points.resize(std::size_t{1} << 24U);  // memory that nobody touches
  expectRefused(mesh, ErrorCode::TooLarge);
}

TEST_F(Page, TakesHugeAndTinyMeshes) {
  for (const double factor : {1e300, 1e150, 1e-150, 1e-300}) {
    HexMesh mesh = gridMesh(2);
    for (Vec3& point : mesh.points) {
      for (double& coordinate : point) coordinate *= factor;
    }
    const std::string page = write(mesh);
    // JSON knows no NaN: it would be null here.
    EXPECT_FALSE(contains(page, "null,\"notPositive\"")) << factor;
    EXPECT_FALSE(contains(page, "\"mean\":null")) << factor;
    EXPECT_FALSE(contains(page, "\"minimum\":null")) << factor;
  }
}

/// The grid's inner vertices are somewhere else.
HexMesh shaken(HexMesh mesh, double by) {
  for (Vec3& point : mesh.points) {
    const bool isInside = std::ranges::all_of(point, [](double x) { return x > 0.5 && x < 2.5; });
    if (isInside) point = {point[0] + by, point[1] - by / 2, point[2]};
  }
  return mesh;
}

const PackedTable& tableNamed(const std::vector<PackedTable>& tables, const std::string& name) {
  return *std::ranges::find(tables, name, &PackedTable::name);
}

TEST(StateBefore, AddsToThePositionsAfter) {
  const HexMesh mesh = gridMesh(3);
  const HexMesh earlier = shaken(mesh, 1.7);
  Context context;
  const Certificate now = certify(mesh, context);
  const Certificate then = certify(earlier, context);
  const StateBefore before{earlier.points, {}, {then.scaledJacobians, {3, 5}}};
  const Quantization quantization = quantizationOf(mesh, {}, before);
  EXPECT_GT(quantization.upper[0], 3);  // vertices were outside of the box of today
  Stage stage(context, "test");
  const auto tables =
      packMesh(mesh, quantization, {now.scaledJacobians}, {}, stage, SurfaceNodes(), before);
  const auto after = unpacked(tableNamed(tables, "points"));
  const auto added = unpacked(tableNamed(tables, "points_before"));
  ASSERT_EQ(added.size(), after.size());
  for (std::size_t i = 0; i < added.size(); ++i) {
    const double place = quantization.lower[i % 3] + quantization.step * (after[i] + added[i]);
    EXPECT_NEAR(place, earlier.points[i / 3][i % 3], 0.501 * quantization.step);
  }
  const auto values = unpacked(tableNamed(tables, "quality_before"));
  for (std::size_t c = 0; c < values.size(); ++c) {
    EXPECT_NEAR(values[c] / kQualitySteps * 2 - 1, then.scaledJacobians[c], 2e-5);
  }
  EXPECT_EQ(unpacked(tableNamed(tables, "not_positive_before")),
            (std::vector<std::uint32_t>{3, 5}));
}

TEST_F(Page, HoldsAnEarlierStateOnlyIfThereIsOne) {
  const HexMesh mesh = gridMesh(3);
  const std::string alone = write(mesh);
  for (const char* const word : {"id=\"data-points_before", "id=\"data-quality_before",
                                 "id=\"data-not_positive", "\"before\":{"}) {
    EXPECT_FALSE(contains(alone, word)) << word;
  }
  const HexMesh earlier = shaken(mesh, 1.7);
  ViewOptions options;
  options.pointsBefore = earlier.points;
  const std::string both = write(mesh, options);
  for (const char* const word : {"id=\"data-points_before-0", "id=\"data-quality_before-0",
                                 "id=\"data-not_positive_before-0", "\"before\":{"}) {
    EXPECT_TRUE(contains(both, word)) << word;
  }
}

TEST_F(Page, RefusesAnEarlierStateOfAnotherMesh) {
  const HexMesh other = gridMesh(2);
  ViewOptions options;
  options.pointsBefore = other.points;
  expectRefused(gridMesh(3), ErrorCode::InvalidArgument, options);
}

/// A grid of side^3 cells with nodes halfway between vertices.
LagrangeMesh quadraticGrid(std::size_t side) {
  const std::size_t n = 2 * side + 1;
  LagrangeMesh mesh;
  mesh.order = 2;
  // The grid's vertices come first.
  Array<Index> numberOf(n * n * n);
  for (const bool corners : {true, false}) {
    for (std::size_t v = 0; v < numberOf.size(); ++v) {
      const std::array<std::size_t, 3> place = {v % n, v / n % n, v / n / n};
      const bool isCorner = std::ranges::all_of(place, [](auto k) { return k % 2 == 0; });
      if (isCorner != corners) continue;
      numberOf[v] = static_cast<Index>(mesh.points.size());
      mesh.points.push_back({static_cast<double>(place[0]), static_cast<double>(place[1]),
                             static_cast<double>(place[2])});
    }
    if (corners) mesh.vertexCount = mesh.points.size();
  }
  for (std::size_t cell = 0; cell < side * side * side; ++cell) {
    const std::size_t begin =
        2 * (cell % side + n * (cell / side % side + n * (cell / side / side)));
    for (std::size_t place = 0; place < 27; ++place) {
      mesh.nodes.push_back(numberOf[begin + place % 3 + n * (place / 3 % 3 + n * (place / 9))]);
    }
  }
  return mesh;
}

std::size_t taggedBy(const TetMesh& tets, const Place& place) {
  return cutTets(tets, place).features.edges.size();
}

TEST(CutTets, AreFourPositiveHexahedraEach) {
  const TetMap map = testing::identityMap(2);
  TetMesh tets{map.points, map.tets};
  std::swap(tets.tets[5][1], tets.tets[5][2]);
  Context context;
  const HexMesh mesh = cutTets(tets, {});
  EXPECT_EQ(mesh.cells.size(), 4 * tets.tets.size());
  EXPECT_TRUE(certify(mesh, context).allPositive());
  const MeshStructure structure = findStructure(mesh, context);
  EXPECT_EQ(structure.boundaryQuads,
            6U * 4 * 2 * 3);  // faces of the box, squares, triangles, quads
  EXPECT_EQ(structure.eulerCharacteristic, 1);
  EXPECT_EQ(structure.components, 1U);
}

TEST(CutTets, TagEdgesAtThePlace) {
  const TetMesh tets{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
                     {{0, 1, 2, 3}, {1, 2, 3, 4}}};
  EXPECT_EQ(taggedBy(tets, {}), 0U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Vertex, 0}), 2 * 3U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Vertex, 3}), 2 * 4U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Edge, 4, 2}), 2 * 1U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Edge, 0, 4}), 0U);  // no edge
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Face, 1, 3}), 2 * 3U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Tet, 1}), 2 * 6U);
  EXPECT_EQ(taggedBy(tets, {PlaceKind::Tet, 7}), 0U);
  const HexMesh mesh = cutTets(tets, {PlaceKind::Vertex, 4});
  EXPECT_EQ(mesh.regions, (Array<std::int32_t>{2, 2, 2, 2, 1, 1, 1, 1}));
}

TEST_F(Page, ShowsWhereAPartIsInTheWay) {
  const TetMesh tets{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  Context context;
  const auto page = folder() / "part.html";
  writeViewPage(tets, {PlaceKind::Edge, 0, 1}, page, {}, context);
  std::ostringstream text;
  text << std::ifstream(page).rdbuf();
  EXPECT_TRUE(contains(text.str(), "\"cells\":4,"));
  EXPECT_TRUE(contains(text.str(), "\"name\":\"feature_edges\",\"rows\":2,"));
  const auto refusalOf = [&](const TetMesh& bad) {
    return test::errorOf([&] { writeViewPage(bad, {}, page, {}, context); }).code();
  };
  EXPECT_EQ(refusalOf({}), ErrorCode::EmptyMesh);
  EXPECT_EQ(refusalOf({tets.points, {{0, 1, 2, 4}}}), ErrorCode::IndexOutOfRange);
}

TEST(SurfaceNodes, AreThoseOnFaces) {
  const LagrangeMesh mesh = quadraticGrid(2);
  const SurfaceNodes nodes = surfaceNodesOf(mesh);
  EXPECT_EQ(nodes.perCell, 27U - 8U - 1U);
  ASSERT_EQ(nodes.numbers.size(), 8 * nodes.perCell);
  // Of 5^3 nodes, 3^3 are vertices and 2^3 are inside cells.
  EXPECT_EQ(nodes.points.size(), 125U - 27U - 8U);
  std::vector<bool> named(nodes.points.size(), false);
  for (const Index number : nodes.numbers) named.at(number - mesh.vertexCount) = true;
  EXPECT_EQ(std::count(named.begin(), named.end(), true), 90);
  // The first one of a cell is halfway from its corner 0 to corner 1.
  const HexMesh corners = straightMesh(mesh);
  for (std::size_t c = 0; c < 8; ++c) {
    const Vec3& place = nodes.points[nodes.numbers[c * nodes.perCell] - mesh.vertexCount];
    const Vec3& a = corners.points[corners.cells[c][0]];
    const Vec3& b = corners.points[corners.cells[c][1]];
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(place[axis], (a[axis] + b[axis]) / 2);
  }
}

TEST_F(Page, HoldsCurvedCells) {
  const LagrangeMesh mesh = quadraticGrid(2);
  const std::string page = write(mesh);
  EXPECT_TRUE(contains(page, "\"order\":2,"));
  EXPECT_TRUE(contains(page, "\"points\":117,"));
  EXPECT_TRUE(contains(page, "\"vertices\":27"));
  LagrangeMesh broken = mesh;
  broken.nodes[13] = 1000;
  expectRefused(broken, ErrorCode::InvalidArgument);
  broken = mesh;
  broken.vertexCount = 5;
  expectRefused(broken, ErrorCode::InvalidArgument);
  broken = mesh;
  broken.nodes.pop_back();
  expectRefused(broken, ErrorCode::InvalidArgument);
}

TEST_F(Page, HoldsAnEarlierStateOfCurvedCells) {
  const LagrangeMesh mesh = quadraticGrid(2);
  LagrangeMesh earlier = mesh;
  for (Vec3& point : earlier.points) point[0] = -point[0];
  ViewOptions options;
  options.pointsBefore = earlier.points;
  const std::string page = write(mesh, options);
  EXPECT_TRUE(contains(page, "\"refuted\":8"));  // mirrored: all of them
  EXPECT_TRUE(contains(page, "\"name\":\"points_before\",\"rows\":117,"));
  EXPECT_TRUE(contains(page, "id=\"data-quality_before-0\""));
  EXPECT_TRUE(contains(page, "id=\"data-not_positive_before-0\""));
  earlier.points[3][1] = std::nan("");
  options.pointsBefore = earlier.points;
  expectRefused(mesh, ErrorCode::NotFinite, options);
}

}  // namespace
}  // namespace hexhex::view
