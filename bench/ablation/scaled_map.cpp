#include "ablation/scaled_map.hpp"

#include <memory>

#include <hexhex/context.hpp>

#include <base/stage.hpp>
#include <igm/defects.hpp>

namespace hexhex::bench {

namespace {

std::unique_ptr<igm::PreparedMap> prepare(int scale) {
  constexpr double kTolerance = 1e-2;
  Context context(1);
  igm::DefectCollector defects;
  auto map = std::make_unique<igm::PreparedMap>(
      igm::prepareMap(load(sphereMap()), kTolerance, scale, context, defects));
  defects.throwIfAny();
  Stage stage(context, "scaling");
  igm::scaleMap(map->exact, scale, stage);
  adjacency::addStars(map->topology, stage);
  return map;
}

}  // namespace

const igm::PreparedMap& scaledMap(int scale) {
  static int preparedScale = 0;
  static std::unique_ptr<igm::PreparedMap> prepared;
  if (preparedScale != scale) {
    prepared.reset();
    prepared = prepare(scale);
    preparedScale = scale;
  }
  return *prepared;
}

}  // namespace hexhex::bench
