// Meshes in pieces: the files of sinks against those of the ordinary writers, reading in pieces,
// the order of calls, and files that appear complete or not at all.
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>
#include <hexhex/summary.hpp>

#include <io/file_size_limit.hpp>
#include <io/io_test_support.hpp>

#include "support/collecting_sink.hpp"
#include "support/error_of.hpp"

namespace hexhex::test::stream {
namespace {

/// A grid with random coordinates, and generators if wanted.
HexMesh randomMesh(Random& random, bool generators) {
  HexMesh mesh =
      gridMesh(static_cast<Index>(1 + random.below(12)), static_cast<Index>(1 + random.below(12)),
               static_cast<Index>(1 + random.below(12)));
  for (Vec3& point : mesh.points) {
    for (double& coordinate : point) {
      coordinate = random.below(3) == 0 ? random.anyDouble() : 1e-3 * double(random.below(1000));
    }
  }
  if (!generators) return mesh;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    mesh.generatorTet.push_back(static_cast<Index>(random.next()));
    mesh.generatorCorners.push_back(static_cast<CornerSet>(1 + random.below(15)));
  }
  return mesh;
}

template <class T>
std::span<const T> part(const Array<T>& values, std::size_t first, std::size_t count) {
  return values.empty() ? std::span<const T>() : std::span(values).subspan(first, count);
}

Array<Hex64> widened(std::span<const Hex> cells) {
  Array<Hex64> wide(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::copy(cells[i].begin(), cells[i].end(), wide[i].begin());
  }
  return wide;
}

/// Hands a mesh over in pieces of random sizes, some of them empty, up to `largest`.
void send(MeshSink& sink, const HexMesh& mesh, Random& random, std::size_t largest, bool wide) {
  sink.begin(mesh.points.size(), mesh.cells.size());
  for (std::size_t first = 0; first < mesh.points.size();) {
    const std::size_t count = std::min(random.below(largest + 1), mesh.points.size() - first);
    sink.points({first, part(mesh.points, first, count), part(mesh.generatorTet, first, count),
                 part(mesh.generatorCorners, first, count)});
    first += count;
  }
  for (std::size_t first = 0; first < mesh.cells.size();) {
    const std::size_t count = std::min(random.below(largest + 1), mesh.cells.size() - first);
    const std::span<const Hex> cells = part(mesh.cells, first, count);
    if (wide) {
      sink.cells(first, std::span<const Hex64>(widened(cells)));
    } else {
      sink.cells(first, cells);
    }
    first += count;
  }
  sink.end();
}

/// The names of the arrays that a stream has in common with the ordinary writer.
const std::vector<std::string> kArrays = {"generator_kind", "generator_tet", "generator_corners",
                                          "Points",         "connectivity",  "offsets",
                                          "types"};

/// The ordinary writer's text without boundary quads.
std::string withoutQuads(std::string text) {
  const std::size_t begin = text.find("Quadrilaterals");
  return text.erase(begin, text.find("Hexahedra") - begin);
}

TEST(Stream, SinksWriteWhatWritersWrite) {
  const TemporaryFolder folder;
  Random random(23);
  for (int i = 0; i < 60; ++i) {
    const HexMesh mesh = randomMesh(random, i % 2 == 0);
    const std::size_t largest = 1 + random.below(i % 3 == 0 ? 5 : 3000);
    for (const std::string extension : {".vtu", ".mesh", ".vtk"}) {
      Context context(1 + i % 3);
      writeHexMesh(mesh, folder / ("whole" + extension), context);
      const std::unique_ptr<MeshSink> sink = openMeshSink(folder / ("pieces" + extension), context);
      send(*sink, mesh, random, largest, i % 5 == 0);
      const std::string whole = contentOf(folder / ("whole" + extension));
      const std::string pieces = contentOf(folder / ("pieces" + extension));
      if (extension == ".mesh") {
        EXPECT_TRUE(pieces == withoutQuads(whole));
        continue;
      }
      if (extension == ".vtk") {
        EXPECT_TRUE(pieces == whole);
        continue;
      }
      EXPECT_EQ(pieces.find("scaled_jacobian"), std::string::npos);
      for (const std::string& name : kArrays) {
        EXPECT_TRUE(arrayOf(pieces, name) == arrayOf(whole, name)) << name;
      }
      EXPECT_TRUE(pieces.ends_with("\n  </AppendedData>\n</VTKFile>\n"));
      const HexMesh read = readHexMesh(folder / "pieces.vtu");
      expectSameBits(read.points, mesh.points);
      EXPECT_EQ(read.cells, mesh.cells);
    }
  }
  EXPECT_EQ(folder.fileCount(), 6U);
}

TEST(Stream, EveryFormatThatStreamsGivesTheMeshBack) {
  const TemporaryFolder folder;
  Random random(29);
  for (const FileFormat& format : fileFormats()) {
    if (!format.streams) continue;
    SCOPED_TRACE(std::string(format.name));
    WriteOptions writing;
    writing.format = format.name;
    ReadOptions reading;
    reading.format = format.name;
    for (int i = 0; i < 12; ++i) {
      Context context(1 + i % 3);
      const HexMesh mesh = randomMesh(random, i % 2 == 0);
      send(*openMeshSink(folder / "a", writing, context), mesh, random, 1 + random.below(2000),
           i % 4 == 0);
      const HexMesh read = readHexMesh(folder / "a", reading, context);
      expectSameBits(read.points, mesh.points);
      EXPECT_EQ(read.cells, mesh.cells);
    }
  }
}

TEST(Stream, EmptyMeshes) {
  const TemporaryFolder folder;
  Context context;
  Random random(1);
  for (const char* name : {"a.vtu", "a.mesh", "a.meshb", "a.msh", "a.vtk"}) {
    send(*openMeshSink(folder / name, context), HexMesh{}, random, 1, false);
    EXPECT_TRUE(readHexMesh(folder / name).cells.empty());
    HexMesh pointsOnly;
    pointsOnly.points = {{1, 2, 3}};
    send(*openMeshSink(folder / name, context), pointsOnly, random, 1, false);
    EXPECT_EQ(readHexMesh(folder / name).points.size(), 1U);
  }
}

TEST(Stream, ReadingInPiecesGivesTheMeshBack) {
  const TemporaryFolder folder;
  Random random(29);
  for (const char* name : {"a.vtu", "a.mesh", "a.meshb", "a.msh", "a.vtk", "b.vtk"}) {
    SCOPED_TRACE(name);
    HexMesh mesh = gridMesh(60, 50, 40);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      mesh.generatorTet.push_back(static_cast<Index>(random.next()));
      mesh.generatorCorners.push_back(static_cast<CornerSet>(1 + random.below(15)));
    }
    Context context;
    const bool isBinary = std::string(name) == "b.vtk";
    writeHexMesh(mesh, folder / name, {.format = isBinary ? "vtk-binary" : ""}, context);
    CollectingSink collector;
    readHexMeshTo(collector, folder / name, context);
    EXPECT_TRUE(collector.ended);
    expectSameBits(collector.mesh.points, mesh.points);
    EXPECT_EQ(collector.mesh.cells, mesh.cells);
    EXPECT_LT(collector.largestPiece, mesh.points.size());
    if (std::string(name) != "a.vtu") continue;
    EXPECT_EQ(collector.mesh.generatorTet, mesh.generatorTet);
    EXPECT_EQ(collector.mesh.generatorCorners, mesh.generatorCorners);
  }
}

/// From a file in pieces to a file in pieces and back: nothing gets lost.
TEST(Stream, FilesAreCopiedInPieces) {
  const TemporaryFolder folder;
  Random random(31);
  const HexMesh mesh = randomMesh(random, true);
  Context context;
  send(*openMeshSink(folder / "a.vtu", context), mesh, random, 100, false);
  readHexMeshTo(*openMeshSink(folder / "b.vtu", context), folder / "a.vtu", context);
  EXPECT_TRUE(contentOf(folder / "a.vtu") == contentOf(folder / "b.vtu"));
  readHexMeshTo(*openMeshSink(folder / "b.mesh", context), folder / "b.vtu", context);
  const HexMesh read = readHexMesh(folder / "b.mesh");
  expectSameBits(read.points, mesh.points);
  EXPECT_EQ(read.cells, mesh.cells);
}

TEST(Stream, OtherCellsAreSkipped) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(3, 2, 2), folder / "a.vtu");
  std::string text = contentOf(folder / "a.vtu");
  const std::string types = arrayOf(text, "types");
  const std::size_t place = text.rfind(types);
  for (const std::size_t i : {0U, 4U, 5U, 11U}) text[place + i] = 41;  // convex point sets
  writeText(folder / "b.vtu", text);
  CollectingSink collector;
  Context context;
  const ReadOptions hexesOnly = {.hexesOnly = true};
  readHexMeshTo(collector, folder / "b.vtu", hexesOnly, context);
  EXPECT_EQ(collector.mesh.cells.size(), 8U);
  EXPECT_EQ(collector.mesh.cells, readHexMesh(folder / "b.vtu", hexesOnly, context).cells);
  text.replace(place, 12, std::string(12, 41));
  writeText(folder / "c.vtu", text);
  EXPECT_EQ(failureOf([&] { readHexMeshTo(collector, folder / "c.vtu", context); }).code,
            ErrorCode::FileUnsupported);
}

/// "good", or the error.
template <class Read>
std::string outcomeOf(const Read& read) {
  try {
    read();
    return "good";
  } catch (const Error& error) {
    return error.what();
  }
}

/// Damaged files give the same error in pieces as at once.
TEST(Stream, DamagedFilesAreRefusedInPiecesToo) {
  const TemporaryFolder folder;
  Random random(37);
  for (const char* format : {"vtu", "mesh", "meshb", "msh", "vtk", "vtk-binary"}) {
    SCOPED_TRACE(format);
    const std::filesystem::path file =
        folder / ("b." + std::string(format).substr(0, std::string(format).find('-')));
    Context context;
    send(*openMeshSink(file, {.format = format}, context), gridMesh(3, 2, 2), random, 5, false);
    const std::string good = contentOf(file);
    std::size_t refused = 0;
    for (int i = 0; i < 500; ++i) {
      std::string text = good;
      for (std::size_t k = 1 + random.below(3); k > 0; --k) {
        text[random.below(text.size())] = static_cast<char>(random.below(256));
      }
      if (random.below(4) == 0) text.resize(random.below(text.size()));
      writeText(file, text);
      HexMesh mesh;
      CollectingSink collector;
      const std::string whole = outcomeOf([&] { mesh = readHexMesh(file); });
      const std::string pieces = outcomeOf([&] { readHexMeshTo(collector, file, context); });
      ASSERT_EQ(pieces, whole);
      if (whole == "good") {
        EXPECT_EQ(collector.mesh.cells, mesh.cells);
        expectSameBits(collector.mesh.points, mesh.points);
      } else {
        ++refused;
      }
    }
    EXPECT_GT(refused, 75U);
  }
}

/// What is not of the simplest form is read as a whole.
TEST(Stream, OtherFilesAreReadAsAWhole) {
  const TemporaryFolder folder;
  const std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  const std::string vertices =
      "Vertices 8\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n0 0 1 1\n1 0 1 1\n1 1 1 1\n0 1 1 1\n";
  const std::string cells = "Hexahedra 1\n1 2 3 4 5 6 7 8 1\n";
  for (const std::string& text :
       {head + vertices + cells + "End\n", head + "# a comment\n" + vertices + cells,
        head + vertices + cells + "# 9", head + "Corners 1 8 " + vertices + cells + "Edges 1 1 2 3",
        head + vertices + "Tetrahedra 1 1 2 3 5 1\n" + cells}) {
    writeText(folder / "a.mesh", text);
    CollectingSink collector;
    Context context;
    const ReadOptions hexesOnly = {.hexesOnly = true};
    readHexMeshTo(collector, folder / "a.mesh", hexesOnly, context);
    EXPECT_EQ(collector.mesh.cells, readHexMesh(folder / "a.mesh", hexesOnly, context).cells);
    EXPECT_EQ(collector.mesh.points.size(), 8U);
  }
}

struct Step {
  const char* what;
  void (*run)(MeshSink&);
};

constexpr Hex kCell = {0, 1, 2, 3, 4, 5, 6, 7};

void sendPoints(MeshSink& sink, std::uint64_t first, std::size_t count) {
  const std::vector<Vec3> points(count);
  sink.points({first, points, {}, {}});
}
void sendCells(MeshSink& sink, std::uint64_t first, std::size_t count) {
  const std::vector<Hex> cells(count, kCell);
  sink.cells(first, std::span<const Hex>(cells));
}

TEST(Stream, WrongOrderIsRefused) {
  const std::vector<Step> wrong = {
      {"points() was called before begin()", [](MeshSink& s) { sendPoints(s, 0, 8); }},
      {"before begin()", [](MeshSink& s) { sendCells(s, 0, 1); }},
      {"before begin()", [](MeshSink& s) { s.end(); }},
      {"begin() was called twice",
       [](MeshSink& s) {
         s.begin(8, 2);
         s.begin(8, 2);
       }},
      {"number 3 of the vertices has to come next, but 5 from number 4 on came",
       [](MeshSink& s) {
         s.begin(9, 2);
         sendPoints(s, 0, 3);
         sendPoints(s, 4, 5);
       }},
      {"more vertices than the 8",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 9);
       }},
      {"only 7 of 8 vertices",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 7);
         sendCells(s, 0, 1);
       }},
      {"points() was called after cells()",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 8);
         sendCells(s, 0, 1);
         sendPoints(s, 8, 1);
       }},
      {"number 1 of the cells has to come next",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 8);
         sendCells(s, 0, 1);
         sendCells(s, 0, 1);
       }},
      {"more cells than the 2",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 8);
         sendCells(s, 0, 3);
       }},
      {"only 1 of 2 cells",
       [](MeshSink& s) {
         s.begin(8, 2);
         sendPoints(s, 0, 8);
         sendCells(s, 0, 1);
         s.end();
       }},
      {"generators",
       [](MeshSink& s) {
         s.begin(8, 2);
         const std::vector<Vec3> points(4);
         const std::vector<Index> tets(4);
         s.points({0, points, tets, {}});
         s.points({4, points, {}, {}});
       }},
      {"generators",
       [](MeshSink& s) {
         s.begin(8, 2);
         const std::vector<Vec3> points(4);
         const std::vector<CornerSet> corners(3);
         s.points({0, points, {}, corners});
       }},
  };
  const TemporaryFolder folder;
  Context context;
  for (const char* name : {"a.vtu", "a.mesh"}) {
    for (const Step& step : wrong) {
      const std::unique_ptr<MeshSink> sink = openMeshSink(folder / name, context);
      const Failure failure = failureOf([&] { step.run(*sink); });
      EXPECT_EQ(failure.code, ErrorCode::InvalidArgument);
      EXPECT_NE(failure.sentence.find(step.what), std::string::npos)
          << step.what << " | " << failure.sentence;
      // Nothing is accepted afterwards, as if it could still become a file.
      EXPECT_NE(failureOf([&] { sink->end(); }).sentence.find("failed"), std::string::npos);
    }
  }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(Stream, WrongContentIsRefused) {
  const TemporaryFolder folder;
  Context context;
  for (const char* name : {"a.vtu", "a.mesh"}) {
    std::unique_ptr<MeshSink> sink = openMeshSink(folder / name, context);
    sink->begin(8, 3);
    sendPoints(*sink, 0, 8);
    sendCells(*sink, 0, 1);
    const std::vector<Hex64> cells = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 8}};
    Failure failure = failureOf([&] { sink->cells(1, std::span<const Hex64>(cells)); });
    EXPECT_EQ(failure.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(toString(failure.place), "cell 2");
    sink = openMeshSink(folder / name, context);
    sink->begin(8, 3);
    sendPoints(*sink, 0, 5);
    const std::vector<Vec3> points = {{0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0}};
    failure = failureOf([&] { sink->points({5, points, {}, {}}); });
    EXPECT_EQ(failure.code, ErrorCode::NotFinite);
    EXPECT_EQ(toString(failure.place), "vertex 6");
  }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(Stream, AbandonedSinksLeaveNothing) {
  const TemporaryFolder folder;
  writeText(folder / "a.vtu", "old");
  Context context;
  for (const char* name : {"a.vtu", "b.mesh"}) {
    const std::unique_ptr<MeshSink> sink = openMeshSink(folder / name, context);
    sink->begin(8, 1);
    sendPoints(*sink, 0, 8);
    sendCells(*sink, 0, 1);
  }
  EXPECT_EQ(contentOf(folder / "a.vtu"), "old");
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(Stream, FilesThatCannotBeMade) {
  const TemporaryFolder folder;
  Context context;
  for (const char* name : {"missing/a.vtu", "missing/a.mesh"}) {
    const Failure failure =
        failureOf([&] { static_cast<void>(openMeshSink(folder / name, context)); });
    EXPECT_EQ(failure.code, ErrorCode::FileWrite);
    EXPECT_NE(failure.sentence.find(name), std::string::npos) << failure.sentence;
  }
  EXPECT_EQ(failureOf([&] { static_cast<void>(openMeshSink(folder / "a.png", context)); }).code,
            ErrorCode::FileUnsupported);
  const Failure whole =
      failureOf([&] { static_cast<void>(openMeshSink(folder / "a.ovm", context)); });
  EXPECT_EQ(whole.code, ErrorCode::FileUnsupported);
  EXPECT_NE(whole.sentence.find("can: mesh, meshb, vtu, vtk, vtk-binary, msh."), std::string::npos)
      << whole.sentence;
  std::filesystem::create_symlink("/dev/null", folder / "null.vtu");
  const Failure device =
      failureOf([&] { static_cast<void>(openMeshSink(folder / "null.vtu", context)); });
  EXPECT_EQ(device.code, ErrorCode::FileWrite);
  EXPECT_NE(device.sentence.find("device"), std::string::npos) << device.sentence;
}

TEST(Stream, FullDiskLeavesNothing) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(40, 40, 40);
  Random random(41);
  Context context;
  const FileSizeLimit limit(1'000'000);
  for (const char* name : {"a.mesh", "a.vtu"}) {
    const Failure failure =
        failureOf([&] { send(*openMeshSink(folder / name, context), mesh, random, 5000, false); });
    EXPECT_EQ(failure.code, ErrorCode::FileWrite);
    EXPECT_NE(failure.sentence.find("File too large"), std::string::npos) << failure.sentence;
    EXPECT_EQ(folder.fileCount(), 0U);
  }
}

TEST(Stream, CancellationIsNoticed) {
  const TemporaryFolder folder;
  Context context;
  const std::unique_ptr<MeshSink> sink = openMeshSink(folder / "a.vtu", context);
  sink->begin(8, 1);
  context.cancel();
  EXPECT_EQ(failureOf([&] { sendPoints(*sink, 0, 8); }).code, ErrorCode::Cancelled);
}

TEST(MeshSummary, IsTheSameHoweverAMeshComes) {
  const TemporaryFolder folder;
  Random random(43);
  HexMesh mesh = gridMesh(50, 40, 30);
  Context one(1);
  const MeshSummary expected = summarize(mesh, one);
  EXPECT_EQ(expected.points, mesh.points.size());
  EXPECT_EQ(expected.cells, mesh.cells.size());
  EXPECT_EQ(expected.lower, (Vec3{0, 0, 0}));
  EXPECT_EQ(expected.upper, (Vec3{50 / 3.0, 40 / 7.0, 30 * 1.1}));
  writeHexMesh(mesh, folder / "a.vtu");
  writeHexMesh(mesh, folder / "a.mesh");
  for (const int threads : {1, 2, 3}) {
    Context context(threads);
    EXPECT_EQ(summarizeFile(folder / "a.vtu", context), expected);
    EXPECT_EQ(summarizeFile(folder / "a.mesh", context), expected);
    for (const bool wide : {false, true}) {
      SummarySink sink(context);
      send(sink, mesh, random, 20'000, wide);
      EXPECT_EQ(sink.result(), expected);
    }
  }
}

TEST(MeshSummary, ChecksumsTellMeshesApart) {
  const HexMesh mesh = gridMesh(3, 3, 3);
  Context context;
  const MeshSummary expected = summarize(mesh, context);
  HexMesh other = mesh;
  std::swap(other.points[1], other.points[2]);
  EXPECT_NE(summarize(other, context).pointChecksum, expected.pointChecksum);
  EXPECT_EQ(summarize(other, context).cellChecksum, expected.cellChecksum);
  other = mesh;
  other.points[7][1] = std::nextafter(other.points[7][1], 2);
  EXPECT_NE(summarize(other, context).pointChecksum, expected.pointChecksum);
  other = mesh;
  std::swap(other.cells[4][0], other.cells[4][1]);
  EXPECT_NE(summarize(other, context).cellChecksum, expected.cellChecksum);
  EXPECT_EQ(summarize(other, context).pointChecksum, expected.pointChecksum);
  other = mesh;
  std::swap(other.cells[0], other.cells[1]);
  EXPECT_NE(summarize(other, context).cellChecksum, expected.cellChecksum);
  EXPECT_EQ(summarize(HexMesh{}, context), MeshSummary{});
}

/// As another program computed them, so that figures of yesterday compare with those of tomorrow.
TEST(MeshSummary, ChecksumsAreThoseOfTheFirstVersion) {
  Context context;
  const MeshSummary sums = summarize(gridMesh(2, 2, 2), context);
  EXPECT_EQ(sums.pointChecksum, 2268866626704337417U);
  EXPECT_EQ(sums.cellChecksum, 2959003485796918603U);
}

TEST(MeshSummary, RefusesGeneratorsOfSomeVerticesOnly) {
  HexMesh mesh = gridMesh(2, 2, 2);
  mesh.generatorTet.resize(mesh.points.size() - 1);
  Context context;
  EXPECT_EQ(errorOf([&] { static_cast<void>(summarize(mesh, context)); }).code(),
            ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hexhex::test::stream
