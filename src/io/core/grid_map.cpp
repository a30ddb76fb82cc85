#include <algorithm>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/grid_map.hpp>
#include <io/core/writable.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 13;

[[noreturn]] void failWithoutMap(const TetGrid& grid, std::string_view name,
                                 const std::string& fileName) {
  std::string found;
  for (const std::string& array : grid.arrays) found += (found.empty() ? "" : ", ") + array;
  throw Error(ErrorCode::FileUnsupported,
              fileName + ": the file holds " + std::to_string(grid.mesh.cells.size()) +
                  " tets, but no map: no cell array \"" + std::string(name) +
                  "\" of 12 floating-point numbers (u v w of each corner), and no point array of "
                  "this name with 3, for a map without jumps. Arrays in the file: " +
                  (found.empty() ? "none" : found) +
                  ". Name the map's array (--map-array), or give the map as a second mesh "
                  "(--polycube).");
}

/// The parameters of one tet.
void setParameters(const TetGrid& grid, std::size_t tet, TetParameters& parameters) {
  const double* const values = grid.map->values.data();
  if (grid.map->ofCells) {
    const std::size_t cell = grid.cellInFile.empty() ? tet : grid.cellInFile[tet];
    std::copy_n(values + kCellMapComponents * cell, kCellMapComponents, parameters[0].data());
    return;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::copy_n(values + kPointMapComponents * grid.mesh.cells[tet][i], kPointMapComponents,
                parameters[i].data());
  }
}

}  // namespace

std::string describeArray(std::string_view name, bool ofCells, std::size_t components) {
  std::string text(1, '"');
  text += name;
  text += ofCells ? "\" (cells, " : "\" (points, ";
  text += std::to_string(components);
  return text += components == 1 ? " component)" : " components)";
}

TetMap toTetMap(TetGrid&& grid, std::string_view name, const std::string& fileName, Stage& stage) {
  if (!grid.map) failWithoutMap(grid, name, fileName);
  TetMap map;
  const std::size_t tets = grid.mesh.cells.size();
  map.points.assign(grid.mesh.points.begin(), grid.mesh.points.end());
  map.tets.assign(grid.mesh.cells.begin(), grid.mesh.cells.end());
  map.parameters.resize(tets);
  parallelFor(stage, tets, kGrain,
              [&](std::size_t t) { setParameters(grid, t, map.parameters[t]); });
  const std::size_t fault =
      firstFault(stage, tets, [&](std::size_t t) { return isFinite(map.parameters[t]); });
  if (fault == tets) return map;
  throw Error(ErrorCode::NotFinite,
              fileName + ": a parameter of tet " + std::to_string(fault) + " is not finite.",
              Place{PlaceKind::Tet, fault});
}

}  // namespace hexhex
