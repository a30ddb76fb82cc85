// Rotations of tets that align the boundary with its labels, after Gregson et al. 2011.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <quantize/polycube/labelled_mesh.hpp>

#include <base/stage.hpp>

namespace hexhex::quantization {

/// The outward normal of a boundary triangle, with twice its area as length.
[[nodiscard]] Eigen::Vector3d outwardNormal(const LabelledMesh& mesh, adjacency::HalfFace h);

[[nodiscard]] inline Eigen::Vector3d vectorOf(lattice::Direction label) {
  return lattice::signOf(label) * Eigen::Vector3d::Unit(lattice::axisOf(label));
}

/// Approximate mean length of edges.
[[nodiscard]] double edgeLength(const LabelledMesh& mesh);

/// A smooth field with one rotation per tet. The rotations of boundary tets align a normal with its
/// label, and otherwise follow their neighbours.
[[nodiscard]] std::vector<Eigen::Matrix3d> rotationField(const LabelledMesh& mesh, Stage& stage);

}  // namespace hexhex::quantization
