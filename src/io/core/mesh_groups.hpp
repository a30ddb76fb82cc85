// What formats with groups of elements hold beside points and cells: the boundary and the tagged
// vertices, edges and quads of a mesh, sorted into groups with a number and a name each; and the
// cells by region.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/parts.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::io {

/// "No face of a cell": see QuadGroups.
inline constexpr std::uint64_t kNoPlace = ~std::uint64_t{0};

/// Consecutive elements that have the same tag.
struct ElementGroup {
  /// In [1, 2^31), different within one kind of elements: the tag where all tags are positive, and
  /// otherwise the number of the group from 1 on. Untagged boundary quads come last.
  std::uint32_t number = 0;
  std::string name;  ///< letters, digits and '_': "boundary", "surface_7", "curve_m2" (tag -2), or
                     ///< what the features name it
  std::size_t begin = 0;
  std::size_t end = 0;
  std::int32_t tag = 0;  ///< 0 for elements without one
};

template <std::size_t vertices>
struct ElementGroups {
  std::vector<ElementGroup> groups;
  Array<std::array<Index, vertices>> elements;
};
using VertexGroups = ElementGroups<1>;
using EdgeGroups = ElementGroups<2>;

/// All boundary quads, facing outwards, and the tagged quads inside.
struct QuadGroups : ElementGroups<4> {
  Array<std::uint64_t> places;  ///< per quad: 8 * cell + face; kNoPlace inside the mesh

  /// The end of a group's boundary quads; those inside the mesh come last.
  [[nodiscard]] std::size_t boundaryEnd(const ElementGroup& group) const;
};

/// Names are "point_TAG" and "curve_TAG".
/// @throws Error InvalidArgument for a feature with a vertex that is none of the mesh
[[nodiscard]] VertexGroups groupVertices(const HexMesh& mesh);
[[nodiscard]] EdgeGroups groupEdges(const HexMesh& mesh);

/// Names are "surface_TAG", and "boundary" for boundary quads without a tag. If no
/// boundary quad has a tag, they are in the smooth patches of boundaryPatches(), "patch_1" and so
/// on, unless there is only one; their numbers come behind the tags of quads inside. Groups are in
/// order of their tags, quads of a group in order of (cell, face), then those inside as the
/// features list them.
/// @param patchAngle  in degrees; 0: no patches
/// @throws Error InvalidArgument for a feature with a vertex that is none of the mesh
/// @param isInside  of a place: whether its quad is inside the mesh though it has one cell only, as
///                  quads between parts have; null: there are none
[[nodiscard]] QuadGroups groupQuads(const HexMesh& mesh, double patchAngle, Stage& stage,
                                    const std::function<bool(std::uint64_t)>& isInside = nullptr);

/// The name of the group of quads with a tag, of those that have one, and of boundary quads
/// without.
[[nodiscard]] std::string quadGroupName(std::int32_t tag);

/// The cells by region, for formats that list them group by group.
struct CellGroups {
  std::vector<ElementGroup> groups;  ///< at least one
  Array<Index> order;                ///< the cells, group by group; empty: as they are

  /// Which cell stands at place i.
  [[nodiscard]] std::size_t at(std::size_t i) const noexcept {
    return order.empty() ? i : order[i];
  }
};

/// Names are "region_TAG", and "hexahedra" for cells of region 0 and in meshes without regions.
[[nodiscard]] CellGroups groupCells(const HexMesh& mesh);

/// Adds groups without elements, so that groups, their numbers and names are the same for all
/// meshes with these tags.
/// @param tags      ascending, without 0
/// @param untagged  whether there is a group of elements without tag, too
/// @param word      of names: "surface"
/// @param nameless  the name of the group without tag
void addMissingGroups(std::vector<ElementGroup>& groups, std::vector<std::int32_t> tags,
                      bool untagged, const std::string& word, const char* nameless);

/// Everything that formats list by group.
struct MeshGroups {
  VertexGroups vertices;
  EdgeGroups edges;
  QuadGroups quads;
  CellGroups cells;

  /// @throws Error InvalidArgument for a feature with a vertex that is none of the mesh
  MeshGroups(const HexMesh& mesh, double patchAngle, Stage& stage);
  MeshGroups(VertexGroups vertices_, EdgeGroups edges_, QuadGroups quads_, CellGroups cells_)
      : vertices(std::move(vertices_)),
        edges(std::move(edges_)),
        quads(std::move(quads_)),
        cells(std::move(cells_)) {}
  /// Of cells alone.
  explicit MeshGroups(std::size_t cellCount) : cells{{{1, "hexahedra", 0, cellCount}}, {}} {}

  [[nodiscard]] std::size_t elementCount() const {
    return vertices.elements.size() + edges.elements.size() + quads.elements.size() +
           cells.groups.back().end;
  }
};

/// The different vertices of a group's elements, ascending.
template <class Groups>
[[nodiscard]] Array<Index> verticesOf(const Groups& groups, const ElementGroup& group) {
  Array<Index> vertices;
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const auto& element = groups.elements[i];
    vertices.insert(vertices.end(), element.begin(), element.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Refuses more elements than 32 bits with a sign can number.
/// @param numbers  who numbers what: "OpenFOAM numbers faces"
/// @param instead  what else can be done
/// @throws Error TooLarge
void requireInt32(std::size_t count, const std::string& numbers,
                  const std::string& instead = "choose another format");

/// What stands for elements without a tag beside others that have one.
enum class Untagged : std::uint8_t { Numbered, Zero };

/// The number of each cell's group, for formats that list cells in order. Empty: all are 1.
[[nodiscard]] Array<std::uint32_t> cellReferences(const HexMesh& mesh,
                                                  Untagged untagged = Untagged::Numbered);

/// For formats with one reference per vertex: the number of the vertex's group, 0 without.
[[nodiscard]] Array<std::uint32_t> vertexReferences(const HexMesh& mesh,
                                                    const VertexGroups& groups);
/// The number of the group of each element.
[[nodiscard]] Array<std::uint32_t> groupNumbers(const std::vector<ElementGroup>& groups,
                                                Untagged untagged = Untagged::Numbered);

// The groups of a part's elements: the same in all parts, some of them empty.

/// Boundary quads are those of the whole mesh; quads between parts are in groups if they are
/// tagged. Groups of boundary quads are "surface_TAG" and "boundary", as in a whole mesh with a
/// patch angle of 0. Cells are own cells.
[[nodiscard]] MeshGroups groupPart(const MeshPart& part, const PartsInfo& info, Stage& stage);

}  // namespace hexhex::io
