// Extraction, whole, partial and in pieces; repair.
#include <mutex>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <hexhex/error.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/io.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/stream.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// A copy of a piece, as the piece does not outlive the call.
template <class Span>
auto copied(const Span& span) {
  return ownedArray(std::vector(span.begin(), span.end()));
}

/// Hands pieces to a Python object's methods.
class PythonSink : public MeshSink {
 public:
  explicit PythonSink(nb::object sink) : sink_(std::move(sink)) {}

  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    call([&] { sink_.attr("begin")(pointCount, cellCount); });
  }
  void points(const PointPiece& piece) override {
    call([&] {
      sink_.attr("points")(piece.first, copied(piece.points), copied(piece.generatorTet),
                           copied(piece.generatorCorners));
    });
  }
  void cells(std::uint64_t first, std::span<const Hex> cells) override {
    call([&] { sink_.attr("cells")(first, copied(cells)); });
  }
  void cells(std::uint64_t first, std::span<const Hex64> cells) override {
    call([&] { sink_.attr("cells")(first, copied(cells)); });
  }
  void end() override {
    call([&] { sink_.attr("end")(); });
  }
  /// Raises what a method has raised.
  void reraise() {
    if (raised_) throw std::move(*raised_);
  }

 private:
  template <class Work>
  void call(const Work& work) {
    const nb::gil_scoped_acquire gil;
    try {
      work();
    } catch (nb::python_error& error) {
      raised_.emplace(std::move(error));
      throw Error(ErrorCode::Cancelled, "The sink raised an exception.");
    }
  }
  nb::object sink_;
  std::optional<nb::python_error> raised_;
};

/// work(sink), where an exception of the target is the one that comes out.
template <class Work>
auto intoSink(const nb::object& target, const Work& work) {
  PythonSink sink(target);
  try {
    return work(sink);
  } catch (const Error&) {
    sink.reraise();
    throw;
  }
}

void readInto(const nb::object& target, const std::string& file, const std::string& format,
              int threads, const Progress& progress) {
  intoSink(target, [&](MeshSink& sink) {
    run(threads, progress,
        [&](Context& context) { readHexMeshTo(sink, file, {.format = format}, context); });
  });
}

nb::tuple extractMesh(const ArrayMap& map, const Options& options, int threads,
                      const Progress& progress) {
  return advising(map, threads, [&] {
    return runNoted(threads, progress, [&](Context& context, Notes& notes) {
      return extract(map.view(), options.get(notes.repaired), context, &notes.statistics);
    });
  });
}

nb::tuple extractInto(const nb::object& target, const ArrayMap& map, const Options& options,
                      int threads, const Progress& progress) {
  return intoSink(target, [&](MeshSink& sink) {
    return runNoted(threads, progress, [&](Context& context, Notes& notes) {
      extractTo(sink, map.view(), options.get(notes.repaired), context, &notes.statistics);
    });
  });
}

nb::tuple extractIntoFile(const std::string& file, const ArrayMap& map, const Options& options,
                          const std::string& format, int threads, const Progress& progress) {
  return runNoted(threads, progress, [&](Context& context, Notes& notes) {
    WriteOptions writing;
    writing.format = format;
    const std::unique_ptr<MeshSink> sink = openMeshSink(file, writing, context);
    extractTo(*sink, map.view(), options.get(notes.repaired), context, &notes.statistics);
  });
}

/// An extractor with the arrays that it refers to.
class PyExtractor {
 public:
  PyExtractor(const ArrayMap& map, double tolerance, int maxScale, int threads,
              const Progress& progress)
      : map_(map), extractor_(run(threads, progress, [&](Context& context) {
          return Extractor(map_.view(), {.tolerance = tolerance, .maxScale = maxScale}, context);
        })) {}

  nb::tuple extract(const Options& options, int threads, const Progress& progress) {
    return runAlone(threads, progress, [&](Context& context, Notes& notes) {
      return extractor_.extract(options.get(notes.repaired), context, &notes.statistics);
    });
  }
  nb::tuple extractInto(const nb::object& target, const Options& options, int threads,
                        const Progress& progress) {
    return intoSink(target, [&](MeshSink& sink) {
      return runAlone(threads, progress, [&](Context& context, Notes& notes) {
        extractor_.extractTo(sink, options.get(notes.repaired), context, &notes.statistics);
      });
    });
  }
  nb::tuple extractPieces(bool patches, const Options& options, int threads,
                          const Progress& progress) {
    const auto parts = patches ? PiecewiseLinearParts::ArcsAndPatches : PiecewiseLinearParts::Arcs;
    return runAlone(threads, progress, [&](Context& context, Notes& notes) {
      return extractor_.extractPiecewiseLinear(parts, options.get(notes.repaired), context,
                                               &notes.statistics);
    });
  }
  nb::tuple extractOrder(int order, const Options& options, int threads, const Progress& progress) {
    return runAlone(threads, progress, [&](Context& context, Notes& notes) {
      return extractor_.extractLagrange(order, options.get(notes.repaired), context,
                                        &notes.statistics);
    });
  }
  [[nodiscard]] std::uint64_t cells() const { return extractor_.cellsAtScaleOne(); }

 private:
  /// runNoted(), one at a time. Not waited for: whoever calls from his own progress function would
  /// wait for ever.
  template <class Work>
  nb::tuple runAlone(int threads, const Progress& progress, const Work& work) {
    return runNoted(threads, progress, [&](Context& context, Notes& notes) {
      const std::unique_lock lock(mutex_, std::try_to_lock);
      if (!lock) {
        throw Error(ErrorCode::InvalidArgument,
                    "The extractor is in use by another call. Make one for each thread.");
      }
      return work(context, notes);
    });
  }
  ArrayMap map_;
  std::mutex mutex_;
  Extractor extractor_;
};

nb::tuple repairMap(const ArrayMap& map, double tolerance, int scale, bool round, bool refine,
                    int threads, const Progress& progress) {
  RepairReport report;
  try {
    TetMap repaired = run(threads, progress, [&](Context& context) {
      return repair(map.copy(),
                    {.tolerance = tolerance, .scale = scale, .round = round, .refine = refine},
                    context, &report);
    });
    return nb::make_tuple(std::move(repaired), asDict(report));
  } catch (const Error& error) {
    // An error that knows what was tried, for the package to raise.
    return nb::make_tuple(
        nb::make_tuple(std::string(name(error.code())), std::string(error.what()),
                       toString(error.place()), error.place().index, error.place().second),
        asDict(report));
  }
}

nb::tuple extractPart(const ArrayMap& map, int scale, double tolerance, int threads,
                      const Progress& progress) {
  PartialMesh part = run(threads, progress, [&](Context& context) {
    return extractPartial(map.view(), {.scale = scale, .tolerance = tolerance}, context);
  });
  nb::list holes;
  for (const Hole& hole : part.holes) {
    holes.append(nb::make_tuple(
        hole.tet, hole.tets, hole.invalidTets,
        nb::make_tuple(hole.position[0], hole.position[1], hole.position[2]), hole.missingCells));
  }
  return nb::make_tuple(std::move(part.mesh), holes, part.invalidTets, part.missingCells,
                        part.faceConflicts);
}

}  // namespace

void bindExtract(nb::module_& module) {
  nb::class_<Options>(module, "Options")
      .def(
          "__init__",
          [](Options* self, int scale, bool propeller, double tolerance, bool repair, bool round,
             bool exactNodes) {
            new (self) Options{scale, propeller, tolerance, repair, round, exactNodes};
          },
          "scale"_a, "propeller"_a, "tolerance"_a, "repair"_a, "round"_a, "exact_nodes"_a);
  module.def("extract", &extractMesh, "map"_a, "options"_a, "threads"_a, "progress"_a.none());
  module.def("extract_to", &extractInto, "sink"_a, "map"_a, "options"_a, "threads"_a,
             "progress"_a.none());
  module.def("extract_to_file", &extractIntoFile, "file"_a, "map"_a, "options"_a, "format"_a,
             "threads"_a, "progress"_a.none());
  module.def("read_to", &readInto, "sink"_a, "file"_a, "format"_a, "threads"_a,
             "progress"_a.none());
  nb::class_<PyExtractor>(module, "Extractor")
      .def(nb::init<const ArrayMap&, double, int, int, const Progress&>(), "map"_a, "tolerance"_a,
           "max_scale"_a, "threads"_a, "progress"_a.none())
      .def("extract", &PyExtractor::extract, "options"_a, "threads"_a, "progress"_a.none())
      .def("extract_to", &PyExtractor::extractInto, "sink"_a, "options"_a, "threads"_a,
           "progress"_a.none())
      .def("extract_piecewise", &PyExtractor::extractPieces, "patches"_a, "options"_a, "threads"_a,
           "progress"_a.none())
      .def("extract_lagrange", &PyExtractor::extractOrder, "order"_a, "options"_a, "threads"_a,
           "progress"_a.none())
      .def("cells", &PyExtractor::cells);
  module.def("repair", &repairMap, "map"_a, "tolerance"_a, "scale"_a, "round"_a, "refine"_a,
             "threads"_a, "progress"_a.none());
  module.def("extract_partial", &extractPart, "map"_a, "scale"_a, "tolerance"_a, "threads"_a,
             "progress"_a.none());
}

}  // namespace hexhex::python
