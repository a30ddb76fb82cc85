// How the hex vertex at a grid point of a tet is found: in a table of its bounding box, in a hash
// table per tet, or in a list per tet. (The paper's Table 6)
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <hexhex/context.hpp>

#include <base/stage.hpp>
#include <sweep/vertex_tables.hpp>

#include "ablation/benchmarks.hpp"
#include "ablation/scaled_map.hpp"

namespace hexhex::bench {

namespace {

/// The vertices of the map at one scale, and the tets in which they are looked up.
struct Scene {
  sweep::VertexTables vertices;
  std::size_t tetCount;
  std::vector<Index> tets;
  std::size_t points = 0;  ///< of these tets

  /// @param maxPoints  of so many tets as have about so many points, evenly chosen
  Scene(const igm::PreparedMap& map, std::size_t maxPoints, Stage& stage)
      : vertices(map, stage), tetCount(map.topology.tetCount()) {
    std::size_t all = 0;
    for (std::size_t t = 0; t < tetCount; ++t) all += pointsOf(static_cast<Index>(t));
    const std::size_t every = all / maxPoints + 1;
    for (std::size_t t = 0; t < tetCount; t += every) {
      const auto tet = static_cast<Index>(t);
      if (!vertices.hasVertices(tet)) continue;
      tets.push_back(tet);
      points += pointsOf(tet);
    }
  }

 private:
  [[nodiscard]] std::size_t pointsOf(Index tet) const {
    std::size_t count = 0;
    vertices.forEach(
        tet, [&](const lattice::GridPoint&, const sweep::VertexTables::Found&) { ++count; });
    return count;
  }
};

std::unique_ptr<Scene> makeScene(int scale, std::size_t maxPoints) {
  const igm::PreparedMap& map = scaledMap(scale);
  Context context(1);
  Stage stage(context, "vertices");
  return std::make_unique<Scene>(map, maxPoints, stage);
}

const Scene& sceneAt(int scale, std::size_t maxPoints) {
  static std::pair<int, std::size_t> key;
  static std::unique_ptr<Scene> scene;
  if (key != std::pair(scale, maxPoints)) {
    scene.reset();
    scene = makeScene(scale, maxPoints);
    key = {scale, maxPoints};
  }
  return *scene;
}

/// All points.
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

class Table {
 public:
  static constexpr std::size_t kMaxPoints = kUnlimited;
  explicit Table(const Scene& scene) : tables_(scene.vertices) {}
  [[nodiscard]] Index find(Index tet, const lattice::GridPoint& z) const {
    return tables_.find(tet, z).vertex;
  }

 private:
  const sweep::VertexTables& tables_;
};

struct HashOfPoint {
  [[nodiscard]] std::size_t operator()(const lattice::GridPoint& z) const noexcept {
    std::uint64_t hash = 0;
    for (const std::int32_t coordinate : z) {
      hash = (hash ^ static_cast<std::uint32_t>(coordinate)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
  }
};

class Hash {
 public:
  static constexpr std::size_t kMaxPoints = kUnlimited;
  explicit Hash(const Scene& scene) : maps_(scene.tetCount) {
    for (const Index tet : scene.tets) {
      scene.vertices.forEach(
          tet, [&](const lattice::GridPoint& z, const sweep::VertexTables::Found& found) {
            maps_[tet].emplace(z, found.vertex);
          });
    }
  }
  [[nodiscard]] Index find(Index tet, const lattice::GridPoint& z) const {
    const auto found = maps_[tet].find(z);
    return found == maps_[tet].end() ? kNone : found->second;
  }

 private:
  std::vector<std::unordered_map<lattice::GridPoint, Index, HashOfPoint>> maps_;
};

class List {
 public:
  /// Searching is quadratic in the points of a tet, so not all tets are asked at large scales.
  static constexpr std::size_t kMaxPoints = 50'000;
  explicit List(const Scene& scene) : lists_(scene.tetCount) {
    for (const Index tet : scene.tets) {
      scene.vertices.forEach(
          tet, [&](const lattice::GridPoint& z, const sweep::VertexTables::Found& found) {
            lists_[tet].emplace_back(z, found.vertex);
          });
    }
  }
  [[nodiscard]] Index find(Index tet, const lattice::GridPoint& z) const {
    for (const auto& [point, vertex] : lists_[tet]) {
      if (point == z) return vertex;
    }
    return kNone;
  }

 private:
  std::vector<std::vector<std::pair<lattice::GridPoint, Index>>> lists_;
};

/// As when edges are traced: from each point of each tet one step in each direction, whether that
/// leads out of the tet or not. Sum of what is found: the same for all methods.
template <class Method>
std::uint64_t findAll(const Method& method, const Scene& scene) {
  std::uint64_t sum = 0;
  for (const Index tet : scene.tets) {
    scene.vertices.forEach(
        tet, [&](const lattice::GridPoint& z, const sweep::VertexTables::Found& /*found*/) {
          for (lattice::Direction d = 0; d < lattice::kDirections; ++d)
            sum += method.find(tet, lattice::step(z, d));
        });
  }
  return sum;
}

template <class Method>
void lookup(benchmark::State& state, int scale) {
  const Scene& scene = sceneAt(scale, Method::kMaxPoints);
  const Method method(scene);
  std::uint64_t sum = 0;
  for (auto _ : state) {
    sum = findAll(method, scene);
    benchmark::DoNotOptimize(sum);
  }
  if (sum != findAll(Table(scene), scene)) {
    state.SkipWithError("the methods found different vertices");
    return;
  }
  state.counters["tets"] = static_cast<double>(scene.tets.size());
  state.counters["points"] = static_cast<double>(scene.points);
  state.counters["queries"] = static_cast<double>(scene.points) * lattice::kDirections;
}

template <class Method>
void add(const std::string& method) {
  for (const int scale : kScales) {
    const std::string name =
        "lookup/" + sphereMap().name + "/scale:" + std::to_string(scale) + "/method:" + method;
    benchmark::RegisterBenchmark(name.c_str(),
                                 [scale](benchmark::State& state) { lookup<Method>(state, scale); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace

void registerLookup() {
  add<Table>("table");
  add<Hash>("hash");
  add<List>("list");
}

}  // namespace hexhex::bench
