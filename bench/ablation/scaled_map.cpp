#include "ablation/scaled_map.hpp"

#include <memory>

#include <hexhex/context.hpp>

#include <base/stage.hpp>
#include <igm/defects.hpp>

namespace hexhex::bench {

namespace {

std::unique_ptr<PreparedMap> prepare(int scale) {
  constexpr double kTolerance = 1e-2;
  Context context(1);
  DefectCollector defects;
  auto map = std::make_unique<PreparedMap>(
      prepareMap(load(sphereMap()), kTolerance, scale, context, defects));
  defects.throwIfAny();
  Stage stage(context, "scaling");
  scaleMap(map->exact, scale, stage);
  addStars(map->topology, stage);
  return map;
}

}  // namespace

const PreparedMap& scaledMap(int scale) {
  static int preparedScale = 0;
  static std::unique_ptr<PreparedMap> prepared;
  if (preparedScale != scale) {
    prepared.reset();
    prepared = prepare(scale);
    preparedScale = scale;
  }
  return *prepared;
}

}  // namespace hexhex::bench
