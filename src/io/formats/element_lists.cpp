#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/sorted.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

constexpr std::size_t kNodesOfQuadratic = 27;

void count(const ElementLists& lists, const Input& input) {
  for (const ElementBlock& block : lists.blocks) {
    if (block.type != nullptr) input.counts()->add(*block.type, block.count());
  }
}

/// The order of hexahedra of higher order; 0 for other elements.
int curvedOrder(const ElementBlock& block) {
  if (block.type == nullptr || !block.type->plural.starts_with("hexahedra")) return 0;
  const int order = block.nodesEach == 20 ? 2 : orderOfNodes(block.nodesEach);
  return order > 1 ? order : 0;
}

/// "; it holds 2 prisms", or what a file without volumes is.
std::string contentOf(const ElementLists& lists, const Input& input) {
  std::string volumes = input.counts()->instead();
  if (!volumes.empty() || lists.blocks.empty()) return volumes;
  return ", but points, lines, triangles or quads only: a surface, not a volume";
}

[[noreturn]] void failWithout(const CellKind& kind, const ElementLists& lists, const Input& input) {
  std::string sentence = concat(input.name(), ": the file holds no ", kind.plural, " with ",
                                kind.corners, " nodes", contentOf(lists, input), ".");
  if (kind.corners == 8) sentence += input.counts()->adviceOnCurved();
  throw Error(ErrorCode::FileUnsupported, sentence);
}

void clearZeros(Array<std::int32_t>& regions) {
  const auto isZero = [](std::int32_t region) { return region == 0; };
  if (std::all_of(regions.begin(), regions.end(), isZero)) regions.clear();
}

/// Takes the cells of one kind and their regions, and adds their numbers in the file.
template <std::size_t corners>
void takeCells(ElementLists& lists, const Input& input, CellMesh<corners>& mesh,
               Array<std::uint64_t>& numbers) {
  count(lists, input);
  constexpr CellKind kKind = kCellKind<corners>;
  for (ElementBlock& block : lists.blocks) {
    if (block.type == nullptr || block.type->vtkType != kKind.vtkType) continue;
    const std::size_t before = mesh.cells.size();
    mesh.cells.resize(before + block.count());
    if (block.count() > 0) {
      std::copy(block.nodes.begin(), block.nodes.end(), mesh.cells[before].begin());
    }
    numbers.insert(numbers.end(), block.numbers.begin(), block.numbers.end());
    mesh.regions.insert(mesh.regions.end(), block.regions.begin(), block.regions.end());
    block.nodes = {};  // frees its memory
  }
  if (mesh.cells.empty() && !lists.mayBeEmpty) failWithout(kKind, lists, input);
  clearZeros(mesh.regions);
  mesh.points = std::move(lists.points);
}

/// The same for other cells.
void takeOthers(ElementLists& lists, OtherCells& others, Array<std::uint64_t>& numbers) {
  for (OtherCellList& kind : others.kinds) {
    for (ElementBlock& block : lists.blocks) {
      if (block.type != &typeWith(kind.corners)) continue;
      kind.vertices.insert(kind.vertices.end(), block.nodes.begin(), block.nodes.end());
      kind.regions.insert(kind.regions.end(), block.regions.begin(), block.regions.end());
      numbers.insert(numbers.end(), block.numbers.begin(), block.numbers.end());
    }
    clearZeros(kind.regions);
  }
}

/// Tagged quads and triangles. Sides win over elements with the same vertices.
/// @param cellAt  returns the corners of a cell
template <class CellAt>
void takeFaces(const ElementLists& lists, const Array<std::uint64_t>& numbers, const CellAt& cellAt,
               std::vector<FeatureQuad>& quads, std::vector<FeatureFace>& triangles) {
  const NodeTags cells(lists.sides.empty() ? Array<std::uint64_t>() : numbers);
  for (const ElementSide& side : lists.sides) {
    const Index cell = cells.find(side.element);
    if (cell == kNone || side.tag == 0) continue;
    const std::span<const Index> corners = cellAt(cell);
    const auto& known = lists.sideNumbers[corners.size()];
    const auto* const face = std::find(known.begin(), known.end(), side.side);
    if (face == known.end()) continue;  // a side of another kind of cells
    const Quad v = faceAt(corners, static_cast<std::size_t>(face - known.begin()));
    if (cornersOf(v) == 4) quads.push_back({v, side.tag});
    if (cornersOf(v) == 3) triangles.push_back({{v[0], v[1], v[2]}, side.tag});
  }
  const auto addElements = [](const auto& elements, auto& faces) {
    const bool both = !faces.empty() && !elements.empty();
    faces.insert(faces.end(), elements.begin(), elements.end());
    if (both) removeRepeated(faces);
  };
  addElements(lists.quads, quads);
  addElements(lists.triangles, triangles);
}

std::vector<FeatureVertex> vertexTagsOf(const ElementLists& lists) {
  std::vector<FeatureVertex> vertices = lists.vertices;
  for (const NodeSet& set : lists.nodeSets) {
    if (set.nodes.size() != 1 && !set.name.starts_with("point_")) continue;
    const std::int32_t tag = tagOfGroup(set.name, set.number);
    if (tag == 0 || set.name.starts_with("curve_")) continue;
    for (const Index node : set.nodes) vertices.push_back({node, tag});
  }
  return vertices;
}

/// Names of regions and faces, and of sets of one node.
std::vector<TagName> namesOf(ElementLists& lists) {
  for (const NodeSet& set : lists.nodeSets) {
    if (set.nodes.size() == 1) lists.addName(0, set.number, set.name);
  }
  return std::move(lists.names);
}

/// The cell edges between nodes of sets that name curves.
template <class CellAt>
std::vector<FeatureEdge> edgesOf(const ElementLists& lists, std::size_t cells,
                                 const CellAt& cellAt) {
  std::vector<std::pair<Index, std::int32_t>> members;  // nodes, and tags of their curves
  for (const NodeSet& set : lists.nodeSets) {
    const std::int32_t tag = set.name.starts_with("curve_") ? tagOfGroup(set.name, 0) : 0;
    if (tag == 0) continue;
    for (const Index node : set.nodes) members.emplace_back(node, tag);
  }
  sortUnique(members);
  const auto curvesAt = [&members](Index node) {
    return std::lower_bound(members.begin(), members.end(),
                            std::pair(node, std::numeric_limits<std::int32_t>::min()));
  };
  std::vector<std::pair<std::int32_t, std::array<Index, 2>>> found;
  const auto addEdge = [&](Index a, Index b) {
    for (auto at = curvesAt(a); at != members.end() && at->first == a; ++at) {
      if (std::binary_search(members.begin(), members.end(), std::pair(b, at->second))) {
        found.push_back({at->second, {a, b}});
      }
    }
  };
  for (std::size_t c = 0; c < (members.empty() ? 0 : cells); ++c) {
    const std::span<const Index> cell = cellAt(c);
    for (std::size_t face = 0; face < kFaceCounts[cell.size()]; ++face) {
      const Quad v = faceAt(cell, face);
      for (std::size_t k = 0; k < 4; ++k) {  // each edge is seen from two faces
        if (v[k] < v[(k + 1) % 4]) addEdge(v[k], v[(k + 1) % 4]);
      }
    }
  }
  sortUnique(found);
  std::vector<FeatureEdge> features = lists.lines;
  for (const auto& [tag, edge] : found) features.push_back({edge, tag});
  return features;
}

/// @param cellAt  cellAt(i): the corners of the cell with numbers[i]
template <class CellAt>
HexFeatures hexFeaturesOf(ElementLists& lists, const Array<std::uint64_t>& numbers,
                          const CellAt& cellAt, std::vector<FeatureFace>& triangles) {
  HexFeatures features = {vertexTagsOf(lists), edgesOf(lists, numbers.size(), cellAt), {}, {}};
  takeFaces(lists, numbers, cellAt, features.quads, triangles);
  features.names = namesOf(lists);
  return features;
}

/// A face without a midpoint node: its sorted corners and its location.
struct NodelessFace {
  Quad corners{};
  std::size_t cell = 0;
  std::size_t face = 0;

  friend bool operator<(const NodelessFace& a, const NodelessFace& b) {
    return std::pair(a.corners, a.cell) < std::pair(b.corners, b.cell);
  }
};

/// The index of the edge between two corners, in VTK's order for cells with 20 nodes.
std::size_t edgeBetween(std::size_t a, std::size_t b) {
  constexpr std::array<std::size_t, 12> kPlaces = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 10};
  for (std::size_t e = 0; e < kPlaces.size(); ++e) {
    const auto& [from, to] = adjacency::kHexEdges[e];
    if ((from == a && to == b) || (from == b && to == a)) return kPlaces[e];
  }
  return 0;  // unreachable: consecutive corners of a face always share an edge
}

/// The midpoint of a face, by the shape functions of 20 nodes.
Vec3 middleOf(const Array<Vec3>& points, const Index* nodes, std::size_t face) {
  Vec3 middle{};
  const auto& corners = adjacency::kHexFaces[face];
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& corner = points[nodes[corners[k]]];
    const Vec3& edge = points[nodes[8 + edgeBetween(corners[k], corners[(k + 1) % 4])]];
    for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += edge[axis] / 2 - corner[axis] / 4;
  }
  return middle;
}

/// The midpoint of a cell, likewise.
Vec3 middleOf(const Array<Vec3>& points, const Index* nodes) {
  Vec3 middle{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 8; ++k) middle[axis] -= points[nodes[k]][axis] / 4;
    for (std::size_t k = 8; k < 20; ++k) middle[axis] += points[nodes[k]][axis] / 4;
  }
  return middle;
}

void requireIndexable(std::size_t points, const std::string& fileName) {
  if (points <= kNone) return;
  throw Error(ErrorCode::TooLarge, fileName + ": the mesh has more nodes than are supported.");
}

}  // namespace

void addMiddles(Array<Vec3>& points, Array<Index>& nodes, const std::vector<std::size_t>& cells,
                const std::string& fileName) {
  std::vector<NodelessFace> faces;
  for (const std::size_t cell : cells) {
    const Index* const row = nodes.data() + kNodesOfQuadratic * cell;
    for (std::size_t face = 0; face < 6; ++face) {
      NodelessFace& added = faces.emplace_back(NodelessFace{{}, cell, face});
      for (std::size_t k = 0; k < 4; ++k) added.corners[k] = row[adjacency::kHexFaces[face][k]];
      std::sort(added.corners.begin(), added.corners.end());
    }
  }
  std::sort(faces.begin(), faces.end());
  requireIndexable(points.size() + faces.size() + cells.size(), fileName);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Index* const row = nodes.data() + kNodesOfQuadratic * faces[i].cell;
    if (i == 0 || faces[i].corners != faces[i - 1].corners) {
      points.push_back(middleOf(points, row, faces[i].face));
    }
    row[20 + faces[i].face] = static_cast<Index>(points.size() - 1);
  }
  for (const std::size_t cell : cells) {
    Index* const row = nodes.data() + kNodesOfQuadratic * cell;
    points.push_back(middleOf(points, row));
    row[kNodesOfQuadratic - 1] = static_cast<Index>(points.size() - 1);
  }
}

const VolumeCells* volumeCells(std::string_view plural) {
  const auto* const found =
      std::find_if(kVolumeCells.begin(), kVolumeCells.end(),
                   [&](const VolumeCells& type) { return type.plural == plural; });
  return found == kVolumeCells.end() ? nullptr : found;
}

const VolumeCells* volumeCells(std::string_view noun, std::size_t nodes) {
  const VolumeCells* const straight = volumeCells(noun);
  return straight != nullptr && straight->meditVertices == nodes
             ? straight
             : volumeCells(concat(noun, " with ", nodes, " nodes"));
}

std::size_t ElementLists::blockOf(const VolumeCells* type, std::size_t nodesEach) {
  std::size_t i = 0;
  while (i < blocks.size() && blocks[i].type != type) ++i;
  if (i == blocks.size()) {
    ElementBlock& added = blocks.emplace_back();
    added.type = type;
    added.nodesEach = nodesEach;
  }
  return i;
}

void ElementLists::addName(int dimension, std::int32_t tag, std::string_view name) {
  if (tag == 0 || name.empty() || tagInGroupName(name, dimension)) return;
  names.push_back({dimension, tag, std::string(name)});
}

void ElementLists::addFlat(std::span<const Index> v, std::int32_t tag) {
  if (tag == 0 || std::find(v.begin(), v.end(), kNone) != v.end()) return;
  if (v.size() == 1) vertices.push_back({v[0], tag});
  if (v.size() == 2) lines.push_back({{v[0], v[1]}, tag});
  if (v.size() == 3) triangles.push_back({{v[0], v[1], v[2]}, tag});
  if (v.size() == 4) quads.push_back({{v[0], v[1], v[2], v[3]}, tag});
}

void ElementLists::addFlat(const FlatElement& element, std::int32_t tag, const NodeTags& nodes) {
  std::array<Index, 4> v{};
  for (std::size_t k = 0; k < element.corners; ++k) v[k] = nodes.find(element.nodes[k]);
  addFlat(std::span(v).first(element.corners), tag);
}

void ElementLists::setRegions(const ElementTags& tags) {
  for (ElementBlock& block : blocks) {
    block.regions.clear();
    for (const std::uint64_t number : block.numbers) block.regions.push_back(tags.find(number));
  }
}

void ElementLists::addNamesInUse(const std::vector<TagName>& known) {
  std::set<std::pair<int, std::int32_t>> used;
  for (const ElementBlock& block : blocks) {
    for (const std::int32_t region : block.regions) used.emplace(3, region);
  }
  for (const FeatureEdge& line : lines) used.emplace(1, line.tag);
  for (const FeatureFace& triangle : triangles) used.emplace(2, triangle.tag);
  for (const FeatureQuad& quad : quads) used.emplace(2, quad.tag);
  for (const TagName& each : known) {
    if (used.contains({each.dimension, each.tag})) addName(each.dimension, each.tag, each.name);
  }
}

void setCoordinates(ElementLists& lists, std::size_t first, std::size_t axis,
                    const std::vector<double>& numbers, const Input& input) {
  requireIndexable(first + numbers.size(), input.name());
  if (axis == 0) lists.points.resize(first + numbers.size());
  if (first + numbers.size() != lists.points.size()) {
    input.fail(ErrorCode::FileSyntax, "the axes have different numbers of coordinates.");
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    lists.points[first + i][axis] = numbers[i];
    if (std::isfinite(numbers[i])) continue;
    throw Error(ErrorCode::NotFinite,
                concat(input.name(), ": a coordinate of node ", i + 1, " is not finite."),
                Place{PlaceKind::Vertex, first + i});
  }
}

void GroupTags::reserve(std::string_view name) {
  if (const auto tag = tagInGroupName(name)) taken_.insert(*tag);
}

std::int32_t GroupTags::next(std::string_view name) {
  if (const auto tag = tagInGroupName(name)) return *tag;
  do {
    ++last_;
  } while (taken_.contains(last_));
  return last_;
}

std::int32_t tagOfGroup(std::string_view name, std::int64_t number) {
  const auto tag = tagInGroupName(name);
  if (tag) return *tag;
  return std::in_range<std::int32_t>(number) ? static_cast<std::int32_t>(number) : 0;
}

std::vector<std::int32_t> tagsOfGroups(const std::vector<NumberedGroup>& groups, int dimension) {
  std::vector<std::int32_t> named;
  std::vector<std::int32_t> numbers;
  std::map<std::int32_t, std::int64_t> distinct;  // tags, and numbers of their groups
  bool merges = false;
  for (const NumberedGroup& group : groups) {
    const bool isOwn = tagInGroupName(group.name, dimension).has_value();
    named.push_back(tagOfGroup(isOwn ? group.name : std::string(), group.number));
    numbers.push_back(named.back() == 0 ? 0 : tagOfGroup({}, group.number));
    const auto known = distinct.emplace(named.back(), group.number).first;
    merges = merges || (named.back() != 0 && known->second != group.number);
  }
  return merges ? numbers : named;
}

NodeTags nodesByNumber(const Array<std::uint64_t>& numbers, const Input& input,
                       std::uint64_t digits) {
  requireIndexable(numbers.size(), input.name());
  NodeTags nodes(numbers);
  if (const Index repeated = nodes.repeated(); repeated != kNone) {
    input.fail(ErrorCode::FileSyntax, "two nodes have the number ", numbers[repeated] & digits,
               ". If the file has several parts, export it as one mesh, without parts.");
  }
  return nodes;
}

void ElementLists::nameNodes(const NodeTags& nodes, const Input& input, std::string_view place,
                             std::uint64_t digits) {
  for (ElementBlock& block : blocks) {
    const std::vector<std::uint64_t> numbers = std::exchange(block.listed, {});
    block.nodes.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      block.nodes[i] = nodes.find(numbers[i]);
      if (block.nodes[i] != kNone) continue;
      input.fail(ErrorCode::IndexOutOfRange, "element ",
                 block.numbers[i / block.nodesEach] & digits, " names node ", numbers[i] & digits,
                 ", which is in no ", place, ".");
    }
  }
}

void ElementTags::sort() {
  std::stable_sort(tags_.begin(), tags_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

std::int32_t ElementTags::find(std::uint64_t element) const {
  const auto behind =
      std::upper_bound(tags_.begin(), tags_.end(), element,
                       [](std::uint64_t number, const auto& tag) { return number < tag.first; });
  const bool found = behind != tags_.begin() && std::prev(behind)->first == element;
  return found ? std::prev(behind)->second : 0;
}

HexMesh hexMeshOf(ElementLists&& lists, const Input& input) {
  HexMesh mesh;
  Array<std::uint64_t> numbers;
  takeCells<8>(lists, input, mesh, numbers);
  OtherCells unwanted;
  OtherCells& others = input.others() != nullptr ? *input.others() : unwanted;
  if (input.others() != nullptr) takeOthers(lists, others, numbers);
  const AllCells cells(mesh, others);
  const auto cellAt = [&cells](std::size_t i) { return cells[i]; };
  mesh.features = hexFeaturesOf(lists, numbers, cellAt, others.triangles);
  return mesh;
}

TetCells tetsOf(ElementLists&& lists, const Input& input) {
  TetCells tets;
  Array<std::uint64_t> numbers;
  takeCells<4>(lists, input, tets, numbers);
  std::vector<FeatureFace> triangles;
  const auto cellAt = [&tets](std::size_t i) { return std::span<const Index>(tets.cells[i]); };
  HexFeatures features = hexFeaturesOf(lists, numbers, cellAt, triangles);
  tets.features = {std::move(features.vertices), std::move(features.edges), std::move(triangles),
                   std::move(features.names)};
  return tets;
}

bool areCurved(const ElementLists& lists) {
  return std::any_of(lists.blocks.begin(), lists.blocks.end(), [](const ElementBlock& block) {
    return curvedOrder(block) > 0 && block.count() > 0;
  });
}

LagrangeMesh curvedMeshOf(ElementLists&& lists, const Input& input, Stage& stage) {
  count(lists, input);
  LagrangeMesh mesh;
  mesh.order = 0;
  Array<std::uint64_t> numbers;
  std::vector<std::size_t> lacking;  // cells with 20 nodes
  for (const ElementBlock& block : lists.blocks) {
    if (block.type == nullptr || block.count() == 0) continue;
    const int order = curvedOrder(block);
    if (mesh.order == 0) mesh.order = order;
    if (order == 0 || order != mesh.order) {
      input.fail(ErrorCode::FileUnsupported,
                 "cells of higher order must be hexahedra of one order" +
                     input.counts()->instead() + ". Give the others a file of their own.");
    }
    const std::size_t perCell = mesh.nodesPerCell();
    mesh.nodes.resize(perCell * (numbers.size() + block.count()));
    for (std::size_t i = 0; i < block.count(); ++i) {
      if (block.nodesEach < perCell) lacking.push_back(numbers.size());
      std::copy_n(block.nodes.begin() + static_cast<std::ptrdiff_t>(block.nodesEach * i),
                  block.nodesEach,
                  mesh.nodes.begin() + static_cast<std::ptrdiff_t>(perCell * numbers.size()));
      numbers.push_back(block.numbers[i]);
      mesh.regions.push_back(block.regions[i]);
    }
  }
  if (numbers.empty()) {
    input.fail(ErrorCode::FileUnsupported,
               "the file holds no hexahedra of higher order" + contentOf(lists, input) + ".");
  }
  clearZeros(mesh.regions);
  mesh.points = std::move(lists.points);
  addMiddles(mesh.points, mesh.nodes, lacking, input.name());
  const auto cellAt = [&mesh](std::size_t i) {
    return std::span<const Index>(mesh.nodes).subspan(mesh.nodesPerCell() * i, 8);
  };
  std::vector<FeatureFace> triangles;  // of other cells, which there are none of
  mesh.features = hexFeaturesOf(lists, numbers, cellAt, triangles);
  fromVtkOrder(mesh, stage);
  return mesh;
}

}  // namespace hexhex::io
