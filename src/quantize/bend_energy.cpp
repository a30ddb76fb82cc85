#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <quantize/bend_energy.hpp>

#include <base/vector3.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

using Matrix3 = Eigen::Matrix3d;
using Corners = Eigen::Matrix<double, 3, 4>;

/// The energy of a Jacobian matrix, and its derivatives along a change dJ, which changes the
/// determinant by d = cofactor : dJ.
struct Density {
  double value = 0;
  Matrix3 gradient;
  // The second derivative is identity |dJ|^2 + 2 mixed (J : dJ) d + normal d^2.
  double identity = 0;
  double mixed = 0;
  double normal = 0;
};

Matrix3 cofactor(const Matrix3& j) {
  Matrix3 columns;
  columns.col(0) = j.col(1).cross(j.col(2));
  columns.col(1) = j.col(2).cross(j.col(0));
  columns.col(2) = j.col(0).cross(j.col(1));
  return columns;
}

Density dirichlet(const Matrix3& j) {
  const Matrix3 strain = j - Matrix3::Identity();
  return {strain.squaredNorm(), 2 * strain, 2, 0, 0};
}

double foldoverFree(const Matrix3& j, double epsilon) {
  const double det = j.determinant();
  if (epsilon == 0 && det <= 0) return std::numeric_limits<double>::infinity();
  const double chi = regularized(epsilon, det);
  return j.squaredNorm() / std::cbrt(chi * chi) + (det * det + 1) / chi;
}

/// Convex in J and the determinant if these are taken for independent, and chi for linear: the
/// second derivative as given is positive semidefinite.
Density foldoverFree(const Matrix3& j, const Matrix3& cofactors, double epsilon) {
  const double det = j.col(0).dot(cofactors.col(0));
  const double chi = regularized(epsilon, det);
  const double slope = 0.5 * (1 + det / std::hypot(epsilon, det));
  const double power = 1 / std::cbrt(chi * chi);
  const double shape = j.squaredNorm() * power;
  const double volume = (det * det + 1) / chi;
  const double relative = slope / chi;
  const double alongCofactor = -(2.0 / 3) * shape * relative + 2 * det / chi - volume * relative;
  return {shape + volume, 2 * power * j + alongCofactor * cofactors, 2 * power,
          -(4.0 / 3) * power * relative,
          (10.0 / 9 * shape + 2 * volume) * relative * relative + (2 - 4 * det * relative) / chi};
}

/// By the coordinates of the corners of a tet, one corner after the other.
struct TetDerivatives {
  Eigen::Matrix<double, 12, 1> gradient;
  Eigen::Matrix<double, 12, 12> hessian;
};

TetDerivatives tetDerivatives(BendEnergyKind kind, const Corners& corners,
                              const Eigen::Matrix<double, 4, 3>& gradients) {
  const Matrix3 j = corners * gradients;
  const Matrix3 cofactors = cofactor(j);
  const Density density = kind.name == BendEnergyKind::Name::Dirichlet
                              ? dirichlet(j)
                              : foldoverFree(j, cofactors, kind.epsilon);
  const Corners along = j * gradients.transpose();
  const Corners across = cofactors * gradients.transpose();
  const Corners force = density.gradient * gradients.transpose();
  const Eigen::Matrix<double, 12, 1> a = across.reshaped();
  const Eigen::Matrix<double, 12, 1> b = density.mixed * along.reshaped();
  TetDerivatives derivatives{force.reshaped(), {}};
  derivatives.hessian = b * a.transpose() + a * b.transpose() + density.normal * a * a.transpose();
  const Eigen::Matrix4d products = density.identity * gradients * gradients.transpose();
  for (Eigen::Index m = 0; m < 4; ++m) {
    for (Eigen::Index n = 0; n < 4; ++n) {
      derivatives.hessian.block<3, 3>(3 * m, 3 * n).diagonal().array() += products(m, n);
    }
  }
  return derivatives;
}

/// The unknowns that the coordinates of a tet's corners are, but for signs and translations.
struct TetUnknowns {
  std::array<int, 12> number{};  ///< or negative
  std::array<double, 12> sign{};

  /// @param toCorner  of the tet's corners
  TetUnknowns(const Tet& tet, const Transition* toCorner,
              std::span<const std::array<int, 3>> numbers) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto rotation = static_cast<std::size_t>(toCorner[i].rotation.index());
      for (std::size_t k = 0; k < 3; ++k) {
        number[3 * i + k] = numbers[tet[i]][detail::kAxisSources.axis[rotation][k]];
        sign[3 * i + k] = detail::kAxisSources.sign[rotation][k];
      }
    }
  }
};

Eigen::Vector3d toEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// From the first corner of a tet, as columns.
Matrix3 edgesOf(const TetParameters& u) {
  Matrix3 edges;
  edges << toEigen(minus(u[1], u[0])), toEigen(minus(u[2], u[0])), toEigen(minus(u[3], u[0]));
  return edges;
}

}  // namespace

double regularized(double epsilon, double det) noexcept {
  const double root = std::hypot(epsilon, det);
  return det > 0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
}

BendEnergy::BendEnergy(const TetTopology& topology, std::span<const TetParameters> reference,
                       const VertexUnknowns& unknowns)
    : topology_(topology), reference_(reference), unknowns_(unknowns) {
  numberUnknowns();
  for (const TetParameters& u : reference) volume_ += edgesOf(u).determinant();
}

void BendEnergy::numberUnknowns() {
  numbers_.assign(unknowns_.fixed.size(), {-1, -1, -1});
  for (std::size_t v = 0; v < numbers_.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      if ((unknowns_.fixed[v] >> k & 1U) == 0) numbers_[v][k] = count_++;
    }
  }
}

BendEnergy::Shape BendEnergy::shape(Index tet) const {
  const Matrix3 edges = edgesOf(reference_[tet]);
  Shape shape;
  shape.gradients.bottomRows<3>() = edges.inverse() / scale_;
  shape.gradients.row(0) = -shape.gradients.bottomRows<3>().colwise().sum();
  shape.weight = edges.determinant() / volume_;
  return shape;
}

Corners BendEnergy::corners(Index tet, const Vector& x) const {
  Corners columns;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index v = topology_.tets[tet][i];
    Vec3 u = unknowns_.fixedPosition[v];
    for (std::size_t k = 0; k < 3; ++k) {
      if (numbers_[v][k] >= 0) u[k] = x[numbers_[v][k]];
    }
    columns.col(static_cast<Eigen::Index>(i)) = toEigen(unknowns_.toCorner[4 * tet + i](u, 1.0));
  }
  return columns;
}

void BendEnergy::adaptScale(const Vector& x) {
  double ratio = 0;
  for (Index t = 0; t < topology_.tetCount(); ++t) {
    const auto [gradients, weight] = shape(t);
    ratio += weight * (corners(t, x) * gradients).determinant();
  }
  if (ratio > 0) scale_ *= std::cbrt(ratio);
}

Folding BendEnergy::folding(const Vector& x, Stage& stage) const {
  std::vector<Folding> parts(blockCount(topology_.tetCount(), kGrain));
  parallelBlocks(stage, topology_.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   Folding& part = parts[block];
                   for (auto t = static_cast<Index>(begin); t < end; ++t) {
                     const double det = (corners(t, x) * shape(t).gradients).determinant();
                     part.leastDeterminant = std::min(part.leastDeterminant, det);
                     part.flippedTets += det > 0 ? 0 : 1;
                   }
                 });
  Folding all;
  for (const Folding& part : parts) {
    all.leastDeterminant = std::min(all.leastDeterminant, part.leastDeterminant);
    all.flippedTets += part.flippedTets;
  }
  return all;
}

double BendEnergy::value(BendEnergyKind kind, const Vector& x, Stage& stage) const {
  std::vector<double> sums(blockCount(topology_.tetCount(), kGrain));
  parallelBlocks(stage, topology_.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (auto t = static_cast<Index>(begin); t < end; ++t) {
                     const auto [gradients, weight] = shape(t);
                     const Matrix3 j = corners(t, x) * gradients;
                     sums[block] += weight * (kind.name == BendEnergyKind::Name::Dirichlet
                                                  ? dirichlet(j).value
                                                  : foldoverFree(j, kind.epsilon));
                   }
                 });
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

SparseMatrix BendEnergy::emptyHessian() const {
  std::vector<EdgeCorner> scratch;
  const auto forEachEntry = [&](const auto& visit) {
    const auto pair = [&](Index v, Index w) {
      for (const int column : numbers_[v]) {
        for (const int row : numbers_[w]) {
          if (column >= 0 && row >= column) visit(row, column);
        }
      }
    };
    for (Index v = 0; v < topology_.pointCount; ++v) {
      pair(v, v);
      forEachEdge(topology_, v, scratch, [&](Index w, const auto& /*fan*/) { pair(v, w); });
    }
  };
  std::vector<int> sizes(static_cast<std::size_t>(count_), 0);
  forEachEntry([&](int /*row*/, int column) { ++sizes[static_cast<std::size_t>(column)]; });
  SparseMatrix hessian(count_, count_);
  hessian.reserve(sizes);
  forEachEntry([&](int row, int column) { hessian.insert(row, column) = 0; });
  hessian.makeCompressed();
  return hessian;
}

void BendEnergy::derivatives(BendEnergyKind kind, const Vector& x, Vector& gradient,
                             SparseMatrix& hessian) const {
  gradient.setZero(count_);
  hessian.coeffs().setZero();
  for (Index t = 0; t < topology_.tetCount(); ++t) {
    const TetUnknowns own(topology_.tets[t], &unknowns_.toCorner[4 * t], numbers_);
    if (std::all_of(own.number.begin(), own.number.end(), [](int n) { return n < 0; })) continue;
    const auto [gradients, weightOfTet] = shape(t);
    const TetDerivatives tet = tetDerivatives(kind, corners(t, x), gradients);
    for (std::size_t p = 0; p < 12; ++p) {
      if (own.number[p] < 0) continue;
      const auto row = static_cast<Eigen::Index>(p);
      const double weight = weightOfTet * own.sign[p];
      gradient[own.number[p]] += weight * tet.gradient[row];
      for (std::size_t q = 0; q < 12; ++q) {
        if (own.number[q] < 0 || own.number[q] > own.number[p]) continue;
        hessian.coeffRef(own.number[p], own.number[q]) +=
            weight * own.sign[q] * tet.hessian(row, static_cast<Eigen::Index>(q));
      }
    }
  }
}

}  // namespace hexhex
