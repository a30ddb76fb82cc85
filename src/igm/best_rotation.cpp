#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <igm/best_rotation.hpp>
#include <igm/turn.hpp>

namespace hexhex {

namespace {

double squaredNorm(const Vec3& a) { return dot(a, a); }

/// How far a rotation is from carrying the vectors over.
double residual(Rotation rotation, const VectorPair& vectors, const VectorPair& images) {
  return squaredNorm(minus(images[0], turned(rotation, vectors[0]))) +
         squaredNorm(minus(images[1], turned(rotation, vectors[1])));
}

/// Contributions[to][from]: what sending axis `from` to axis `to` adds to the sum of scalar
/// products of rotated vectors with the images wanted; sending it to the opposite direction
/// subtracts it.
using Contributions = std::array<Vec3, 3>;

Contributions contributions(const VectorPair& vectors, const VectorPair& images) {
  Contributions sums{};
  for (std::size_t to = 0; to < 3; ++to) {
    for (std::size_t from = 0; from < 3; ++from) {
      sums[to][from] = images[0][to] * vectors[0][from] + images[1][to] * vectors[1][from];
    }
  }
  return sums;
}

/// How well each of the rotations carries the vectors over: a sum of three contributions.
std::array<double, Rotation::kCount> agreements(const VectorPair& vectors,
                                                const VectorPair& images) {
  const Contributions sums = contributions(vectors, images);
  std::array<double, Rotation::kCount> agreement{};
  for (std::size_t r = 0; r < agreement.size(); ++r) {
    for (int from = 0; from < 3; ++from) {
      const Direction to = Rotation(static_cast<int>(r))(direction(from, 1));
      agreement[r] +=
          signOf(to) * sums[static_cast<std::size_t>(axisOf(to))][static_cast<std::size_t>(from)];
    }
  }
  return agreement;
}

/// A way to permute the axes.
struct AxisOrder {
  std::array<std::uint8_t, 3> to;  ///< where each axis goes
  bool odd;                        ///< a rotation then reverses one axis or all three
};

constexpr std::array<AxisOrder, 6> kAxisOrders = {{{{0, 1, 2}, false},
                                                   {{1, 2, 0}, false},
                                                   {{2, 0, 1}, false},
                                                   {{0, 2, 1}, true},
                                                   {{2, 1, 0}, true},
                                                   {{1, 0, 2}, true}}};

/// Contributions without their signs.
struct Magnitudes {
  std::array<Vec3, 3> size{};
  std::array<std::array<unsigned, 3>, 3> isNegative{};  ///< 0 or 1

  explicit Magnitudes(const Contributions& sums) {
    for (std::size_t to = 0; to < 3; ++to) {
      for (std::size_t from = 0; from < 3; ++from) {
        size[to][from] = std::abs(sums[to][from]);
        isNegative[to][from] = sums[to][from] < 0 ? 1U : 0U;
      }
    }
  }
};

/// The best order of axes so far.
struct BestOrder {
  double agreement = -1;
  std::size_t order = 0;

  /// Looks at the rotation that gives each contribution its better sign, except for the smallest if
  /// that would be a reflection.
  template <std::size_t kOrder>
  void consider(const Magnitudes& sums) {
    constexpr AxisOrder kAxes = kAxisOrders[kOrder];
    const double x = sums.size[kAxes.to[0]][0];
    const double y = sums.size[kAxes.to[1]][1];
    const double z = sums.size[kAxes.to[2]][2];
    const double smallest = std::min(std::min(x, y), z);
    const unsigned reflects = sums.isNegative[kAxes.to[0]][0] ^ sums.isNegative[kAxes.to[1]][1] ^
                              sums.isNegative[kAxes.to[2]][2] ^ (kAxes.odd ? 1U : 0U);
    const std::array<double, 2> lost = {0, 2 * smallest};
    const double candidate = x + y + z - lost[reflects];
    order = candidate > agreement ? kOrder : order;
    agreement = std::max(agreement, candidate);
  }
};

/// The rotation that agrees best, or nearly so.
Rotation proposedRotation(const VectorPair& vectors, const VectorPair& images) {
  const Magnitudes sums(contributions(vectors, images));
  BestOrder best;
  [&]<std::size_t... kOrder>(std::index_sequence<kOrder...>) { (best.consider<kOrder>(sums), ...); }
  (std::make_index_sequence<kAxisOrders.size()>());
  const AxisOrder& order = kAxisOrders[best.order];
  std::array<unsigned, 3> reversed{};
  unsigned reflects = order.odd ? 1U : 0U;
  std::size_t weakest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reversed[axis] = sums.isNegative[order.to[axis]][axis];
    reflects ^= reversed[axis];
    const double size = sums.size[order.to[axis]][axis];
    weakest = size < least ? axis : weakest;
    least = std::min(size, least);
  }
  reversed[weakest] ^= reflects;
  return Rotation::fromAxes(static_cast<Direction>(2U * order.to[0] + reversed[0]),
                            static_cast<Direction>(2U * order.to[1] + reversed[1]));
}

/// The only rotation that carries the first vector over, if that has components of three different
/// sizes, none zero, and if that carries over both without rounding: all others are then worse.
/// Nothing is foretold but that it is found.
std::optional<Rotation> exactRotation(const VectorPair& vectors, const VectorPair& images) {
  const Vec3 a = {std::abs(vectors[0][0]), std::abs(vectors[0][1]), std::abs(vectors[0][2])};
  std::array<Direction, 3> from{};  // per axis: what is turned into it
  for (std::size_t to = 0; to < 3; ++to) {
    const double b = std::abs(images[0][to]);
    const unsigned axis = (b == a[1] ? 1U : 0U) | (b == a[2] ? 2U : 0U);
    const unsigned reversed = signBit(images[0][to]) ^ signBit(vectors[0][axis % 3]);
    from[to] = static_cast<Direction>(2 * (axis % 3) + reversed);
  }
  // Of the inverse, these are the images of the axes.
  if (axisOf(from[0]) == axisOf(from[1])) return std::nullopt;
  const Rotation rotation = inverseOf(Rotation::fromAxes(from[0], from[1]));
  const Vec3 first = turned(rotation, vectors[0]);
  const Vec3 second = turned(rotation, vectors[1]);
  double difference = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    difference += std::abs(first[k] - images[0][k]) + std::abs(second[k] - images[1][k]);
  }
  const bool isOnlyOne = allOf(a[0] != a[1], a[1] != a[2], a[2] != a[0]);
  if (!allOf(difference == 0, isOnlyOne, a[0] > 0, a[1] > 0, a[2] > 0)) return std::nullopt;
  return rotation;
}

}  // namespace

/// The squared error is a constant minus twice the agreement; as the agreement is rounded, it only
/// tells which rotations need a closer look.
Rotation bestRotationOfAll(const VectorPair& vectors, const VectorPair& images) noexcept {
  const std::array<double, Rotation::kCount> agreement = agreements(vectors, images);
  const double size = squaredNorm(vectors[0]) + squaredNorm(vectors[1]) + squaredNorm(images[0]) +
                      squaredNorm(images[1]);
  // Far above rounding (a few 2^-53), far below what tells rotations apart.
  const double enough = *std::max_element(agreement.begin(), agreement.end()) - 0x1p-40 * size;
  Rotation best;
  double bestResidual = std::numeric_limits<double>::infinity();
  for (std::size_t index = 0; index < agreement.size(); ++index) {
    if (agreement[index] < enough) continue;
    const Rotation rotation(static_cast<int>(index));
    const double error = residual(rotation, vectors, images);
    if (error < bestResidual) {
      bestResidual = error;
      best = rotation;
    }
  }
  return best;
}

/// Another rotation, S before R, moves a vector v by |v - S v| >= sqrt(2) |v'|, with v' the part of
/// v across the axis of S, as cube rotations turn by at least 90 degrees. For vectors a and b,
/// |a'|^2 + |b'|^2 is at least the smaller eigenvalue of their Gram matrix, and that is at least
/// |a x b|^2 / (|a|^2 + |b|^2). The difference D, at least twice that, is between the images under
/// both rotations; so if the squared residual of R is below D / 100, those of all others are above
/// 0.81 D.
std::optional<Rotation> certainRotation(const VectorPair& vectors,
                                        const VectorPair& images) noexcept {
  const Rotation rotation = proposedRotation(vectors, images);
  const double trace = squaredNorm(vectors[0]) + squaredNorm(vectors[1]);
  const double area = squaredNorm(cross(vectors[0], vectors[1]));
  // Vectors that are nearly parallel would leave it to rounding; far smaller ones underflow.
  const bool sound = area > 0x1p-30 * trace * trace && trace > 0x1p-200;
  // With twice the certainty needed, for what is rounded here.
  const bool certain = 100 * residual(rotation, vectors, images) * trace <= area;
  if (sound && certain) return rotation;
  return std::nullopt;
}

Rotation bestRotation(const VectorPair& vectors, const VectorPair& images) noexcept {
  const std::optional<Rotation> exact = exactRotation(vectors, images);
  if (exact) return *exact;
  const std::optional<Rotation> certain = certainRotation(vectors, images);
  return certain ? *certain : bestRotationOfAll(vectors, images);
}

}  // namespace hexhex
