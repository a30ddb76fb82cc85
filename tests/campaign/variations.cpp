#include "campaign/variations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <tetmap/split_map.hpp>

#include <base/vector3.hpp>

#include "extract/support.hpp"
#include "igm/map_samples.hpp"

namespace hexhex::campaign {

using namespace test;

namespace {

void shuffle(std::vector<Index>& numbers, Random& random) {
  for (std::size_t i = numbers.size(); i > 1; --i) {
    std::swap(numbers[i - 1], numbers[random.below(i)]);
  }
}

void swapCorners(TetMap& map, std::size_t tet, std::size_t a, std::size_t b) {
  std::swap(map.tets[tet][a], map.tets[tet][b]);
  std::swap(map.parameters[tet][a], map.parameters[tet][b]);
}

/// Puts vertices in the middle of some edges, as a repair does.
void splitSomeEdges(TetMap& map, Random& random) {
  const Topology topology(map);
  std::vector<tetmap::EdgeInTet> edges;
  const std::size_t wanted = 1 + random.below(1 + map.tets.size() / 20);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t t = random.below(map.tets.size());
    const Tet& tet = map.tets[t];
    const std::size_t a = random.below(4);
    edges.push_back(
        {tetmap::pairOf(tet[a], tet[(a + 1 + random.below(3)) % 4]), static_cast<Index>(t)});
  }
  tetmap::splitEdges(map, topology.topology, edges);
}

/// Cuts some tets into four around a vertex inside.
void cutSomeTets(TetMap& map, Random& random) {
  const std::size_t count = 1 + random.below(1 + map.tets.size() / 20);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t tet = random.below(map.tets.size());
    // Multiples of an eighth, so that sums are exact.
    constexpr std::array<std::array<double, 4>, 3> kWeights = {
        {{0.25, 0.25, 0.25, 0.25}, {0.125, 0.125, 0.25, 0.5}, {0.625, 0.125, 0.125, 0.125}}};
    const std::array<double, 4>& weights = kWeights[random.below(kWeights.size())];
    Vec3 inMap{};
    Vec3 inSpace{};
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t a = 0; a < 3; ++a) {
        inMap[a] += weights[c] * map.parameters[tet][c][a];
        inSpace[a] += weights[c] * map.points[map.tets[tet][c]][a];
      }
    }
    const auto vertex = static_cast<Index>(map.points.size());
    map.points.push_back(inSpace);
    const Tet whole = map.tets[tet];
    const TetParameters parameters = map.parameters[tet];
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t part = c == 0 ? tet : map.tets.size();
      if (c > 0) {
        map.tets.push_back(whole);
        map.parameters.push_back(parameters);
        if (!map.regions.empty()) map.regions.push_back(map.regions[tet]);
      }
      map.tets[part][c] = vertex;
      map.parameters[part][c] = inMap;
    }
  }
}

/// Gives some tets charts of their own, and their corners another (even) order.
void changeCharts(TetMap& map, std::uint64_t oneIn, std::int64_t limit, Random& random) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (random.below(oneIn) > 0) continue;
    const lattice::Transition chart = drawChart(limit, random);
    for (Vec3& u : map.parameters[t]) u = chart(u, 1.0);
    // Two swaps are an even permutation.
    for (int swap = 0; swap < 2; ++swap) {
      const std::size_t first = random.below(4);
      swapCorners(map, t, first, (first + 1 + random.below(3)) % 4);
    }
  }
}

void addNoise(TetMap& map, double noise, Random& random) {
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) {
      for (double& coordinate : u) coordinate += random.realUpTo(noise);
    }
  }
}

/// Numbers vertices and tets anew; vertices without a tet may vanish.
void renumber(TetMap& map, Random& random) {
  std::vector<Index> vertices(map.points.size());
  std::iota(vertices.begin(), vertices.end(), Index{0});
  if (random.below(2) == 0) {
    std::vector<bool> used(map.points.size(), false);
    for (const Tet& tet : map.tets) {
      for (const Index v : tet) used[v] = true;
    }
    std::erase_if(vertices, [&](Index v) { return !used[v]; });
  }
  shuffle(vertices, random);
  std::vector<Index> number(map.points.size(), kNone);
  std::vector<Vec3> points;
  for (const Index v : vertices) {
    number[v] = static_cast<Index>(points.size());
    points.push_back(map.points[v]);
  }
  map.points = std::move(points);
  std::vector<Index> tets(map.tets.size());
  std::iota(tets.begin(), tets.end(), Index{0});
  shuffle(tets, random);
  TetMap old = map;
  for (std::size_t i = 0; i < tets.size(); ++i) {
    map.tets[i] = old.tets[tets[i]];
    for (Index& v : map.tets[i]) v = number[v];
    map.parameters[i] = old.parameters[tets[i]];
    if (!map.regions.empty()) map.regions[i] = old.regions[tets[i]];
  }
  for (FeatureVertex& each : map.features.vertices) each.vertex = number[each.vertex];
  for (FeatureEdge& each : map.features.edges) {
    for (Index& v : each.vertices) v = number[v];
  }
  for (FeatureFace& each : map.features.faces) {
    for (Index& v : each.vertices) v = number[v];
  }
}

/// Another size, a distortion, or places at random, so that tets overlap.
void changeSpace(TetMap& map, Random& random) {
  const std::uint64_t way = random.below(6);
  const double size = std::pow(10.0, static_cast<double>(random.integerUpTo(9)));
  const Vec3 shear = {random.realUpTo(1), random.realUpTo(1), random.realUpTo(1)};
  for (Vec3& p : map.points) {
    if (way == 0) p = {random.share(), random.share(), random.share()};
    if (way == 1) p = {size * p[0] + 1e3 * size, size * p[1], size * p[2]};
    if (way == 2) p = {p[0] + shear[0] * p[1], p[1] + shear[1] * p[2], 1e-3 * p[2]};
  }
}

}  // namespace

lattice::Transition drawChart(std::int64_t limit, Random& random) {
  lattice::Transition chart{
      lattice::Rotation(static_cast<int>(random.below(lattice::Rotation::kCount))), {}};
  for (std::int32_t& coordinate : chart.translation) {
    coordinate = static_cast<std::int32_t>(random.integerUpTo(limit));
  }
  return chart;
}

void vary(DrawnMap& drawn, Random& random) {
  TetMap& map = drawn.map;
  if (drawn.answer && random.below(3) == 0) splitSomeEdges(map, random);
  if (random.below(3) == 0) cutSomeTets(map, random);
  constexpr std::array<std::int64_t, 4> kOffsets = {20, 1000, 1'000'000'000, 3};
  const std::int64_t offset = kOffsets[random.below(kOffsets.size())];
  const std::uint64_t charts = random.below(3);
  if (charts > 0) changeCharts(map, charts == 1 ? 1 : 8, offset, random);
  if (offset <= 1000 && random.below(4) == 0) {
    addNoise(map, random.below(2) == 0 ? 1e-12 : 1e-9, random);
  }
  if (random.below(8) == 0) {  // a mirror image
    for (TetParameters& corners : map.parameters) {
      for (Vec3& u : corners) u[0] = -u[0];
    }
  }
  if (random.below(8) == 0) {  // tets of the other orientation
    for (std::size_t t = 0; t < map.tets.size(); ++t) swapCorners(map, t, 0, 1);
  }
  if (random.below(2) == 0) renumber(map, random);
  if (random.below(3) == 0) changeSpace(map, random);
  if (random.below(4) == 0) map = withChartsKept(std::move(map));
}

}  // namespace hexhex::campaign
