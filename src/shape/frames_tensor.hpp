// Frames of three axes, up to order and sign of these, as nine numbers.
//
// The quartic (x . a)^4 + (x . b)^4 + (x . c)^4 of a frame's axes, without what all frames share,
// is a point of a space of nine dimensions: the harmonic quartics. What is near to each other there
// is so in space, whatever axes are called.
//
// J. Huang et al., "Boundary Aligned Smooth 3D Cross-Frame Field", ACM Transactions on Graphics 30
// (2011); D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame
// Fields", ACM Transactions on Graphics 39 (2020).
#pragma once

#include <Eigen/Core>

namespace hexhex::shape {

/// Axes are columns: an orthogonal matrix of determinant 1.
using Frame = Eigen::Matrix3d;
using FrameTensor = Eigen::Matrix<double, 9, 1>;

/// All frames have tensors of one length.
[[nodiscard]] FrameTensor tensorOf(const Frame& frame);

/// A frame whose tensor is nearest to this one, or nearly so.
/// @param start  one that it may be near to
[[nodiscard]] Frame nearestFrame(const FrameTensor& tensor, const Frame& start);

/// A frame whose first axis is this one.
/// @param angle  of the second axis, about the first one
[[nodiscard]] Frame frameAbout(const Eigen::Vector3d& axis, double angle);

/// The tensors of all frames with one axis in common: a circle, which takes a quarter turn.
struct TensorCircle {
  explicit TensorCircle(const Eigen::Vector3d& axis);

  FrameTensor middle;
  FrameTensor cosine;  ///< towards that of frameAbout(axis, 0)
  FrameTensor sine;    ///< at an eighth of a turn: perpendicular to that, and as long
};

}  // namespace hexhex::shape
