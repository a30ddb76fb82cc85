// Whether a single cell is positive everywhere, and its least scaled Jacobian.
#pragma once

#include <span>
#include <vector>

#include <hexhex/quality.hpp>

#include <mesh/bezier.hpp>

namespace hexhex::mesh {

/// Examines cells of one order, one after another; threads may share it.
class CellValidity {
 public:
  explicit CellValidity(int order);

  /// Examines a cell: `minimum` is the bound given by the undivided Bezier coefficients, and
  /// `scaledJacobian` the value at `place` if the cell is refuted.
  /// @param nodes  (order + 1)^3, the first axis fastest
  [[nodiscard]] CellCertificate examine(std::span<const Vec3> nodes) const;

  /// As examine(), but with the place of the least scaled Jacobian, and with `minimum` at most
  /// kMinimumTolerance below it or below `target`, whichever is less.
  [[nodiscard]] CellCertificate findLeast(std::span<const Vec3> nodes, double target) const;

  /// Maximum number of calls of findLeast() per mesh: takes about a second.
  [[nodiscard]] std::size_t looks() const noexcept { return 1000 / (order_ * order_ * order_); }

  /// The point of a cell at a place.
  [[nodiscard]] Vec3 pointAt(std::span<const Vec3> nodes, const Vec3& place) const;

 private:
  /// A cell in doubles.
  struct Form {
    Columns<double> columns = {};
    Bezier<double> determinant = {};
    double error = 0;  ///< of the determinant's coefficients; infinite if doubles are no help
    double size = 0;   ///< the largest of them
    double largestLengths = 1;  ///< bound of the product of the lengths of columns
  };
  template <class T>
  [[nodiscard]] Columns<T> columnsOf(const std::vector<std::array<T, 3>>& nodes,
                                     const NodeMatrices<T>& matrices) const;
  [[nodiscard]] Columns<double> roundedColumnsOf(const std::vector<Vec3>& nodes) const;
  [[nodiscard]] CellCertificate examine(std::span<const Vec3> nodes, Form& form) const;
  [[nodiscard]] Form formOf(std::span<const Vec3> nodes) const;
  [[nodiscard]] CellCertificate decide(std::span<const Vec3> nodes, const Form& form) const;
  [[nodiscard]] CellCertificate decideExactly(std::span<const Vec3> nodes, const Form& form) const;

  std::size_t order_;
  NodeMatrices<double> matrices_;
  NodeMatrices<Twofold> fineMatrices_;
  NodeMatrices<BigInteger> exactMatrices_;
  double conversionError_;  ///< of unrounded columns, relative to the largest difference of nodes
};

}  // namespace hexhex::mesh
