// Reads and writes MFEM meshes (see formats.hpp): straight cells, Lagrange cells, and parts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

// Reading.

/// The number of vertices of an element, and what volume it is, by MFEM's number of its geometry.
struct MfemGeometry {
  std::size_t vertices;
  std::string_view volume = {};
};
constexpr std::array<MfemGeometry, 8> kMfemGeometries = {
    {{1}, {2}, {3}, {4}, {4, "tetrahedra"}, {8, "hexahedra"}, {6, "prisms"}, {5, "pyramids"}}};

/// A space of nodes: of vertices, edges, faces and cells; or of each cell, x fastest. Nodes are at
/// the points of Gauss and Lobatto, or at the same distances; up to order 2, these are the same.
struct MfemSpace {
  std::string_view name;  ///< but for the order
  bool perCell = false;
  bool isEqual = false;
  int order = 0;
};
constexpr std::array<MfemSpace, 6> kMfemSpaces = {{{"Linear", false, true, 1},
                                                   {"Quadratic", false, true, 2},
                                                   {"H1_3D_P"},
                                                   {"H1@U_3D_P", false, true},
                                                   {"L2_T1_3D_P", true},
                                                   {"L2_T4_3D_P", true, true}}};

std::optional<MfemSpace> mfemSpace(std::string_view name) {
  for (MfemSpace space : kMfemSpaces) {
    if (!name.starts_with(space.name)) continue;
    const std::string_view digit = name.substr(space.name.size());
    if (space.order > 0 && digit.empty()) return space;
    if (space.order > 0) continue;
    space.order = digit.size() == 1 ? digit[0] - '0' : 0;
    if (space.order >= 1 && space.order <= kMaxOrder) return space;
  }
  return std::nullopt;
}

/// Row i: the polynomials that are 1 at one of the points of Gauss and Lobatto in [0, 1] and 0 at
/// the others, at i / order.
std::vector<double> valuesFromLobatto(int order) {
  const auto n = static_cast<std::size_t>(order) + 1;
  std::vector<double> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * static_cast<double>(i) / order);
    constexpr int kSteps = 20;  // of Newton's method, to the zeros of (1 - x^2) P'(x)
    for (int step = 0; step < kSteps; ++step) {
      double before = 1;  // Legendre's polynomials
      double last = x;
      for (int k = 2; k <= order; ++k) {
        before = std::exchange(last, ((2 * k - 1) * x * last - (k - 1) * before) / k);
      }
      x -= (x * last - before) / ((order + 1) * last);
    }
    points[i] = (1 + x) / 2;
  }
  std::vector<double> values(n * n, 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = i / n;
    const double place = static_cast<double>(row) / order;
    for (std::size_t k = 0; k < n; ++k) {
      if (k != i % n) values[i] *= (place - points[k]) / (points[i % n] - points[k]);
    }
  }
  return values;
}

/// Numbers elements in the order in which they are first met.
template <class Element>
class FirstMet {
 public:
  [[nodiscard]] Index number(Element element) {
    std::sort(element.begin(), element.end());
    return numbers_.try_emplace(element, static_cast<Index>(numbers_.size())).first->second;
  }
  [[nodiscard]] std::size_t size() const noexcept { return numbers_.size(); }

 private:
  std::map<Element, Index> numbers_;
};

/// Numbers the nodes inside edges and faces of cells as MFEM does, from 0 on for each: from the
/// smaller vertex of an edge, and as the first cell of a face lists its vertices.
class NodeNumbers {
 public:
  explicit NodeNumbers(int order) : order_(order), slots_(nodesOfOrder(order)) {
    const std::vector<std::uint32_t> places = vtkNodeOrder(order);
    for (std::size_t k = 0; k < places.size(); ++k) slots_[places[k]] = k;
  }
  [[nodiscard]] std::size_t ofEdges() const { return edges_.size() * inner(); }
  [[nodiscard]] std::size_t ofFaces() const { return faces_.size() * inner() * inner(); }

  /// @param corners  of a cell
  /// @param[out] nodes  of the cell, in VTK's order
  void numberEdges(const Index* corners, Index* nodes) {
    for (std::size_t e = 0; e < 12; ++e) {  // around the bottom, around the top, upright
      std::size_t from = e % 4 + (e / 4 == 1 ? 4 : 0);
      std::size_t to = e < 8 ? (e % 4 + 1) % 4 + (e < 4 ? 0 : 4) : from + 4;
      if (corners[from] > corners[to]) std::swap(from, to);
      number(nodes, {from, to, from}, inner() * edges_.number({corners[from], corners[to]}));
    }
  }
  /// @return  false if a cell before has the vertices of a face, but not its edges
  [[nodiscard]] bool numberFaces(const Index* corners, Index* nodes) {
    constexpr std::array<std::array<std::uint8_t, 4>, 6> kFaces = {
        {{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}};
    for (const auto& face : kFaces) {
      const Quad v = {corners[face[0]], corners[face[1]], corners[face[2]], corners[face[3]]};
      const Index met = faces_.number(v);
      if (met == begins_.size()) begins_.push_back({v[0], v[1], v[3]});
      const auto& [a, b, d] = begins_[met];
      const auto at = static_cast<std::size_t>(std::find(v.begin(), v.end(), a) - v.begin());
      std::array<std::size_t, 2> sides = {(at + 1) % 4, (at + 3) % 4};
      if (v[sides[0]] != b) std::swap(sides[0], sides[1]);
      if (v[sides[0]] != b || v[sides[1]] != d) return false;
      number(nodes, {face[at], face[sides[0]], face[sides[1]]}, inner() * inner() * met);
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t inner() const { return static_cast<std::size_t>(order_) - 1; }

  /// Numbers the nodes from a corner to another and, of a face, row by row to a third one.
  /// @param corners  the third is the first, of an edge
  void number(Index* nodes, const std::array<std::size_t, 3>& corners, std::size_t first) const {
    const int at = placeOf(corners[0]);
    const int lastRow = corners[2] == corners[0] ? 0 : order_ - 1;
    for (int j = std::min(1, lastRow); j <= lastRow; ++j) {
      for (int i = 1; i < order_; ++i) {
        const int place =
            order_ * at + i * (placeOf(corners[1]) - at) + j * (placeOf(corners[2]) - at);
        nodes[slots_[static_cast<std::size_t>(place)]] = static_cast<Index>(first++);
      }
    }
  }
  /// Of a corner of a cell of one step.
  [[nodiscard]] int placeOf(std::size_t k) const { return nodePlace(corner(k, 0, 1), order_); }

  int order_;
  std::vector<std::size_t> slots_;  ///< in VTK's order, of nodes with x fastest
  FirstMet<std::array<Index, 2>> edges_;
  FirstMet<Quad> faces_;
  std::vector<std::array<Index, 3>> begins_;  ///< of faces: a vertex and its neighbours
};

/// Replaces nodes of a cell, x fastest, by the values of rows of polynomials along each axis.
void evaluate(const std::vector<double>& rows, std::size_t n, std::vector<Vec3>& nodes) {
  for (const std::size_t stride : {std::size_t{1}, n, n * n}) {
    const std::vector<Vec3> from = std::exchange(nodes, std::vector<Vec3>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t at = i / stride % n;
      for (std::size_t k = 0; k < n; ++k) {
        nodes[i] = plus(nodes[i], times(rows[at * n + k], from[i - at * stride + k * stride]));
      }
    }
  }
}

constexpr std::string_view kMfemCollection = "FiniteElementCollection:";
constexpr std::size_t kFewestBytesOfNode = 6;  // "0 0 0" and the line's end

class MfemReader {
 public:
  MfemReader(const Input& input, Stage& stage)
      : input_(input),
        scanner_(input.text(room_, stage, "M"), input.name(), TextScanner::Comments::Hash) {}

  ElementLists read() {
    constexpr std::string_view kMfemHead = "MFEM mesh v1.";
    if (!scanner_.takeLine().starts_with(kMfemHead)) {
      input_.fail(ErrorCode::FileUnsupported, "the file does not begin with \"", kMfemHead,
                  "0\": other files of MFEM, such as NURBS and nonconforming meshes, are not "
                  "read. Save the mesh as .vtk (Mesh::PrintVTK).");
    }
    for (std::string_view word = scanner_.readToken(); !word.empty(); word = scanner_.readToken()) {
      if (word.starts_with("mfem_")) break;  // mfem_mesh_end, mfem_serial_mesh_end
      readSection(word);
    }
    if (!hasVertices_) scanner_.failToken("the section \"vertices\"");
    lists_.mayBeEmpty = lists_.blocks.empty() && !hasFaces_;
    return std::move(lists_);
  }

  /// The types of the cells alone.
  ElementLists readTypes() {
    const std::string_view text = scanner_.text();
    const std::size_t at = text.find(kMfemCollection);
    if (at < text.size()) scanner_.moveTo(at + kMfemCollection.size());
    std::optional<MfemSpace> space;
    if (at < text.size()) space = mfemSpace(scanner_.readToken());
    const std::size_t nodesEach = nodesOfOrder(space ? space->order : 1);
    const std::size_t block = lists_.blockOf(volumeCells("hexahedra", nodesEach), nodesEach);
    lists_.blocks[block].numbers = {0};
    return std::move(lists_);
  }

 private:
  void readSection(std::string_view word) {
    if ((word == "nodes") != hasVertices_) {
      scanner_.fail(ErrorCode::FileSyntax, "the section ", quoted(word), " is out of order: only ",
                    "nodes follow the vertices.");
    }
    if (word == "dimension") {
      if (scanner_.integer("the dimension") == 3) return;
      scanner_.fail(ErrorCode::FileUnsupported, "the dimension must be 3.");
    }
    if (word == "elements" || word == "boundary") return readElements();
    if (word == "attribute_sets") return readNames(3);
    if (word == "bdr_attribute_sets") return readNames(2);
    if (word == "vertices") return readVertices();
    if (word == "nodes") return readNodes();
    scanner_.failToken("a section of an MFEM mesh");
  }

  void readElements() {
    const std::size_t count = scanner_.readCount("elements", 6);  // bytes of "1 0 0" and a line end
    for (std::size_t i = 0; i < count; ++i) {
      const auto attribute = static_cast<std::int32_t>(
          std::clamp<std::int64_t>(scanner_.integer({"the attribute of ", "element", i}), 0,
                                   std::numeric_limits<std::int32_t>::max()));
      const std::int64_t type = scanner_.integer({"the geometry of ", "element", i});
      if (type < 0 || type >= std::int64_t{kMfemGeometries.size()}) {
        scanner_.fail(ErrorCode::FileSyntax, "there is no geometry ", type, " in MFEM.");
      }
      const auto& [size, volume] = kMfemGeometries[static_cast<std::size_t>(type)];
      std::array<Index, 8> vertices{};
      for (std::size_t k = 0; k < size; ++k) {
        const std::int64_t vertex = scanner_.integer({"a vertex of ", "element", i});
        if (vertex < 0 || vertex >= kNone) failVertex(vertex);
        vertices[k] = static_cast<Index>(vertex);
        vertexEnd_ = std::max(vertexEnd_, std::size_t{vertices[k]} + 1);
      }
      if (!volume.empty()) {
        ElementBlock& block = lists_.blocks[lists_.blockOf(volumeCells(volume), size)];
        block.nodes.insert(block.nodes.end(), vertices.begin(), vertices.begin() + size);
        block.numbers.push_back(i);
        block.regions.push_back(attribute);
      } else if (size == 3) {
        lists_.triangles.push_back({{vertices[0], vertices[1], vertices[2]}, attribute});
      } else if (size == 4) {
        lists_.quads.push_back({{vertices[0], vertices[1], vertices[2], vertices[3]}, attribute});
      }
    }
  }

  /// Sets of attributes have names; a set of one names it.
  void readNames(int dimension) {
    const std::size_t count = scanner_.readCount("sets of attributes", 4);
    for (std::size_t i = 0; i < count; ++i) {
      static_cast<void>(scanner_.peekToken());
      const std::string_view line = scanner_.takeLine();
      const std::size_t end = line.rfind('"');
      if (!line.starts_with('"') || end == 0) scanner_.failToken("a name in quotes");
      // Numbers may be on the same line or, as MFEM writes them, on the next ones.
      scanner_.moveTo(static_cast<std::size_t>(line.data() - scanner_.text().data()) + end + 1);
      const std::size_t size = scanner_.readCount("attributes of a set", 2);
      std::int64_t tag = 0;
      for (std::size_t k = 0; k < size; ++k) tag = scanner_.integer("an attribute");
      if (size != 1 || !std::in_range<std::int32_t>(tag)) continue;
      lists_.addName(dimension, static_cast<std::int32_t>(tag), line.substr(1, end - 1));
    }
  }

  void readVertices() {
    hasVertices_ = true;
    lists_.points.resize(scanner_.readCount("vertices", kFewestBytesOfNode));
    if (vertexEnd_ > lists_.points.size()) failVertex(static_cast<std::int64_t>(vertexEnd_) - 1);
    hasFaces_ = !lists_.quads.empty() || !lists_.triangles.empty();
    clearIfAllOnes();
    if (scanner_.peekToken() == "nodes") return;
    if (scanner_.integer("the number of coordinates") != 3) {
      scanner_.fail(ErrorCode::FileUnsupported, "vertices must have 3 coordinates.");
    }
    for (std::size_t i = 0; i < lists_.points.size(); ++i) {
      for (double& x : lists_.points[i]) x = scanner_.number({"a coordinate of ", "vertex", i});
    }
  }

  [[noreturn]] void failVertex(std::int64_t vertex) const {
    scanner_.fail(ErrorCode::IndexOutOfRange, "an element names vertex ", vertex,
                  ", which does not exist; they are numbered from 0.");
  }

  void readNodes() {
    const auto take = [&](std::string_view word) {
      if (scanner_.readToken() != word) scanner_.failToken(concat("\"", word, "\""));
    };
    take("FiniteElementSpace");
    take(kMfemCollection);
    const std::optional<MfemSpace> space = mfemSpace(scanner_.readToken());
    if (!space) {
      scanner_.fail(ErrorCode::FileUnsupported, "nodes of the space ",
                    quoted(scanner_.currentToken()),
                    " are not read, only those of orders 1 to 9 in H1 and, with closed bases, in "
                    "L2: use Mesh::SetCurvature(2).");
    }
    take("VDim:");
    take("3");
    take("Ordering:");
    const bool byNode = scanner_.integer("the ordering") == 1;
    placeNodes(*space, byNode);
  }

  /// Reads the nodes, and makes the cells list them.
  void placeNodes(const MfemSpace& space, bool byNode) {
    const std::size_t each = nodesOfOrder(space.order);
    if (space.order > 1 || space.perCell) requireHexahedraOnly();
    ElementBlock none;
    ElementBlock& cells = lists_.blocks.empty() ? none : lists_.blocks[0];
    if (space.order > 1) addNodes(cells, space.order);
    const std::size_t dofs = space.perCell ? each * cells.count() : lists_.points.size();
    requireRoom(dofs);
    std::vector<double> numbers(3 * dofs);
    for (double& x : numbers) x = scanner_.number("a coordinate of a node");
    const auto nodeAt = [&](std::size_t i) {
      if (byNode) return Vec3{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
      return Vec3{numbers[i], numbers[dofs + i], numbers[2 * dofs + i]};
    };
    for (std::size_t i = 0; i < dofs && !space.perCell; ++i) lists_.points[i] = nodeAt(i);
    const bool moves = space.order > 2 && !space.isEqual;
    if (!space.perCell && !moves) return;
    const std::vector<double> rows = valuesFromLobatto(space.order);
    const std::vector<std::uint32_t> order = vtkNodeOrder(space.order);
    std::vector<bool> known(lists_.points.size(), false);
    std::vector<Vec3> nodes(each);
    for (std::size_t c = 0; c < cells.count(); ++c) {
      const Index* const row = cells.nodes.data() + each * c;
      for (std::size_t k = 0; k < each; ++k) {
        nodes[order[k]] = nodeAt(space.perCell ? each * c + order[k] : row[k]);
      }
      if (moves) {
        evaluate(rows, static_cast<std::size_t>(space.order) + 1, nodes);
        requireFinite(nodes, c);
      }
      for (std::size_t k = 0; k < each; ++k) {
        Vec3& point = lists_.points[row[k]];
        if (!known[row[k]]) point = nodes[order[k]];
        known[row[k]] = true;
        if (space.perCell) requireSame(point, nodes[order[k]]);
      }
    }
  }

  void requireRoom(std::size_t nodes) const {
    const std::size_t room = (scanner_.text().size() - scanner_.position()) / kFewestBytesOfNode;
    if (nodes <= room) return;
    scanner_.fail(ErrorCode::FileSyntax, lacksRoom(std::to_string(nodes), "nodes", room));
  }

  void requireFinite(const std::vector<Vec3>& nodes, std::size_t cell) const {
    if (std::all_of(nodes.begin(), nodes.end(), [](const Vec3& node) { return isFinite(node); })) {
      return;
    }
    scanner_.fail(ErrorCode::NotFinite, Place{PlaceKind::Cell, cell}, "a node of cell ", cell,
                  " is not finite between the places that the file gives.");
  }

  void requireHexahedraOnly() const {
    const bool others = std::any_of(lists_.blocks.begin(), lists_.blocks.end(),
                                    [](const auto& block) { return block.nodesEach != 8; });
    if (!others) return;
    scanner_.fail(ErrorCode::FileUnsupported,
                  "nodes of cells other than hexahedra are not read. Give these a file of their "
                  "own.");
  }

  /// Cells of a periodic mesh have common vertices at different places.
  void requireSame(const Vec3& a, const Vec3& b) const {
    constexpr double kRounding = 1e-9;  // of nodes computed cell by cell
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::abs(a[k] - b[k]) <= kRounding * std::max(1.0, std::abs(a[k]))) continue;
      scanner_.fail(ErrorCode::FileUnsupported,
                    "cells have a common node at different places, as in a periodic mesh.");
    }
  }

  /// Adds nodes of edges, faces and cells, in this order.
  void addNodes(ElementBlock& cells, int order) {
    const std::size_t each = nodesOfOrder(order);
    const auto inner = static_cast<std::size_t>(order) - 1;  // nodes of an edge
    const Array<Index> corners = std::exchange(cells.nodes, {});
    const std::size_t count = cells.count();
    requireRoom(inner * inner * inner * count);
    cells.nodes.resize(each * count);
    NodeNumbers numbers(order);
    for (std::size_t c = 0; c < count; ++c) {
      const Index* const cell = corners.data() + 8 * c;
      Index* const row = cells.nodes.data() + each * c;
      std::copy_n(cell, 8, row);
      numbers.numberEdges(cell, row);
      if (numbers.numberFaces(cell, row)) continue;
      scanner_.fail(ErrorCode::FileSyntax,
                    "two cells have the vertices of a face in common, but not its edges.");
    }
    const std::size_t firstEdge = lists_.points.size();
    const std::size_t firstFace = firstEdge + numbers.ofEdges();
    std::size_t end = firstFace + numbers.ofFaces();
    for (std::size_t c = 0; c < count; ++c) {
      Index* const row = cells.nodes.data() + each * c;
      Index* const onFaces = row + 8 + 12 * inner;
      Index* const inside = onFaces + 6 * inner * inner;
      for (Index* node = row + 8; node < onFaces; ++node) *node += static_cast<Index>(firstEdge);
      for (Index* node = onFaces; node < inside; ++node) *node += static_cast<Index>(firstFace);
      for (Index* node = inside; node < row + each; ++node) *node = static_cast<Index>(end++);
    }
    cells.type = volumeCells("hexahedra", each);
    cells.nodesEach = each;
    lists_.points.resize(end);
  }

  /// Clears attributes that are all 1, as of meshes without regions or tags.
  void clearIfAllOnes() {
    const auto isOne = [](std::int32_t attribute) { return attribute == 1; };
    const auto hasTagOne = [](const auto& feature) { return feature.tag == 1; };
    auto& quads = lists_.quads;
    auto& triangles = lists_.triangles;
    if (std::all_of(quads.begin(), quads.end(), hasTagOne) &&
        std::all_of(triangles.begin(), triangles.end(), hasTagOne)) {
      quads.clear();
      triangles.clear();
    }
    const bool saysNothing =
        std::all_of(lists_.blocks.begin(), lists_.blocks.end(), [&](const ElementBlock& block) {
          return std::all_of(block.regions.begin(), block.regions.end(), isOne);
        });
    for (ElementBlock& block : lists_.blocks) {
      if (saysNothing) std::fill(block.regions.begin(), block.regions.end(), 0);
    }
  }

  const Input& input_;
  Array<char> room_;
  TextScanner scanner_;
  ElementLists lists_;
  std::size_t vertexEnd_ = 0;  ///< behind the largest vertex of an element
  bool hasFaces_ = false;
  bool hasVertices_ = false;
};

// Writing.

/// Writes the sections common to all files.
class MfemWriter {
 public:
  MfemWriter(OutputFile& output, int threads) : output_(output), lines_(output, threads) {}

  /// Writes cells and quads with their attributes.
  /// @param regions  of the cells; empty: all are 1
  /// @param progress  may be null
  void writeElements(std::string_view version, std::span<const Hex> cells,
                     std::span<const std::uint32_t> regions, const QuadGroups& quads,
                     LoopProgress* progress) {
    output_.write("MFEM mesh ").write(version).write("\n\ndimension\n3\n\nelements\n");
    output_.write(cells.size()).write('\n');
    const auto cell = [&](char* place, std::size_t i) {
      place = put(put(place, regions.empty() ? 1U : regions[i]), " 5 ");  // 5: cube
      return put(putNumbers(place, cells[i]), '\n');
    };
    lines_.write(cells.size(), 10 * (kNumberRoom + 1), cell, progress);
    output_.write("\nboundary\n").write(quads.elements.size()).write('\n');
    for (const ElementGroup& group : quads.groups) {
      const auto quad = [&](char* place, std::size_t i) {
        place = put(put(place, group.number), " 3 ");  // 3: square
        return put(putNumbers(place, quads.elements[group.begin + i]), '\n');
      };
      lines_.write(group.end - group.begin, 6 * (kNumberRoom + 1), quad, progress);
    }
    output_.write("\nvertices\n");
  }
  /// @param pointAt  returns the i-th of n points
  template <class F>
  void writePoints(std::size_t n, const F& pointAt, LoopProgress* progress) {
    const auto point = [&](char* place, std::size_t i) {
      return put(putNumbers(place, pointAt(i)), '\n');
    };
    lines_.write(n, 3 * (kNumberRoom + 1), point, progress);
  }

 private:
  OutputFile& output_;
  LineWriter lines_;
};

/// A set of parts that share something, ascending; at least two.
using PartGroup = std::vector<std::uint32_t>;

/// What the parts of a group share, as local vertices; in the same order in all these parts.
struct SharedElements {
  std::vector<Index> vertices;
  std::vector<std::array<Index, 2>> edges;
  std::vector<Quad> faces;
};

class SharedByGroup {
 public:
  explicit SharedByGroup(const MeshPart& part) : part_(part) {
    addVertices();
    addEdges();
    addFaces();
  }
  [[nodiscard]] const std::map<PartGroup, SharedElements>& groups() const noexcept {
    return groups_;
  }

 private:
  void addVertices() {
    parts_.resize(part_.ownPoints);
    for (const PartNeighbour& neighbour : part_.neighbours) {
      for (const Index v : neighbour.vertices) parts_[v].push_back(neighbour.part);
    }
    // Local numbers of own vertices are in order of global ones.
    for (Index v = 0; v < parts_.size(); ++v) {
      if (parts_[v].empty()) continue;
      groups_[withOwn(parts_[v])].vertices.push_back(v);
    }
  }

  /// Finds shared edges: another part has an edge if one of its cells does, found among the first
  /// layer of ghosts.
  void addEdges() {
    std::map<std::array<Index, 2>, PartGroup> edges;
    for (std::size_t c = 0; c < part_.mesh.cells.size(); ++c) {
      const std::uint32_t owner =
          c < part_.ownCells ? part_.part : part_.ghostParts[c - part_.ownCells];
      for (const auto& ends : adjacency::kHexEdges) {
        std::array<Index, 2> edge = {part_.mesh.cells[c][ends[0]], part_.mesh.cells[c][ends[1]]};
        if (!isShared(edge[0]) || !isShared(edge[1])) continue;
        std::sort(edge.begin(), edge.end());
        edges[edge].push_back(owner);
      }
    }
    for (auto& [edge, owners] : edges) {
      sortUnique(owners);
      const bool isOwn = std::binary_search(owners.begin(), owners.end(), part_.part);
      if (isOwn && owners.size() > 1) groups_[owners].edges.push_back(edge);
    }
  }

  /// Orients faces from the smallest vertex to its smaller neighbour.
  void addFaces() {
    for (const PartNeighbour& neighbour : part_.neighbours) {
      for (const PartFace& face : neighbour.faces) {
        Quad quad = adjacency::faceVertices(part_.mesh.cells[face.cell], face.side);
        std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
        if (quad[3] < quad[1]) std::swap(quad[1], quad[3]);
        groups_[withOwn({neighbour.part})].faces.push_back(quad);
      }
    }
  }

  [[nodiscard]] bool isShared(Index v) const { return v < parts_.size() && !parts_[v].empty(); }
  [[nodiscard]] PartGroup withOwn(PartGroup others) const {
    others.insert(std::lower_bound(others.begin(), others.end(), part_.part), part_.part);
    return others;
  }

  const MeshPart& part_;
  std::vector<PartGroup> parts_;  ///< per own vertex: the other parts that have it
  std::map<PartGroup, SharedElements> groups_;
};

/// Writes a serial mesh for each part, followed by the vertices, edges and faces that it shares,
/// grouped by the set of parts that share them.
class MfemSink final : public PartSink {
 public:
  MfemSink(std::filesystem::path file, Context& context, ProcessTeam* team)
      : context_(context), file_(std::move(file)), files_(team) {}

  [[nodiscard]] std::uint32_t neededGhostLayers() const override { return 1; }

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "MFEM's files");
  }

  [[nodiscard]] bool takesAnyOrder() const override { return true; }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    constexpr std::size_t kDigits = 6;
    std::string number = std::to_string(part.part);
    number.insert(0, kDigits - std::min(kDigits, number.size()), '0');
    files_.write(part.part, file_.string() + '.' + number, [&](OutputFile& output) {
      writeSerial(output, part, stage);
      writeShared(output, SharedByGroup(part).groups(), part.part);
    });
  }
  void end() override { files_.commit(); }

 private:
  void writeSerial(OutputFile& output, const MeshPart& part, Stage& stage) const {
    const MeshGroups groups = groupPart(part, info_, stage);
    const Array<std::uint32_t> numbers = groupNumbers(groups.cells.groups);
    std::vector<std::uint32_t> regions(part.ownCells, 1);
    for (std::size_t i = 0; i < numbers.size(); ++i) regions[groups.cells.at(i)] = numbers[i];
    MfemWriter writer(output, context_.threads());
    writer.writeElements("v1.2", std::span<const Hex>(part.mesh.cells).first(part.ownCells),
                         regions, groups.quads, nullptr);
    output.write(part.ownPoints).write("\n3\n");
    writer.writePoints(
        part.ownPoints, [&](std::size_t i) -> const Vec3& { return part.mesh.points[i]; }, nullptr);
    output.write("\nmfem_serial_mesh_end\n");
  }

  static void writeShared(OutputFile& output, const std::map<PartGroup, SharedElements>& groups,
                          std::uint32_t part) {
    output.write("\ncommunication_groups\nnumber_of_groups ").write(groups.size() + 1);
    output.write("\n\n# number of entities in each group, followed by ranks in group\n1 ");
    output.write(part).write('\n');
    std::array<std::size_t, 3> totals{};
    for (const auto& [parts, shared] : groups) {
      output.write(parts.size());
      for (const std::uint32_t each : parts) output.write(' ').write(each);
      output.write('\n');
      totals[0] += shared.vertices.size();
      totals[1] += shared.edges.size();
      totals[2] += shared.faces.size();
    }
    output.write("\ntotal_shared_vertices ").write(totals[0]);
    output.write("\ntotal_shared_edges ").write(totals[1]);
    output.write("\ntotal_shared_faces ").write(totals[2]).write('\n');
    std::size_t number = 0;
    for (const auto& [parts, shared] : groups) {
      output.write("\n# group ").write(++number);
      output.write("\nshared_vertices ").write(shared.vertices.size()).write('\n');
      for (const Index v : shared.vertices) output.write(v).write('\n');
      output.write("\nshared_edges ").write(shared.edges.size()).write('\n');
      for (const auto& edge : shared.edges) {
        output.write(edge[0]).write(' ').write(edge[1]).write('\n');
      }
      output.write("\nshared_faces ").write(shared.faces.size()).write('\n');
      for (const Quad& face : shared.faces) {
        output.write('3');  // square
        for (const Index v : face) output.write(' ').write(v);
        output.write('\n');
      }
    }
    output.write("\nmfem_mesh_end\n");
  }

  Context& context_;
  std::filesystem::path file_;
  PartsInfo info_;
  FileSet files_;
};

}  // namespace

ElementLists readMfem(const Input& input, ElementParts parts, Stage& stage) {
  MfemReader reader(input, stage);
  return parts == ElementParts::All ? reader.read() : reader.readTypes();
}

void writeMfem(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage) {
  MfemWriter writer(output, stage.context().threads());
  const QuadGroups quads = groupQuads(mesh, options.patchAngle, stage);
  LoopProgress progress(stage, mesh.cells.size() + quads.elements.size() + mesh.points.size());
  writer.writeElements("v1.0", mesh.cells, cellReferences(mesh), quads, &progress);
  output.write(mesh.points.size()).write("\n3\n");
  writer.writePoints(
      mesh.points.size(), [&](std::size_t i) -> const Vec3& { return mesh.points[i]; }, &progress);
}

void writeLagrangeMfem(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage) {
  MfemWriter writer(output, stage.context().threads());
  const HexMesh straight = straightMesh(mesh);
  const QuadGroups quads = groupQuads(straight, options.patchAngle, stage);
  LoopProgress progress(stage, straight.cells.size() + quads.elements.size() + mesh.nodes.size());
  writer.writeElements("v1.0", straight.cells, cellReferences(straight), quads, &progress);
  // L2_T4: per-cell polynomials given by values at equidistant nodes, x fastest: the order of
  // LagrangeMesh. Ordering 1: the coordinates of a node are consecutive.
  output.write(straight.points.size());
  output.write("\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_3D_P");
  output.write(static_cast<unsigned>(mesh.order)).write("\nVDim: 3\nOrdering: 1\n\n");
  writer.writePoints(
      mesh.nodes.size(), [&](std::size_t i) -> const Vec3& { return mesh.points[mesh.nodes[i]]; },
      &progress);
}

std::unique_ptr<PartSink> openMfemPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* team) {
  return std::make_unique<MfemSink>(file, context, team);
}

}  // namespace hexhex::io
