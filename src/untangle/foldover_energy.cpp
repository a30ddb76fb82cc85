#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <untangle/foldover_energy.hpp>

#include <base/parallel.hpp>

namespace hexhex::untangle {

namespace {

constexpr std::size_t kEnergyGrain = 512;

using Corners = Eigen::Matrix<double, 3, 4>;
using Gradients = Eigen::Matrix<double, 4, 3>;

Eigen::Vector3d toEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

Eigen::Matrix3d toEigen(const Matrix3& rows) {
  Eigen::Matrix3d m;
  m << toEigen(rows[0]).transpose(), toEigen(rows[1]).transpose(), toEigen(rows[2]).transpose();
  return m;
}

Eigen::Matrix3d cofactorOf(const Eigen::Matrix3d& j) {
  Eigen::Matrix3d columns;
  columns.col(0) = j.col(1).cross(j.col(2));
  columns.col(1) = j.col(2).cross(j.col(0));
  columns.col(2) = j.col(0).cross(j.col(1));
  return columns;
}

/// Not std::hypot, which takes as long as the rest of an element's energy; the squares stay within
/// the range of double.
double rootOf(double epsilon, double det) {
  return epsilon == 0 ? std::abs(det) : std::sqrt(epsilon * epsilon + det * det);
}

double positivePart(double epsilon, double det, double root) {
  return det > 0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
}

/// |J|^2 / chi^(2/3) + (det^2 + 1) / chi and its derivatives: the terms for angles and for volumes.
struct Density {
  double value = std::numeric_limits<double>::infinity();
  // The derivative along a change dJ is power (J : dJ) + along (cofactor : dJ).
  double power = 0;
  double along = 0;

  Density(const Eigen::Matrix3d& j, double det, double epsilon) {
    if (epsilon == 0 && det <= 0) return;
    const double root = rootOf(epsilon, det);
    const double chi = positivePart(epsilon, det, root);
    const double slope = 0.5 * (1 + det / root);
    const double share = 1 / std::cbrt(chi * chi);
    const double shape = j.squaredNorm() * share;
    const double volume = (det * det + 1) / chi;
    value = shape + volume;
    power = 2 * share;
    along = (-(2.0 / 3) * shape * slope + 2 * det - volume * slope) / chi;
  }
};

}  // namespace

double regularized(double epsilon, double det) noexcept {
  assert(epsilon > 0 || det > 0);
  return positivePart(epsilon, det, rootOf(epsilon, det));
}

Vector coordinatesOf(const Problem& problem, const Vector& unknowns) {
  const SparseRows& sums = problem.sums;
  if (sums.size() == 0) return unknowns;
  Vector coordinates = Vector::Zero(std::ssize(sums.begins) - 1);
  for (std::size_t row = 0; row < sums.size(); ++row) {
    double& sum = coordinates[static_cast<Eigen::Index>(row)];
    for (std::size_t i = sums.begins[row]; i < sums.begins[row + 1]; ++i) {
      sum += sums.entries[i].factor * unknowns[sums.entries[i].column];
    }
  }
  return coordinates;
}

Vector byUnknowns(const Problem& problem, const Vector& byCoordinates) {
  const SparseRows& sums = problem.sums;
  if (sums.size() == 0) return byCoordinates;
  Vector result = Vector::Zero(std::ssize(problem.x));
  for (std::size_t row = 0; row < sums.size(); ++row) {
    const double value = byCoordinates[static_cast<Eigen::Index>(row)];
    for (std::size_t i = sums.begins[row]; i < sums.begins[row + 1]; ++i) {
      result[sums.entries[i].column] += sums.entries[i].factor * value;
    }
  }
  return result;
}

Gradients cornerGradients(const Element& element) {
  Gradients g;
  for (Eigen::Index i = 0; i < 3; ++i) {
    g.row(i + 1) = toEigen(element.gradients[static_cast<std::size_t>(i)]).transpose();
  }
  g.row(0) = -g.bottomRows<3>().colwise().sum();
  return g;
}

Eigen::Matrix3d jacobian(const Problem& problem, const Element& element, const double* x) {
  Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
  if (element.offset >= 0) j = toEigen(problem.matrices[static_cast<std::size_t>(element.offset)]);
  // Differences keep small elements accurate far from the origin.
  const Eigen::Vector3d origin = toEigen(element.corners[0].at(x));
  for (std::size_t i = 0; i < 3; ++i) {
    j += (toEigen(element.corners[i + 1].at(x)) - origin) *
         toEigen(element.gradients[i]).transpose();
  }
  return j;
}

Eigen::Matrix3d targetOf(const Problem& problem, const Element& element) {
  if (element.target < 0) return Eigen::Matrix3d::Identity();
  return toEigen(problem.matrices[static_cast<std::size_t>(element.target)]);
}

Uses::Uses(const Problem& problem) : begins_(coordinateCount(problem) + 1) {
  const auto forEachUse = [&problem](const auto& visit) {
    std::uint32_t entry = 0;
    for (const Element& element : problem.elements) {
      for (const Corner& corner : element.corners) {
        for (const int unknown : corner.unknown) {
          if (unknown >= 0) visit(static_cast<std::size_t>(unknown), entry);
          ++entry;
        }
      }
    }
  };
  forEachUse([&](std::size_t unknown, std::uint32_t /*entry*/) { ++begins_[unknown]; });
  entries_.resize(exclusiveScan<std::uint32_t>(begins_));
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  forEachUse([&](std::size_t unknown, std::uint32_t entry) { entries_[next[unknown]++] = entry; });
}

Energy::Energy(const Problem& problem, Stage& stage)
    : problem_(problem), stage_(stage), uses_(problem), forces_(problem.elements.size()) {}

/// Sums visit(index, element, height) over all elements, block by block.
template <class Visit>
Height Energy::collect(const Visit& visit) const {
  const std::size_t n = problem_.elements.size();
  std::vector<Height> parts(blockCount(n, kEnergyGrain));
  parallelBlocks(stage_, n, kEnergyGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t i = begin; i < end; ++i)
                     visit(i, problem_.elements[i], parts[block]);
                 });
  Height all;
  for (const Height& part : parts) {
    all.energy += part.energy;
    all.leastDeterminant = std::min(all.leastDeterminant, part.leastDeterminant);
    all.flipped += part.flipped;
  }
  return all;
}

void Energy::add(const Element& element, const Eigen::Matrix3d& j, double density,
                 Height& height) const {
  const double det = j.determinant();
  height.leastDeterminant = std::min(height.leastDeterminant, det);
  height.flipped += det > 0 ? 0 : 1;
  if (problem_.pull > 0) {
    density += 0.5 * problem_.pull * (j - targetOf(problem_, element)).squaredNorm();
  }
  height.energy += element.weight * density;
}

Height Energy::at(const Vector& unknowns, double epsilon) const {
  const Vector x = coordinatesOf(problem_, unknowns);
  return collect([&](std::size_t /*index*/, const Element& element, Height& part) {
    const Eigen::Matrix3d j = jacobian(problem_, element, x.data());
    add(element, j, Density(j, j.determinant(), epsilon).value, part);
  });
}

Height Energy::at(const Vector& unknowns, double epsilon, Vector& gradient) {
  const Vector x = coordinatesOf(problem_, unknowns);
  assert(forces_.size() == problem_.elements.size());
  const Height height = collect([&](std::size_t index, const Element& element, Height& part) {
    const Eigen::Matrix3d j = jacobian(problem_, element, x.data());
    const Density density(j, j.determinant(), epsilon);
    add(element, j, density.value, part);
    Eigen::Matrix3d byMatrix = density.power * j + density.along * cofactorOf(j);
    if (problem_.pull > 0) byMatrix += problem_.pull * (j - targetOf(problem_, element));
    Eigen::Map<Corners>(forces_[index].data()) =
        element.weight * byMatrix * cornerGradients(element).transpose();
    // Apply signs while the element is in cache: reading it again below would cost more.
    for (std::size_t use = 0; use < 12; ++use) {
      forces_[index][use] *= element.corners[use / 3].sign[use % 3];
    }
  });
  gradient.resize(x.size());
  parallelFor(stage_, coordinateCount(problem_), kEnergyGrain, [&](std::size_t unknown) {
    double sum = 0;
    for (const std::uint32_t use : uses_(unknown)) sum += forces_[use / 12][use % 12];
    gradient[static_cast<Eigen::Index>(unknown)] = sum;
  });
  if (problem_.sums.size() != 0) gradient = byUnknowns(problem_, gradient);
  return height;
}

}  // namespace hexhex::untangle
