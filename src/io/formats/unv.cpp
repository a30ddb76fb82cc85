// Reads `.unv` files (see formats.hpp): data sets between lines of "-1", each with a number that
// determines its records.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

/// Kinds of elements by type number ("FE descriptor").
enum class UnvKind : std::uint8_t { Other, Line, Triangle, Quad, Volume };

struct UnvType {
  UnvKind kind = UnvKind::Other;
  const VolumeCells* cells = nullptr;  ///< of volumes; null if the type is not supported
};

/// Whether an element is a rod or beam, which has an extra record.
bool isBeam(std::int64_t type) { return type == 11 || (type >= 21 && type <= 24); }

UnvType unvType(std::int64_t type, std::size_t nodes) {
  if (isBeam(type)) return {nodes <= 3 ? UnvKind::Line : UnvKind::Other};
  constexpr std::int64_t kFirstPlane = 41;  // plane stress, plane strain, plates, membranes, shells
  constexpr std::int64_t kLastPlane = 96;
  if (type >= kFirstPlane && type <= kLastPlane) {
    if (nodes == 3 || nodes == 6) return {UnvKind::Triangle};
    return {nodes == 4 || nodes == 8 ? UnvKind::Quad : UnvKind::Other};
  }
  constexpr std::array<std::pair<std::int64_t, std::string_view>, 11> kVolumes = {
      {{111, "tetrahedra"},
       {112, "prisms"},
       {113, "prisms"},
       {114, "prisms"},
       {115, "hexahedra"},
       {116, "hexahedra"},
       {117, "hexahedra"},
       {118, "tetrahedra"},
       {119, "hexahedra"},
       {312, "pyramids"},
       {313, "pyramids"}}};
  for (const auto& [number, noun] : kVolumes) {
    if (number == type) return {UnvKind::Volume, volumeCells(noun, nodes)};
  }
  return {};
}

/// Hexahedra with 20 nodes list midpoints of edges between the corners.
constexpr std::array<std::size_t, 20> kNodesInVtkOrder = {0, 2, 4,  6,  12, 14, 16, 18, 1,  3,
                                                          5, 7, 13, 15, 17, 19, 8,  9,  10, 11};

class UnvReader {
 public:
  UnvReader(const Input& input, ElementParts parts, Stage& stage) : input_(input), parts_(parts) {
    scanner_.emplace(input.text(room_, stage, "-"), input.name());
  }

  ElementLists read() {
    while (scanner_->skipSpace() && !isFound()) {
      requireMark("\"-1\", with which a data set begins");
      readDataSet();
    }
    if (parts_ == ElementParts::All) finish();
    return std::move(lists_);
  }

 private:
  void requireMark(const char* what) {
    if (scanner_->readToken() != "-1") scanner_->failToken(what);
  }
  /// Whether the data set or the file ends here.
  bool isEnd() { return scanner_->peekToken() == "-1" || scanner_->peekToken().empty(); }
  /// Whether curved cells were found and nothing else is requested.
  [[nodiscard]] bool isFound() const { return parts_ == ElementParts::Types && areCurved(lists_); }

  void readDataSet() {
    const std::string_view kind = scanner_->readToken();
    scanner_->takeLine();
    const bool all = parts_ == ElementParts::All;
    if (kind == "2412") {
      while (!isEnd()) {
        readElement();
        if (isFound()) return;
      }
    } else if (all && (kind == "2411" || kind == "781")) {
      while (!isEnd()) readNode();
    } else if (all && (kind == "2467" || kind == "2477" || kind == "2452" || kind == "2435")) {
      while (!isEnd()) readGroup();
    } else {
      skipDataSet();
    }
    requireMark("\"-1\", with which a data set ends");
  }

  /// Skips to a line with "-1" only; lines of text may contain "-1" as well.
  void skipDataSet() {
    while (scanner_->skipSpace()) {
      const std::size_t begin = scanner_->position();
      TextScanner line(scanner_->takeLine(), input_.name());
      const bool mark = line.readToken() == "-1" && !line.skipSpace();
      if (mark) return scanner_->moveTo(begin);
    }
  }

  std::uint64_t number(std::string_view what) {
    const std::int64_t value = scanner_->integer(what);
    if (value < 0) scanner_->failInteger(what);
    return static_cast<std::uint64_t>(value);
  }
  void skipNumbers(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) static_cast<void>(scanner_->integer("a whole number"));
  }

  void readNode() {
    nodeNumbers_.push_back(number("the number of a node"));
    skipNumbers(3);  // coordinate systems and a colour
    Vec3& point = lists_.points.emplace_back();
    for (double& coordinate : point) coordinate = scanner_->number("a coordinate of a node");
  }

  void readElement() {
    const std::uint64_t element = number("the number of an element");
    const std::int64_t typeNumber = scanner_->integer("the type of an element");
    skipNumbers(3);  // tables of properties and a colour
    const std::uint64_t count = number("the number of nodes of an element");
    if (isBeam(typeNumber)) skipNumbers(3);
    constexpr std::uint64_t kMost = 64;
    if (count > kMost) {
      scanner_->fail(ErrorCode::FileSyntax, "element ", element, " has ", count,
                     " nodes; no element of this format has more than 64.");
    }
    const UnvType type = unvType(typeNumber, count);
    // Other programs do not agree on the order of 27 nodes.
    if (type.kind == UnvKind::Volume &&
        (type.cells == nullptr || count > kNodesInVtkOrder.size())) {
      scanner_->fail(ErrorCode::FileUnsupported, "elements of the type ", typeNumber, " with ",
                     count,
                     " nodes are not known. Save hexahedra of order 2 "
                     "with 20 nodes (in Gmsh: Mesh.SecondOrderIncomplete = 1).");
    }
    std::array<std::uint64_t, kMost> nodes{};
    for (std::size_t k = 0; k < count; ++k) nodes[k] = number("a node of an element");
    addElement(element, type, std::span(nodes).first(static_cast<std::size_t>(count)));
  }

  void addElement(std::uint64_t element, const UnvType& type,
                  std::span<const std::uint64_t> nodes) {
    if (type.kind == UnvKind::Line && nodes.size() >= 2) {
      flats_.push_back({element, 2, {nodes.front(), nodes.back()}});
    } else if (type.kind == UnvKind::Triangle || type.kind == UnvKind::Quad) {
      const std::size_t corners = type.kind == UnvKind::Quad ? 4 : 3;
      FlatElement& face = flats_.emplace_back(FlatElement{element, corners, {}});
      const std::size_t step = nodes.size() / corners;  // edge midpoints are between the corners
      for (std::size_t k = 0; k < corners; ++k) face.nodes[k] = nodes[k * step];
    } else if (type.kind == UnvKind::Volume) {
      ElementBlock& block = lists_.blocks[lists_.blockOf(type.cells, nodes.size())];
      block.numbers.push_back(element);
      const bool quadratic = block.nodesEach == 20;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        block.listed.push_back(nodes[quadratic ? kNodesInVtkOrder[k] : k]);
      }
    }
  }

  void readGroup() {
    const std::uint64_t group = number("the number of a group");
    skipNumbers(6);  // sets of loads and the like
    const std::uint64_t count = number("the number of members of a group");
    scanner_->takeLine();
    NodeSet nodes;
    nodes.name = trimmed(scanner_->takeLine());
    nodes.number = std::in_range<std::int32_t>(group) ? static_cast<std::int32_t>(group) : 0;
    std::vector<std::uint64_t> members;
    for (std::uint64_t i = 0; i < count; ++i) {
      constexpr std::int64_t kNodes = 7;
      constexpr std::int64_t kElements = 8;
      const std::int64_t kind = scanner_->integer("the kind of a group's member");
      const std::uint64_t member = number("a member of a group");
      skipNumbers(2);  // part of an assembly
      if (kind == kNodes) members.push_back(member);
      if (kind == kElements) members_.emplace_back(member, lists_.nodeSets.size());
    }
    nodeSets_.push_back(std::move(members));
    lists_.nodeSets.push_back(std::move(nodes));
  }

  /// Resolves node numbers, and turns groups into tags.
  void finish() {
    if (nodeNumbers_.empty()) {
      input_.fail(ErrorCode::FileUnsupported, "the file has no nodes: no data set 2411 or 781.");
    }
    const NodeTags nodes = nodesByNumber(nodeNumbers_, input_);
    std::vector<NumberedGroup> groups;
    groups.reserve(lists_.nodeSets.size());
    for (const NodeSet& group : lists_.nodeSets) groups.push_back({group.name, group.number});
    const std::vector<std::int32_t> ofGroups = tagsOfGroups(groups, -1);
    ElementTags tags;
    for (const auto& [element, group] : members_) tags.add(element, ofGroups[group]);
    tags.sort();
    lists_.nameNodes(nodes, input_, "data set of nodes");
    lists_.setRegions(tags);
    for (const FlatElement& flat : flats_) lists_.addFlat(flat, tags.find(flat.number), nodes);
    std::vector<TagName> names;  // a group may contain elements of several kinds
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const int dimension : {1, 2, 3}) {
        names.push_back({dimension, ofGroups[g], groups[g].name});
      }
    }
    lists_.addNamesInUse(names);
    for (std::size_t s = 0; s < nodeSets_.size(); ++s) {
      for (const std::uint64_t number : nodeSets_[s]) {
        const Index node = nodes.find(number);
        if (node != kNone) lists_.nodeSets[s].nodes.push_back(node);
      }
    }
  }

  const Input& input_;
  ElementParts parts_;
  Array<char> room_;
  std::optional<TextScanner> scanner_;
  ElementLists lists_;
  Array<std::uint64_t> nodeNumbers_;
  std::vector<std::vector<std::uint64_t>> nodeSets_;  ///< per group: node numbers
  std::vector<FlatElement> flats_;
  std::vector<std::pair<std::uint64_t, std::size_t>> members_;  ///< elements, with their groups
};

}  // namespace

ElementLists readUnv(const Input& input, ElementParts parts, Stage& stage) {
  return UnvReader(input, parts, stage).read();
}

}  // namespace hexhex::io
