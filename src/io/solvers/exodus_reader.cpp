// The reading half of Exodus files.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/solvers/element_lists.hpp>
#include <io/solvers/exodus_file.hpp>
#include <io/solvers/netcdf_reader.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex::io {
namespace {

/// VTK's place k is this place of Exodus, which lists the edges along z before those of the top,
/// and the node inside before those of the faces.
constexpr std::array<std::uint8_t, 27> kExodusPlaces = {0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                        9,  10, 11, 16, 17, 18, 19, 12, 13,
                                                        14, 15, 23, 24, 25, 26, 21, 22, 20};

class ExodusReader {
 public:
  ExodusReader(std::string_view bytes, const std::string& name, ElementParts parts)
      : file_(bytes, name), name_(name), parts_(parts) {}

  ElementLists read() {
    if (parts_ == ElementParts::Types) {
      readBlocks();
      return std::move(lists_);
    }
    readPoints();
    readBlocks();
    readSides();
    readNodeSets();
    return std::move(lists_);
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& sentence) const {
    throw Error(code, name_ + ": " + sentence);
  }

  void readPoints() {
    const NetcdfValues* const together = file_.find("coord");  // all axes, in older files
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name = std::string("coord") + "xyz"[axis];
      const NetcdfValues* const values = together != nullptr ? together : file_.find(name);
      if (values == nullptr) {
        fail(ErrorCode::FileUnsupported,
             "the file lacks the variable \"" + name + "\": it has no nodes in space.");
      }
      std::vector<double> numbers = file_.reals(*values);
      if (together != nullptr) {
        if (values->lengths.size() != 2 || values->lengths[0] != 3) {
          fail(ErrorCode::FileUnsupported, "the file has no nodes in space.");
        }
        const auto each = static_cast<std::ptrdiff_t>(numbers.size() / 3);
        const auto begin = numbers.begin() + each * static_cast<std::ptrdiff_t>(axis);
        numbers = std::vector<double>(begin, begin + each);
      }
      if (axis == 0) lists_.points.resize(numbers.size());
      if (numbers.size() != lists_.points.size() || numbers.size() > kNone) {
        fail(ErrorCode::FileSyntax, "the axes have different numbers of coordinates.");
      }
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        lists_.points[i][axis] = numbers[i];
        if (std::isfinite(numbers[i])) continue;
        throw Error(ErrorCode::NotFinite,
                    name_ + ": a coordinate of node " + std::to_string(i + 1) + " is not finite.",
                    Place{PlaceKind::Vertex, i});
      }
    }
  }

  /// The numbers and names of all blocks, or of all sets of a kind.
  struct Groups {
    std::vector<std::int64_t> numbers;
    std::vector<std::string> names;

    [[nodiscard]] std::int64_t numberOf(std::size_t i) const {
      return i < numbers.size() ? numbers[i] : static_cast<std::int64_t>(i) + 1;
    }
    [[nodiscard]] std::string nameOf(std::size_t i) const {
      return i < names.size() ? names[i] : std::string();
    }
    [[nodiscard]] std::int32_t tagOf(std::size_t i) const {
      return tagOfGroup(nameOf(i), numberOf(i));
    }
    [[nodiscard]] std::size_t size() const { return std::max(numbers.size(), names.size()); }
  };
  Groups groupsOf(const std::string& prefix) const {
    Groups groups;
    const NetcdfValues* const status = file_.find(prefix + "_status");
    const NetcdfValues* const numbers = file_.find(prefix + "_prop1");
    const NetcdfValues* const names = file_.find(prefix + "_names");
    if (numbers != nullptr) groups.numbers = file_.integers(*numbers);
    if (names != nullptr) groups.names = file_.texts(*names);
    if (numbers == nullptr && status != nullptr) {
      for (std::uint64_t i = 0; i < status->count; ++i) {
        groups.numbers.push_back(static_cast<std::int64_t>(i) + 1);
      }
    }
    return groups;
  }

  void readBlocks() {
    const Groups groups = groupsOf("eb");
    std::uint64_t next = 1;
    for (std::size_t b = 0; b < groups.size(); ++b) {
      // Blocks without elements have no variable.
      const NetcdfValues* const values = file_.find("connect" + std::to_string(b + 1));
      if (values != nullptr) readBlock(*values, groups.tagOf(b), next);
    }
    if (lists_.blocks.empty()) fail(ErrorCode::FileUnsupported, "the file has no elements.");
  }

  void readBlock(const NetcdfValues& values, std::int32_t region, std::uint64_t& next) {
    const std::string type = lowerCase(values.elementType);
    if (type == "nsided" || type == "nfaced" || values.lengths.size() != 2) {
      fail(ErrorCode::FileUnsupported, "elements of the type \"" + values.elementType +
                                           "\" are not supported. Leave their block out.");
    }
    ElementBlock& block = lists_.blocks.emplace_back();
    const auto each = static_cast<std::size_t>(values.lengths[1]);
    block.type = typeOf(type, each);
    const auto count = static_cast<std::size_t>(values.lengths[0]);
    next += count;
    if (block.type == nullptr) return;
    const bool isRead =
        block.type->plural.starts_with("hexahedra") || block.type->plural.starts_with("tetrahedra");
    block.nodesEach = isRead ? each : 0;
    block.numbers.resize(count);
    for (std::size_t i = 0; i < count; ++i) block.numbers[i] = next - count + i;
    block.regions.assign(count, region);
    if (!isRead || parts_ == ElementParts::Types) return;  // others are only counted
    const std::vector<std::int64_t> nodes = file_.integers(values);
    block.nodes.resize(nodes.size());
    const bool isCurved = each == 20 || each == kExodusPlaces.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t k = i % each;
      block.nodes[i] = nodeOf(nodes[isCurved ? i - k + kExodusPlaces[k] : i], values.name);
    }
  }

  /// @param name  in lower case; often without the number of nodes
  [[nodiscard]] const VolumeCells* typeOf(const std::string& name, std::size_t nodes) const {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kNouns = {
        {{"hex", "hexahedra"}, {"tet", "tetrahedra"}, {"wedge", "prisms"}, {"pyr", "pyramids"}}};
    for (const auto& [word, noun] : kNouns) {
      if (!name.starts_with(word)) continue;
      const VolumeCells* const type = volumeCells(noun, nodes);
      if (type != nullptr) return type;
      fail(ErrorCode::FileUnsupported, std::string(noun) + " with " + std::to_string(nodes) +
                                           " nodes are not known. Leave their block out.");
    }
    if (name.starts_with("bex_hex")) return volumeCells("Bezier hexahedra");
    constexpr std::array<std::string_view, 9> kFlat = {"shell", "quad", "tri",    "bar",   "beam",
                                                       "truss", "edge", "sphere", "circle"};
    const auto begins = [&name](std::string_view word) { return name.starts_with(word); };
    if (std::any_of(kFlat.begin(), kFlat.end(), begins)) return nullptr;
    fail(ErrorCode::FileUnsupported, "elements of the type " + quoted(std::string_view(name)) +
                                         " are not supported. Leave their block out.");
  }

  [[nodiscard]] Index nodeOf(std::int64_t number, const std::string& variable) const {
    if (number >= 1 && static_cast<std::uint64_t>(number) <= lists_.points.size()) {
      return static_cast<Index>(number - 1);
    }
    fail(ErrorCode::IndexOutOfRange,
         "the variable \"" + variable + "\" names node " + std::to_string(number) + ", but the " +
             std::to_string(lists_.points.size()) + " nodes are numbered from 1.");
  }

  void readSides() {
    const Groups groups = groupsOf("ss");
    for (std::size_t s = 0; s < groups.size(); ++s) {
      const std::string end = "_ss" + std::to_string(s + 1);
      const NetcdfValues* const found = file_.find("elem" + end);
      if (found == nullptr) continue;
      const std::vector<std::int64_t> elements = file_.integers(*found);
      const std::vector<std::int64_t> sides = file_.integers(file_.get("side" + end));
      if (elements.size() != sides.size()) {
        fail(ErrorCode::FileSyntax,
             "side set " + std::to_string(s + 1) + " has not as many sides as elements.");
      }
      const std::int32_t tag = groups.tagOf(s);
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto* const face = std::find(kExodusSides.begin(), kExodusSides.end(), sides[i]);
        if (face == kExodusSides.end() || elements[i] < 1) continue;  // of no hexahedron
        lists_.sides.push_back({static_cast<std::uint64_t>(elements[i]),
                                static_cast<std::size_t>(face - kExodusSides.begin()), tag});
      }
    }
  }

  void readNodeSets() {
    const Groups groups = groupsOf("ns");
    for (std::size_t s = 0; s < groups.size(); ++s) {
      const NetcdfValues* const found = file_.find("node_ns" + std::to_string(s + 1));
      if (found == nullptr) continue;
      NodeSet& set = lists_.nodeSets.emplace_back(NodeSet{groups.nameOf(s), groups.tagOf(s), {}});
      for (const std::int64_t node : file_.integers(*found)) {
        set.nodes.push_back(nodeOf(node, found->name));
      }
    }
  }

  NetcdfReader file_;
  const std::string& name_;
  ElementParts parts_;
  ElementLists lists_;
};

/// What is no such file at all is refused before it is read as a whole.
void requireExodus(const Input& input) {
  if (input.bytes()) return;
  const InputFile file(input.path());
  if (!file.isRegular()) return;  // a pipe can be opened but once
  std::array<char, 8> head{};
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), head.size()));
  file.readAt(0, head.data(), size);
  requireNetcdf({head.data(), size}, input.name());
}

}  // namespace

ElementLists readExodus(const Input& input, ElementParts parts, Stage& stage) {
  requireExodus(input);
  Array<char> room;
  return ExodusReader(input.text(room, stage, ""), input.name(), parts).read();
}

}  // namespace hexhex::io
