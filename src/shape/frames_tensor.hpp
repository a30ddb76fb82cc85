// Frames of three axes, up to order and sign of the axes, as tensors of nine numbers.
//
// The quartic (x . a)^4 + (x . b)^4 + (x . c)^4 of the axes of a frame, without the part that all
// frames share, is a harmonic quartic, i.e. a point of a nine-dimensional space. Distances there
// are those between frames, whatever the order and sign of axes.
//
// J. Huang et al., "Boundary Aligned Smooth 3D Cross-Frame Field", ACM Transactions on Graphics 30
// (2011); D. Palmer, D. Bommes, J. Solomon, "Algebraic Representations for Volumetric Frame
// Fields", ACM Transactions on Graphics 39 (2020).
#pragma once

#include <Eigen/Core>

namespace hexhex::shape {

/// An orthogonal matrix of determinant 1; columns are axes.
using Frame = Eigen::Matrix3d;
using FrameTensor = Eigen::Matrix<double, 9, 1>;

/// The tensors of all frames have the same norm.
[[nodiscard]] FrameTensor tensorOf(const Frame& frame);

/// The frame whose tensor is closest, up to local optima of Newton's method.
/// @param start  an initial guess, in addition to fixed samples
[[nodiscard]] Frame nearestFrame(const FrameTensor& tensor, const Frame& start);

/// The frame with a given first axis.
/// @param angle  of the second axis about the first one
[[nodiscard]] Frame frameAbout(const Eigen::Vector3d& axis, double angle);

/// The tensors of all frames with a common axis: a circle, parametrized by a quarter turn of
/// frames.
struct TensorCircle {
  explicit TensorCircle(const Eigen::Vector3d& axis);

  FrameTensor middle;
  FrameTensor cosine;  ///< towards the tensor of frameAbout(axis, 0)
  FrameTensor sine;    ///< towards an angle of pi / 8: perpendicular, of the same norm
};

}  // namespace hexhex::shape
