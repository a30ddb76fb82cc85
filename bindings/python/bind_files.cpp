// Files: reading, writing, and writing a mesh that comes in pieces.
#include <memory>

#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>
#if defined(HEXHEX_HAS_VIEWER)
#include <hexhex/view.hpp>
#endif

#include "piece_taker.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// @param compress  a value of Compression
WriteOptions writeOptions(const std::string& format, double patchAngle, int compress,
                          const std::string& mapArray) {
  WriteOptions options;
  options.format = format;
  options.patchAngle = patchAngle;
  options.compress = static_cast<Compression>(compress);
  options.mapArray = mapArray;
  return options;
}

/// A file that gets a mesh in pieces.
class MeshWriter : public PieceTaker {
 public:
  MeshWriter(const std::string& file, const std::string& format) {
    sink_ = openMeshSink(file, {.format = format}, context_);
  }
};

nb::list formats() {
  nb::list list;
  for (const FileFormat& f : fileFormats()) {
    list.append(nb::make_tuple(std::string(f.name), std::string(f.extension),
                               std::string(f.description), f.readsMaps, f.writesMaps, f.readsTets,
                               f.readsHexMeshes, f.writesHexMeshes, f.streams, f.compresses));
  }
  return list;
}

void requireFormat(const std::string& what, const std::string& file, const std::string& format,
                   double patchAngle, int compress, const std::string& mapArray) {
  const WriteOptions options = writeOptions(format, patchAngle, compress, mapArray);
  if (what == "map") return requireMapFormat(file, options);
  if (what == "mesh") return requireHexMeshFormat(file, options);
  if (what == "arcs") return requireArcFormat(file);
  if (what == "patches") return requirePatchFormat(file);
  if (what == "curved") return requireLagrangeFormat(file, format);
  throw Error(ErrorCode::InvalidArgument,
              "A \"" + what +
                  "\" is nothing that can be written. Choose map, mesh, arcs, patches or curved.");
}

/// @param mesh  straight or curved
void writePage(const auto& mesh, const std::string& file, const std::string& title, int threads,
               const Progress& progress) {
#if defined(HEXHEX_HAS_VIEWER)
  ViewOptions options;
  options.title = title;
  run(threads, progress, [&](Context& context) { writeViewPage(mesh, file, options, context); });
#else
  static_cast<void>(mesh);
  static_cast<void>(title);
  static_cast<void>(threads);
  static_cast<void>(progress);
  throw Error(
      ErrorCode::FileUnsupported,
      file +
          ": this hexhex was built without the viewer page. Wheels have it; with nodejs and "
          "npm, `pip install . -C cmake.define.HEXHEX_BUILD_VIEWER=ON` builds it.");
#endif
}

}  // namespace

void bindFiles(nb::module_& module) {
  definePieces(nb::class_<MeshWriter>(module, "MeshWriter")
                   .def(nb::init<const std::string&, const std::string&>(), "file"_a, "format"_a));
  module.def(
      "read_map",
      [](const std::string& file, const std::string& format, const std::string& mapArray,
         bool keepWalls, int threads, const Progress& progress) {
        return run(threads, progress, [&](Context& context) {
          return readMap(file, {.format = format, .mapArray = mapArray, .keepWalls = keepWalls},
                         context);
        });
      },
      "file"_a, "format"_a, "map_array"_a, "keep_walls"_a, "threads"_a, "progress"_a.none());
  module.def(
      "read_tets",
      [](const std::string& file, const std::string& format, int threads,
         const Progress& progress) {
        TetMesh mesh = run(threads, progress, [&](Context& context) {
          return readTetMesh(file, {.format = format}, context);
        });
        return nb::make_tuple(ownedArray(std::move(mesh.points)), ownedArray(std::move(mesh.tets)));
      },
      "file"_a, "format"_a, "threads"_a, "progress"_a.none());
  module.def(
      "read_pair",
      [](const std::string& tets, const std::string& polycube, int threads,
         const Progress& progress) {
        return run(threads, progress,
                   [&](Context& context) { return readMapPair(tets, polycube, context); });
      },
      "tets"_a, "polycube"_a, "threads"_a, "progress"_a.none());
  module.def(
      "read_flags",
      [](const std::string& tets, const std::string& flags, const std::string& surface,
         const std::string& array, int threads, const Progress& progress) {
        return run(threads, progress, [&](Context& context) {
          const TetMesh mesh = readTetMesh(tets, {}, context);
          return mapFromFlags(mesh, readFlags({flags, surface, array}, mesh, context), context);
        });
      },
      "tets"_a, "flags"_a, "surface"_a, "array"_a, "threads"_a, "progress"_a.none());
  module.def(
      "read_mesh",
      [](const std::string& file, const std::string& format, bool hexesOnly, int threads,
         const Progress& progress) {
        return run(threads, progress, [&](Context& context) {
          return readHexMesh(file, {.format = format, .hexesOnly = hexesOnly}, context);
        });
      },
      "file"_a, "format"_a, "hexes_only"_a, "threads"_a, "progress"_a.none());
  module.def(
      "read",
      [](const std::string& file, const std::string& format, const std::string& mapArray,
         bool keepWalls, bool hexesOnly, int threads, const Progress& progress) {
        return run(threads, progress, [&](Context& context) {
          return readMapOrHexMesh(file,
                                  {.format = format,
                                   .mapArray = mapArray,
                                   .keepWalls = keepWalls,
                                   .hexesOnly = hexesOnly},
                                  context);
        });
      },
      "file"_a, "format"_a, "map_array"_a, "keep_walls"_a, "hexes_only"_a, "threads"_a,
      "progress"_a.none());
  module.def(
      "write_mesh",
      [](const HexMesh& mesh, const std::string& file, const std::string& format, double patchAngle,
         int compress, const In1<double>& scaledJacobians, int threads, const Progress& progress) {
        WriteOptions writing = writeOptions(format, patchAngle, compress, "igm");
        writing.scaledJacobians = elements<double>(scaledJacobians);
        run(threads, progress,
            [&](Context& context) { writeHexMesh(mesh, file, writing, context); });
      },
      "mesh"_a, "file"_a, "format"_a, "patch_angle"_a, "compress"_a,
      "scaled_jacobians"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def(
      "write_map",
      [](const ArrayMap& map, const std::string& file, const std::string& format, int compress,
         const std::string& mapArray, int threads, const Progress& progress) {
        run(threads, progress, [&](Context& context) {
          writeMap(map.copy(), file, writeOptions(format, 40, compress, mapArray), context);
        });
      },
      "map"_a, "file"_a, "format"_a, "compress"_a, "map_array"_a, "threads"_a, "progress"_a.none());
  module.def("write_page", &writePage<HexMesh>, "mesh"_a, "file"_a, "title"_a, "threads"_a,
             "progress"_a.none());
  module.def("write_page", &writePage<LagrangeMesh>, "mesh"_a, "file"_a, "title"_a, "threads"_a,
             "progress"_a.none());
  module.def("formats", &formats);
  module.def("require_format", &requireFormat, "what"_a, "file"_a, "format"_a, "patch_angle"_a,
             "compress"_a, "map_array"_a);
}

}  // namespace hexhex::python
