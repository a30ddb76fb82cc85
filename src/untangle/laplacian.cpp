#include <algorithm>
#include <utility>
#include <vector>

#include <untangle/laplacian.hpp>

namespace hexhex::untangle {

namespace {

/// The shift, as a fraction of the diagonal: negligible, but far above rounding.
constexpr double kShift = 1e-9;

}  // namespace

Eigen::SparseMatrix<double> laplacian(const Problem& problem, const Uses& uses) {
  const auto n = static_cast<int>(coordinateCount(problem));
  Eigen::SparseMatrix<double> matrix(n, n);
  std::vector<std::pair<int, double>> column;
  for (int u = 0; u < n; ++u) {
    column.assign(1, {u, 0.0});
    for (const std::uint32_t use : uses(static_cast<std::size_t>(u))) {
      const Element& element = problem.elements[use / 12];
      const Eigen::Matrix<double, 4, 3> gradients = cornerGradients(element);
      const std::size_t axis = use % 3;
      const auto own = static_cast<Eigen::Index>(use % 12 / 3);
      const double sign = element.corners[use % 12 / 3].sign[axis];
      for (std::size_t i = 0; i < 4; ++i) {
        const Corner& corner = element.corners[i];
        if (corner.unknown[axis] < u) continue;
        column.emplace_back(
            corner.unknown[axis],
            element.weight * sign * corner.sign[axis] *
                gradients.row(own).dot(gradients.row(static_cast<Eigen::Index>(i))));
      }
    }
    std::stable_sort(column.begin(), column.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    matrix.startVec(u);
    for (std::size_t i = 0; i < column.size();) {
      const int row = column[i].first;
      double sum = 0;
      for (; i < column.size() && column[i].first == row; ++i) sum += column[i].second;
      if (row == u) sum = sum > 0 ? sum * (1 + kShift) : 1;  // 1 if no element uses it
      matrix.insertBack(row, u) = sum;
    }
  }
  matrix.finalize();
  const Eigen::SparseMatrix<double> both = matrix.selfadjointView<Eigen::Lower>();
  if (problem.sums.size() == 0) return both;
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < n; ++row) {
    const auto begin = problem.sums.begins[static_cast<std::size_t>(row)];
    const auto end = problem.sums.begins[static_cast<std::size_t>(row) + 1];
    for (std::size_t i = begin; i < end; ++i) {
      entries.emplace_back(row, problem.sums.entries[i].column, problem.sums.entries[i].factor);
    }
  }
  Eigen::SparseMatrix<double> sums(n, std::ssize(problem.x));
  sums.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> half = both * sums;
  return sums.transpose() * half;
}

Vector targetForces(const Problem& problem, const Uses& uses) {
  const std::vector<double> origin(coordinateCount(problem), 0.0);
  Vector rest(std::ssize(origin));
  for (std::size_t u = 0; u < origin.size(); ++u) {
    double sum = 0;
    for (const std::uint32_t use : uses(u)) {
      const Element& element = problem.elements[use / 12];
      const auto axis = static_cast<Eigen::Index>(use % 3);
      const Eigen::Matrix3d missing =
          targetOf(problem, element) - jacobian(problem, element, origin.data());
      sum += element.weight * element.corners[use % 12 / 3].sign[use % 3] *
             missing.row(axis).dot(cornerGradients(element).row(use % 12 / 3));
    }
    rest[static_cast<Eigen::Index>(u)] = sum;
  }
  return byUnknowns(problem, rest);
}

}  // namespace hexhex::untangle
