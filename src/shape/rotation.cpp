#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <shape/rotation.hpp>

#include <base/random.hpp>

namespace hexhex::shape {

namespace {

constexpr Rotation kIdentity = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
/// Number of random rotations: practically always, one is within 20 degrees of any rotation, up to
/// the symmetries of a cube.
constexpr int kDrawn = 150;
constexpr std::size_t kRefined = 6;
/// Minimum relative gain that is worth turning the object.
constexpr double kWorthwhile = 0.985;
/// Larger surfaces are sampled with about this many triangles.
constexpr std::size_t kSampled = 4096;

struct Quaternion {
  double w, x, y, z;
};

Rotation rotationOf(Quaternion q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double w = q.w / norm;
  const double x = q.x / norm;
  const double y = q.y / norm;
  const double z = q.z / norm;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
          Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
          Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
}

/// a after b.
Rotation composed(const Rotation& a, const Rotation& b) {
  Rotation result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) result[i][k] += a[i][j] * b[j][k];
    }
  }
  return result;
}

struct WeightedNormal {
  Vec3 normal;
  double weight;
};

std::vector<WeightedNormal> sampledNormals(const Surface& surface) {
  const std::size_t step = std::max<std::size_t>(1, surface.triangleCount() / kSampled);
  std::vector<WeightedNormal> normals;
  for (std::size_t t = 0; t < surface.triangleCount(); t += step) {
    normals.push_back({surface.normals[t], surface.areas[t]});
  }
  return normals;
}

/// The mean 1-norm of normals: 1 if all are along axes, at most sqrt(3).
double costOf(const Rotation& rotation, const std::vector<WeightedNormal>& normals) {
  double sum = 0;
  double weights = 0;
  for (const WeightedNormal& each : normals) {
    const Vec3 n = turned(rotation, each.normal);
    sum += each.weight * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
    weights += each.weight;
  }
  return sum / weights;
}

struct Candidate {
  double cost = 0;
  Rotation rotation = kIdentity;
};

/// Applies small random turns of decreasing size while they help.
void refine(Candidate& candidate, const std::vector<WeightedNormal>& normals, Random& random) {
  constexpr double kSmallest = 1e-6;
  constexpr int kPatience = 8;
  int failures = 0;
  for (double size = 0.3; size > kSmallest;) {
    const Rotation turn =
        rotationOf({1, random.realUpTo(size), random.realUpTo(size), random.realUpTo(size)});
    const Rotation rotation = composed(turn, candidate.rotation);
    const double cost = costOf(rotation, normals);
    if (cost < candidate.cost) {
      candidate = {cost, rotation};
      failures = 0;
    } else if (++failures > kPatience) {
      size *= 0.6;
      failures = 0;
    }
  }
}

/// Uniform among all rotations (Marsaglia 1972: points of the 4-ball, projected onto its sphere).
Rotation drawRotation(Random& random) {
  while (true) {
    const Quaternion q = {random.realUpTo(1), random.realUpTo(1), random.realUpTo(1),
                          random.realUpTo(1)};
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (square > 1e-3 && square < 1) return rotationOf(q);
  }
}

}  // namespace

Rotation bestRotation(const Surface& surface, std::uint64_t seed) {
  const std::vector<WeightedNormal> normals = sampledNormals(surface);
  Random random(seed, 1);
  std::vector<Candidate> candidates = {{costOf(kIdentity, normals), kIdentity}};
  const double asItIs = candidates.front().cost;
  for (int i = 0; i < kDrawn; ++i) {
    const Rotation rotation = drawRotation(random);
    candidates.push_back({costOf(rotation, normals), rotation});
  }
  const auto isBetter = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
  std::stable_sort(candidates.begin(), candidates.end(), isBetter);
  candidates.resize(kRefined);
  for (Candidate& candidate : candidates) refine(candidate, normals, random);
  const Candidate best = *std::min_element(candidates.begin(), candidates.end(), isBetter);
  return best.cost < kWorthwhile * asItIs ? best.rotation : kIdentity;
}

}  // namespace hexhex::shape
