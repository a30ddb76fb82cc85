#include <string>
#include <utility>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace hexhex::c {

ReadOptions readOptions(const hexhex_read_options* options) {
  const hexhex_read_options given = readStruct(options, HEXHEX_READ_OPTIONS_INIT, "options");
  ReadOptions result;
  if (given.format != nullptr) result.format = given.format;
  if (given.map_array != nullptr) result.mapArray = given.map_array;
  result.keepWalls = given.keep_walls != 0;
  result.hexesOnly = given.hexes_only != 0;
  return result;
}

WriteOptions writeOptions(const hexhex_write_options* options, std::size_t cells) {
  const hexhex_write_options given = readStruct(options, HEXHEX_WRITE_OPTIONS_INIT, "options");
  WriteOptions result;
  if (given.format != nullptr) result.format = given.format;
  if (given.map_array != nullptr) result.mapArray = given.map_array;
  if (given.scaled_jacobians != nullptr) result.scaledJacobians = {given.scaled_jacobians, cells};
  result.patchAngle = given.patch_angle;
  if (given.compress < 0 || given.compress > 2) {
    throw Error(ErrorCode::InvalidArgument, "There is no such compression.");
  }
  result.compress = static_cast<Compression>(given.compress);
  return result;
}

void give(TetMesh&& tets, hexhex_map** map) {
  give(TetMap{.points = std::move(tets.points),
              .tets = std::move(tets.tets),
              .parameters = {},
              .features = std::move(tets.features),
              .regions = std::move(tets.regions)},
       map);
}

}  // namespace hexhex::c

hexhex_status hexhex_map_read(const char* file, const hexhex_read_options* options,
                              hexhex_context* context, hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    give(hexhex::readMap(&require(file, "file"), readOptions(options), *used), map);
  });
}

hexhex_status hexhex_map_read_tets(const char* file, const hexhex_read_options* options,
                                   hexhex_context* context, hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    give(hexhex::readTetMesh(&require(file, "file"), readOptions(options), *used), map);
  });
}

hexhex_status hexhex_map_read_pair(const char* tets, const char* polycube, hexhex_context* context,
                                   hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    give(hexhex::readMapPair(&require(tets, "tets"), &require(polycube, "polycube"), *used), map);
  });
}

hexhex_status hexhex_map_read_flags(const char* tets, const char* flags, const char* surface,
                                    const char* array, hexhex_context* context, hexhex_map** map,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    const hexhex::TetMesh mesh = hexhex::readTetMesh(&require(tets, "tets"), {}, *used);
    hexhex::FlagsFile file = {.file = &require(flags, "flags")};
    if (surface != nullptr) file.surface = surface;
    if (array != nullptr) file.array = array;
    give(hexhex::mapFromFlags(mesh, hexhex::readFlags(file, mesh, *used), *used), map);
  });
}

hexhex_status hexhex_map_write(const hexhex_map* map, const char* file,
                               const hexhex_write_options* options, hexhex_context* context,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used given(map, "map");
    ContextOrDefault used(context);
    const hexhex::WriteOptions how = writeOptions(options, 0);
    if (given->owned) {
      hexhex::writeMap(*given->owned, &require(file, "file"), how, *used);
    } else {
      hexhex::writeMap(copyOf(*given), &require(file, "file"), how, *used);
    }
  });
}

hexhex_status hexhex_mesh_read(const char* file, const hexhex_read_options* options,
                               hexhex_context* context, hexhex_mesh** mesh, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    ContextOrDefault used(context);
    give(hexhex::readHexMesh(&require(file, "file"), readOptions(options), *used), mesh);
  });
}

hexhex_status hexhex_read(const char* file, const hexhex_read_options* options,
                          hexhex_context* context, hexhex_map** map, hexhex_mesh** mesh,
                          hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    require(mesh, "mesh");
    ContextOrDefault used(context);
    auto found = hexhex::readMapOrHexMesh(&require(file, "file"), readOptions(options), *used);
    hexhex_map* foundMap = nullptr;
    hexhex_mesh* foundMesh = nullptr;
    if (auto* const tetMap = std::get_if<hexhex::TetMap>(&found)) {
      give(std::move(*tetMap), &foundMap);
    } else {
      give(std::move(std::get<hexhex::HexMesh>(found)), &foundMesh);
    }
    *map = foundMap;
    *mesh = foundMesh;
  });
}

hexhex_status hexhex_mesh_write(const hexhex_mesh* mesh, const char* file,
                                const hexhex_write_options* options, hexhex_context* context,
                                hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used handle(mesh, "mesh");
    const hexhex::HexMesh& given = handle->mesh();
    ContextOrDefault used(context);
    hexhex::writeHexMesh(given, &require(file, "file"), writeOptions(options, given.cells.size()),
                         *used);
  });
}

size_t hexhex_format_count(void) { return hexhex::fileFormats().size(); }

hexhex_status hexhex_get_format(size_t number, hexhex_file_format* format, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::FileFormat& found = at(hexhex::fileFormats(), number, "formats");
    // Of literals, which end with a zero.
    const hexhex_file_format result = {
        .size = sizeof(hexhex_file_format),
        .name = found.name.data(),
        .extension = found.extension.empty() ? "" : found.extension.data(),
        .description = found.description.data(),
        .reads_maps = found.readsMaps ? 1 : 0,
        .writes_maps = found.writesMaps ? 1 : 0,
        .reads_tets = found.readsTets ? 1 : 0,
        .reads_meshes = found.readsHexMeshes ? 1 : 0,
        .writes_meshes = found.writesHexMeshes ? 1 : 0,
        .streams = found.streams ? 1 : 0,
        .compresses = found.compresses ? 1 : 0};
    writeStruct(result, require(format, "format"), "format");
  });
}

hexhex_status hexhex_require_format(hexhex_output output, const char* file,
                                    const hexhex_write_options* options, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const char* const name = &require(file, "file");
    const hexhex::WriteOptions how = writeOptions(options, 0);
    switch (output) {
      case HEXHEX_OUTPUT_MAP:
        return hexhex::requireMapFormat(name, how);
      case HEXHEX_OUTPUT_MESH:
        return hexhex::requireHexMeshFormat(name, how);
      case HEXHEX_OUTPUT_ARCS:
        return hexhex::requireArcFormat(name);
      case HEXHEX_OUTPUT_PATCHES:
        return hexhex::requirePatchFormat(name);
      case HEXHEX_OUTPUT_LAGRANGE:
        return hexhex::requireLagrangeFormat(name, how.format);
    }
    throw Error(ErrorCode::InvalidArgument, "There is no such kind of output.");
  });
}
