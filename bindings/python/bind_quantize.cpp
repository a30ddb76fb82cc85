// From seamless maps to integer-grid maps.
#include <nanobind/stl/string.h>

#include <hexhex/quantize.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {

Dict asDict(const QuantizeReport& r) {
  Dict d = fieldsOf(r);
  d["worst_before"] = r.distortionBefore.worst;
  d["median_before"] = r.distortionBefore.median;
  d["worst_after"] = r.distortionAfter.worst;
  d["median_after"] = r.distortionAfter.median;
  return d;
}

Error adviceOn(const Error& error, const ArrayMap& map, int threads) {
  const auto call = [](std::string_view option, std::string_view value) {
    return (option == "cells" ? "hexhex.extract(map, quantize=True, " : "hexhex.quantize(map, ") +
           std::string(option) + "=" + std::string(value) + ")";
  };
  return run(threads, {},
             [&](Context& context) { return withAdvice(error, map.view(), call, context); });
}

namespace {

nb::tuple quantizeMap(const ArrayMap& map, double cells, double scale, double edgeLength,
                      bool densify, std::int32_t wallTag, double tolerance, int threads,
                      const Progress& progress) {
  const QuantizeOptions options = {.cells = cells,
                                   .scale = scale,
                                   .edgeLength = edgeLength,
                                   .densify = densify,
                                   .wallTag = wallTag,
                                   .tolerance = tolerance};
  std::vector<StageTime> times;
  QuantizedMap made = run(
      threads, progress, [&](Context& context) { return quantize(map.view(), options, context); },
      &times);
  Dict report = python::asDict(made.report);
  report["stages"] = asList(times);
  return nb::make_tuple(std::move(made.map), report);
}

nb::tuple examineMap(const ArrayMap& map, int threads, const Progress& progress) {
  const SeamlessReport report = run(
      threads, progress, [&](Context& context) { return examineSeamless(map.view(), context); });
  constexpr std::array kKinds = {"seamless", "almost seamless", "neither"};
  return nb::make_tuple(kKinds.at(static_cast<std::size_t>(report.kind)), report.displacement,
                        report.cells, report.problem);
}

}  // namespace

void bindQuantize(nb::module_& module) {
  module.def("can_quantize", &canQuantize);
  module.def("quantize", &quantizeMap, "map"_a, "cells"_a, "scale"_a, "edge_length"_a, "densify"_a,
             "wall_tag"_a, "tolerance"_a, "threads"_a, "progress"_a.none());
  module.def("examine_seamless", &examineMap, "map"_a, "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
