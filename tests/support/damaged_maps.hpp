// Small random sample maps in which single tets are damaged: what must hold of maps that nobody
// made on purpose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

#include <hexhex/samples.hpp>

namespace hexhex::test {

/// Draws maps. The same seed gives the same map.
class MapDamage {
 public:
  explicit MapDamage(std::uint64_t seed) : random_(seed) {}

  /// A sample of any kind, in charts of any kind.
  [[nodiscard]] TetMap sample() {
    SampleOptions options;
    options.seed = random_();
    options.cells = 1 + below(3);
    options.refine = 1 + below(2);
    options.valence = 3 + below(5);
    options.charts = chartStyles()[below<std::size_t>(chartStyles().size())].kind;
    options.jitter = below(2) * share();
    options.onLattice = below(2) * share();
    if (below(4) == 0) options.offset = 1e6;
    return generateSample(sampleKinds()[below<std::size_t>(sampleKinds().size())].kind, options)
        .map;
  }

  /// Damages one to three tets of a map.
  void apply(TetMap& map) {
    for (int count = 1 + below(3); count > 0; --count) {
      damage(map.parameters[below<std::size_t>(map.parameters.size())]);
    }
  }

  /// An integer from [0, count).
  template <class Integer>
  [[nodiscard]] Integer below(Integer count) {
    return static_cast<Integer>(random_() % static_cast<std::uint64_t>(count));
  }
  /// A number from [0, 1).
  [[nodiscard]] double share() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

 private:
  void damage(TetParameters& u) {
    const auto corner = below<std::size_t>(4);
    const auto axis = below<std::size_t>(3);
    switch (below(13)) {
      case 0:  // reflected at the origin
        for (Vec3& v : u) v = {-v[0], -v[1], -v[2]};
        break;
      case 1:
        for (Vec3& v : u) v[axis] = -v[axis];
        break;
      case 2:
        u = {};
        break;
      case 3:  // to a point
        u = {u[corner], u[corner], u[corner], u[corner]};
        break;
      case 4:  // to a triangle
        u[corner] = u[(corner + 1) % 4];
        break;
      case 5:  // half a unit off
        for (Vec3& v : u) v[axis] += 0.5;
        break;
      case 6:
        u[corner][axis] += 0.5;
        break;
      case 7:  // another chart
        for (Vec3& v : u) v[axis] += 1;
        break;
      case 8:
        u[corner][axis] += 2;
        break;
      case 9:  // flat
        for (Vec3& v : u) v[axis] = u[0][axis];
        break;
      case 10:
        u[corner] = {-u[corner][0], -u[corner][1], -u[corner][2]};
        break;
      case 11:
        u[corner] = {};
        break;
      default:  // about as much as the tolerance
        u[corner][axis] += (share() - 0.5) * 0.08;
    }
  }

  std::mt19937_64 random_;
};

}  // namespace hexhex::test
