// What a map is, and whether a mesh agrees with it.
#include <string>
#include <vector>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <hexhex/check.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {

nb::list asList(const std::vector<Defect>& defects) {
  nb::list list;
  for (const Defect& defect : defects) {
    nb::list worst;
    for (const Defect::Occurrence& occurrence : defect.worst) {
      worst.append(nb::make_tuple(toString(occurrence.place), occurrence.place.index,
                                  occurrence.place.second, occurrence.amount));
    }
    list.append(
        nb::make_tuple(std::string(name(defect.code)), defect.sentence, defect.count, worst));
  }
  return list;
}

nb::list asList(const VerifyReport& report) {
  nb::list rows;
  for (const VerifyItem& item : report.items) {
    rows.append(nb::make_tuple(item.name, item.expected, item.found, item.passed));
  }
  return rows;
}

namespace {

Dict asDict(const CheckReport& r) {
  Dict d = fieldsOf(r);
  d["defects"] = asList(r.defects);
  d["expected"] = r.valid() ? nb::object(fieldsOf(r.expected)) : nb::none();
  return d;
}

nb::list verifyMesh(const ArrayMap& map, const HexMesh& mesh, int scale, double tolerance,
                    int digits, int threads, const Progress& progress) {
  return asList(run(threads, progress, [&](Context& context) {
    return verify(map.view(), mesh, {.scale = scale, .tolerance = tolerance, .digits = digits},
                  context);
  }));
}

}  // namespace

void bindReports(nb::module_& module) {
  module.def(
      "check",
      [](const ArrayMap& map, double tolerance, int scale, int threads, const Progress& progress) {
        return asDict(run(threads, progress, [&](Context& context) {
          return check(map.view(), {.tolerance = tolerance, .scale = scale}, context);
        }));
      },
      "map"_a, "tolerance"_a, "scale"_a, "threads"_a, "progress"_a.none());
  module.def("verify", &verifyMesh, "map"_a, "mesh"_a, "scale"_a, "tolerance"_a, "digits"_a,
             "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
