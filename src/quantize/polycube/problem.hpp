// A polycube as input of the foldover-free solver: shared coordinates of vertices, and elements
// that must stay positive.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <quantize/polycube/borders.hpp>
#include <quantize/polycube/labelled_mesh.hpp>
#include <untangle/problem.hpp>

namespace hexhex::quantization {

/// All vertices of a connected boundary region with labels of one axis share their coordinate along
/// it. Elements of the problem are
///
/// 1. the tets, with a rotation as target,
/// 2. the boundary triangles in the order of half-faces, which must not fold over in their planes,
/// 3. the edges between labels, which must not run backwards near a corner.
class PolycubeProblem {
 public:
  /// Adds the tets only.
  /// @param mesh  must outlive this
  /// @param rotations  per tet
  PolycubeProblem(const LabelledMesh& mesh, std::span<const Eigen::Matrix3d> rotations);

  [[nodiscard]] untangle::Problem& solved() noexcept { return problem_; }
  [[nodiscard]] const untangle::Problem& solved() const noexcept { return problem_; }

  /// The coordinate of a vertex; along the axis of a plane, that of the plane.
  [[nodiscard]] double& at(Index vertex, std::size_t axis) {
    return problem_.x[static_cast<std::size_t>(unknowns_[vertex][axis])];
  }
  [[nodiscard]] double at(Index vertex, std::size_t axis) const {
    return problem_.x[static_cast<std::size_t>(unknowns_[vertex][axis])];
  }

  /// Adds boundary triangles and edges.
  /// @param weight  relative to tets of their size
  void addBoundary(std::span<const PolycubeEdge> edges, double weight);
  /// Fixes planes at their current positions.
  void fixPlanes();

  /// The vertices of an element, ascending.
  [[nodiscard]] std::vector<Index> verticesOf(std::size_t element) const;
  /// A description of an element, to be used in a sentence.
  [[nodiscard]] std::string nameOf(std::size_t element) const;
  /// A tet that contains an element.
  [[nodiscard]] Index tetAt(std::size_t element) const;

 private:
  void numberUnknowns();
  void addTets();
  [[nodiscard]] Eigen::Vector3d point(Index vertex) const;
  [[nodiscard]] untangle::Corner corner(Index vertex) const;
  int addMatrix(const Eigen::Matrix3d& matrix);

  const LabelledMesh& mesh_;
  double length_ = 0;  ///< approximate length of an edge
  double volume_ = 0;
  std::vector<std::array<int, 3>> unknowns_;  ///< per vertex and axis
  std::vector<bool> isPlane_;                 ///< per unknown
  std::vector<adjacency::HalfFace> triangles_;
  std::vector<PolycubeEdge> edges_;
  untangle::Problem problem_;
};

}  // namespace hexhex::quantization
