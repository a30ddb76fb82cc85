#include "campaign/random_map.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "campaign/variations.hpp"
#include "support/joined_maps.hpp"

namespace hexhex::campaign {

using test::joined;

namespace {

template <class Key>
void add(std::map<Key, std::uint64_t>& sum, const std::map<Key, std::uint64_t>& more) {
  for (const auto& [key, count] : more) sum[key] += count;
}

/// Of two maps beside each other. Tags are the same in both, so those of features are not told.
SampleAnswer sum(SampleAnswer a, const SampleAnswer& b) {
  a.vertices += b.vertices;
  a.expected.cells += b.expected.cells;
  a.expected.boundaryQuads += b.expected.boundaryQuads;
  add(a.expected.innerSingularEdges, b.expected.innerSingularEdges);
  add(a.expected.boundarySingularEdges, b.expected.boundarySingularEdges);
  a.expected.eulerCharacteristic += b.expected.eulerCharacteristic;
  a.expected.components += b.expected.components;
  a.expected.boundaryComponents += b.expected.boundaryComponents;
  a.features = {};
  return a;
}

template <class T, std::size_t count>
T oneOf(const std::array<T, count>& values, Random& random) {
  return values[random.below(count)];
}

/// What `hexhex generate` makes.
DrawnMap drawSample(Random& random) {
  const SampleKindName& kind = sampleKinds()[random.below(sampleKinds().size())];
  SampleOptions options;
  // Mostly small: samples have up to 12 blocks of cells^3 cells and 12 refine^3 tets.
  options.cells = static_cast<int>(1 + random.below(random.below(12) == 0 ? 7 : 2));
  options.refine = static_cast<int>(1 + random.below(random.below(12) == 0 ? 3 : 1));
  options.valence = static_cast<int>(3 + random.below(10));
  options.charts = chartStyles()[random.below(chartStyles().size())].kind;
  options.jitter = oneOf(std::array{0.0, 0.1, 0.5, 1.0}, random);
  options.onLattice = oneOf(std::array{0.0, 0.2, 0.8, 1.0}, random);
  options.noise = oneOf(std::array{0.0, 1e-9, 1e-5}, random);
  options.offset = oneOf(std::array{0.0, 1e3, 1e9}, random);
  options.features = random.below(3) == 0;
  options.seed = random.next();
  Sample sample = generateSample(kind.kind, options);
  return {"sample " + std::string(kind.name), std::move(sample.map), std::move(sample.answer)};
}

/// Columns of three blocks each that do not touch; sometimes dozens of them.
DrawnMap drawManyComponents(Random& random) {
  SampleOptions options;
  options.cells = 1;
  options.refine = 1;
  options.valence = 3;
  options.charts = ChartStyle::Random;
  const std::size_t count = 2 + random.below(random.below(8) == 0 ? 80 : 10);
  DrawnMap drawn{"many components", {}, SampleAnswer{}};
  for (std::size_t i = 0; i < count; ++i) {
    options.seed = random.next();
    const Sample sample = generateSample(SampleKind::Star, options);
    drawn.map = joined(std::move(drawn.map), sample.map);
    drawn.answer = sum(*drawn.answer, sample.answer);
  }
  return drawn;
}

}  // namespace

DrawnMap drawMap(Random& random) {
  const std::uint64_t choice = random.below(40);
  if (choice < 8) return drawSample(random);
  if (choice == 8) return drawManyComponents(random);
  DrawnMap drawn = drawBlockMap(random);
  if (choice < 13) {
    const DrawnMap other = drawBlockMap(random);
    if (drawn.answer && other.answer) {
      drawn.kind = "two structures";
      drawn.map = joined(std::move(drawn.map), other.map);
      drawn.answer = sum(*drawn.answer, *other.answer);
    }
  }
  vary(drawn, random);
  return drawn;
}

}  // namespace hexhex::campaign
