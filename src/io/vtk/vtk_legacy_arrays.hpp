// Arrays of points and cells in legacy VTK files: one of them may be a map.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <io/core/grid_map.hpp>
#include <io/vtk/vtk_legacy_source.hpp>

namespace hexhex {

/// Reads arrays, of which it keeps the map alone.
class VtkLegacyArrays {
 public:
  /// @param source  must outlive this
  /// @param mapArray  the name of the map's array; empty: there is no map
  VtkLegacyArrays(VtkLegacySource& source, std::string_view mapArray)
      : source_(source), mapArray_(mapArray) {}

  /// Reads arrays behind the keyword FIELD. In front of the mesh's sections none is the map.
  /// @throws Error FileSyntax, FileUnsupported, NotFinite
  void readField();

  /// Reads everything behind the sections of a mesh, as far as the map.
  /// @param points, cells  how many the file has
  /// @throws Error  the same
  [[nodiscard]] std::optional<GridMap> readMap(std::size_t points, std::size_t cells);

  /// All arrays that were seen on the way, as Grid::arrays has them.
  [[nodiscard]] const std::vector<std::string>& seen() const noexcept { return seen_; }

 private:
  void readAttribute(const std::string& keyword);
  void beginArrays(bool ofCells);
  void readScalars(std::string_view name);
  void readArray(std::string_view name, std::size_t components, std::size_t tuples,
                 const VtkNumberType& type);
  /// Number of points or cells, whichever arrays belong to.
  [[nodiscard]] std::size_t elements() const { return ofCells_ ? cells_ : points_; }

  VtkLegacySource& source_;
  std::string_view mapArray_;
  bool behindMesh_ = false;
  std::size_t points_ = 0;
  std::size_t cells_ = 0;
  bool ofCells_ = false;  ///< whether arrays belong to cells or to points
  std::optional<GridMap> map_;
  std::vector<std::string> seen_;
};

}  // namespace hexhex
