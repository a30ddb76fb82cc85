// What files of finite elements list: nodes, blocks of elements, sides of these, and sets of nodes.
// Readers of such formats fill the lists; one place makes meshes of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// Elements of one type. Nodes are in the order of VTK.
struct ElementBlock {
  const VolumeCells* type =
      nullptr;  ///< null for elements that are no volumes, which have no nodes
  std::size_t nodesEach = 0;
  Array<Index> nodes;
  Array<std::uint64_t> numbers;  ///< of each element, by which sides name it
  Array<std::int32_t> regions;   ///< of each element

  [[nodiscard]] std::size_t count() const noexcept { return numbers.size(); }
};

/// A face of an element.
struct ElementSide {
  std::uint64_t element = 0;  ///< its number
  std::size_t face = 0;       ///< of a hexahedron: a row of kHexFaces
  std::size_t opposite = 0;   ///< of a tetrahedron: the corner that the face lacks; 4: it has none
  std::int32_t tag = 0;
};

struct NodeSet {
  std::string name;
  std::int32_t number = 0;
  std::vector<Index> nodes;
};

struct ElementLists {
  Array<Vec3> points;
  std::vector<ElementBlock> blocks;
  std::vector<ElementSide> sides;
  std::vector<FeatureFace> triangles;  ///< with tags: elements of shells
  std::vector<FeatureEdge> lines;      ///< with tags: elements of beams
  std::vector<NodeSet> nodeSets;
  std::vector<TagName> names;

  /// Notes what another program calls a group.
  void addName(int dimension, std::int32_t tag, std::string_view name);
};

/// The type of volume cells with this name in kVolumeCells.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view plural);
/// The type with this noun ("hexahedra", "tetrahedra", "prisms" or "pyramids") and number of nodes;
/// null if there is none.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view noun, std::size_t nodes);

/// What groups of elements are tagged with: what a name of this library says, or a number.
[[nodiscard]] std::int32_t tagOfGroup(std::string_view name, std::int64_t number);

/// Hexahedra with 8 nodes. Sides of a tag are tagged quads. Sets of nodes that this library calls
/// "point_7" and those of one node are tagged vertices, and the edges between nodes of a set
/// "curve_7" are tagged; other sets name nodes for loads and the like, and tag nothing.
/// @throws Error FileUnsupported, naming what there is instead; TooLarge
[[nodiscard]] HexMesh hexMeshOf(ElementLists&& lists, const Input& input);
/// Tetrahedra with 4 nodes, and the same of them.
[[nodiscard]] TetCells tetsOf(ElementLists&& lists, const Input& input);

/// Gives cells of order 2 the nodes in their faces and inside, where the shape functions of the
/// other 20 place them; cells share those of common faces.
/// @param nodes  rows of 27 in VTK's order
/// @param cells  which rows lack the last 7
void addMiddles(Array<Vec3>& points, Array<Index>& nodes, const std::vector<std::size_t>& cells,
                const std::string& fileName);

/// Of a mesh whose cells list their nodes in VTK's order: puts them in that of LagrangeMesh, and
/// vertices in front of other nodes.
void fromVtkOrder(LagrangeMesh& mesh, Stage& stage);

/// Whether there are hexahedra with 20 or 27 nodes.
[[nodiscard]] bool areCurved(const ElementLists& lists);
/// These, as cells of order 2; nodes that those with 20 lack are where their 20 nodes place them.
/// @throws Error FileUnsupported for other volume cells, too
[[nodiscard]] LagrangeMesh curvedMeshOf(ElementLists&& lists, const Input& input, Stage& stage);

/// What of a file is read: types and numbers of elements alone can be told without their nodes.
enum class ElementParts : std::uint8_t { All, Types };

/// Reads the lists of one format.
using ReadElementLists = ElementLists (*)(const Input&, ElementParts, Stage&);

/// What the registry has of a format, by the function that reads its lists.
template <ReadElementLists read>
struct ElementFormat {
  [[nodiscard]] static HexMesh readMesh(const Input& input, Context& context) {
    return inStage(context, "read mesh", [&](Stage& stage) {
      return hexMeshOf(read(input, ElementParts::All, stage), input);
    });
  }
  [[nodiscard]] static TetCells readTets(const Input& input, Context& context) {
    return inStage(context, "read tets", [&](Stage& stage) {
      return tetsOf(read(input, ElementParts::All, stage), input);
    });
  }
  [[nodiscard]] static bool holdsCurved(const Input& input, Context& context) {
    return inStage(context, "read mesh", [&](Stage& stage) {
      return areCurved(read(input, ElementParts::Types, stage));
    });
  }
  [[nodiscard]] static LagrangeMesh readCurved(const Input& input, Context& context) {
    return inStage(context, "read mesh", [&](Stage& stage) {
      return curvedMeshOf(read(input, ElementParts::All, stage), input, stage);
    });
  }
};

}  // namespace hexhex::io
