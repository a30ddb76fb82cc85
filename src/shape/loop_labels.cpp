// M. Snoep, B. Speckmann, K. Verbeek, "Robust construction of polycube segmentations via dual
// loops", Computer Graphics Forum 44 (2025): a loop across an axis passes the labels of the other
// two axes in turn.
#include <array>
#include <cmath>
#include <limits>

#include <shape/loop_labels.hpp>
#include <shape/triangle_paths.hpp>

namespace hexhex::shape {

namespace {

/// The axis that a loop surrounds, with the sign that makes it run counterclockwise.
lattice::Direction axisOf(const HandleLoop& loop) {
  const std::size_t axis = dominantAxis(loop.area);
  return lattice::direction(static_cast<int>(axis), loop.area[axis] < 0 ? -1 : 1);
}

/// Labels along a loop by dynamic programming over its triangles and the number of quarter turns
/// made so far.
class LoopLabels {
 public:
  LoopLabels(const Surface& surface, const HandleLoop& loop)
      : surface_(surface), strip_(loop.triangles) {
    const lattice::Direction axis = axisOf(loop);
    ring_[0] = lattice::direction((lattice::axisOf(axis) + 1) % 3, 1);
    for (std::size_t i = 1; i < ring_.size(); ++i) ring_[i] = lattice::cross(axis, ring_[i - 1]);
  }

  Labels best() {
    double least = std::numeric_limits<double>::infinity();
    Labels best;
    for (std::size_t first = 0; first < ring_.size(); ++first) {
      const double cost = turn(first);
      if (cost >= least) continue;
      least = cost;
      best = labels(first);
    }
    return best;
  }

 private:
  static constexpr std::size_t kBefore = 3;  ///< quarter turns that may be taken back at the start
  static constexpr std::size_t kEnd = kBefore + 4;
  static constexpr std::size_t kStates = kEnd + 1 + kBefore;

  [[nodiscard]] lattice::Direction label(std::size_t first, std::size_t state) const {
    return ring_[(first + state + 4 - kBefore) % 4];
  }
  [[nodiscard]] double cost(std::size_t i, lattice::Direction label) const {
    return surface_.areas[strip_[i]] * (1 - cosine(surface_.normals[strip_[i]], label));
  }

  /// The least cost of labels from a first one, around the loop and back to it.
  double turn(std::size_t first) {
    using Costs = std::array<double, kStates>;
    Costs costs;
    costs.fill(std::numeric_limits<double>::infinity());
    costs[kBefore] = cost(0, label(first, kBefore));
    turns_.assign(strip_.size(), {});
    for (std::size_t i = 0; i < strip_.size(); ++i) {  // from one triangle to the next
      Costs next = costs;
      for (std::size_t state = 0; state < kStates; ++state) {
        if (state > 0) take(costs[state - 1], 1, next[state], turns_[i][state]);
        if (state + 1 < kStates) {
          take(costs[state + 1] + surface_.meanArea, -1, next[state], turns_[i][state]);
        }
        if (i + 1 < strip_.size()) next[state] += cost(i + 1, label(first, state));
      }
      costs = next;
    }
    return costs[kEnd];
  }

  static void take(double cost, int turn, double& least, int& best) {
    if (cost >= least) return;
    least = cost;
    best = turn;
  }

  /// The labels of the last call of turn().
  [[nodiscard]] Labels labels(std::size_t first) const {
    Labels labels(strip_.size());
    std::size_t state = kEnd;
    for (std::size_t i = strip_.size(); i-- > 0;) {
      state -= static_cast<std::size_t>(turns_[i][state]);
      labels[i] = label(first, state);
    }
    return labels;
  }

  const Surface& surface_;
  const std::vector<Index>& strip_;
  std::array<lattice::Direction, 4> ring_{};     ///< counterclockwise
  std::vector<std::array<int, kStates>> turns_;  ///< per triangle and state: the turn after it
};

/// The smallest rotation that turns one unit vector to another.
Rotation rotationBetween(const Vec3& from, const Vec3& to) {
  const Vec3 axis = cross(from, to);
  const double cos = dot(from, to);
  Rotation rotation{};
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 unit{};
    unit[i] = 1;
    const Vec3 image =
        plus(times(cos, unit), plus(cross(axis, unit), times(axis[i] / (1 + cos), axis)));
    for (std::size_t k = 0; k < 3; ++k) rotation[k][i] = image[k];
  }
  return rotation;
}

/// The connected triangles around a loop, no farther from its middle than half its length, that
/// face away from its area.
std::vector<Index> beside(const Surface& surface, const HandleLoop& loop, const Vec3& normal,
                          std::vector<bool>& isTaken) {
  constexpr double kSteepest = 0.6;  // cosine to the normal of the loop
  const auto take = [&](Index t) {
    if (isTaken[t]) return false;
    isTaken[t] = true;
    return true;
  };
  std::vector<Index> found;
  std::vector<Vec3> centres;
  for (const Index t : loop.triangles) {
    if (take(t)) found.push_back(t);
    centres.push_back(surface.centres[t]);
  }
  const Vec3 middle = centreOf(centres);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (Side side = 3 * found[i]; side < 3 * found[i] + 3; ++side) {
      const Index t = surface.beyond(side);
      const bool isClose = length(minus(surface.centres[t], middle)) < 0.5 * loop.length;
      const bool isSteep = std::abs(dot(surface.normals[t], normal)) < kSteepest;
      if (isClose && isSteep && take(t)) found.push_back(t);
    }
  }
  return found;
}

/// Turns the triangles beside a loop such that its area points along an axis.
void turnToAxis(Surface& surface, const HandleLoop& loop, std::vector<bool>& isTurned) {
  const double size = length(loop.area);
  if (size == 0) return;
  const Vec3 normal = times(1 / size, loop.area);
  const lattice::Direction direction = axisOf(loop);
  Vec3 axis{};
  axis[static_cast<std::size_t>(lattice::axisOf(direction))] = lattice::signOf(direction);
  const Rotation rotation = rotationBetween(normal, axis);
  for (const Index t : beside(surface, loop, normal, isTurned)) {
    surface.normals[t] = turned(rotation, surface.normals[t]);
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      surface.directions[side] = turned(rotation, surface.directions[side]);
    }
  }
}

/// Turns normals close to labelled triangles towards their labels.
void turnToLabels(Surface& surface, const Labels& labels) {
  constexpr double kReach = 3;  // in mean edges
  const double reach = kReach * surface.meanEdge;
  std::vector<Index> labelled;
  for (Index t = 0; t < labels.size(); ++t) {
    if (labels[t] != lattice::kDirections) labelled.push_back(t);
  }
  const TrianglePaths paths = shortestPaths(surface, labelled, reach, {});
  for (Index t = 0; t < labels.size(); ++t) {
    Index nearest = t;
    while (paths.entries[nearest] != kNone) nearest = surface.beyond(paths.entries[nearest]);
    const lattice::Direction label = labels[nearest];
    if (label == lattice::kDirections) continue;
    Vec3 normal = surface.normals[t];
    normal[static_cast<std::size_t>(lattice::axisOf(label))] +=
        lattice::signOf(label) * (1 - paths.distances[t] / reach);
    const double size = length(normal);
    if (size > 0) surface.normals[t] = times(1 / size, normal);
  }
}

}  // namespace

Labels labelsAlong(const Surface& surface, const HandleLoop& loop) {
  return LoopLabels(surface, loop).best();
}

Labels turnAroundHandles(Surface& surface, const std::vector<HandleLoop>& loops) {
  std::vector<bool> isTurned(surface.triangleCount());
  for (const HandleLoop& loop : loops) turnToAxis(surface, loop, isTurned);
  Labels labels(surface.triangleCount(), lattice::kDirections);
  for (const HandleLoop& loop : loops) {
    const Labels along = labelsAlong(surface, loop);
    for (std::size_t i = 0; i < along.size(); ++i) labels[loop.triangles[i]] = along[i];
  }
  turnToLabels(surface, labels);
  return labels;
}

}  // namespace hexhex::shape
