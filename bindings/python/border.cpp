#include "border.hpp"

#include <chrono>
#include <exception>
#include <future>
#include <memory>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <hexhex/error.hpp>

namespace hexhex::python {

TetMapView ArrayMap::view() const {
  TetMapView view(elements<Vec3>(points), elements<Tet>(tets), elements<TetParameters>(igm));
  view.features = {elements<FeatureVertex>(featureVertices), elements<FeatureEdge>(featureEdges),
                   elements<FeatureFace>(featureFaces)};
  view.features.names = names;
  view.regions = elements<std::int32_t>(regions);
  view.edgeValences = elements<EdgeValence>(edgeValences);
  view.rotations = elements<std::array<std::int8_t, 4>>(rotations);
  return view;
}

TetMap ArrayMap::copy() const {
  const auto copied = [](const auto& span) { return std::vector(span.begin(), span.end()); };
  const TetMapView from = view();
  return {.points = copied(from.points),
          .tets = copied(from.tets),
          .parameters = copied(from.parameters),
          .edgeValences = copied(from.edgeValences),
          .rotations = copied(from.rotations),
          .features = from.features.copy(),
          .regions = copied(from.regions)};
}

std::vector<NameRow> rowsOf(const std::vector<TagName>& names) {
  std::vector<NameRow> rows;
  for (const TagName& known : names) rows.emplace_back(known.dimension, known.tag, known.name);
  return rows;
}

std::vector<TagName> namesOf(const std::vector<NameRow>& rows) {
  std::vector<TagName> names;
  for (const auto& [dimension, tag, name] : rows) names.push_back({dimension, tag, name});
  return names;
}

TetMesh tetMeshOf(const InPoints& points, const InTets& tets) {
  TetMesh mesh;
  assign(mesh.points, elements<Vec3>(points));
  assign(mesh.tets, elements<Tet>(tets));
  return mesh;
}

void runWork(int threads, const Progress& progress, const std::function<void(Context&)>& work,
             std::vector<StageTime>* stages) {
  std::optional<nb::python_error> raised;
  Context* running = nullptr;
  Context::Progress report;
  if (progress) {
    report = [&](std::string_view stage, double share) {
      const nb::gil_scoped_acquire gil;
      if (raised) return;
      try {
        (*progress)(nb::str(stage.data(), stage.size()), share);
      } catch (nb::python_error& error) {
        raised.emplace(std::move(error));
        running->cancel();
      }
    };
  }
  Context context(threads, std::move(report));
  running = &context;
  std::exception_ptr failure;
  {
    std::future<void> future = std::async(std::launch::async, [&] { work(context); });
    const nb::gil_scoped_release released;
    // Short work does not wait for the clock.
    auto pause = std::chrono::milliseconds(1);
    while (future.wait_for(pause) != std::future_status::ready) {
      if (pause.count() < 50) pause *= 2;
      const nb::gil_scoped_acquire gil;
      if (!raised && PyErr_CheckSignals() != 0) {
        raised.emplace();
        context.cancel();
      }
    }
    try {
      future.get();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  if (raised) throw std::move(*raised);
  if (failure) std::rethrow_exception(failure);
  if (stages != nullptr) *stages = context.stageTimes();
}

ExtractOptions Options::get(RepairedMap& repaired) const {
  return {.engine = propeller ? Engine::Propeller : Engine::Atlas,
          .scale = scale,
          .tolerance = tolerance,
          .repair = repair ? &repaired : nullptr,
          .round = round,
          .curvedNodes = exactNodes ? CurvedNodes::Exact : CurvedNodes::Blended};
}

Dict asDict(const RepairReport& report) {
  Dict d = fieldsOf(report);
  d["changed"] = report.changed;
  nb::list regions;
  for (const RepairedRegion& region : report.regions) {
    regions.append(
        nb::make_tuple(toString(region.place), region.place.index,
                       nb::make_tuple(region.position[0], region.position[1], region.position[2]),
                       region.badTets, region.tets, region.movedVertices, region.largestMove));
  }
  d["regions"] = regions;
  return d;
}

nb::list asList(const std::vector<StageTime>& stages) {
  nb::list list;
  for (const StageTime& time : stages) list.append(nb::make_tuple(time.stage, time.seconds));
  return list;
}

nb::tuple asTuple(const Notes& notes) {
  Dict d = fieldsOf(notes.statistics);
  d["stages"] = asList(notes.stages);
  const auto& [map, report] = notes.repaired;
  if (!map) return nb::make_tuple(d, nb::none(), nb::none());
  // Nobody else holds it; Python has no const.
  return nb::make_tuple(d, asDict(report), std::const_pointer_cast<TetMap>(map));
}

}  // namespace hexhex::python
