// First the tets that the mesh itself names are tried. Only if that leaves vertices, a search tree
// over all tets is built.
#include <algorithm>
#include <cmath>
#include <limits>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <mesh/tet_locator.hpp>
#include <mesh/verify_against.hpp>

namespace hexhex {
namespace {

/// Vertices per block: a block takes about a tenth of a millisecond.
constexpr std::size_t kGrain = 1024;

/// How much the position of a vertex may be off, relative to the coordinates around it. Positions
/// are interpolated with an error of a few 2^-53 and written with 17 digits; this is four orders of
/// magnitude above.
constexpr double kPositionError = 1e-12;

/// How far outside of a tet a vertex may be, relative to the tet's longest edge. A vertex in a tet
/// that is nearly flat, where interpolation fails, is then in its neighbour too; the parameters
/// there change by a billionth of what they span.
constexpr double kContainment = 1e-9;

/// Tets in which kPositionError means more than this distance between parameters, in hex edges, are
/// too flat to tell anything. Small against the distance 0.5 of a point farthest off the lattice.
constexpr double kLargestNoise = 0.05;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Smaller determinants are taken for 0: their terms may have lost digits below the smallest
/// numbers, 2^-1022.
constexpr double kLeastVolume = 0x1p-960;

/// In tets that are too flat in space, so many lattice points are looked at.
constexpr double kMostCandidates = 4096;

/// The largest component: unlike a length, it is not 0 where numbers are tiny.
double extentOf(const Vec3& v) {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

/// Affine coordinates of points with respect to one tet of any orientation, in space or in the map.
class AffineTet {
 public:
  explicit AffineTet(const TetParameters& corners) : origin_(corners[0]) {
    std::array<Vec3, 3> edges;
    for (std::size_t i = 0; i < 3; ++i) edges[i] = minus(corners[i + 1], origin_);
    std::array<Vec3, 4> normals = {};
    for (std::size_t i = 0; i < 3; ++i) {
      normals[i + 1] = cross(edges[(i + 1) % 3], edges[(i + 2) % 3]);
      normals[0] = minus(normals[0], normals[i + 1]);
      size_ = std::max({size_, length(edges[i]), length(minus(edges[i], edges[(i + 1) % 3]))});
    }
    double volume = dot(edges[0], normals[1]);
    if (std::abs(volume) < kLeastVolume) volume = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 gradient = {normals[i][0] / volume, normals[i][1] / volume,
                             normals[i][2] / volume};
      gradients_[i] = gradient;
      for (const double coordinate : corners[i]) {
        largestCoordinate_ = std::max(largestCoordinate_, std::abs(coordinate));
      }
    }
  }

  /// Barycentric coordinates of p.
  [[nodiscard]] std::array<double, 4> weights(const Vec3& p) const {
    const Vec3 offset = minus(p, origin_);
    std::array<double, 4> result = {1, 0, 0, 0};
    for (std::size_t i = 1; i < 4; ++i) {
      result[i] = dot(gradients_[i], offset);
      result[0] -= result[i];
    }
    return result;
  }

  /// Whether a point with these coordinates is inside, or outside by no more than rounding and a
  /// further distance. False for not-a-number.
  [[nodiscard]] bool contains(const std::array<double, 4>& weights, double further = 0) const {
    const double distance = kContainment * size_ + positionError() + further;
    for (std::size_t i = 0; i < 4; ++i) {
      // The gradient is the inverse of the height over face i.
      if (!(weights[i] >= -distance * length(gradients_[i]))) return false;
    }
    return true;
  }

  /// How far a position here may be off, in units of space.
  [[nodiscard]] double positionError() const {
    return kPositionError * largestCoordinate_ + TetLocator::kLeastMargin;
  }
  [[nodiscard]] const Vec3& gradient(std::size_t corner) const { return gradients_[corner]; }

 private:
  Vec3 origin_;
  std::array<Vec3, 4> gradients_;  ///< of the barycentric coordinates; not finite for a flat tet
  double size_ = 0;                ///< longest edge
  double largestCoordinate_ = 0;
};

/// Interpolates parameters relative to an integer near corner 0, so that charts far from the origin
/// lose no digits.
class LatticeDistance {
 public:
  LatticeDistance(const TetMapView& map, int scale, double allowed)
      : map_(map), scale_(scale), allowed_(allowed) {}

  /// Distance of p from the lattice in hex edges (largest coordinate difference) as tet t sees it,
  /// 0 if within what is allowed; infinite if p is not in the tet.
  [[nodiscard]] double inTet(Index t, const Vec3& p) const {
    TetParameters points;
    for (std::size_t i = 0; i < 4; ++i) points[i] = map_.points[map_.tets[t][i]];
    const AffineTet tet(points);
    const std::array<double, 4> weights = tet.weights(p);
    TetParameters parameters = map_.parameters[t];
    const Vec3 near = parameters[0];
    Vec3 position{};
    double noise = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        parameters[i][k] = scale_ * (parameters[i][k] - std::round(near[k]));
        position[k] += weights[i] * parameters[i][k];
      }
      noise += length(tet.gradient(i)) * length(parameters[i]);
    }
    noise *= tet.positionError();
    if (!(noise <= kLargestNoise)) {
      return isLatticePoint(p, points, tet.positionError(), parameters) ? 0 : kInfinity;
    }
    if (!tet.contains(weights)) return kInfinity;
    double distance = 0;
    for (const double u : position) distance = std::max(distance, std::abs(u - std::round(u)));
    return distance <= allowed_ + noise ? 0 : distance;
  }

 private:
  /// Whether a lattice point of a tet is at p in space, for tets that are flat there; so far as
  /// that can be told with few candidates.
  [[nodiscard]] bool isLatticePoint(const Vec3& p, const TetParameters& points, double error,
                                    const TetParameters& parameters) const {
    const AffineTet tet(parameters);
    for (std::size_t i = 1; i < 4; ++i) {
      error += 2 * allowed_ * length(tet.gradient(i)) * extentOf(minus(points[i], points[0]));
    }
    Vec3 low = {kInfinity, kInfinity, kInfinity};
    Vec3 high = {-kInfinity, -kInfinity, -kInfinity};
    double candidates = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Vec3& u : parameters) {
        low[k] = std::min(low[k], std::ceil(u[k] - allowed_));
        high[k] = std::max(high[k], std::floor(u[k] + allowed_));
      }
      candidates *= high[k] - low[k] + 1;
    }
    if (candidates > kMostCandidates) return true;
    for (Vec3 z = low; z[0] <= high[0]; z[0] += 1) {
      for (z[1] = low[1]; z[1] <= high[1]; z[1] += 1) {
        for (z[2] = low[2]; z[2] <= high[2]; z[2] += 1) {
          const std::array<double, 4> weights = tet.weights(z);
          if (!tet.contains(weights, 2 * allowed_)) continue;
          Vec3 rest = p;
          for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 3; ++k) rest[k] -= weights[i] * points[i][k];
          }
          if (extentOf(rest) <= 2 * error) return true;
        }
      }
    }
    return false;
  }

  const TetMapView& map_;
  double scale_;
  double allowed_;
};

/// Distances of all vertices from the lattice as far as the tets named by the mesh tell.
Array<double> distancesByHints(const LatticeDistance& lattice, const TetMapView& map,
                               const HexMesh& mesh, Stage& stage) {
  Array<double> distances(mesh.points.size());
  const bool hints = mesh.generatorTet.size() == mesh.points.size();
  parallelFor(stage, distances.size(), kGrain, [&](std::size_t v) {
    const Index tet = hints ? mesh.generatorTet[v] : kNone;
    distances[v] = tet < map.tets.size() ? lattice.inTet(tet, mesh.points[v]) : kInfinity;
  });
  return distances;
}

/// Looks for better tets where the distance is not 0.
void searchTets(const LatticeDistance& lattice, const TetMapView& map, const HexMesh& mesh,
                Array<double>& distances, Stage& stage) {
  const TetLocator locator(map, {kContainment, kPositionError}, stage);
  parallelFor(stage, distances.size(), kGrain, [&](std::size_t v) {
    double best = distances[v];
    if (best == 0) return;
    (void)locator.anyAround(mesh.points[v], [&](Index tet) {
      best = std::min(best, lattice.inTet(tet, mesh.points[v]));
      return best == 0;
    });
    distances[v] = best;
  });
}

}  // namespace

OffLattice findOffLattice(const TetMapView& map, const HexMesh& mesh, int scale, double allowed,
                          Stage& stage) {
  const LatticeDistance lattice(map, scale, allowed);
  Array<double> distances = distancesByHints(lattice, map, mesh, stage);
  const auto isOff = [](double distance) { return distance != 0; };
  if (std::any_of(distances.begin(), distances.end(), isOff)) {
    searchTets(lattice, map, mesh, distances, stage);
  }
  OffLattice result;
  result.count =
      static_cast<std::uint64_t>(std::count_if(distances.begin(), distances.end(), isOff));
  if (result.count > 0) {
    const auto first = std::find_if(distances.begin(), distances.end(), isOff);
    result.first = static_cast<Index>(first - distances.begin());
    result.outside = std::isinf(*first);
    result.distance = *first;
  }
  return result;
}

}  // namespace hexhex
