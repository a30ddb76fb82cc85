// A polycube as the foldover-free solver takes it: which coordinates its tets share, and what is to
// stay positive.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <quantize/polycube/borders.hpp>
#include <quantize/polycube/labelled_mesh.hpp>
#include <untangle/problem.hpp>

namespace hexhex::quantization {

/// All vertices of a connected piece of boundary with one axis share their coordinate along it.
/// Elements of the problem are
///
/// 1. the tets, which are pulled to rotations,
/// 2. the boundary triangles, in their order as half-faces: they must not fold over in their plane,
/// 3. the edges between labels: they must not run backwards beside a corner.
class PolycubeProblem {
 public:
  /// With the tets only.
  /// @param mesh  must outlive this
  /// @param rotations  per tet
  PolycubeProblem(const LabelledMesh& mesh, std::span<const Eigen::Matrix3d> rotations);

  [[nodiscard]] untangle::Problem& solved() noexcept { return problem_; }
  [[nodiscard]] const untangle::Problem& solved() const noexcept { return problem_; }

  /// Where a vertex is, or its planes.
  [[nodiscard]] double& at(Index vertex, std::size_t axis) {
    return problem_.x[static_cast<std::size_t>(unknowns_[vertex][axis])];
  }
  [[nodiscard]] double at(Index vertex, std::size_t axis) const {
    return problem_.x[static_cast<std::size_t>(unknowns_[vertex][axis])];
  }

  /// Adds triangles and edges.
  /// @param weight  of these, beside tets of their size
  void addBoundary(std::span<const PolycubeEdge> edges, double weight);
  /// Planes stay where they are from now on.
  void fixPlanes();

  /// Of an element, ascending.
  [[nodiscard]] std::vector<Index> verticesOf(std::size_t element) const;
  /// What an element is, as a sentence has it, and where in the mesh.
  [[nodiscard]] std::string nameOf(std::size_t element) const;
  /// One of the tets at an element.
  [[nodiscard]] Index tetAt(std::size_t element) const;

 private:
  void numberUnknowns();
  void addTets();
  [[nodiscard]] Eigen::Vector3d point(Index vertex) const;
  [[nodiscard]] untangle::Corner corner(Index vertex) const;
  int addMatrix(const Eigen::Matrix3d& matrix);

  const LabelledMesh& mesh_;
  double length_ = 0;  ///< of an edge, about
  double volume_ = 0;
  std::vector<std::array<int, 3>> unknowns_;  ///< per vertex and axis
  std::vector<bool> isPlane_;                 ///< per unknown
  std::vector<adjacency::HalfFace> triangles_;
  std::vector<PolycubeEdge> edges_;
  untangle::Problem problem_;
};

}  // namespace hexhex::quantization
