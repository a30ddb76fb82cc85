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

ExtractOptions Options::get() const {
  return {.engine = propeller ? Engine::Propeller : Engine::Atlas,
          .scale = scale,
          .epsilon = epsilon,
          .tolerance = tolerance,
          .repair = repair ? RepairMode::Auto : RepairMode::Off,
          .round = round};
}

Dict asDict(const RepairReport& report) {
  Dict d;
  d["changed"] = report.changed;
  d["bad_tets"] = report.badTets;
  d["moved_vertices"] = report.movedVertices;
  d["largest_move"] = report.largestMove;
  d["split_edges"] = report.splitEdges;
  d["added_tets"] = report.addedTets;
  d["rounded_vertices"] = report.roundedVertices;
  d["seconds"] = report.seconds;
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

namespace {

nb::list countsAsList(const std::array<std::uint64_t, 4>& counts) {
  nb::list list;
  for (const std::uint64_t count : counts) list.append(count);
  return list;
}

}  // namespace

nb::list asList(const std::vector<StageTime>& stages) {
  nb::list list;
  for (const StageTime& time : stages) list.append(nb::make_tuple(time.stage, time.seconds));
  return list;
}

nb::tuple asTuple(const Notes& notes) {
  const ExtractStatistics& s = notes.statistics;
  Dict d;
  d["seconds"] = s.seconds;
  d["threads"] = s.threads;
  d["epsilon"] = s.epsilon;
  d["epsilon_fallback"] = s.epsilonFallback;
  d["mirrored"] = s.mirrored;
  d["tets_inverted_in_space"] = s.tetsInvertedInSpace;
  d["max_displacement"] = s.maxDisplacement;
  d["max_transition_residual"] = s.maxTransitionResidual;
  d["chart_jumps"] = s.chartJumps;
  d["inner_faces"] = s.innerFaces;
  d["singular_edges"] = s.singularEdges;
  d["generators"] = countsAsList(s.generators);
  d["vertices"] = countsAsList(s.vertices);
  d["local_propellers"] = s.localPropellers;
  d["global_propellers"] = s.globalPropellers;
  d["charts"] = s.charts;
  d["cut_faces"] = s.cutFaces;
  d["overlapping_tets"] = s.overlappingTets;
  d["traced_cells"] = s.tracedCells;
  d["stages"] = asList(notes.stages);
  if (!s.repairedMap) return nb::make_tuple(d, nb::none(), nb::none());
  // Nobody else holds it; Python has no const.
  return nb::make_tuple(d, asDict(s.repair), std::const_pointer_cast<TetMap>(s.repairedMap));
}

}  // namespace hexhex::python
