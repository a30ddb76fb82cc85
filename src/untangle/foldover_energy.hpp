// The foldover-free energy of all elements, and its derivatives with respect to the unknowns.
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <untangle/problem.hpp>

#include <base/stage.hpp>

namespace hexhex::untangle {

using Vector = Eigen::VectorXd;

/// Regularized::chi of one determinant.
[[nodiscard]] double regularized(double epsilon, double det) noexcept;

/// The energy at one point, with the number of flips and the least determinant there.
struct Height {
  double energy = 0;
  double leastDeterminant = std::numeric_limits<double>::infinity();
  std::size_t flipped = 0;  ///< elements whose determinant is not positive
};

/// The elements that use each coordinate: entries are 12 * element + 3 * corner + axis.
class Uses {
 public:
  explicit Uses(const Problem& problem);
  [[nodiscard]] std::span<const std::uint32_t> operator()(std::size_t unknown) const {
    return std::span(entries_).subspan(begins_[unknown], begins_[unknown + 1] - begins_[unknown]);
  }

 private:
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> entries_;
};

[[nodiscard]] inline std::size_t coordinateCount(const Problem& problem) noexcept {
  return problem.sums.size() == 0 ? problem.x.size() : problem.sums.size();
}
/// The coordinates from which corners are computed.
[[nodiscard]] Vector coordinatesOf(const Problem& problem, const Vector& unknowns);
/// Converts derivatives with respect to coordinates to derivatives with respect to unknowns.
[[nodiscard]] Vector byUnknowns(const Problem& problem, const Vector& byCoordinates);

/// The gradients of all four corners.
[[nodiscard]] Eigen::Matrix<double, 4, 3> cornerGradients(const Element& element);
[[nodiscard]] Eigen::Matrix3d jacobian(const Problem& problem, const Element& element,
                                       const double* x);
/// The rotation towards which an element is pulled.
[[nodiscard]] Eigen::Matrix3d targetOf(const Problem& problem, const Element& element);

/// Sum over all elements of their weight times
///
///     |J|^2 / chi^(2/3) + (det^2 + 1) / chi + pull / 2 |J - target|^2
///
/// with chi = regularized(epsilon, det J). With epsilon 0 it is infinite if an element is not
/// positive. Bitwise the same with any number of threads.
class Energy {
 public:
  /// @param problem  must outlive this, and keep its elements; x and pull may change
  Energy(const Problem& problem, Stage& stage);

  [[nodiscard]] const Problem& problem() const noexcept { return problem_; }
  [[nodiscard]] const Uses& uses() const noexcept { return uses_; }

  [[nodiscard]] Height at(const Vector& unknowns, double epsilon) const;
  /// @param[out] gradient  per unknown; meaningless where the energy is infinite
  [[nodiscard]] Height at(const Vector& unknowns, double epsilon, Vector& gradient);

 private:
  template <class Use>
  Height collect(const Vector& x, double epsilon, const Use& use) const;

  const Problem& problem_;
  Stage& stage_;
  Uses uses_;
  /// Per element, corner and axis: contribution to the derivative with respect to that coordinate.
  std::vector<std::array<double, 12>> forces_;
};

}  // namespace hexhex::untangle
