// What files of finite elements list: nodes, blocks of elements, sides of these, and sets of nodes.
// Readers of such formats fill the lists; one place makes meshes of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

/// Finds nodes, or elements, by the numbers that a file gives them.
class NodeTags {
 public:
  NodeTags() = default;
  /// @param tags  of the nodes in their order; fewer than kNone
  explicit NodeTags(const Array<std::uint64_t>& tags) : count_(tags.size()) {
    if (tags.empty()) return;
    first_ = tags[0];
    std::size_t i = 0;
    while (i < tags.size() && tags[i] == first_ + i) ++i;
    if (i < tags.size()) sortTags(tags);
  }

  /// The node with a tag, or kNone.
  [[nodiscard]] Index find(std::uint64_t tag) const {
    if (sorted_.empty()) return tag - first_ < count_ ? static_cast<Index>(tag - first_) : kNone;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), Entry{tag, 0});
    return found == sorted_.end() || found->first != tag ? kNone : found->second;
  }

  /// A node whose tag an earlier node has, too; kNone if there is none.
  [[nodiscard]] Index repeated() const {
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) return sorted_[i].second;
    }
    return kNone;
  }

 private:
  using Entry = std::pair<std::uint64_t, Index>;

  void sortTags(const Array<std::uint64_t>& tags) {
    sorted_.resize(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_[i] = {tags[i], static_cast<Index>(i)};
    std::sort(sorted_.begin(), sorted_.end());
  }

  // The usual case needs no table: consecutive tags from first_ on.
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
  Array<Entry> sorted_;
};

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
  // Elements with a tag that are no volumes.
  std::vector<FeatureVertex> vertices;
  std::vector<FeatureFace> triangles;
  std::vector<FeatureQuad> quads;
  std::vector<FeatureEdge> lines;
  std::vector<NodeSet> nodeSets;
  std::vector<TagName> names;

  /// Notes what another program calls a group.
  void addName(int dimension, std::int32_t tag, std::string_view name);
  /// The same of those names whose tag an element of their dimension has, from 1 to 3.
  void addNamesInUse(const std::vector<TagName>& known);
};

/// Sets one coordinate of all points from number `first` on; that of the first axis makes room.
/// @throws Error FileSyntax for another number of them than of the first axis; NotFinite; TooLarge
void setCoordinates(ElementLists& lists, std::size_t first, std::size_t axis,
                    const std::vector<double>& numbers, const Input& input);

/// The type of volume cells with this name in kVolumeCells.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view plural);
/// The type with this noun ("hexahedra", "tetrahedra", "prisms" or "pyramids") and number of nodes;
/// null if there is none.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view noun, std::size_t nodes);

/// The tag of a group of elements: from a name that this library gave it, or else its number.
[[nodiscard]] std::int32_t tagOfGroup(std::string_view name, std::int64_t number);

/// Tags of groups: from names that this library gave them, or else numbers in their order.
/// Tags that names contain are not given to other groups.
class GroupTags {
 public:
  /// Before tags of others are asked for.
  void reserve(std::string_view name);
  [[nodiscard]] std::int32_t next(std::string_view name);

 private:
  std::set<std::int32_t> taken_;
  std::int32_t last_ = 0;
};

/// Finds nodes by the numbers that a file gives them.
/// @throws Error FileSyntax if two have one number
[[nodiscard]] NodeTags nodesByNumber(const Array<std::uint64_t>& numbers, const Input& input);
/// Gives a block its nodes.
/// @param numbers  of the nodes, element by element
/// @param place  where nodes are listed, for messages: "*NODE section"
/// @throws Error IndexOutOfRange
void nameNodes(ElementBlock& block, const std::vector<std::uint64_t>& numbers,
               const NodeTags& nodes, const Input& input, std::string_view place);

/// Tags of elements by their numbers. Of several tags of one element, the last one counts.
class ElementTags {
 public:
  void add(std::uint64_t element, std::int32_t tag) { tags_.emplace_back(element, tag); }
  /// After the last add().
  void sort();
  /// 0 of elements without a tag.
  [[nodiscard]] std::int32_t find(std::uint64_t element) const;

 private:
  std::vector<std::pair<std::uint64_t, std::int32_t>> tags_;
};

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
void fromVtkOrder(LagrangeMesh& mesh, Stage& stage, VtkEdges upright = VtkEdges::Around);

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
  [[nodiscard]] static HexMesh readMesh(const Input& input, Stage& stage) {
    return hexMeshOf(read(input, ElementParts::All, stage), input);
  }
  [[nodiscard]] static TetCells readTets(const Input& input, Stage& stage) {
    return tetsOf(read(input, ElementParts::All, stage), input);
  }
  [[nodiscard]] static bool holdsCurved(const Input& input, Stage& stage) {
    return areCurved(read(input, ElementParts::Types, stage));
  }
  [[nodiscard]] static LagrangeMesh readCurved(const Input& input, Stage& stage) {
    return curvedMeshOf(read(input, ElementParts::All, stage), input, stage);
  }
};

}  // namespace hexhex::io
