// How each tet has to turn for the boundary to face where its labels say.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <quantize/polycube/labelled_mesh.hpp>

#include <base/stage.hpp>

namespace hexhex::quantization {

/// The normal of a boundary triangle, outwards, as long as twice its area.
[[nodiscard]] Eigen::Vector3d outwardNormal(const LabelledMesh& mesh, adjacency::HalfFace h);

[[nodiscard]] inline Eigen::Vector3d vectorOf(lattice::Direction label) {
  return lattice::signOf(label) * Eigen::Vector3d::Unit(lattice::axisOf(label));
}

/// The mean length of edges, about.
[[nodiscard]] double edgeLength(const LabelledMesh& mesh);

/// A smooth field of rotations, one per tet: those of tets with a boundary triangle turn its normal
/// to its label, and as little else as their neighbours allow.
[[nodiscard]] std::vector<Eigen::Matrix3d> rotationField(const LabelledMesh& mesh, Stage& stage);

}  // namespace hexhex::quantization
