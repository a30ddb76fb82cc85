// Readers of surfaces: each format as other programs write it, and what is wrong in files.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>

#include <base/vector3.hpp>
#include <io/core/registry.hpp>

#include "io_test_support.hpp"

namespace hexhex::test {
namespace {

TriangleMesh readSurface(const std::string& text, const std::string& name) {
  const TemporaryFolder folder;
  writeText(folder / name, text);
  Context context(1);
  return readTriangleMesh(folder / name, context);
}

const std::vector<Vec3> kPyramid = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.25, 1.5}};
using Corners = std::array<Index, 3>;
const std::vector<Corners> kFaces = {{0, 3, 2}, {0, 2, 1}, {0, 1, 4},
                                     {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

/// By positions: formats number vertices as they please.
std::vector<std::array<Vec3, 3>> placesOf(const std::vector<Vec3>& points,
                                          const std::vector<Corners>& triangles) {
  std::vector<std::array<Vec3, 3>> places;
  for (const auto& [a, b, c] : triangles) places.push_back({points[a], points[b], points[c]});
  return places;
}

void expectPyramid(const std::string& text, const std::string& name) {
  SCOPED_TRACE(name);
  const TriangleMesh mesh = readSurface(text, name);
  EXPECT_EQ(mesh.points.size(), 5U);
  EXPECT_EQ(placesOf(mesh.points, mesh.triangles), placesOf(kPyramid, kFaces));
}

template <class T>
void appendBytes(std::string& bytes, T number, bool bigEndian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (bigEndian != (std::endian::native == std::endian::big)) {
    std::reverse(raw.begin(), raw.end());
  }
  bytes.append(raw.data(), raw.size());
}

std::string stlText() {
  std::string text = "solid a pyramid of nothing\n";
  for (const Corners& t : kFaces) {
    text += "  facet normal 0 nan 1\n    outer loop\n";
    for (const Index v : t) {
      text += "      vertex";
      for (const double x : kPyramid[v]) text += " " + std::to_string(x);
      text += "\n";
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid\n";
}

std::string stlBytes(const std::string& head) {
  std::string bytes = head;
  bytes.resize(80, ' ');
  appendBytes(bytes, std::uint32_t{6});
  for (const Corners& t : kFaces) {
    for (int i = 0; i < 3; ++i) appendBytes(bytes, 0.0F);
    for (const Index v : t) {
      for (const double x : kPyramid[v]) appendBytes(bytes, static_cast<float>(x));
    }
    appendBytes(bytes, std::uint16_t{0x7fff});
  }
  return bytes;
}

/// With what nobody needs: normals, colours, a list of texture coordinates, an element of its own.
std::string plyHead(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment element vertex 7\nobj_info made by hand\nelement vertex 5\nproperty uchar "
         "red\nproperty float x\nproperty double y\nproperty float32 z\nelement material "
         "1\nproperty "
         "list uchar short words\nelement face 5\nproperty list uchar float texcoord\nproperty "
         "list "
         "uchar int vertex_indices\nproperty uchar flags\nend_header\n";
}

const std::vector<std::vector<std::int32_t>> kPolygons = {
    {0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

std::string plyText() {
  std::string text = plyHead("ascii");
  for (const Vec3& p : kPyramid) {
    text += "255 " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
            std::to_string(p[2]) + "\n";
  }
  text += "2 7 -8\n";
  for (const auto& polygon : kPolygons) {
    text += "2 0.5 0.25 " + std::to_string(polygon.size());
    for (const std::int32_t v : polygon) text += " " + std::to_string(v);
    text += " 1\n";
  }
  return text;
}

std::string plyBytes(bool big) {
  std::string bytes = plyHead(big ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3& p : kPyramid) {
    bytes += '\xff';
    appendBytes(bytes, static_cast<float>(p[0]), big);
    appendBytes(bytes, p[1], big);
    appendBytes(bytes, static_cast<float>(p[2]), big);
  }
  bytes += '\1';
  appendBytes(bytes, std::int16_t{-8}, big);
  for (const auto& polygon : kPolygons) {
    bytes += '\1';
    appendBytes(bytes, 0.5F, big);
    bytes += static_cast<char>(polygon.size());
    for (const std::int32_t v : polygon) appendBytes(bytes, v, big);
    bytes += '\1';
  }
  return bytes;
}

const std::string kObj =
    "# by hand\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nvn 0 0 1\nvt 0 0\nv 0 1 0\n"
    "v 0.5 0.25 1.5\ng base\nusemtl red\nf 1 4 3 2\ns off\nf 1/1 2/1 5/1\nf 2//1 3//1 5//1\n"
    "f 3/1/1 4/1/1 5/1/1\nf -2 -5 -1 # the last\n";
const std::string kOff =
    "# by hand\nCOFF\n# counts\n5 5 8\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n1 1 0\n0 1 0\n0.5 0.25 1.5\n"
    "4 0 3 2 1 0.5 0.5 0.5\n3 0 1 4\n3 1 2 4 7\n3 2 3 4\n3 3 0 4\n";

const std::string kVtkPoints = "POINTS 5 float\n0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.25 1.5\n";
const std::string kVtkHead = "# vtk DataFile Version 5.1\nby hand\nASCII\nDATASET POLYDATA\n";
const std::string kVtk = kVtkHead + kVtkPoints + "LINES 1 3\n2 0 1\nPOLYGONS 5 21\n4 0 3 2 1\n" +
                         "3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\nCELL_DATA 6\n";
const std::string kVtk5 = kVtkHead + kVtkPoints + "POLYGONS 6 16\nOFFSETS vtktypeint64\n" +
                          "0 4 7 10 13 16\nCONNECTIVITY vtktypeint64\n" +
                          "0 3 2 1 0 1 4 1 2 4 2 3 4 3 0 4\n";
const std::string kVtp =
    "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"5\" NumberOfVerts=\"1\" "
    "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"5\"><Points><DataArray "
    "type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 0.5 "
    "0.25 1.5</DataArray></Points><Verts><DataArray type=\"Int32\" Name=\"connectivity\" "
    "format=\"ascii\">0</DataArray><DataArray type=\"Int32\" Name=\"offsets\" "
    "format=\"ascii\">1</DataArray></Verts><Polys><DataArray type=\"Int32\" "
    "Name=\"connectivity\" format=\"ascii\">0 3 2 1 0 1 4 1 2 4 2 3 4 3 0 4</DataArray>"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 7 10 13 16</DataArray>"
    "</Polys></Piece></PolyData></VTKFile>";

TEST(SurfaceFiles, OfVtkAreNoVolumes) {
  const TemporaryFolder folder;
  writeText(folder / "a.vtk", kVtk);
  writeText(folder / "b.vtk",
            "# vtk DataFile Version 2.0\ntets\nASCII\nDATASET UNSTRUCTURED_GRID\n" + kVtkPoints +
                "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n");
  Context context(1);
  EXPECT_TRUE(io::holdsSurface(folder / "a.vtk", context));
  EXPECT_FALSE(io::holdsSurface(folder / "b.vtk", context));
  const Failure tets =
      failureOf([&] { static_cast<void>(readTriangleMesh(folder / "b.vtk", context)); });
  EXPECT_NE(tets.sentence.find("no surface"), std::string::npos) << tets.sentence;
  const Failure failure =
      failureOf([&] { static_cast<void>(readHexMesh(folder / "a.vtk", context)); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("surface: `hexhex mesh`"), std::string::npos) << failure.sentence;
}

TEST(SurfaceFiles, AreReadAsOthersWriteThem) {
  expectPyramid(kVtk, "a.vtk");
  expectPyramid(replaced(kVtk, "POLYGONS 5 21\n", "POLYGONS 6 22\n0\n"), "none.vtk");
  expectPyramid(kVtk5, "b.vtk");
  expectPyramid(kVtp, "a.vtp");
  expectPyramid(stlText(), "text.stl");
  std::string upper = " \n" + stlText();
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  expectPyramid(upper, "upper.stl");
  expectPyramid(stlBytes("made by hand"), "bytes.STL");
  expectPyramid(stlBytes("solid as some programs begin"), "solid.stl");
  expectPyramid(kObj, "a.obj");
  expectPyramid(kOff, "a.off");
  expectPyramid(replaced(kOff, "COFF\n# counts\n", "OFF "), "one-line.off");
  expectPyramid(plyText(), "text.ply");
  expectPyramid(plyBytes(false), "little.ply");
  expectPyramid(plyBytes(true), "big.ply");
}

TEST(SurfaceFiles, PolygonsThatAreNotConvexAreCutIntoEars) {
  // A U of area 5, facing up, and far from the origin: triangles around a corner would overlap.
  const std::vector<Vec3> u = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0},
                               {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  std::string points;
  for (const Vec3& p : u) {
    points += "v " + std::to_string(p[0] + 1e6) + " " + std::to_string(p[1]) + " 0\n";
  }
  for (std::size_t first = 0; first < u.size(); ++first) {
    std::string face = "f";
    for (std::size_t i = 0; i < u.size(); ++i) {
      face += " " + std::to_string((first + i) % u.size() + 1);
    }
    const TriangleMesh mesh = readSurface(points + face + "\n", "u.obj");
    ASSERT_EQ(mesh.triangles.size(), 6U);
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 twice =
          cross(minus(mesh.points[b], mesh.points[a]), minus(mesh.points[c], mesh.points[a]));
      EXPECT_GE(twice[2], 0) << first;
      area += twice[2] / 2;
    }
    EXPECT_DOUBLE_EQ(area, 5) << first;
  }
}

TEST(SurfaceFiles, AreWeldedExactly) {
  const TriangleMesh mesh = readSurface(
      "OFF 9 3 0\n0 0 0\n1 0 0\n0 1 0\n-0 0 0\n1 0 1e-300\n0 1 0\n2 0 0\n2 0 0\n3 3 3\n"
      "3 0 1 2\n3 3 4 5\n3 0 6 7\n",
      "a.off");
  EXPECT_EQ(mesh.points.size(), 6U);  // 0 has one sign; the least difference is one
  EXPECT_EQ(mesh.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 3, 2}}));
}

struct Broken {
  std::string name;
  std::string text;
  ErrorCode code;
  std::string words;
};

TEST(SurfaceFiles, SayWhatIsWrong) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const std::vector<Broken> all = {
      {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0 x\n", ErrorCode::FileSyntax, "line 4"},
      {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nendloop\n", ErrorCode::FileSyntax,
       "1 corners in place of three"},
      {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\n", ErrorCode::FileSyntax,
       "within a facet"},
      {"a.stl", "solid\nrubbish\n", ErrorCode::FileSyntax, "line 2"},
      {"a.stl", "rubbish", ErrorCode::FileSyntax, "the head of a binary .stl file needs 84 bytes"},
      {"a.stl", stlBytes("cut").substr(0, 300), ErrorCode::FileSyntax, "announces 6 triangles"},
      {"a.obj", "v 0 0 0\nf 1 1\n", ErrorCode::FileSyntax, "fewer than three"},
      {"a.obj", "v 0 0 0\nf 1 1 2\n", ErrorCode::FileSyntax, "line 2"},
      {"a.obj", "v 0 0\n", ErrorCode::FileSyntax, "coordinate"},
      {"a.off", "FOO 1 1 1\n", ErrorCode::FileSyntax, "\"OFF\""},
      {"a.off", "4OFF 1 1 1\n", ErrorCode::FileUnsupported, "three coordinates"},
      {"a.off", "OFF BINARY\n", ErrorCode::FileUnsupported, "three coordinates"},
      {"a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorCode::IndexOutOfRange, "is 3"},
      {"a.off", "OFF 1000000000 1 0\n0 0 0\n", ErrorCode::FileSyntax, "1000000000 vertices"},
      {"a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n", ErrorCode::FileSyntax, "2 of 3 vertices"},
      {"a.ply", "plz\n", ErrorCode::FileSyntax, "\"ply\""},
      {"a.ply", "ply\nelement vertex 1\nend_header\n", ErrorCode::FileSyntax, "no format"},
      {"a.ply", "ply\nformat ascii 1.0\n", ErrorCode::FileSyntax, "end_header"},
      {"a.ply", "ply\nproperty float x\n", ErrorCode::FileSyntax, "before all elements"},
      {"a.ply", "ply\nelement vertex 1\nproperty real x\n", ErrorCode::FileSyntax, "\"real\""},
      {"a.ply", ply + "end_header\n", ErrorCode::FileSyntax, "property"},
      {"a.ply",
       ply + "element face 1\nproperty list uchar int vertex_index\nend_header\n0\n3 0 0 1\n",
       ErrorCode::IndexOutOfRange, "no vertex"},
      {"a.ply", plyBytes(false).substr(0, plyBytes(false).size() - 3), ErrorCode::FileSyntax,
       "byte"},
      {"a.vtk", replaced(kVtk, "3 3 0 4", "3 3 0 5"), ErrorCode::IndexOutOfRange, "names point 5"},
      {"a.vtk", kVtkHead + "TRIANGLE_STRIPS 0 0\n", ErrorCode::FileUnsupported, "strips"},
      {"a.vtk", kVtkHead + "POLYGONS 0 0\n", ErrorCode::FileSyntax, "without the section POINTS"},
      {"a.vtp", replaced(kVtp, "Strips=\"0\"", "Strips=\"1\""), ErrorCode::FileUnsupported,
       "strips"},
      {"a.vtp", replaced(kVtp, "4 7 10", "4 3 10"), ErrorCode::FileSyntax, "before they begin"},
      {"a.xyz", "", ErrorCode::FileUnsupported, "no format of surfaces"}};
  for (const Broken& broken : all) {
    SCOPED_TRACE(broken.name + ": " + broken.text.substr(0, 60));
    const Failure failure = failureOf([&] { return readSurface(broken.text, broken.name); });
    EXPECT_EQ(failure.code, broken.code);
    EXPECT_NE(failure.sentence.find(broken.words), std::string::npos) << failure.sentence;
  }
  std::string infinite = stlBytes("x");
  infinite.replace(84 + 12, 4, std::string("\0\0\x80\x7f", 4));
  EXPECT_EQ(failureOf([&] { return readSurface(infinite, "a.stl"); }).code, ErrorCode::NotFinite);
}

// Whatever ends early or is changed is read, or refused with an error.
TEST(SurfaceFiles, EndWhereverTheyLike) {
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"a.stl", stlText()},
                                                        {"a.stl", stlBytes("b")},
                                                        {"a.obj", kObj},
                                                        {"a.off", kOff},
                                                        {"a.ply", plyText()},
                                                        {"a.ply", plyBytes(false)}}) {
    SCOPED_TRACE(name);
    for (std::size_t size = 0; size < text.size(); size += 3) {
      try {
        const TriangleMesh mesh = readSurface(text.substr(0, size), name);
        for (const Corners& t : mesh.triangles) {
          for (const Index v : t) EXPECT_LT(v, mesh.points.size());
        }
      } catch (const Error& error) {
        EXPECT_NE(error.code(), ErrorCode::Internal);
      }
    }
  }
}

}  // namespace
}  // namespace hexhex::test
