// What becomes of the elements of a `.msh` file, whatever its version: cells of one kind, their
// regions, and features.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <io/core/bytes.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/gmsh/gmsh_types.hpp>
#include <io/gmsh/node_tags.hpp>

namespace hexhex {

/// Fills the cells of a mesh, hexahedra (8 corners) or tetrahedra (4), and its features.
template <std::size_t corners>
class GmshCells {
 public:
  /// @param nodes, mesh  must outlive this
  GmshCells(const NodeTags& nodes, CellMesh<corners>& mesh) : nodes_(nodes), mesh_(mesh) {}

  [[nodiscard]] static constexpr bool isCell(std::int64_t type) {
    return type == kCellKind<corners>.gmshType;
  }
  /// Whether elements of a type can be features of a mesh of hexahedra.
  [[nodiscard]] static constexpr bool isFeature(std::int64_t type) {
    return corners == 8 && (type == kGmshPoint || type == kGmshLine || type == kGmshQuad);
  }

  /// Makes room for cells, before any are set.
  void resize(std::size_t cells) { mesh_.cells.resize(cells); }
  /// Keeps so many of them.
  void keep(std::size_t cells) {
    mesh_.cells.resize(cells);
    if (!mesh_.regions.empty()) mesh_.regions.resize(cells);
  }

  /// Reads the nodes of a cell.
  /// @param wide  whether they have 8 bytes, where they are bytes
  /// @throws Error IndexOutOfRange
  template <class Source>
  void readCorners(Source& record, std::size_t cell, bool wide);
  /// The same of nodes of 8 bytes at a place; false if one of them does not exist.
  [[nodiscard]] bool loadCorners(const char* place, std::size_t cell);
  /// Regions of consecutive cells. Without any, there is no array.
  void setRegions(std::size_t first, std::size_t count, std::int32_t region);
  /// @param nodes  as many as the type has, in front
  /// @throws Error IndexOutOfRange
  template <class Source>
  void addFeature(const Source& source, std::int64_t type,
                  const std::array<std::uint64_t, 4>& nodes, std::int32_t tag);

 private:
  const NodeTags& nodes_;
  CellMesh<corners>& mesh_;
};

template <std::size_t corners>
template <class Source>
void GmshCells<corners>::readCorners(Source& record, std::size_t cell, bool wide) {
  for (Index& corner : mesh_.cells[cell]) {
    const char* const what = "a node of a cell";
    const std::uint64_t tag =
        wide ? record.size(what) : static_cast<std::uint64_t>(record.integer(what));
    corner = nodes_.find(tag);
    if (corner != kNone) continue;
    record.fail(ErrorCode::IndexOutOfRange,
                std::string(kCellKind<corners>.singular) + " " + std::to_string(cell) +
                    " (counted from 0) names node " +
                    std::to_string(static_cast<std::int64_t>(tag)) +
                    ", which is not in the section $Nodes.",
                Place{kCellKind<corners>.place, cell});
  }
}

template <std::size_t corners>
bool GmshCells<corners>::loadCorners(const char* place, std::size_t cell) {
  bool known = true;
  for (Index& corner : mesh_.cells[cell]) {
    corner = nodes_.find(loadLittle<std::uint64_t>(place));
    known = known && corner != kNone;
    place += sizeof(std::uint64_t);
  }
  return known;
}

template <std::size_t corners>
void GmshCells<corners>::setRegions(std::size_t first, std::size_t count, std::int32_t region) {
  if (mesh_.regions.empty() && region != 0) mesh_.regions.assign(mesh_.cells.size(), 0);
  if (mesh_.regions.empty()) return;
  std::fill_n(mesh_.regions.begin() + static_cast<std::ptrdiff_t>(first), count, region);
}

template <std::size_t corners>
template <class Source>
void GmshCells<corners>::addFeature(const Source& source, std::int64_t type,
                                    const std::array<std::uint64_t, 4>& nodes, std::int32_t tag) {
  Quad vertices{};
  for (std::size_t k = 0; k < nodesOfGmshType(type); ++k) {
    vertices[k] = nodes_.find(nodes[k]);
    if (vertices[k] != kNone) continue;
    source.fail(ErrorCode::IndexOutOfRange,
                "an element names node " + std::to_string(static_cast<std::int64_t>(nodes[k])) +
                    ", which is not in the section $Nodes.");
  }
  HexFeatures& features = mesh_.features;
  if (type == kGmshPoint) features.vertices.push_back({vertices[0], tag});
  if (type == kGmshLine) features.edges.push_back({{vertices[0], vertices[1]}, tag});
  if (type == kGmshQuad) features.quads.push_back({vertices, tag});
}

}  // namespace hexhex
