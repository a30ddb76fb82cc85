#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <igm/gauges.hpp>
#include <igm/input.hpp>
#include <igm/transition_fit.hpp>
#include <igm/unfold_charts.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Rewrites parameters by gauges.
class ChartChanger {
 public:
  ChartChanger(const LocalParameters& parameters, OrientedMap& map, Array<Gauge>& gauges)
      : parameters_(parameters), map_(map), gauges_(gauges) {}

  void rewrite(Index t) {
    const TetParameters u = parameters_(t);
    const TetParameters rotated = turnedTet(gauges_[t].rotation, u);
    moveToOrigin(gauges_[t], rotated[0]);
    TetParameters& image = map_.parameters[t];
    if (!moveExactly(rotated, gauges_[t], image)) {
      gauges_[t] = {};
      image = u;
    }
    for (const Vec3& corner : image) {
      for (const double coordinate : corner) largest_ = std::max(largest_, std::abs(coordinate));
    }
  }
  /// The largest magnitude of a coordinate.
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  static TetParameters turnedTet(Rotation rotation, const TetParameters& u) {
    return {rotation(u[0]), rotation(u[1]), rotation(u[2]), rotation(u[3])};
  }

  /// As LocalParameters would move the chart.
  /// @param corner  0, rotated
  void moveToOrigin(Gauge& gauge, const Vec3& corner) const {
    const Vec3 by = translationOf(gauge);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto back = static_cast<std::int64_t>(parameters_.roundedToGrid(corner[k] + by[k]));
      gauge.translation[k] -= static_cast<std::uint32_t>(back);
    }
  }

  /// @return whether nothing is rounded
  static bool moveExactly(const TetParameters& rotated, const Gauge& gauge, TetParameters& image) {
    const Vec3 by = translationOf(gauge);
    double rest = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double sum = rotated[corner][k] + by[k];
        rest += restOfSum(sum, rotated[corner][k], by[k]);
        image[corner][k] = sum;
      }
    }
    return rest == 0;
  }

  static Vec3 translationOf(const Gauge& gauge) noexcept {
    const auto at = [&](std::size_t k) -> double {
      return static_cast<std::int32_t>(gauge.translation[k]);
    };
    return {at(0), at(1), at(2)};
  }

  const LocalParameters& parameters_;
  OrientedMap& map_;
  Array<Gauge>& gauges_;
  double largest_ = 0;
};

}  // namespace

std::uint64_t Unfolding::countGivenJumps(const TetTopology& topology,
                                         const Transitions& transitions, Stage& stage) const {
  if (gauges_.empty()) return transitions.nonTrivial;
  std::vector<std::uint64_t> blocks(blockCount(topology.mate.size(), 4 * kGrain));
  parallelBlocks(stage, topology.mate.size(), 4 * kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (auto here = static_cast<HalfFace>(begin); here < end; ++here) {
                     const HalfFace there = topology.mate[here];
                     if (there == kNone || there < here) continue;
                     Gauge image = gauges_[tetOf(here)];
                     if (transitions.isNonTrivial(here)) {
                       image = Gauge{} * transitions.across(here) * image;
                     }
                     blocks[block] += image == gauges_[tetOf(there)] ? 0 : 1;
                   }
                 });
  std::uint64_t nonTrivial = 0;
  for (const std::uint64_t count : blocks) nonTrivial += count;
  return nonTrivial;
}

bool needsUnfolding(const TetTopology& topology, const OrientedMap& map) {
  const LocalParameters given(map);
  if (!map.view.rotations.empty() || given.tooLarge()) return false;
  constexpr std::size_t kSample = 32;  // tets
  constexpr std::size_t kBreakEven =
      3;  // of as many triangles, one between different charts costs as much
  const std::size_t step = std::max(topology.tetCount() / kSample, std::size_t{1});
  std::size_t faces = 0;
  std::size_t nonTrivial = 0;
  for (std::size_t t = 0; t < topology.tetCount(); t += step) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace here = halfFaceOf(static_cast<Index>(t), f);
      const HalfFace there = topology.mate[here];
      if (there == kNone) continue;
      ++faces;
      if (agree(topology, given, here)) continue;
      const FittedTransition fitted = fitTransition(SharedTriangle(topology, given, here));
      nonTrivial += fitted.isExact && !fitted.transition.isIdentity() ? 1 : 0;
    }
  }
  return kBreakEven * nonTrivial > faces;
}

Unfolding unfoldCharts(const TetTopology& topology, OrientedMap& map, Stage& stage) {
  const LocalParameters given(map);
  Gauges gauges = computeGauges(topology, given, stage);
  const std::size_t tets = topology.tetCount();
  if (map.parameters.empty()) map.parameters.resize(tets);
  std::vector<double> largest(blockCount(tets, kGrain));
  parallelBlocks(stage, tets, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    ChartChanger changer(given, map, gauges.of);
    for (std::size_t t = begin; t < end; ++t) changer.rewrite(static_cast<Index>(t));
    largest[block] = changer.largest();
  });
  map.view.parameters = map.parameters;
  map.largestCoordinate = *std::max_element(largest.begin(), largest.end());
  return Unfolding(std::move(gauges.of));
}

}  // namespace hexhex
