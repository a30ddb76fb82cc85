// The adapter for OpenVolumeMesh, on a minimal type with its interface.
#include <array>
#include <vector>

#include <api/look_alike_mesh.hpp>
#include <gtest/gtest.h>

#include <hexhex/adapters/openvolumemesh.hpp>
#include <hexhex/hexhex.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

using namespace look_alike;

TEST(OpenVolumeMeshAdapter, ReadsAMap) {
  const TetMap map = generateSample(SampleKind::Sphere).map;
  LookAlike tets;
  for (const Vec3& p : map.points) tets.add_vertex(Point(p[0], p[1], p[2]));
  for (const Tet& t : map.tets) {
    tets.add_tet({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2]),
                  static_cast<int>(t[3])});
  }
  const auto parameter = [&](CellHandle c, VertexHandle v) {
    const auto cell = static_cast<std::size_t>(c.idx());
    std::size_t corner = 0;
    while (map.tets[cell][corner] != static_cast<Index>(v.idx())) ++corner;
    return map.parameters[cell][corner];
  };
  const TetMap read = fromOpenVolumeMesh(tets, parameter);
  EXPECT_EQ(read.points, map.points);
  EXPECT_EQ(read.tets, map.tets);
  EXPECT_EQ(read.parameters, map.parameters);
}

/// Volume of the cell from its half-faces alone, each taken as two triangles. Half-faces of
/// OpenVolumeMesh look inwards.
double volume(const LookAlike& mesh, std::size_t cell) {
  double sum = 0;
  for (const HalfFaceHandle h : mesh.cellFaces[cell]) {
    const auto& face = mesh.faces[static_cast<std::size_t>(h.idx() / 2)];
    const auto at = [&](std::size_t i) {
      const VertexHandle v = face[h.idx() % 2 == 0 ? i : face.size() - 1 - i];
      return mesh.vertex(v);
    };
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Point a = at(0);
      const Point b = at(i);
      const Point c = at(i + 1);
      sum -= a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
             a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
  }
  return sum / 6;
}

TEST(OpenVolumeMeshAdapter, AddsAMesh) {
  const Sample sample = generateSample(SampleKind::Sphere);
  const HexMesh mesh = extract(sample.map);
  LookAlike out;
  toOpenVolumeMesh(mesh, out);
  EXPECT_EQ(out.points.size(), mesh.points.size());
  ASSERT_EQ(out.cellFaces.size(), mesh.cells.size());
  // Every face once, from each side at most once.
  EXPECT_EQ(out.faces.size(), (6 * mesh.cells.size() + sample.answer.expected.boundaryQuads) / 2);
  std::vector<int> uses(2 * out.faces.size(), 0);
  for (std::size_t c = 0; c < out.cellFaces.size(); ++c) {
    ASSERT_EQ(out.cellFaces[c].size(), 6U);
    for (const HalfFaceHandle h : out.cellFaces[c]) {
      EXPECT_EQ(uses[static_cast<std::size_t>(h.idx())]++, 0);
    }
    EXPECT_GT(volume(out, c), 0);
  }
  for (std::size_t f = 0; f < out.faces.size(); ++f) EXPECT_EQ(uses[2 * f], 1);
}

TEST(OpenVolumeMeshAdapter, RefusesAFaceOfThreeCells) {
  HexMesh mesh;
  mesh.points.resize(8, Vec3{});
  mesh.cells.resize(3, Hex{0, 1, 2, 3, 4, 5, 6, 7});
  LookAlike out;
  EXPECT_EQ(test::codeOf([&] { toOpenVolumeMesh(mesh, out); }), ErrorCode::NonManifoldFace);
}

}  // namespace
}  // namespace hexhex
