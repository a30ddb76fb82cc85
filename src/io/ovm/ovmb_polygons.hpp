// Polygons, and lines, as polyhedral meshes without cells in `.ovmb` files.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>

namespace hexhex {

/// Values of one property.
struct OvmbProperty {
  std::uint8_t entity = 0;  ///< 0 vertex, 1 edge, 2 face
  std::string_view name;
  std::vector<std::int32_t> integers = {};
  std::vector<std::array<double, 2>> pairs = {};  ///< if there are no integers

  [[nodiscard]] bool isPair() const { return !pairs.empty(); }
  [[nodiscard]] std::size_t count() const { return isPair() ? pairs.size() : integers.size(); }
  [[nodiscard]] std::size_t bytesEach() const {
    return isPair() ? sizeof(pairs[0]) : sizeof(integers[0]);
  }
};

/// A mesh without cells, as it will be written.
struct OvmbPolygons {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::uint8_t> valences;  ///< per face
  std::vector<Index> halfEdges;        ///< of all faces
  std::vector<OvmbProperty> properties;
};

/// Writes and commits a file.
/// @throws Error FileWrite
void writeOvmbPolygons(const OvmbPolygons& mesh, OutputFile& output, Stage& stage);

}  // namespace hexhex
