#include <cassert>
#include <cmath>
#include <vector>

#include <untangle/multigrid.hpp>

namespace hexhex::untangle {

namespace {

/// Unknowns are strongly connected if their entry exceeds this fraction of the geometric mean of
/// their diagonal entries; half of that on each coarser level.
constexpr double kStrong = 0.08;
/// A level that does not reduce the number of unknowns by this factor is useless.
constexpr double kCoarser = 1.5;

/// An unknown with more connections is one of many vertices, like a plane. Its interpolation is not
/// smoothed: it would connect each of its neighbours with all others, and take the square of their
/// number in memory.
constexpr int kWide = 1000;

/// Maximum number of rows of the coarsest level of a matrix that is not itself factored: coarse
/// rows have many entries.
constexpr Eigen::Index kCoarsest = 500;
/// Power iterations approach the largest eigenvalue from below.
constexpr int kPowerIterations = 12;
constexpr double kFromBelow = 1.1;

/// Per unknown: the coarse unknown to which it belongs, and the sign between them, since charts may
/// differ in sign.
struct Aggregates {
  std::vector<int> of;
  std::vector<double> sign;
  int count = 0;
};

/// Calls visit(neighbour, entry) for all unknowns strongly connected to one.
template <class Visit>
void forEachStrong(const SparseMatrix& matrix, const Vector& diagonal, double share, int i,
                   const Visit& visit) {
  for (SparseMatrix::InnerIterator it(matrix, i); it; ++it) {
    const auto j = static_cast<int>(it.row());
    if (j != i && std::abs(it.value()) >= share * std::sqrt(diagonal[i] * diagonal[j])) {
      visit(j, it.value());
    }
  }
}

Aggregates aggregate(const SparseMatrix& matrix, double share) {
  const auto n = static_cast<int>(matrix.rows());
  const Vector diagonal = matrix.diagonal();
  Aggregates result{std::vector<int>(static_cast<std::size_t>(n), -1),
                    std::vector<double>(static_cast<std::size_t>(n), 1), 0};
  const auto join = [&result](int i, int other, double entry) {
    result.of[static_cast<std::size_t>(i)] = result.of[static_cast<std::size_t>(other)];
    result.sign[static_cast<std::size_t>(i)] = entry < 0
                                                   ? result.sign[static_cast<std::size_t>(other)]
                                                   : -result.sign[static_cast<std::size_t>(other)];
  };
  const auto isFree = [&result](int i) { return result.of[static_cast<std::size_t>(i)] < 0; };
  // Aggregate whole neighbourhoods first.
  for (int i = 0; i < n; ++i) {
    bool allFree = isFree(i);
    forEachStrong(matrix, diagonal, share, i,
                  [&](int j, double /*entry*/) { allFree = allFree && isFree(j); });
    if (!allFree) continue;
    result.of[static_cast<std::size_t>(i)] = result.count++;
    forEachStrong(matrix, diagonal, share, i, [&](int j, double entry) { join(j, i, entry); });
  }
  // Attach unknowns next to these by their strongest connection.
  const std::vector<int> wholes = result.of;
  for (int i = 0; i < n; ++i) {
    if (!isFree(i)) continue;
    double strongest = 0;
    forEachStrong(matrix, diagonal, share, i, [&](int j, double entry) {
      if (wholes[static_cast<std::size_t>(j)] < 0 || !(std::abs(entry) > strongest)) return;
      strongest = std::abs(entry);
      join(i, j, entry);
    });
  }
  // Aggregate the rest.
  for (int i = 0; i < n; ++i) {
    if (!isFree(i)) continue;
    result.of[static_cast<std::size_t>(i)] = result.count++;
    forEachStrong(matrix, diagonal, share, i, [&](int j, double entry) {
      if (isFree(j)) join(j, i, entry);
    });
  }
  return result;
}

/// Approximates the largest eigenvalue of the matrix divided by its diagonal.
double largestEigenvalue(const SparseMatrix& matrix, const Vector& diagonal) {
  Vector v(matrix.rows());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = std::sin(static_cast<double>(i + 1));
  double value = 1;
  for (int i = 0; i < kPowerIterations; ++i) {
    v /= v.norm();
    v = Vector((matrix * v).cwiseQuotient(diagonal));
    value = v.norm();
  }
  return kFromBelow * value;
}

SparseMatrix prolongationOf(const SparseMatrix& matrix, double share) {
  const Aggregates aggregates = aggregate(matrix, share);
  const auto n = static_cast<int>(matrix.rows());
  SparseMatrix tentative(n, aggregates.count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, aggregates.of[static_cast<std::size_t>(i)],
                         aggregates.sign[static_cast<std::size_t>(i)]);
  }
  tentative.setFromTriplets(entries.begin(), entries.end());
  const Vector diagonal = matrix.diagonal();
  const double damping = 4.0 / 3 / largestEigenvalue(matrix, diagonal);
  Vector steps = damping * diagonal.cwiseInverse();
  for (int i = 0; i < n; ++i) {
    if (matrix.col(i).nonZeros() > kWide) steps[i] = 0;
  }
  const SparseMatrix moved = matrix * tentative;
  return tentative - SparseMatrix(steps.asDiagonal() * moved).pruned();
}

/// An unknown that moves nothing, as where the surface has no area, has no diagonal entry: it
/// stays.
double quotient(double rest, double diagonal) { return diagonal > 0 ? rest / diagonal : 0; }

/// A Gauss-Seidel sweep through a symmetric matrix, whose columns are its rows. It begins at 0, so
/// it reads only entries before the diagonal, and leftOver() only those behind.
Vector sweepFromZero(const SparseMatrix& matrix, const Vector& v) {
  Vector x(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    double rest = v[i];
    SparseMatrix::InnerIterator it(matrix, i);
    for (; it && it.row() < i; ++it) rest -= it.value() * x[it.row()];
    const bool isDiagonal = it && it.row() == i;
    x[i] = isDiagonal ? quotient(rest, it.value()) : 0;
  }
  return x;
}

/// v - matrix * x after sweepFromZero().
Vector leftOver(const SparseMatrix& matrix, const Vector& x) {
  Vector rest(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double sum = 0;
    for (SparseMatrix::ReverseInnerIterator it(matrix, i); it && it.row() > i; --it) {
      sum -= it.value() * x[it.row()];
    }
    rest[i] = sum;
  }
  return rest;
}

/// The sweep in the other order, from any x.
void sweepBack(const SparseMatrix& matrix, const Vector& v, Vector& x) {
  for (Eigen::Index i = v.size() - 1; i >= 0; --i) {
    double rest = v[i];
    double diagonal = 0;
    for (SparseMatrix::InnerIterator it(matrix, i); it; ++it) {
      if (it.row() == i) {
        diagonal = it.value();
      } else {
        rest -= it.value() * x[it.row()];
      }
    }
    x[i] = quotient(rest, diagonal);
  }
}

}  // namespace

Multigrid::Multigrid(SparseMatrix matrix, Eigen::Index mostFactored, const Context& context) {
  assert(matrix.rows() == matrix.cols());
  double share = kStrong;
  while (matrix.rows() > (levels_.empty() ? mostFactored : kCoarsest)) {
    context.throwIfCancelled();
    SparseMatrix prolongation = prolongationOf(matrix, share);
    if (kCoarser * static_cast<double>(prolongation.cols()) > static_cast<double>(matrix.rows())) {
      break;
    }
    const SparseMatrix moved = matrix * prolongation;
    SparseMatrix coarser = prolongation.transpose() * moved;
    // Swapped, since Eigen's sparse matrices cannot be moved.
    levels_.emplace_back();
    levels_.back().matrix.swap(matrix);
    levels_.back().prolongation.swap(prolongation);
    matrix.swap(coarser);
    share /= 2;
  }
  factor_.compute(matrix);
}

Multigrid::Multigrid(SparseMatrix matrix) {
  levels_.emplace_back();
  levels_.back().matrix.swap(matrix);
}

Vector Multigrid::cycle(std::size_t level, const Vector& v) const {
  assert(level == levels_.size() || levels_[level].matrix.rows() == v.size());
  if (level == levels_.size()) return factor_.solve(v);
  const auto& [matrix, prolongation] = levels_[level];
  Vector x = sweepFromZero(matrix, v);
  if (prolongation.cols() > 0) {
    x += prolongation * cycle(level + 1, prolongation.transpose() * leftOver(matrix, x));
  }
  sweepBack(matrix, v, x);
  return x;
}

Vector Multigrid::solve(const Vector& v) const {
  if (levels_.empty()) return factor_.solve(v);
  constexpr double kTolerance = 1e-5;
  constexpr int kMostSteps = 200;
  const SparseMatrix& matrix = levels_.front().matrix;
  Vector x = Vector::Zero(v.size());
  Vector rest = v;
  Vector preconditioned = cycle(rest);
  Vector direction = preconditioned;
  double product = rest.dot(preconditioned);
  for (int i = 0; i < kMostSteps && rest.norm() > kTolerance * v.norm(); ++i) {
    const Vector image = matrix * direction;
    const double length = product / direction.dot(image);
    x += length * direction;
    rest -= length * image;
    preconditioned = cycle(rest);
    const double next = rest.dot(preconditioned);
    direction = preconditioned + next / product * direction;
    product = next;
  }
  return x;
}

}  // namespace hexhex::untangle
