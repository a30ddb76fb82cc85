#include <algorithm>

#include <Eigen/Geometry>
#include <quantize/polycube/field.hpp>
#include <quantize/polycube/problem.hpp>

#include <base/disjoint_sets.hpp>
#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

Vec3 asArray(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

PolycubeProblem::PolycubeProblem(const LabelledMesh& mesh,
                                 std::span<const Eigen::Matrix3d> rotations)
    : mesh_(mesh), length_(edgeLength(mesh)) {
  numberUnknowns();
  for (const Eigen::Matrix3d& rotation : rotations) addMatrix(rotation);
  addTets();
}

void PolycubeProblem::numberUnknowns() {
  const adjacency::TetTopology& topology = mesh_.topology;
  unknowns_.assign(topology.pointCount, {-1, -1, -1});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    DisjointSets planes(topology.pointCount);
    std::vector<bool> isInPlane(topology.pointCount);
    for (adjacency::HalfFace h = 0; h < mesh_.flags.size(); ++h) {
      if (!mesh_.isLabelled(h) || lattice::axisOf(mesh_.label(h)) != static_cast<int>(axis))
        continue;
      const Tet& tet = topology.tets[adjacency::tetOf(h)];
      const Index first = tet[static_cast<std::size_t>(lattice::kFaceCorners[h % 4][0])];
      for (const int k : lattice::kFaceCorners[h % 4]) {
        planes.unite(first, tet[static_cast<std::size_t>(k)]);
        isInPlane[tet[static_cast<std::size_t>(k)]] = true;
      }
    }
    for (Index v = 0; v < topology.pointCount; ++v) {
      if (topology.isIsolated(v)) continue;
      const Index first = planes.find(v);  // the smallest vertex of its plane
      if (first == v) isPlane_.push_back(isInPlane[v]);
      unknowns_[v][axis] =
          first == v ? static_cast<int>(isPlane_.size()) - 1 : unknowns_[first][axis];
    }
  }
  problem_.x.assign(isPlane_.size(), 0.0);
}

void PolycubeProblem::addTets() {
  for (const Tet& tet : mesh_.topology.tets) {
    std::array<Vec3, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i) edges[i] = asArray(point(tet[i + 1]) - point(tet[0]));
    untangle::Element element;
    for (std::size_t i = 0; i < 4; ++i) element.corners[i] = corner(tet[i]);
    element.gradients = untangle::tetGradients(edges);
    element.weight = tripleProduct(edges[0], edges[1], edges[2]) / 6;
    element.target = static_cast<int>(problem_.elements.size());
    volume_ += element.weight;
    problem_.elements.push_back(element);
  }
  for (untangle::Element& element : problem_.elements) element.weight /= volume_;
}

void PolycubeProblem::addBoundary(std::span<const PolycubeEdge> edges, double weight) {
  for (adjacency::HalfFace h = 0; h < mesh_.flags.size(); ++h) {
    if (!mesh_.isLabelled(h)) continue;
    triangles_.push_back(h);
    const Tet& tet = mesh_.topology.tets[adjacency::tetOf(h)];
    const auto& face = lattice::kFaceCorners[h % 4];
    const auto vertex = [&](std::size_t k) { return tet[static_cast<std::size_t>(face[k])]; };
    const Eigen::Vector3d across = outwardNormal(mesh_, h);
    const Eigen::Vector3d normal = across.normalized();
    untangle::Element element;
    for (std::size_t k = 0; k < 4; ++k) element.corners[k] = corner(vertex(k % 3));
    element.gradients =
        untangle::tetGradients({asArray(point(vertex(1)) - point(vertex(0))),
                                asArray(point(vertex(2)) - point(vertex(0))), asArray(normal)});
    element.gradients[2] = {};  // the normal is not mapped, but replaced by the label
    element.weight = weight * length_ * across.norm() / 2 / volume_;
    element.offset = addMatrix(vectorOf(mesh_.label(h)) * normal.transpose());
    element.target = static_cast<int>(adjacency::tetOf(h));
    problem_.elements.push_back(element);
  }
  edges_.assign(edges.begin(), edges.end());
  for (const PolycubeEdge& edge : edges) {
    const auto& [first, second] = edge.vertices;
    const double length = (point(second) - point(first)).norm();
    const Eigen::Vector3d from = (point(second) - point(first)) / length;
    const Eigen::Vector3d to = vectorOf(edge.along);
    const Eigen::Matrix3d rotation =
        Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
    const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
    untangle::Element element;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index v = k == 1 ? second : first;
      element.corners[k].unknown[axis] = unknowns_[v][axis];
      element.corners[k].sign[axis] = 1;
    }
    element.gradients = {asArray(from / length), Vec3{}, Vec3{}};
    element.weight = weight * length_ * length_ * length / volume_;
    element.offset = addMatrix(rotation - to * from.transpose());
    element.target = addMatrix(rotation);
    problem_.elements.push_back(element);
  }
}

void PolycubeProblem::fixPlanes() {
  for (untangle::Element& element : problem_.elements) {
    for (untangle::Corner& corner : element.corners) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int unknown = corner.unknown[axis];
        if (unknown < 0 || !isPlane_[static_cast<std::size_t>(unknown)]) continue;
        corner.constant[axis] = problem_.x[static_cast<std::size_t>(unknown)];
        corner.unknown[axis] = -1;
      }
    }
  }
}

std::vector<Index> PolycubeProblem::verticesOf(std::size_t element) const {
  const std::size_t tets = mesh_.topology.tetCount();
  if (element >= tets + triangles_.size()) {
    const tetmap::VertexPair& ends = edges_[element - tets - triangles_.size()].vertices;
    return {ends.begin(), ends.end()};
  }
  const Tet& tet = mesh_.topology.tets[tetAt(element)];
  std::vector<Index> vertices(tet.begin(), tet.end());
  if (element >= tets) vertices.erase(vertices.begin() + triangles_[element - tets] % 4);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

std::string PolycubeProblem::nameOf(std::size_t element) const {
  const std::size_t tets = mesh_.topology.tetCount();
  if (element < tets) return "a tet";
  if (element < tets + triangles_.size()) {
    return "a boundary triangle with the label " +
           quantization::nameOf(mesh_.label(triangles_[element - tets]));
  }
  const PolycubeEdge& edge = edges_[element - tets - triangles_.size()];
  return "an edge between the labels " + quantization::nameOf(edge.labels[0]) + " and " +
         quantization::nameOf(edge.labels[1]);
}

Index PolycubeProblem::tetAt(std::size_t element) const {
  const std::size_t tets = mesh_.topology.tetCount();
  if (element < tets) return static_cast<Index>(element);
  if (element < tets + triangles_.size()) return adjacency::tetOf(triangles_[element - tets]);
  return mesh_.topology.vertexTet[edges_[element - tets - triangles_.size()].vertices[0]];
}

Eigen::Vector3d PolycubeProblem::point(Index vertex) const {
  const Vec3& p = mesh_.input.view.points[vertex];
  return {p[0], p[1], p[2]};
}

untangle::Corner PolycubeProblem::corner(Index vertex) const {
  return {.constant = {}, .unknown = unknowns_[vertex], .sign = {1, 1, 1}};
}

int PolycubeProblem::addMatrix(const Eigen::Matrix3d& matrix) {
  untangle::Matrix3& rows = problem_.matrices.emplace_back();
  for (Eigen::Index i = 0; i < 3; ++i) {
    rows[static_cast<std::size_t>(i)] = asArray(matrix.row(i).transpose());
  }
  return static_cast<int>(problem_.matrices.size()) - 1;
}

}  // namespace hexhex::quantization
