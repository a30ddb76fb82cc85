// What the tests of src/igm share: samples, maps prepared from them, and small meshes by hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>

#include <base/parallel.hpp>
#include <igm/defects.hpp>
#include <igm/igm.hpp>

namespace hexhex::test {

using namespace igm;

/// The preprocessing of a map, in the charts that it has, and what it complains about. The map must
/// outlive it.
class Prepared {
 public:
  explicit Prepared(const TetMapView& view, double tolerance = 1e-2, int maxScale = 1,
                    int threads = 1, ChartChoice charts = ChartChoice::AsGiven) {
    Context context(threads);
    withThreads(threads, [&] {
      map_ = prepareMap(view, tolerance, maxScale, context, defects_, charts);
      Stage stage(context, "edges");
      if (map_.singularities.areKnown()) adjacency::addStars(map_.topology, stage);
    });
  }
  [[nodiscard]] const adjacency::TetTopology& topology() const { return map_.topology; }
  [[nodiscard]] const Singularities& singularities() const { return map_.singularities; }
  [[nodiscard]] const ExactMap& exact() const { return map_.exact; }
  [[nodiscard]] const Transitions& transitions() const { return map_.exact.transitions; }
  [[nodiscard]] const PreparedMap& map() const { return map_; }
  [[nodiscard]] const DefectCollector& defects() const { return defects_; }

 private:
  DefectCollector defects_;
  PreparedMap map_;
};

/// The first steps of the preprocessing of a map, for tests of what comes next.
struct Topology {
  Context context;
  Stage stage{context, "test"};
  DefectCollector defects;
  OrientedMap input;
  adjacency::TetTopology topology;

  explicit Topology(const TetMapView& map)
      : input(readInput(map, stage, defects)),
        topology(buildTopology(input.view, stage, defects)) {}
};

/// For tests that run once per kind of sample.
class EveryKind : public testing::TestWithParam<SampleKindName> {
 protected:
  [[nodiscard]] static SampleKind kind() { return GetParam().kind; }
};

inline std::string kindTestName(const testing::TestParamInfo<SampleKindName>& instance) {
  std::string name(instance.param.name);
  std::erase(name, '-');
  return name;
}

inline constexpr ChartStyle kChartStyles[] = {ChartStyle::Aligned, ChartStyle::Blocks,
                                              ChartStyle::Random, ChartStyle::Scattered};

/// A map that is the identity on its mesh.
inline TetMap identityMap(std::vector<Vec3> points, std::vector<Tet> tets) {
  TetMap map{std::move(points), std::move(tets), {}};
  for (const Tet& tet : map.tets) {
    map.parameters.push_back(
        {map.points[tet[0]], map.points[tet[1]], map.points[tet[2]], map.points[tet[3]]});
  }
  return map;
}

/// det(u1 - u0, u2 - u0, u3 - u0)
inline double determinant(const TetParameters& u) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const double minor =
        (u[1][i] - u[0][i]) * (u[2][j] - u[0][j]) - (u[1][j] - u[0][j]) * (u[2][i] - u[0][i]);
    sum += minor * (u[3][k] - u[0][k]);
  }
  return sum;
}

/// Adds a vector to the parameters of a vertex in all tets, for maps with one chart.
inline void moveParameters(TetMap& map, Index vertex, const Vec3& shift) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (map.tets[t][i] != vertex) continue;
      for (std::size_t k = 0; k < 3; ++k) map.parameters[t][i][k] += shift[k];
    }
  }
}

/// Numbers 0 .. size-1 in an order that depends on the seed alone (splitmix64, Fisher and Yates).
inline std::vector<Index> permutation(std::size_t size, std::uint64_t seed) {
  std::vector<Index> order(size);
  for (std::size_t i = 0; i < size; ++i) order[i] = static_cast<Index>(i);
  for (std::size_t i = size; i > 1; --i) {
    std::uint64_t x = seed += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    std::swap(order[i - 1], order[(x ^ (x >> 31)) % i]);
  }
  return order;
}

}  // namespace hexhex::test
