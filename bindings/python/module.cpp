// hexhex._hexhex: what the Python package hexhex is made of, over the public headers.
//
// Arrays come in as numpy arrays of exactly the right type and layout (the package converts
// others), and leave as views on meshes and maps that they keep alive. Long work runs in a thread
// of its own without the GIL, while the caller's thread looks for signals.
#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <hexhex/hexhex.hpp>

namespace nb = nanobind;
using namespace nb::literals;

namespace hexhex::python {
namespace {

using InPoints = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using InTets = nb::ndarray<const Index, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using InIgm = nb::ndarray<const double, nb::shape<-1, 4, 3>, nb::c_contig, nb::device::cpu>;
using InCells = nb::ndarray<const Index, nb::shape<-1, 8>, nb::c_contig, nb::device::cpu>;
using Progress = std::optional<nb::typed<nb::callable, nb::object(nb::str, double)>>;
using Dict = nb::typed<nb::dict, nb::str, nb::any>;

template <class Element, class NdArray>
std::span<const Element> elements(const NdArray& array) {
  return {reinterpret_cast<const Element*>(array.data()), array.shape(0)};
}

TetMapView viewOf(const InPoints& points, const InTets& tets, const InIgm& igm) {
  return {elements<Vec3>(points), elements<Tet>(tets), elements<TetParameters>(igm)};
}

/// A numpy array on the elements of `list`, which `owner` keeps alive.
template <class Scalar, std::size_t kRank, class List>
auto viewOn(List& list, nb::handle owner, const std::array<std::size_t, kRank>& shape) {
  using Array = nb::ndarray<nb::numpy, Scalar, nb::ndim<kRank>, nb::c_contig>;
  return Array(reinterpret_cast<Scalar*>(list.data()), kRank, shape.data(), owner);
}

/// Runs work(context) in a thread of its own, without the GIL. A signal (Ctrl-C) or an exception in
/// the progress function cancels it, and is raised when it has ended.
template <class Work>
auto runInterruptibly(int threads, const Progress& progress, const Work& work) {
  using Result = decltype(work(std::declval<Context&>()));
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
  std::optional<Result> result;
  std::exception_ptr failure;
  {
    std::future<Result> future = std::async(std::launch::async, [&] { return work(context); });
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
      result = future.get();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  if (raised) throw std::move(*raised);
  if (failure) std::rethrow_exception(failure);
  return std::move(*result);
}

/// What Python raises for an error of the library: an instance of a class of hexhex._errors.
void translate(const std::exception_ptr& exception, void* /*payload*/) {
  const auto raise = [](ErrorCode code, const char* message, const Place& place) {
    const nb::object error = nb::module_::import_("hexhex._errors")
                                 .attr("make")(std::string(name(code)), message, toString(place),
                                               place.index, place.second);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
  };
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    raise(error.code(), error.what(), error.place());
  } catch (const std::bad_alloc&) {
    raise(ErrorCode::OutOfMemory, "Memory is exhausted. Use a smaller scale.", {});
  }
}

ExtractOptions optionsOf(int scale, bool propeller, double tolerance, double epsilon) {
  return {.engine = propeller ? Engine::Propeller : Engine::Atlas,
          .scale = scale,
          .epsilon = epsilon,
          .tolerance = tolerance};
}

Dict asDict(const ExtractStatistics& s) {
  Dict d;
  d["seconds"] = s.seconds;
  d["threads"] = s.threads;
  d["mirrored"] = s.mirrored;
  d["tets_inverted_in_space"] = s.tetsInvertedInSpace;
  d["max_displacement"] = s.maxDisplacement;
  d["max_transition_residual"] = s.maxTransitionResidual;
  d["chart_jumps"] = s.chartJumps;
  d["inner_faces"] = s.innerFaces;
  d["singular_edges"] = s.singularEdges;
  d["charts"] = s.charts;
  d["cut_faces"] = s.cutFaces;
  d["traced_cells"] = s.tracedCells;
  return d;
}

struct Extracted {
  HexMesh mesh;
  ExtractStatistics statistics;
};

std::tuple<HexMesh, Dict> give(Extracted&& extracted) {
  return {std::move(extracted.mesh), asDict(extracted.statistics)};
}

std::tuple<HexMesh, Dict> extractMesh(const InPoints& points, const InTets& tets, const InIgm& igm,
                                      int scale, bool propeller, double tolerance, double epsilon,
                                      int threads, const Progress& progress) {
  return give(runInterruptibly(threads, progress, [&](Context& context) {
    Extracted extracted;
    extracted.mesh =
        extract(viewOf(points, tets, igm), optionsOf(scale, propeller, tolerance, epsilon), context,
                &extracted.statistics);
    return extracted;
  }));
}

/// An extractor with the arrays that it refers to.
class PyExtractor {
 public:
  PyExtractor(InPoints points, InTets tets, InIgm igm, double tolerance, int maxScale, int threads,
              const Progress& progress)
      : points_(std::move(points)),
        tets_(std::move(tets)),
        igm_(std::move(igm)),
        extractor_(runInterruptibly(threads, progress, [&](Context& context) {
          return Extractor(viewOf(points_, tets_, igm_),
                           {.tolerance = tolerance, .maxScale = maxScale}, context);
        })) {}

  std::tuple<HexMesh, Dict> extract(int scale, bool propeller, double epsilon, int threads,
                                    const Progress& progress) {
    return give(runInterruptibly(threads, progress, [&](Context& context) {
      const std::lock_guard lock(mutex_);  // one call at a time
      Extracted extracted;
      extracted.mesh = extractor_.extract(optionsOf(scale, propeller, 0, epsilon), context,
                                          &extracted.statistics);
      return extracted;
    }));
  }

 private:
  InPoints points_;
  InTets tets_;
  InIgm igm_;
  std::mutex mutex_;
  Extractor extractor_;
};

HexMesh meshOf(const InPoints& points, const InCells& cells) {
  HexMesh mesh;
  const auto p = elements<Vec3>(points);
  const auto c = elements<Hex>(cells);
  mesh.points.assign(p.begin(), p.end());
  mesh.cells.assign(c.begin(), c.end());
  return mesh;
}

Dict asDict(const Expectation& e) {
  Dict d;
  d["cells"] = e.cells;
  d["boundary_quads"] = e.boundaryQuads;
  d["inner_singular_edges"] = nb::cast(e.innerSingularEdges);
  d["boundary_singular_edges"] = nb::cast(e.boundarySingularEdges);
  d["euler_characteristic"] = e.eulerCharacteristic;
  d["components"] = e.components;
  d["boundary_components"] = e.boundaryComponents;
  return d;
}

Dict asDict(const CheckReport& r) {
  Dict d;
  d["points"] = r.points;
  d["tets"] = r.tets;
  d["edges"] = r.edges;
  d["faces"] = r.faces;
  d["boundary_faces"] = r.boundaryFaces;
  d["chart_jumps"] = r.chartJumps;
  d["isolated_vertices"] = r.isolatedVertices;
  d["tets_inverted_in_space"] = r.tetsInvertedInSpace;
  d["mirrored"] = r.mirrored;
  d["max_transition_residual"] = r.maxTransitionResidual;
  d["max_displacement"] = r.maxDisplacement;
  d["inner_singular_tet_edges"] = nb::cast(r.innerSingularTetEdges);
  d["boundary_singular_tet_edges"] = nb::cast(r.boundarySingularTetEdges);
  d["singular_nodes"] = r.singularNodes;
  d["boundary_genus"] = nb::cast(r.boundaryGenus);
  nb::list defects;
  for (const Defect& defect : r.defects) {
    nb::list worst;
    for (const Defect::Occurrence& occurrence : defect.worst) {
      worst.append(nb::make_tuple(toString(occurrence.place), occurrence.place.index,
                                  occurrence.place.second, occurrence.amount));
    }
    defects.append(
        nb::make_tuple(std::string(name(defect.code)), defect.sentence, defect.count, worst));
  }
  d["defects"] = defects;
  d["expected"] = r.valid() ? nb::object(asDict(r.expected)) : nb::none();
  return d;
}

using VerifyRow = std::tuple<std::string, std::string, std::string, bool>;

std::vector<VerifyRow> verifyMesh(const InPoints& points, const InTets& tets, const InIgm& igm,
                                  const HexMesh& mesh, int scale, double tolerance, int threads) {
  const VerifyReport report = runInterruptibly(threads, {}, [&](Context& context) {
    return verify(viewOf(points, tets, igm), mesh, {.scale = scale, .tolerance = tolerance},
                  context);
  });
  std::vector<VerifyRow> rows;
  for (const VerifyItem& item : report.items) {
    rows.emplace_back(item.name, item.expected, item.found, item.passed);
  }
  return rows;
}

TetMap generateMap(const std::string& kind, int cells, int refine, int valence,
                   const std::string& charts, double jitter, double onLattice, double noise,
                   double offset, std::uint64_t seed) {
  SampleOptions options{cells, refine, valence, ChartStyle::Aligned, jitter, onLattice,
                        noise, offset, seed};
  if (charts == "blocks") options.charts = ChartStyle::Blocks;
  if (charts == "random") options.charts = ChartStyle::Random;
  for (const SampleKindName& entry : sampleKinds()) {
    if (entry.name == kind) {
      return runInterruptibly(
          0, {}, [&](Context& /*context*/) { return generateSample(entry.kind, options).map; });
    }
  }
  throw Error(ErrorCode::InvalidArgument, "There is no kind of map called \"" + kind + "\".");
}

void writeMesh(const HexMesh& mesh, const std::string& file, const std::string& format,
               int threads) {
  runInterruptibly(threads, {}, [&](Context& context) {
    WriteOptions options;
    options.format = format;
    writeHexMesh(mesh, file, options, context);
    return true;
  });
}

void writeMapFile(const InPoints& points, const InTets& tets, const InIgm& igm,
                  const std::string& file, int threads) {
  runInterruptibly(threads, {}, [&](Context& context) {
    const TetMapView view = viewOf(points, tets, igm);
    TetMap map;
    map.points.assign(view.points.begin(), view.points.end());
    map.tets.assign(view.tets.begin(), view.tets.end());
    map.parameters.assign(view.parameters.begin(), view.parameters.end());
    writeMap(map, file, context);
    return true;
  });
}

/// Scaled Jacobians, which the array owns.
auto qualityOf(const HexMesh& mesh, int threads) {
  auto* const values = new Array<double>(runInterruptibly(
      threads, {}, [&](Context& context) { return scaledJacobians(mesh, context); }));
  const nb::capsule owner(values,
                          [](void* array) noexcept { delete static_cast<Array<double>*>(array); });
  return viewOn<double, 1>(*values, owner, {values->size()});
}

template <class T>
T& unwrapped(nb::handle self) {
  return *nb::inst_ptr<T>(self);
}

void bindMesh(nb::module_& module) {
  nb::class_<HexMesh>(module, "Mesh", "A mesh in the library's own arrays.")
      .def(
          "__init__",
          [](HexMesh* self, const InPoints& points, const InCells& cells) {
            new (self) HexMesh(meshOf(points, cells));
          },
          "points"_a.noconvert(), "cells"_a.noconvert())
      .def_prop_ro("points",
                   [](nb::handle self) {
                     auto& points = unwrapped<HexMesh>(self).points;
                     return viewOn<double, 2>(points, self, {points.size(), 3});
                   })
      .def_prop_ro("cells",
                   [](nb::handle self) {
                     auto& cells = unwrapped<HexMesh>(self).cells;
                     return viewOn<Index, 2>(cells, self, {cells.size(), 8});
                   })
      .def_prop_ro("generator_tet",
                   [](nb::handle self) {
                     auto& tets = unwrapped<HexMesh>(self).generatorTet;
                     return viewOn<Index, 1>(tets, self, {tets.size()});
                   })
      .def_prop_ro("generator_corners", [](nb::handle self) {
        auto& corners = unwrapped<HexMesh>(self).generatorCorners;
        return viewOn<CornerSet, 1>(corners, self, {corners.size()});
      });
}

void bindMap(nb::module_& module) {
  nb::class_<TetMap>(module, "Map", "A map in the library's own arrays.")
      .def_prop_ro("points",
                   [](nb::handle self) {
                     auto& points = unwrapped<TetMap>(self).points;
                     return viewOn<double, 2>(points, self, {points.size(), 3});
                   })
      .def_prop_ro("tets",
                   [](nb::handle self) {
                     auto& tets = unwrapped<TetMap>(self).tets;
                     return viewOn<Index, 2>(tets, self, {tets.size(), 4});
                   })
      .def_prop_ro("igm", [](nb::handle self) {
        auto& igm = unwrapped<TetMap>(self).parameters;
        return viewOn<double, 3>(igm, self, {igm.size(), 4, 3});
      });
}

}  // namespace

NB_MODULE(_hexhex, module) {
  nb::register_exception_translator(translate);
  // What a program still holds at its end is no leak worth a message.
  nb::set_leak_warnings(false);
  module.def("version", [] { return std::string(version()); });
  bindMesh(module);
  bindMap(module);
  nb::class_<PyExtractor>(module, "Extractor")
      .def(nb::init<InPoints, InTets, InIgm, double, int, int, const Progress&>(),
           "points"_a.noconvert(), "tets"_a.noconvert(), "igm"_a.noconvert(), "tolerance"_a,
           "max_scale"_a, "threads"_a, "progress"_a.none())
      .def("extract", &PyExtractor::extract, "scale"_a, "propeller"_a, "epsilon"_a, "threads"_a,
           "progress"_a.none());
  module.def("extract", &extractMesh, "points"_a.noconvert(), "tets"_a.noconvert(),
             "igm"_a.noconvert(), "scale"_a, "propeller"_a, "tolerance"_a, "epsilon"_a, "threads"_a,
             "progress"_a.none());
  module.def(
      "check",
      [](const InPoints& points, const InTets& tets, const InIgm& igm, double tolerance, int scale,
         int threads) {
        return asDict(runInterruptibly(threads, {}, [&](Context& context) {
          return check(viewOf(points, tets, igm), {.tolerance = tolerance, .scale = scale},
                       context);
        }));
      },
      "points"_a.noconvert(), "tets"_a.noconvert(), "igm"_a.noconvert(), "tolerance"_a, "scale"_a,
      "threads"_a);
  module.def("verify", &verifyMesh, "points"_a.noconvert(), "tets"_a.noconvert(),
             "igm"_a.noconvert(), "mesh"_a, "scale"_a, "tolerance"_a, "threads"_a);
  module.def("generate", &generateMap, "kind"_a, "cells"_a, "refine"_a, "valence"_a, "charts"_a,
             "jitter"_a, "on_lattice"_a, "noise"_a, "offset"_a, "seed"_a);
  module.def(
      "read_map",
      [](const std::string& file, int threads) {
        return runInterruptibly(threads, {},
                                [&](Context& context) { return readMap(file, context); });
      },
      "file"_a, "threads"_a);
  module.def(
      "read_mesh",
      [](const std::string& file, int threads) {
        return runInterruptibly(threads, {},
                                [&](Context& context) { return readHexMesh(file, context); });
      },
      "file"_a, "threads"_a);
  module.def("write_mesh", &writeMesh, "mesh"_a, "file"_a, "format"_a, "threads"_a);
  module.def("write_map", &writeMapFile, "points"_a.noconvert(), "tets"_a.noconvert(),
             "igm"_a.noconvert(), "file"_a, "threads"_a);
  module.def("scaled_jacobians", &qualityOf, "mesh"_a, "threads"_a);
}

}  // namespace hexhex::python
