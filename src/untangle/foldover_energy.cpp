#include <algorithm>
#include <cassert>
#include <cmath>

#include <untangle/energy_lanes.hpp>
#include <untangle/foldover_energy.hpp>
#include <untangle/regularized.hpp>

#include <base/parallel.hpp>

namespace hexhex::untangle {

namespace {

constexpr std::size_t kEnergyGrain = 512;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Gradients = Eigen::Matrix<double, 4, 3>;

Eigen::Vector3d toEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

Eigen::Matrix3d toEigen(const Matrix3& rows) {
  Eigen::Matrix3d m;
  m << toEigen(rows[0]).transpose(), toEigen(rows[1]).transpose(), toEigen(rows[2]).transpose();
  return m;
}

/// Writes an element into a lane.
/// @param x  the coordinates
void load(const Problem& problem, const Element& element, const double* x, std::size_t lane,
          ElementLanes& lanes) {
  const auto copy = [lane](const auto& from, auto& to) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) to[i][k][lane] = from[i][k];
    }
  };
  const auto matrix = [&problem](int index, const Matrix3& otherwise) {
    return index < 0 ? otherwise : problem.matrices[static_cast<std::size_t>(index)];
  };
  constexpr Matrix3 kIdentity = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = element.corners[i].at(x);
  copy(corners, lanes.corners);
  copy(element.gradients, lanes.gradients);
  copy(matrix(element.offset, {}), lanes.offset);
  if (problem.pull > 0) copy(matrix(element.target, kIdentity), lanes.target);
  lanes.weight[lane] = element.weight;
}

}  // namespace

double regularized(double epsilon, double det) noexcept {
  assert(epsilon > 0 || det > 0);
  return Regularized<Pair>(epsilon, Pair{det, det}).chi()[0];
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

/// Calls use(index of an element, its lane, forces) for all elements, four at a time.
template <class Use>
Height Energy::collect(const Vector& x, double epsilon, const Use& use) const {
  static_assert(kEnergyGrain % kLanes == 0);
  const std::vector<Element>& elements = problem_.elements;
  std::vector<Height> parts(blockCount(elements.size(), kEnergyGrain));
  const EnergyKernel kernel = energyKernels().back();
  parallelBlocks(stage_, elements.size(), kEnergyGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   ElementLanes lanes;
                   ForceLanes forces;
                   Height& part = parts[block];
                   for (std::size_t i = begin; i < end; i += kLanes) {
                     const std::size_t count = std::min(kLanes, end - i);
                     for (std::size_t lane = 0; lane < count; ++lane) {
                       load(problem_, elements[i + lane], x.data(), lane, lanes);
                     }
                     kernel(lanes, epsilon, problem_.pull, forces);
                     for (std::size_t lane = 0; lane < count; ++lane) {
                       const double det = forces.determinant[lane];
                       const bool isInfinite = epsilon == 0 && !(det > 0);
                       part.energy += isInfinite ? kInfinite : forces.energy[lane];
                       part.leastDeterminant = std::min(part.leastDeterminant, det);
                       part.flipped += det > 0 ? 0 : 1;
                       use(i + lane, lane, forces);
                     }
                   }
                 });
  Height all;
  for (const Height& part : parts) {
    all.energy += part.energy;
    all.leastDeterminant = std::min(all.leastDeterminant, part.leastDeterminant);
    all.flipped += part.flipped;
  }
  return all;
}

Height Energy::at(const Vector& unknowns, double epsilon) const {
  return collect(coordinatesOf(problem_, unknowns), epsilon,
                 [](std::size_t /*index*/, std::size_t /*lane*/, const ForceLanes& /*forces*/) {});
}

Height Energy::at(const Vector& unknowns, double epsilon, Vector& gradient) {
  const Vector x = coordinatesOf(problem_, unknowns);
  assert(forces_.size() == problem_.elements.size());
  const auto keep = [this](std::size_t index, std::size_t lane, const ForceLanes& forces) {
    const Element& element = problem_.elements[index];
    for (std::size_t use = 0; use < 12; ++use) {
      forces_[index][use] =
          element.corners[use / 3].sign[use % 3] * forces.forces[use / 3][use % 3][lane];
    }
  };
  const Height height = collect(x, epsilon, keep);
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
