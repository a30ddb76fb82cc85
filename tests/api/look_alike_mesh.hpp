// A minimal type with the interface that OpenVolumeMesh documents: handles with idx(), half-faces
// 2f and 2f + 1, points with three coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace look_alike {

template <int Kind>
class Handle {
 public:
  Handle() = default;
  explicit Handle(int idx) : idx_(idx) {}
  [[nodiscard]] int idx() const noexcept { return idx_; }

 private:
  int idx_ = -1;
};
using VertexHandle = Handle<0>;
using FaceHandle = Handle<1>;
using HalfFaceHandle = Handle<2>;
using CellHandle = Handle<3>;

class Point {
 public:
  Point(double x, double y, double z) : p_{x, y, z} {}
  double operator[](std::size_t k) const { return p_[k]; }

 private:
  std::array<double, 3> p_;
};

/// As much of a polyhedral mesh as the adapter calls.
class LookAlike {
 public:
  using PointT = Point;

  VertexHandle add_vertex(const PointT& point) {  // NOLINT(readability-identifier-naming)
    points.push_back(point);
    return VertexHandle(static_cast<int>(points.size()) - 1);
  }
  FaceHandle add_face(const std::vector<VertexHandle>& vertices) {  // NOLINT
    faces.push_back(vertices);
    return FaceHandle(static_cast<int>(faces.size()) - 1);
  }
  [[nodiscard]] HalfFaceHandle halfface_handle(FaceHandle face, int side) const {  // NOLINT
    return HalfFaceHandle(2 * face.idx() + side);
  }
  CellHandle add_cell(const std::vector<HalfFaceHandle>& halfFaces) {  // NOLINT
    cellFaces.push_back(halfFaces);
    return CellHandle(static_cast<int>(cellFaces.size()) - 1);
  }
  CellHandle add_tet(const std::array<int, 4>& vertices) {  // NOLINT
    tets.push_back(vertices);
    return CellHandle(static_cast<int>(tets.size()) - 1);
  }

  [[nodiscard]] std::size_t n_vertices() const { return points.size(); }  // NOLINT
  [[nodiscard]] const PointT& vertex(VertexHandle v) const {
    return points[static_cast<std::size_t>(v.idx())];
  }
  [[nodiscard]] std::vector<VertexHandle> vertices() const { return all<VertexHandle>(points); }
  [[nodiscard]] std::vector<CellHandle> cells() const { return all<CellHandle>(tets); }
  [[nodiscard]] std::vector<VertexHandle> get_cell_vertices(CellHandle c) const {  // NOLINT
    std::vector<VertexHandle> result;
    for (const int v : tets[static_cast<std::size_t>(c.idx())]) result.emplace_back(v);
    return result;
  }

  std::vector<Point> points;
  std::vector<std::array<int, 4>> tets;
  std::vector<std::vector<VertexHandle>> faces;
  std::vector<std::vector<HalfFaceHandle>> cellFaces;

 private:
  template <class H, class List>
  static std::vector<H> all(const List& list) {
    std::vector<H> handles;
    for (std::size_t i = 0; i < list.size(); ++i) handles.emplace_back(static_cast<int>(i));
    return handles;
  }
};

}  // namespace look_alike
