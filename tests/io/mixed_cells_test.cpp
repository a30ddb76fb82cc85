// Files with hexahedra among other volume cells, as most mesh generators write them: refused, with
// all types named, or read without the others where that is asked for.
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/summary.hpp>

#include <io/io_test_support.hpp>

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

}  // namespace
}  // namespace hexhex::test
