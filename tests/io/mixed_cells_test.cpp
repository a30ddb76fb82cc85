// Files with hexahedra among other volume cells, as most mesh generators write them: refused, with
// all types named; read without the others where that is asked for; or carried from file to file.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/summary.hpp>

#include <io/core/mesh_groups.hpp>
#include <io/io_test_support.hpp>
#if !defined(_WIN32)  // it runs programs by POSIX's functions
#include <io/other_programs.hpp>
#endif

namespace hexhex::test {
namespace {

/// A hexahedron (vertices 0 to 7) with a pyramid on top, two tets beside each other and a prism,
/// over 13 points; the quad and the triangle are no volume cells.
struct Element {
  int vtk;
  int gmsh;
  std::string medit;
  std::vector<int> corners;
};
const std::vector<Element> kElements = {{9, 3, "Quadrilaterals", {0, 1, 2, 3}},
                                        {14, 7, "Pyramids", {4, 5, 6, 7, 8}},
                                        {12, 5, "Hexahedra", {0, 1, 2, 3, 4, 5, 6, 7}},
                                        {10, 4, "Tetrahedra", {4, 5, 8, 9}},
                                        {10, 4, "Tetrahedra", {5, 6, 8, 9}},
                                        {13, 6, "Prisms", {1, 2, 10, 5, 6, 11}},
                                        {5, 2, "Triangles", {8, 9, 12}}};
constexpr int kPoints = 13;

std::string pointsAs(const std::string& before, const std::string& behind) {
  std::string text;
  for (int i = 0; i < kPoints; ++i) {
    text += before.empty() ? "" : std::to_string(i + 1) + before;
    for (const int k : {(i ^ (i >> 1)) & 1, (i >> 1) & 1, i >> 2}) text += std::to_string(k) + ' ';
    text += behind + '\n';
  }
  return text;
}

std::string cornersOf(const Element& element, int first) {
  std::string text;
  for (const int corner : element.corners) text += ' ' + std::to_string(corner + first);
  return text;
}

std::string legacyVtk(const std::vector<Element>& elements) {
  std::string cells;
  std::string types;
  std::size_t numbers = 0;
  for (const Element& element : elements) {
    cells += std::to_string(element.corners.size()) + cornersOf(element, 0) + '\n';
    types += std::to_string(element.vtk) + '\n';
    numbers += element.corners.size() + 1;
  }
  const std::string count = std::to_string(elements.size());
  return "# vtk DataFile Version 3.0\nmixed\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 13 double\n" +
         pointsAs("", "") + "CELLS " + count + ' ' + std::to_string(numbers) + '\n' + cells +
         "CELL_TYPES " + count + '\n' + types;
}

std::string vtu(const std::vector<Element>& elements) {
  std::string cells;
  std::string ends;
  std::string types;
  std::size_t end = 0;
  for (const Element& element : elements) {
    cells += cornersOf(element, 0);
    ends += std::to_string(end += element.corners.size()) + ' ';
    types += std::to_string(element.vtk) + ' ';
  }
  const auto array = [](const std::string& attributes, const std::string& content) {
    return "<DataArray format=\"ascii\" " + attributes + '>' + content + "</DataArray>";
  };
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
         "<UnstructuredGrid><Piece NumberOfPoints=\"13\" NumberOfCells=\"" +
         std::to_string(elements.size()) + "\"><Points>" +
         array("type=\"Float64\" NumberOfComponents=\"3\"", pointsAs("", "")) + "</Points><Cells>" +
         array("type=\"Int32\" Name=\"connectivity\"", cells) +
         array("type=\"Int32\" Name=\"offsets\"", ends) +
         array("type=\"UInt8\" Name=\"types\"", types) +
         "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

std::string gmsh22(const std::vector<Element>& elements) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n13\n" + pointsAs(" ", "") +
                     "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + '\n';
  for (std::size_t i = 0; i < elements.size(); ++i) {
    text += std::to_string(i + 1) + ' ' + std::to_string(elements[i].gmsh) + " 2 0 1" +
            cornersOf(elements[i], 1) + '\n';
  }
  return text + "$EndElements\n";
}

std::string gmsh41(const std::vector<Element>& elements) {
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 13 1 13\n3 1 0 13\n";
  for (int i = 0; i < kPoints; ++i) text += std::to_string(i + 1) + '\n';
  const std::string count = std::to_string(elements.size());
  text += pointsAs("", "") + "$EndNodes\n$Elements\n" + count + ' ' + count + " 1 " + count + '\n';
  for (std::size_t i = 0; i < elements.size(); ++i) {
    text += "3 1 " + std::to_string(elements[i].gmsh) + " 1\n" + std::to_string(i + 1) +
            cornersOf(elements[i], 1) + '\n';
  }
  return text + "$EndElements\n";
}

std::string medit(const std::vector<Element>& elements) {
  std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n13\n" + pointsAs("", "0");
  std::vector<std::string> done;
  for (const Element& element : elements) {
    if (std::find(done.begin(), done.end(), element.medit) != done.end()) continue;
    done.push_back(element.medit);
    std::string section;
    int count = 0;
    for (const Element& other : elements) {
      if (other.medit != element.medit) continue;
      section += cornersOf(other, 1) + " 0\n";
      ++count;
    }
    text += element.medit + '\n' + std::to_string(count) + '\n' + section;
  }
  return text + "End\n";
}

struct Kind {
  std::string extension;
  std::string (*write)(const std::vector<Element>& elements);
};
const std::vector<Kind> kKinds = {
    {".vtk", legacyVtk}, {".vtu", vtu}, {".msh", gmsh22}, {".msh", gmsh41}, {".mesh", medit}};

/// "hexahedra 1, prisms 1, ..."
std::string asText(const std::vector<CellCount>& counts) {
  std::string text;
  for (const CellCount& each : counts) text += each.name + ' ' + std::to_string(each.count) + ", ";
  return text;
}

class MixedCells : public testing::Test {
 protected:
  /// Calls f(file) with a file of each format.
  template <class F>
  void forEachFormat(const std::vector<Element>& elements, const F& f) {
    for (const Kind& kind : kKinds) {
      SCOPED_TRACE(kind.extension + ' ' + kind.write(elements).substr(0, 20));
      const std::filesystem::path file = folder_ / ("x" + kind.extension);
      writeText(file, kind.write(elements));
      f(file);
    }
  }
  static std::vector<Element> only(const std::vector<int>& vtkTypes) {
    std::vector<Element> elements;
    for (const int type : vtkTypes) {
      for (const Element& element : kElements) {
        if (element.vtk == type) elements.push_back(element);
      }
    }
    return elements;
  }

  TemporaryFolder folder_;
  Context context_{2};
};

TEST_F(MixedCells, AreRefusedAndNamed) {
  forEachFormat(kElements, [this](const std::filesystem::path& file) {
    const auto expectRefused = [](const auto& read) {
      const Failure failure = failureOf(read);
      EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
      EXPECT_NE(failure.sentence.find("1 hexahedron, 1 prism, 1 pyramid and 2 tetrahedra"),
                std::string::npos)
          << failure.sentence;
      EXPECT_NE(failure.sentence.find("--hexes-only"), std::string::npos);
    };
    expectRefused([&] { static_cast<void>(readHexMesh(file, context_)); });
    expectRefused([&] { static_cast<void>(readMapOrHexMesh(file, {}, context_)); });
    expectRefused([&] { static_cast<void>(summarizeFile(file, context_)); });
    // A file that is written piece by piece does not appear.
    expectRefused([&] {
      const auto sink = openMeshSink(folder_ / "copy.vtu", context_);
      readHexMeshTo(*sink, file, context_);
    });
    EXPECT_FALSE(std::filesystem::exists(folder_ / "copy.vtu"));
  });
}

TEST_F(MixedCells, AreLeftOutIfThatIsAskedFor) {
  forEachFormat(kElements, [this](const std::filesystem::path& file) {
    std::vector<CellCount> counts;
    const ReadOptions options = {.hexesOnly = true, .cellCounts = &counts};
    const auto expectCounts = [&] {
      EXPECT_EQ(asText(counts), "hexahedra 1, prisms 1, pyramids 1, tetrahedra 2, ");
      counts.clear();
    };
    const HexMesh mesh = readHexMesh(file, options, context_);
    EXPECT_EQ(mesh.cells, (Array<Hex>{{0, 1, 2, 3, 4, 5, 6, 7}}));
    EXPECT_EQ(mesh.points.size(), 13U);
    expectCounts();
    EXPECT_TRUE(std::holds_alternative<HexMesh>(readMapOrHexMesh(file, options, context_)));
    expectCounts();
    EXPECT_EQ(summarizeFile(file, options, context_).cells, 1U);
    expectCounts();
  });
}

/// Faces, edges and points are how files tag boundaries.
TEST_F(MixedCells, DoNotCountWhatIsNoVolume) {
  forEachFormat(only({9, 12, 5}), [this](const std::filesystem::path& file) {
    std::vector<CellCount> counts;
    const HexMesh mesh = readHexMesh(file, {.cellCounts = &counts}, context_);
    EXPECT_EQ(mesh.cells.size(), 1U);
    EXPECT_EQ(asText(counts), "hexahedra 1, ");
  });
}

TEST_F(MixedCells, OfTetsAreRefusedToo) {
  forEachFormat(only({5, 10, 13}), [this](const std::filesystem::path& file) {
    const Failure failure = failureOf([&] { static_cast<void>(readTetMesh(file, {}, context_)); });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
    EXPECT_NE(failure.sentence.find("1 prism and 2 tetrahedra"), std::string::npos)
        << failure.sentence;
  });
  forEachFormat(only({5, 10}), [this](const std::filesystem::path& file) {
    EXPECT_EQ(readTetMesh(file, {}, context_).tets.size(), 2U);
  });
}

/// Whatever a file holds in place of hexahedra is called what it is.
TEST_F(MixedCells, AreNamedWhereThereAreNoHexahedra) {
  std::vector<int> corners(20);
  for (int i = 0; i < 20; ++i) corners[static_cast<std::size_t>(i)] = i % kPoints;
  const Element twenty = {25, 17, "none", corners};
  corners.resize(27, 0);
  const Element twentySeven = {29, 12, "HexahedraQ2", corners};
  const auto expectNamed = [this](const std::filesystem::path& file, const std::string& what) {
    for (const bool hexesOnly : {false, true}) {
      const Failure failure = failureOf(
          [&] { static_cast<void>(readMapOrHexMesh(file, {.hexesOnly = hexesOnly}, context_)); });
      EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
      EXPECT_NE(failure.sentence.find("no hexahedra"), std::string::npos) << failure.sentence;
      EXPECT_NE(failure.sentence.find("it holds " + what), std::string::npos) << failure.sentence;
    }
  };
  forEachFormat({twentySeven, twentySeven}, [&](const std::filesystem::path& file) {
    expectNamed(file, "2 hexahedra with 27 nodes.");
  });
  forEachFormat(only({13, 14}), [&](const std::filesystem::path& file) {
    expectNamed(file, "1 prism and 1 pyramid.");
  });
  for (const Kind& kind : kKinds) {
    if (kind.extension == ".mesh") continue;  // which has no section for them
    const std::filesystem::path file = folder_ / ("x" + kind.extension);
    writeText(file, kind.write({twenty}));
    expectNamed(file, "1 hexahedron with 20 nodes.");
  }
  Element unknown = twenty;
  unknown.vtk = 200;
  writeText(folder_ / "x.vtk", legacyVtk({unknown, unknown}));
  expectNamed(folder_ / "x.vtk", "2 cells of VTK's type 200.");
}

/// Cells of higher order, too, are a whole mesh or none.
TEST_F(MixedCells, AreRefusedBesideCurvedOnes) {
  SampleOptions sample;
  sample.cells = 1;
  const LagrangeMesh mesh =
      extractLagrange(generateSample(SampleKind::Box, sample).map, 2, {}, context_);
  const std::filesystem::path file = folder_ / "curved.vtu";
  Element curved = {72, 12, "", {}};
  for (int i = 0; i < 27; ++i) curved.corners.push_back(i % kPoints);
  std::vector<Element> elements = only({10});
  elements.push_back(curved);
  writeText(file, vtu(elements));
  const Failure failure = failureOf([&] { static_cast<void>(readLagrangeMesh(file, context_)); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("1 Lagrange hexahedron and 2 tetrahedra"), std::string::npos)
      << failure.sentence;
  writeLagrangeMesh(mesh, file, {}, context_);
  EXPECT_EQ(readLagrangeMesh(file, context_).cellCount(), mesh.cellCount());
}

/// The binary formats that this library writes itself, with a section or block of tets put in.
TEST_F(MixedCells, AreFoundInBinaryFiles) {
  const std::filesystem::path file = folder_ / "x.meshb";
  writeHexMesh(gridMesh(2, 1, 1), file, context_);
  std::string bytes = contentOf(file);
  // Version 2: the code of the section Hexahedra becomes that of a list of prisms behind it.
  const auto number = [](std::uint32_t value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const std::size_t end = bytes.size() - 8;  // the section End: its code and position
  ASSERT_EQ(bytes.substr(end, 4), number(54));
  std::string prisms = number(9) + number(static_cast<std::uint32_t>(end) + 12 + 7 * 4) + number(1);
  for (const std::uint32_t k : {1U, 2U, 3U, 4U, 5U, 6U, 0U}) prisms += number(k);
  bytes.insert(end, prisms);
  writeText(file, bytes);
  const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(file, context_)); });
  EXPECT_NE(failure.sentence.find("2 hexahedra and 1 prism"), std::string::npos)
      << failure.sentence;
  EXPECT_NE(failureOf([&] {
              static_cast<void>(summarizeFile(file, context_));
            }).sentence.find("2 hexahedra and 1 prism"),
            std::string::npos);
  EXPECT_EQ(readHexMesh(file, {.hexesOnly = true}, context_).cells.size(), 2U);
}

/// Hexahedra with a pyramid on the first, a prism on the second, and tets between and beside these,
/// in regions of several kinds of cells.
struct Mixed {
  HexMesh mesh = gridMesh(2, 1, 1);
  OtherCells others;

  Mixed() {
    mesh.points.insert(mesh.points.end(), {{0.5, 0.5, 2}, {1, 0.5, 2}, {2, 0.5, 2}, {3, 0.5, 1.5}});
    mesh.regions = {1, 2};
    others.kinds[0].vertices = {7, 10, 12, 13, 8, 11, 14, 15};
    others.kinds[0].regions = {3, 1};
    others.kinds[1].vertices = {6, 7, 10, 9, 12};
    others.kinds[1].regions = {2};
    others.kinds[2].vertices = {7, 10, 13, 8, 11, 14};
    others.kinds[2].regions = {3};
    mesh.features.quads = {{{0, 3, 4, 1}, 7}, {{7, 8, 14, 13}, 7}, {{10, 13, 14, 11}, 6}};
    others.triangles = {{{6, 7, 12}, 7}, {{8, 11, 15}, 8}, {{9, 12, 10}, 8}};
    mesh.features.edges = {{{0, 1}, 5}, {{13, 14}, 5}};
    mesh.features.vertices = {{12, 4}};
    mesh.features.names = {{2, 8, "skin"}, {3, 2, "steel"}};
  }
};

/// "corners region vertices" of all cells, sorted.
std::vector<std::string> cellsOf(const HexMesh& mesh, const OtherCells& others, bool regions) {
  std::vector<std::string> lines;
  const io::AllCells cells(mesh, others);
  const Array<std::int32_t> all = cells.regions();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string& line = lines.emplace_back(std::to_string(cells[i].size()));
    line += ' ' + std::to_string(regions && !all.empty() ? all[i] : 0);
    for (const Index v : cells[i]) line += ' ' + std::to_string(v);
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

/// Sorted vertices and tags of all features with tags.
std::map<std::vector<Index>, std::int32_t> tagsOf(const HexMesh& mesh, const OtherCells& others) {
  std::map<std::vector<Index>, std::int32_t> tags;
  const auto add = [&tags](const auto& features) {
    for (const auto& feature : features) {
      std::vector<Index> key(feature.vertices.begin(), feature.vertices.end());
      std::sort(key.begin(), key.end());
      tags[key] = feature.tag;
    }
  };
  add(mesh.features.quads);
  add(others.triangles);
  add(mesh.features.edges);
  for (const FeatureVertex& feature : mesh.features.vertices) tags[{feature.vertex}] = feature.tag;
  return tags;
}

struct MixedFormat {
  std::string name;
  std::string extension;
  bool faces = true;  ///< whether it holds tags of faces
  bool edges = true;  ///< and of edges
  bool names = true;  ///< and tags of groups with names
};
bool hasFormat(std::string_view name) {
  const auto formats = fileFormats();
  return std::any_of(formats.begin(), formats.end(), [name](const FileFormat& format) {
    return format.name == name && format.writesHexMeshes;
  });
}
std::vector<MixedFormat> mixedFormats() {
  std::vector<MixedFormat> formats = {
      {"vtu", ".vtu"},
      {"vtk", ".vtk", false, false, false},
      {"vtk-binary", ".vtk", false, false, false},
      {"msh", ".msh"},
      {"msh41-ascii", ".msh"},
      {"msh22-ascii", ".msh"},
      {"mesh", ".mesh", true, false, false},
      {"meshb", ".meshb", true, true, false},
      {"inp", ".inp", true, true, false},  // tags of named groups are new

      {"exodus", ".exo"}};
  if (hasFormat("vtkhdf")) formats.push_back({"vtkhdf", ".vtkhdf", true, true, false});
  return formats;
}

TEST_F(MixedCells, AreCarriedThroughEveryPairOfFormatsThatHoldThem) {
  const Mixed wanted;
  for (const MixedFormat& first : mixedFormats()) {
    for (const MixedFormat& second : mixedFormats()) {
      SCOPED_TRACE(first.name + " to " + second.name);
      HexMesh mesh = wanted.mesh;
      OtherCells others = wanted.others;
      const bool names = first.names && second.names;
      if (!names) mesh.features.names.clear();
      for (const MixedFormat& format : {first, second}) {
        const std::filesystem::path file = folder_ / ("x" + format.extension);
        writeHexMesh(mesh, file, {.format = format.name, .others = &others}, context_);
        others = {};
        mesh = readHexMesh(file, {.format = format.name, .others = &others}, context_);
      }
      expectSameBits(mesh.points, wanted.mesh.points);
      EXPECT_EQ(cellsOf(mesh, others, true), cellsOf(wanted.mesh, wanted.others, true));
      HexMesh tagged = wanted.mesh;
      if (!first.edges || !second.edges) tagged.features.edges.clear();
      if (first.faces && second.faces) {
        EXPECT_EQ(tagsOf(mesh, others), tagsOf(tagged, wanted.others));
      }
      if (names) {
        const auto isThere = [&mesh](const TagName& name) {
          const auto& all = mesh.features.names;
          return std::find(all.begin(), all.end(), name) != all.end();
        };
        EXPECT_TRUE(isThere({2, 8, "skin"}));
        EXPECT_TRUE(isThere({3, 2, "steel"}));
      }
    }
  }
}

/// Untagged boundaries are those of all cells: not where hexahedra meet others.
TEST_F(MixedCells, HaveTheirCommonBoundary) {
  Mixed mixed;
  mixed.mesh.features = {};
  mixed.mesh.regions.clear();
  mixed.others.triangles.clear();
  for (OtherCellList& kind : mixed.others.kinds) kind.regions.clear();
  for (const double angle : {0.0, 20.0}) {
    const std::filesystem::path file = folder_ / "x.msh";
    writeHexMesh(mixed.mesh, file, {.patchAngle = angle, .others = &mixed.others}, context_);
    const std::string text = contentOf(file);
    EXPECT_EQ(text.find("boundary") == std::string::npos, angle > 0);
    EXPECT_NE(text.find("\"all_cells\""), std::string::npos);
    OtherCells read;
    const HexMesh mesh = readHexMesh(file, {.others = &read}, context_);
    EXPECT_TRUE(mesh.regions.empty());
    EXPECT_EQ(cellsOf(mesh, read, true), cellsOf(mixed.mesh, mixed.others, true));
  }
  const auto groups = io::inStage(context_, "test", [&](Stage& stage) {
    return io::groupQuads(mixed.mesh, 0, stage, nullptr, mixed.others);
  });
  const auto triangles = std::count_if(groups.elements.begin(), groups.elements.end(),
                                       [](const Quad& v) { return io::cornersOf(v) == 3; });
  EXPECT_EQ(triangles, 8);                          // 4 + 2 + 8 without five that two cells share
  EXPECT_EQ(groups.elements.size(), 8U + 2U + 8U);  // 10 of hexahedra without two, 3 without one
}

TEST_F(MixedCells, AreRefusedByFormatsThatDoNotHoldThem) {
  const Mixed mixed;
  for (const std::string file : {"x.ovm", "x.foam", "y.mesh", "x.cgns"}) {
    if (file == "x.cgns" && !hasFormat("cgns")) continue;
    const std::string format = file == "y.mesh" ? "mfem" : "";
    const Failure failure = failureOf([&] {
      writeHexMesh(mixed.mesh, folder_ / file, {.format = format, .others = &mixed.others},
                   context_);
    });
    EXPECT_EQ(failure.code, ErrorCode::FileUnsupported) << file;
    for (const std::string word : {"1 prism, 1 pyramid and 2 tetrahedra", ".vtu, .vtk", ".inp"}) {
      EXPECT_NE(failure.sentence.find(word), std::string::npos) << failure.sentence;
    }
  }
}

TEST_F(MixedCells, ThatAreWrongAreNotWritten) {
  Mixed mixed;
  mixed.others.kinds[2].vertices[3] = 16;
  const auto write = [&] {
    writeHexMesh(mixed.mesh, folder_ / "x.vtu", {.others = &mixed.others}, context_);
  };
  EXPECT_EQ(failureOf(write).code, ErrorCode::InvalidArgument);
  mixed = {};
  mixed.others.kinds[1].regions.push_back(1);
  EXPECT_EQ(failureOf(write).code, ErrorCode::InvalidArgument);
}

/// Programs list the prisms of VTK's files in two ways, which mirror each other.
TEST_F(MixedCells, TurnPrismsOfVtkRound) {
  Mixed mirrored;
  mirrored.others.kinds[2].vertices = {7, 13, 10, 8, 14, 11};
  for (const std::string file : {"x.vtu", "x.vtk"}) {
    writeHexMesh(mirrored.mesh, folder_ / file, {.others = &mirrored.others}, context_);
    OtherCells read;
    static_cast<void>(readHexMesh(folder_ / file, {.others = &read}, context_));
    EXPECT_EQ(read.kinds[2].vertices, Mixed().others.kinds[2].vertices);
  }
}

/// References that say nothing of one kind of cells may tell it from another.
TEST_F(MixedCells, KeepReferencesOfMedit) {
  Mixed mixed;
  mixed.mesh.regions = {1, 1};
  for (OtherCellList& kind : mixed.others.kinds) kind.regions.assign(kind.count(), 2);
  for (const std::string file : {"x.mesh", "x.meshb"}) {
    writeHexMesh(mixed.mesh, folder_ / file, {.others = &mixed.others}, context_);
    OtherCells read;
    const HexMesh mesh = readHexMesh(folder_ / file, {.others = &read}, context_);
    EXPECT_EQ(cellsOf(mesh, read, true), cellsOf(mixed.mesh, mixed.others, true));
  }
}

#if !defined(_WIN32)
struct MixedCheck {
  std::string program;
  std::string file;
  std::string format;
  bool regions = true;  ///< whether the program says the regions
};
class MixedCellsAndOthers : public testing::TestWithParam<MixedCheck> {};

TEST_P(MixedCellsAndOthers, AreTheSameToOtherPrograms) {
  const auto& [program, file, format, regions] = GetParam();
  const TemporaryFolder folder;
  Context context;
  Mixed mixed;
  if (format == "inp") mixed.others.kinds[1] = {5};  // which meshio does not know
  writeHexMesh(mixed.mesh, folder / file, {.format = format, .others = &mixed.others}, context);
  const std::string out = (folder / "out").string();
  const std::string copy =
      (folder / ("copy" + std::filesystem::path(file).extension().string())).string();
  const int code = runScript(
      "mixed_with.py", program + " '" + (folder / file).string() + "' '" + out + "' '" + copy + "'",
      out + ".errors");
  if (isMissing(code)) GTEST_SKIP() << program << " for " << interpreter() << " is not installed";
  ASSERT_EQ(code, 0) << contentOf(out + ".errors");
  std::string wanted;
  for (const std::string& line : cellsOf(mixed.mesh, mixed.others, regions)) wanted += line + '\n';
  EXPECT_EQ(contentOf(out), wanted);
  OtherCells read;
  HexMesh mesh;
  try {
    mesh = readHexMesh(copy, {.others = &read}, context);
  } catch (const Error& error) {  // programs write with libraries that some builds are without
    if (std::string(error.what()).find("this build of hexhex") == std::string::npos) throw;
    GTEST_SKIP() << error.what();
  }
  // Programs may list points in another order, with rounded coordinates.
  const auto restore = [&](Index& v) {
    const auto isNear = [&](const Vec3& point) {
      return std::hypot(point[0] - mesh.points[v][0], point[1] - mesh.points[v][1],
                        point[2] - mesh.points[v][2]) < 1e-9;
    };
    const auto& known = mixed.mesh.points;
    v = static_cast<Index>(std::find_if(known.begin(), known.end(), isNear) - known.begin());
  };
  for (Hex& cell : mesh.cells) std::for_each(cell.begin(), cell.end(), restore);
  for (OtherCellList& kind : read.kinds) {
    std::for_each(kind.vertices.begin(), kind.vertices.end(), restore);
  }
  EXPECT_EQ(mesh.points.size(), mixed.mesh.points.size());
  EXPECT_EQ(cellsOf(mesh, read, regions), cellsOf(mixed.mesh, mixed.others, regions));
}

INSTANTIATE_TEST_SUITE_P(
    Formats, MixedCellsAndOthers,
    testing::Values(
        MixedCheck{"vtk", "a.vtu", "vtu"}, MixedCheck{"vtk", "a.vtk", "vtk"},
        MixedCheck{"vtk", "a.vtk", "vtk-binary"}, MixedCheck{"gmsh", "a.msh", "msh"},
        MixedCheck{"gmsh", "a.msh", "msh41-ascii"}, MixedCheck{"gmsh", "a.msh", "msh22-ascii"},
        MixedCheck{"meshio", "a.vtu", "vtu"}, MixedCheck{"meshio", "a.vtk", "vtk"},
        MixedCheck{"meshio", "a.msh", "msh"}, MixedCheck{"meshio", "a.msh", "msh22-ascii"},
        MixedCheck{"meshio", "a.mesh", "mesh"}, MixedCheck{"meshio", "a.meshb", "meshb"},
        MixedCheck{"meshio", "a.inp", "inp", false},
        MixedCheck{"meshio", "a.e", "exodus-e", false}),
    [](const auto& test) {
      std::string name = test.param.program + "_" + test.param.format;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });
#endif

}  // namespace
}  // namespace hexhex::test
