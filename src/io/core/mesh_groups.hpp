// Groups of elements for formats that store them: the boundary and the tagged vertices, edges and
// quads of a mesh, sorted into groups with a number and a name each; and the cells by region.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/features.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/types.hpp>

#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>

namespace hexhex::io {

/// Marks a quad that is not on the boundary: see QuadGroups.
inline constexpr std::uint64_t kNoPlace = ~std::uint64_t{0};

/// Consecutive elements that have the same tag.
struct ElementGroup {
  /// In [1, 2^31), unique within one kind of elements: the tag where all tags are positive,
  /// otherwise the number of the group from 1 on. Untagged boundary quads come last.
  std::uint32_t number = 0;
  std::string name;  ///< letters, digits and '_': "boundary", "surface_7", "curve_m2" (tag -2), or
                     ///< the name that the features give
  std::size_t begin = 0;
  std::size_t end = 0;
  std::int32_t tag = 0;  ///< 0: untagged
};

template <std::size_t vertices>
struct ElementGroups {
  std::vector<ElementGroup> groups;
  Array<std::array<Index, vertices>> elements;
};
using VertexGroups = ElementGroups<1>;
using EdgeGroups = ElementGroups<2>;

/// All boundary quads, facing outwards, and the tagged interior quads. Among them, in meshes with
/// other cells, are triangles: quads that repeat their last vertex.
struct QuadGroups : ElementGroups<4> {
  /// Per quad: 8 * cell + face, as AllCells and kFaces number them; kNoPlace in the interior.
  Array<std::uint64_t> places;

  /// The end of a group's boundary quads; interior quads come last.
  [[nodiscard]] std::size_t boundaryEnd(const ElementGroup& group) const;
};

/// Default names are "point_TAG" and "curve_TAG".
/// @throws Error InvalidArgument for a feature with a vertex index out of range
[[nodiscard]] VertexGroups groupVertices(const HexMesh& mesh);
[[nodiscard]] EdgeGroups groupEdges(const HexMesh& mesh);

/// Default names are "surface_TAG", and "boundary" for untagged boundary quads. If no boundary quad
/// is tagged, they are grouped into the smooth patches of boundaryPatches(), "patch_1" and so on,
/// unless there is only one; patch numbers follow the tags of interior quads. Groups are sorted by
/// tag, quads of a group by (cell, face), followed by interior quads in the order of the features.
/// @param patchAngle  in degrees; 0: no patches
/// @param isInside  whether a quad is interior though only one cell has it, as between parts, given
///                  its place; null: no such quads
/// @throws Error InvalidArgument for a feature with a vertex index out of range
[[nodiscard]] QuadGroups groupQuads(const HexMesh& mesh, double patchAngle, Stage& stage,
                                    const std::function<bool(std::uint64_t)>& isInside = nullptr,
                                    const OtherCells& others = noOthers());

/// The cells by region, for formats that list them group by group.
struct CellGroups {
  std::vector<ElementGroup> groups;  ///< at least one
  /// Cell indices as in AllCells, group by group, those of a group by kind; empty: the original
  /// order.
  Array<Index> order;

  /// The cell at position i of the list.
  [[nodiscard]] std::size_t at(std::size_t i) const noexcept {
    return order.empty() ? i : order[i];
  }
};

/// Default names are "region_TAG", and "hexahedra" (with other cells: "all_cells") for region 0 and
/// meshes without regions.
[[nodiscard]] CellGroups groupCells(const HexMesh& mesh, const OtherCells& others = noOthers());

/// Calls f(group) for the parts of a group whose elements have equally many corners.
/// @param corners  corners(i): of element i of the list
template <class Corners, class F>
void splitByCorners(ElementGroup group, const Corners& corners, const F& f) {
  for (const std::size_t end = group.end; group.begin < end; group.begin = group.end) {
    group.end = group.begin + 1;
    while (group.end < end && corners(group.end) == corners(group.begin)) ++group.end;
    f(std::as_const(group));
  }
}

/// Adds empty groups, so that all meshes with these tags have the same groups with the same numbers
/// and names.
/// @param tags      ascending, without 0
/// @param untagged  whether to have a group of untagged elements
/// @param word      prefix of names, e.g. "surface"
/// @param nameless  the name of the untagged group
void addMissingGroups(std::vector<ElementGroup>& groups, std::vector<std::int32_t> tags,
                      bool untagged, const std::string& word, const char* nameless);

/// All groups of a mesh.
struct MeshGroups {
  VertexGroups vertices;
  EdgeGroups edges;
  QuadGroups quads;
  CellGroups cells;

  /// @throws Error InvalidArgument for a feature with a vertex index out of range
  MeshGroups(const HexMesh& mesh, const WriteOptions& options, Stage& stage);
  MeshGroups(VertexGroups vertices_, EdgeGroups edges_, QuadGroups quads_, CellGroups cells_)
      : vertices(std::move(vertices_)),
        edges(std::move(edges_)),
        quads(std::move(quads_)),
        cells(std::move(cells_)) {}
  /// For a mesh of cells only.
  explicit MeshGroups(std::size_t cellCount) : cells{{{1, "hexahedra", 0, cellCount}}, {}} {}

  [[nodiscard]] std::size_t elementCount() const {
    return vertices.elements.size() + edges.elements.size() + quads.elements.size() +
           cells.groups.back().end;
  }
};

/// The distinct vertices of a group's elements, ascending.
template <class Groups>
[[nodiscard]] Array<Index> verticesOf(const Groups& groups, const ElementGroup& group) {
  Array<Index> vertices;
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const auto& element = groups.elements[i];
    vertices.insert(vertices.end(), element.begin(), element.end());
  }
  sortUnique(vertices);
  return vertices;
}

/// Refuses more elements than a signed 32-bit integer can number.
/// @param numbers  start of the message, e.g. "OpenFOAM numbers faces"
/// @param instead  a suggestion
/// @throws Error TooLarge
void requireInt32(std::size_t count, const std::string& numbers,
                  const std::string& instead = "choose another format");

/// The tag in a default name of a group, 0 for "boundary", "hexahedra", "all_cells" and "patch_7";
/// empty for other names.
/// @param dimension  of the elements, if only their names count; -1: any
[[nodiscard]] std::optional<std::int32_t> tagInGroupName(std::string_view name, int dimension = -1);

/// The vertices of a feature.
[[nodiscard]] inline std::array<Index, 1> verticesOf(const FeatureVertex& feature) {
  return {feature.vertex};
}
template <class Feature>
[[nodiscard]] const auto& verticesOf(const Feature& feature) {
  return feature.vertices;
}
/// The same in ascending order, to compare features.
template <class Feature>
[[nodiscard]] auto keyOf(const Feature& feature) {
  return sorted(verticesOf(feature));
}

/// Keeps the first feature of each set of vertices, whatever the tags.
template <class Feature>
void removeRepeated(std::vector<Feature>& features) {
  std::set<decltype(keyOf(features[0]))> seen;
  std::size_t kept = 0;
  for (const Feature& feature : features) {
    if (seen.insert(keyOf(feature)).second) features[kept++] = feature;
  }
  features.resize(kept);
}

/// Gives groups unique numbers across dimensions, since programs such as meshio and GetFEM merge
/// groups with equal numbers. Numbers that are tags are kept where possible, earlier kinds first.
void numberApart(std::initializer_list<std::vector<ElementGroup>*> kinds);

/// How untagged elements are numbered beside tagged ones: as their group, or 0.
enum class Untagged : std::uint8_t { Numbered, Zero };

/// The group number of each cell, for formats that list cells in order; empty if all are 1.
[[nodiscard]] Array<std::uint32_t> cellReferences(const HexMesh& mesh,
                                                  Untagged untagged = Untagged::Numbered,
                                                  const OtherCells& others = noOthers());

/// The group number of each vertex, 0 if none, for formats with one reference per vertex.
[[nodiscard]] Array<std::uint32_t> vertexReferences(const HexMesh& mesh,
                                                    const VertexGroups& groups);
/// The group number of each element.
[[nodiscard]] Array<std::uint32_t> groupNumbers(const std::vector<ElementGroup>& groups,
                                                Untagged untagged = Untagged::Numbered);

/// The groups of a part's elements: the same in all parts, some of them empty. Boundary quads are
/// those of the whole mesh; quads between parts are grouped if they are tagged. Groups of boundary
/// quads are "surface_TAG" and "boundary", as for a whole mesh with patch angle 0. Only owned cells
/// are grouped.
[[nodiscard]] MeshGroups groupPart(const MeshPart& part, const PartsInfo& info, Stage& stage);

}  // namespace hexhex::io
