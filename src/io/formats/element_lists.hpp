// Intermediate lists for finite element formats: nodes, blocks of elements, element sides, and node
// sets. Readers of the formats fill them; the functions here build meshes from them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
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

/// Maps the numbers that a file gives to nodes or elements to indices.
class NodeTags {
 public:
  NodeTags() = default;
  /// @param tags  the numbers, by index; fewer than kNone
  explicit NodeTags(const Array<std::uint64_t>& tags) : count_(tags.size()) {
    if (tags.empty()) return;
    first_ = tags[0];
    std::size_t i = 0;
    while (i < tags.size() && tags[i] == first_ + i) ++i;
    if (i < tags.size()) sortTags(tags);
  }

  /// The index of a tag, or kNone.
  [[nodiscard]] Index find(std::uint64_t tag) const {
    if (sorted_.empty()) return tag - first_ < count_ ? static_cast<Index>(tag - first_) : kNone;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), Entry{tag, 0});
    return found == sorted_.end() || found->first != tag ? kNone : found->second;
  }

  /// An index whose tag occurs earlier as well; kNone if all tags are distinct.
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

  // Consecutive tags from first_ on, the usual case, need no table.
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
  Array<Entry> sorted_;
};

/// Elements of one type, with nodes in VTK order.
struct ElementBlock {
  const VolumeCells* type =
      nullptr;  ///< null for elements that are not volumes; their nodes are not stored
  std::size_t nodesEach = 0;
  Array<Index> nodes;
  std::vector<std::uint64_t> listed;  ///< by the numbers of the file, until nameNodes()
  Array<std::uint64_t> numbers;       ///< per element: its number in the file, to which sides refer
  Array<std::int32_t> regions;        ///< per element

  [[nodiscard]] std::size_t count() const noexcept { return numbers.size(); }
};

/// A face of an element.
struct ElementSide {
  std::uint64_t element = 0;  ///< its number in the file
  std::uint8_t side = 0;      ///< as ElementLists::sideNumbers says; others are ignored
  std::int32_t tag = 0;
};

/// A line, triangle or quad, with the numbers of its corners in the file.
struct FlatElement {
  std::uint64_t number = 0;
  std::size_t corners = 0;
  std::array<std::uint64_t, 4> nodes = {};
};

class ElementTags;

struct NodeSet {
  std::string name;
  std::int32_t number = 0;
  std::vector<Index> nodes;
};

inline constexpr std::uint64_t kAllDigits = ~std::uint64_t{0};

struct ElementLists {
  Array<Vec3> points;
  std::vector<ElementBlock> blocks;
  std::vector<ElementSide> sides;
  SideNumbers sideNumbers = {};
  // Tagged elements other than volumes.
  std::vector<FeatureVertex> vertices;
  std::vector<FeatureFace> triangles;
  std::vector<FeatureQuad> quads;
  std::vector<FeatureEdge> lines;
  std::vector<NodeSet> nodeSets;
  std::vector<TagName> names;
  bool mayBeEmpty = false;  ///< whether the file is a mesh without elements

  /// The index of the block of this type, which is added if there is none.
  [[nodiscard]] std::size_t blockOf(const VolumeCells* type, std::size_t nodesEach);
  /// Stores the name of a group given by another program.
  void addName(int dimension, std::int32_t tag, std::string_view name);
  /// Adds a point, line, triangle or quad, by its number of corners, unless the tag is 0 or a
  /// corner is kNone.
  void addFlat(std::span<const Index> v, std::int32_t tag);
  void addFlat(const FlatElement& element, std::int32_t tag, const NodeTags& nodes);
  /// Sets the nodes of blocks that list their numbers in the file.
  /// @param place  where the file lists nodes, for messages: "*NODE section"
  /// @param digits  bits of numbers that are the file's, for messages
  /// @throws Error IndexOutOfRange
  void nameNodes(const NodeTags& nodes, const Input& input, std::string_view place,
                 std::uint64_t digits = kAllDigits);
  /// Sets the region of each element.
  void setRegions(const ElementTags& tags);
  /// Stores those names whose tag is used by an element of their dimension, 1 to 3.
  void addNamesInUse(const std::vector<TagName>& known);
};

/// Sets one coordinate of all points from number `first` on. The first axis determines their
/// number.
/// @throws Error FileSyntax if another axis has a different number of points; NotFinite; TooLarge
void setCoordinates(ElementLists& lists, std::size_t first, std::size_t axis,
                    const std::vector<double>& numbers, const Input& input);

/// The volume cell type with this name in kVolumeCells.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view plural);
/// The type with this noun ("hexahedra", "tetrahedra", "prisms" or "pyramids") and number of nodes;
/// null if there is none.
[[nodiscard]] const VolumeCells* volumeCells(std::string_view noun, std::size_t nodes);

/// The tag of a group of elements: from a name written by this library, otherwise its number.
[[nodiscard]] std::int32_t tagOfGroup(std::string_view name, std::int64_t number);

/// A group of elements in a file.
struct NumberedGroup {
  std::string name;
  std::int64_t number = 0;
};
/// The tags of all groups of elements of a dimension (-1: any), as by tagOfGroup(), unless this
/// would merge groups: then their numbers.
[[nodiscard]] std::vector<std::int32_t> tagsOfGroups(const std::vector<NumberedGroup>& groups,
                                                     int dimension);

/// Assigns tags to groups: from names written by this library, otherwise consecutive numbers that
/// skip the tags in names.
class GroupTags {
 public:
  /// Must be called for all names before next().
  void reserve(std::string_view name);
  [[nodiscard]] std::int32_t next(std::string_view name);

 private:
  std::set<std::int32_t> taken_;
  std::int32_t last_ = 0;
};

/// Builds the map from node numbers in the file to indices.
/// @param digits  as for nameNodes()
/// @throws Error FileSyntax if two nodes have the same number
[[nodiscard]] NodeTags nodesByNumber(const Array<std::uint64_t>& numbers, const Input& input,
                                     std::uint64_t digits = kAllDigits);

/// Tags of elements by number. The last tag given to an element counts.
class ElementTags {
 public:
  void add(std::uint64_t element, std::int32_t tag) { tags_.emplace_back(element, tag); }
  /// To be called after the last add().
  void sort();
  /// The tag of an element; 0 if it has none.
  [[nodiscard]] std::int32_t find(std::uint64_t element) const;

 private:
  std::vector<std::pair<std::uint64_t, std::int32_t>> tags_;
};

/// Builds a mesh from hexahedra with 8 nodes; other straight cells go into input.others(), if that
/// is not null. Tagged sides become tagged quads and triangles. Node sets named
/// "point_7" by this library, and sets of a single node, become tagged vertices; a set "curve_7"
/// tags the edges between its nodes. Other sets, such as those for loads, are ignored.
/// @throws Error FileUnsupported if there are no such cells, listing those found; TooLarge
[[nodiscard]] HexMesh hexMeshOf(ElementLists&& lists, const Input& input);
/// The same for tetrahedra with 4 nodes.
[[nodiscard]] TetCells tetsOf(ElementLists&& lists, const Input& input);

/// Adds the missing face and interior nodes of order-2 cells, placed by the shape functions of the
/// 20 others; cells share the nodes of common faces.
/// @param nodes  rows of 27 in VTK order
/// @param cells  rows that lack the last 7
void addMiddles(Array<Vec3>& points, Array<Index>& nodes, const std::vector<std::size_t>& cells,
                const std::string& fileName);

/// Converts a mesh whose cells list their nodes in VTK order to that of LagrangeMesh, with vertices
/// before other nodes.
void fromVtkOrder(LagrangeMesh& mesh, Stage& stage, VtkEdges upright = VtkEdges::Around);
/// Renumbers nodes: corners first, otherwise in file order. Drops tags of other nodes.
void putCornersFirst(LagrangeMesh& mesh);

/// Whether there are hexahedra with 20 or, of an order p > 1, (p + 1)^3 nodes.
[[nodiscard]] bool areCurved(const ElementLists& lists);
/// Builds cells of higher order from them; missing nodes of those with 20 are placed by these.
/// @throws Error FileUnsupported if there are other volume cells, or cells of several orders
[[nodiscard]] LagrangeMesh curvedMeshOf(ElementLists&& lists, const Input& input, Stage& stage);

/// What to read of a file: everything, or only types and numbers of elements.
enum class ElementParts : std::uint8_t { All, Types };

/// Reads the lists of one format.
using ReadElementLists = ElementLists (*)(const Input&, ElementParts, Stage&);

/// The entries of a format in the registry, given the function that reads its lists.
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
