// The best rotation and the nearest translation between two charts (Section 5.1.1).
#include <algorithm>
#include <cmath>
#include <limits>

#include <igm/transition_fit.hpp>

namespace hexhex::igm {

namespace {

double squaredNorm(const Vec3& a) { return dot(a, a); }

/// Squared error of a rotation that should carry the vectors to their images.
double residual(lattice::Rotation rotation, const VectorPair& vectors, const VectorPair& images) {
  return squaredNorm(minus(images[0], rotation(vectors[0]))) +
         squaredNorm(minus(images[1], rotation(vectors[1])));
}

/// How well each rotation carries the vectors over: the sum of scalar products of the rotated
/// vectors with the wanted images.
std::array<double, lattice::Rotation::kCount> agreements(const VectorPair& vectors,
                                                         const VectorPair& images) {
  // What sending axis `from` to axis `to` adds to the sum; sending it to the opposite direction
  // subtracts it.
  std::array<Vec3, 3> sums{};
  for (std::size_t to = 0; to < 3; ++to) {
    for (std::size_t from = 0; from < 3; ++from) {
      sums[to][from] = images[0][to] * vectors[0][from] + images[1][to] * vectors[1][from];
    }
  }
  std::array<double, lattice::Rotation::kCount> agreement{};
  for (std::size_t r = 0; r < agreement.size(); ++r) {
    for (int from = 0; from < 3; ++from) {
      const lattice::Direction to =
          lattice::Rotation(static_cast<int>(r))(lattice::direction(from, 1));
      agreement[r] +=
          lattice::signOf(to) *
          sums[static_cast<std::size_t>(lattice::axisOf(to))][static_cast<std::size_t>(from)];
    }
  }
  return agreement;
}

/// The rotation that carries both vectors over without rounding, if the first vector determines it:
/// its components differ in magnitude, and none is zero, so that all other rotations do worse. (5 %
/// of a whole extraction with a chart per tet.)
std::optional<lattice::Rotation> exactRotation(const VectorPair& vectors,
                                               const VectorPair& images) {
  const Vec3 a = {std::abs(vectors[0][0]), std::abs(vectors[0][1]), std::abs(vectors[0][2])};
  if (!(a[0] > 0 && a[1] > 0 && a[2] > 0)) return std::nullopt;
  if (a[0] == a[1] || a[1] == a[2] || a[2] == a[0]) return std::nullopt;
  std::array<lattice::Direction, 2>
      source{};  // for the first two axes: what the rotation sends there
  for (std::size_t to = 0; to < 2; ++to) {
    const double b = std::abs(images[0][to]);
    const int axis = (b == a[1] ? 1 : 0) + (b == a[2] ? 2 : 0);
    const bool isReversed =
        std::signbit(images[0][to]) != std::signbit(vectors[0][static_cast<std::size_t>(axis)]);
    source[to] = lattice::direction(axis, isReversed ? -1 : 1);
  }
  if (lattice::axisOf(source[0]) == lattice::axisOf(source[1])) return std::nullopt;
  const lattice::Rotation rotation = lattice::Rotation::fromAxes(source[0], source[1]).inverse();
  if (rotation(vectors[0]) != images[0] || rotation(vectors[1]) != images[1]) return std::nullopt;
  return rotation;
}

/// The integers nearest to the mean difference that the rotation leaves at the corners.
Vec3 meanTranslation(const SharedTriangle& triangle, const std::array<Vec3, 3>& images) {
  Vec3 mean{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 difference = minus(triangle.there[i], images[i]);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += difference[k] / 3;
  }
  for (double& component : mean) component = nearestInteger(component);
  return mean;
}

/// What remains after a transition has carried corners over.
double residualOf(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
                  const Vec3& translation) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 rest = minus(triangle.there[i], plus(images[i], translation));
    for (const double x : rest) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

/// Whether moving corners by a translation that leaves no residual rounds nothing.
bool isExact(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
             const Vec3& translation) {
  double rest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      rest += restOfSum(triangle.there[i][k], images[i][k], translation[k]);
    }
  }
  return rest == 0;
}

}  // namespace

/// The squared error is a constant minus twice the agreement; as the agreement is rounded, it only
/// tells which rotations need a closer look.
lattice::Rotation bestRotationOfAll(const VectorPair& vectors, const VectorPair& images) noexcept {
  const std::array<double, lattice::Rotation::kCount> agreement = agreements(vectors, images);
  const double size = squaredNorm(vectors[0]) + squaredNorm(vectors[1]) + squaredNorm(images[0]) +
                      squaredNorm(images[1]);
  // Far above rounding (a few 2^-53), far below the differences between rotations.
  const double enough = *std::max_element(agreement.begin(), agreement.end()) - 0x1p-40 * size;
  lattice::Rotation best;
  double bestResidual = std::numeric_limits<double>::infinity();
  for (std::size_t index = 0; index < agreement.size(); ++index) {
    if (agreement[index] < enough) continue;
    const lattice::Rotation rotation(static_cast<int>(index));
    const double error = residual(rotation, vectors, images);
    if (error < bestResidual) {
      bestResidual = error;
      best = rotation;
    }
  }
  return best;
}

lattice::Rotation bestRotation(const VectorPair& vectors, const VectorPair& images) noexcept {
  const std::optional<lattice::Rotation> exact = exactRotation(vectors, images);
  return exact ? *exact : bestRotationOfAll(vectors, images);
}

lattice::Rotation bestRotation(const SharedTriangle& triangle) noexcept {
  return bestRotation(
      {minus(triangle.here[1], triangle.here[0]), minus(triangle.here[2], triangle.here[0])},
      {minus(triangle.there[1], triangle.there[0]), minus(triangle.there[2], triangle.there[0])});
}

bool agree(const adjacency::TetTopology& topology, const LocalParameters& parameters,
           adjacency::HalfFace halfFace) noexcept {
  const SharedTriangle triangle(topology, parameters, halfFace);
  return triangle.here == triangle.there;
}

FittedTransition fitTransition(const SharedTriangle& triangle) noexcept {
  return fitTransition(triangle, bestRotation(triangle));
}

FittedTransition fitTransition(const SharedTriangle& triangle,
                               lattice::Rotation rotation) noexcept {
  std::array<Vec3, 3> images{};
  for (std::size_t i = 0; i < 3; ++i) images[i] = rotation(triangle.here[i]);
  Vec3 translation = minus(triangle.there[0], images[0]);
  for (double& component : translation) component = nearestInteger(component);
  FittedTransition fitted;
  fitted.residual = residualOf(triangle, images, translation);
  // If it fits each corner to within a quarter, it is also nearest to the mean.
  if (fitted.residual > 0.25) {
    translation = meanTranslation(triangle, images);
    fitted.residual = residualOf(triangle, images, translation);
  }
  fitted.isExact = fitted.residual == 0 && isExact(triangle, images, translation);
  fitted.transition.rotation = rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    fitted.transition.translation[k] = static_cast<std::int32_t>(translation[k]);
  }
  return fitted;
}

std::vector<FittedTransition> fitAllTransitions(const SharedTriangle& triangle) {
  std::vector<FittedTransition> fits;
  fits.reserve(lattice::Rotation::kCount);
  for (int r = 0; r < lattice::Rotation::kCount; ++r)
    fits.push_back(fitTransition(triangle, lattice::Rotation(r)));
  std::stable_sort(
      fits.begin(), fits.end(),
      [](const FittedTransition& a, const FittedTransition& b) { return a.residual < b.residual; });
  return fits;
}

}  // namespace hexhex::igm
