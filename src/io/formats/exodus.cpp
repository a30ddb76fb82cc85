// Exodus II (see formats.hpp): dimensions, attributes and variables of a NetCDF file with the names
// that the Exodus library expects; for whole meshes, and for parts with Nemesis maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/version.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>
#include <io/formats/netcdf.hpp>

namespace hexhex::io {

namespace {

constexpr SideNumbers kExodusSides = {
    {4, 1, 2, 3}, {5, 1, 2, 3, 4}, {4, 5, 1, 2, 3}, {4, 2, 1, 3, 5, 6}};

/// Entry k: the Exodus position of VTK's node k. Exodus lists the vertical edges before those of
/// the top, and the interior node before those of the faces.
constexpr std::array<std::uint8_t, 27> kExodusPlaces = {0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                        9,  10, 11, 16, 17, 18, 19, 12, 13,
                                                        14, 15, 23, 24, 25, 26, 21, 22, 20};

/// Bytes of a name, including the terminating zero.
constexpr std::size_t kExodusNameBytes = 33;
constexpr std::size_t kExodusLineBytes = 81;
constexpr std::string_view kExodusMaker = "by hexhex ";

/// Converts an index to Exodus' 1-based numbers.
constexpr std::int32_t fromOne(std::size_t i) { return static_cast<std::int32_t>(i) + 1; }

/// Names of kinds of elements; and what the names of blocks end in
/// that have the cells of a region that are no hexahedra.
constexpr ByCorners<std::string_view> kExodusTypes = {"TETRA", "PYRAMID", "WEDGE", "HEX8"};
constexpr ByCorners<std::string_view> kExodusEnds = {"_tet", "_pyr", "_wed", ""};
constexpr std::size_t kBeforeEnd = kExodusNameBytes - 1 - 4;

/// Blocks hold one kind of cells each: makes several of groups with several kinds.
void splitBlocks(CellGroups& cells, const AllCells& all) {
  if (all.others().count() == 0) return;
  std::vector<ElementGroup> blocks;
  const auto corners = [&](std::size_t i) { return all[cells.at(i)].size(); };
  for (const ElementGroup& group : cells.groups) {
    splitByCorners(group, corners, [&](ElementGroup part) {
      const std::string_view end = kExodusEnds[corners(part.begin)];
      if (part.begin > group.begin) part.name = concat(part.name.substr(0, kBeforeEnd), end);
      blocks.push_back(std::move(part));
    });
  }
  cells.groups = std::move(blocks);
  numberApart({&cells.groups});
}

/// The position of each cell in block order; empty: the identity.
Array<Index> cellPlacesOf(const CellGroups& cells) {
  Array<Index> places(cells.order.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[cells.at(i)] = static_cast<Index>(i);
  return places;
}

/// Describes all blocks, or all sets of a kind.
struct ExodusList {
  std::vector<std::int32_t> numbers;
  std::vector<std::string> names;
  std::vector<std::uint64_t> counts;  ///< of elements; empty blocks and sets have no variables

  /// @return  the suffix of the names of its variables
  std::string add(std::int32_t number, const std::string& name, std::uint64_t count) {
    numbers.push_back(number);
    names.push_back(name);
    counts.push_back(count);
    return std::to_string(names.size());
  }
};

class ExodusFile {
 public:
  /// @param allGroups  whether to write sets for empty groups
  /// @param curved  the order-2 mesh that `mesh` is the straight version of; null: cells are
  /// straight
  /// @param edgeNodes  of its tagged edges, as nodesOfGroups() returns them
  ExodusFile(const HexMesh& mesh, const MeshGroups& groups, Stage& stage, bool allGroups = false,
             const LagrangeMesh* curved = nullptr, Array<Index> edgeNodes = {},
             const OtherCells& others = noOthers())
      : all_(mesh, others),
        curved_(curved),
        points_(curved != nullptr ? curved->points : mesh.points),
        edgeNodes_(std::move(edgeNodes)),
        groups_(groups),
        allGroups_(allGroups),
        progress_(stage, 3 * points_.size() + all_.size()) {
    describe();
    if (!points_.empty()) addPoints();
    if (groups.cells.groups.back().end > 0 || allGroups) addBlocks();
    addSideSets();
    addNodeSets();
    addVariable("time_whole", NetcdfType::Double, {addDimension("time_step", 0)}, {});
  }

  void write(OutputFile& output, int threads, std::uint64_t mostBytes) const {
    file_.write(output, threads, mostBytes);
  }

 protected:
  using Write = std::function<void(LineWriter&)>;

  /// The index of an existing dimension.
  [[nodiscard]] std::uint32_t dimensionOf(const std::string& name) const {
    const auto found =
        std::find_if(file_.dimensions.begin(), file_.dimensions.end(),
                     [&name](const NetcdfDimension& dimension) { return dimension.name == name; });
    return static_cast<std::uint32_t>(found - file_.dimensions.begin());
  }
  /// @return  its index
  std::uint32_t addDimension(const std::string& name, std::size_t length) {
    file_.dimensions.push_back({name, length});
    return static_cast<std::uint32_t>(file_.dimensions.size() - 1);
  }
  /// @param text  value of the attribute, if there is one
  void addVariable(const std::string& name, NetcdfType type, std::vector<std::uint32_t> dimensions,
                   Write write, const char* attribute = nullptr, const std::string& text = {}) {
    file_.variables.push_back({name, type, std::move(dimensions), {}, std::move(write)});
    if (attribute == nullptr) return;
    file_.variables.back().attributes.push_back({attribute, text + '\0'});
  }
  void addNumbers(const std::string& name, std::uint32_t dimension,
                  std::vector<std::int32_t> numbers, const char* attribute = nullptr) {
    const Write write = [numbers = std::move(numbers)](LineWriter& values) {
      const auto put = [&](char* place, std::size_t i) { return putBigBytes(place, numbers[i]); };
      values.write(numbers.size(), sizeof(std::int32_t), put, nullptr);
    };
    addVariable(name, NetcdfType::Int, {dimension}, write, attribute, "ID");
  }
  void addTexts(const std::string& name, std::uint32_t dimension, std::uint32_t ofBytes,
                std::size_t bytes, std::vector<std::string> texts) {
    for (std::string& text : texts) text.resize(bytes);
    const Write write = [texts = std::move(texts), bytes](LineWriter& values) {
      const auto copy = [&](char* place, std::size_t i) { return put(place, texts[i]); };
      values.write(texts.size(), bytes, copy, nullptr);
    };
    addVariable(name, NetcdfType::Char, {dimension, ofBytes}, write);
  }
  /// @param prefix  of the variables' names
  void addList(const std::string& prefix, const char* dimension, const ExodusList& list) {
    if (list.names.empty()) return;
    const std::uint32_t length = addDimension(dimension, list.names.size());
    std::vector<std::int32_t> isThere;
    for (const std::uint64_t count : list.counts) isThere.push_back(count > 0 ? 1 : 0);
    addNumbers(prefix + "_status", length, std::move(isThere));
    addNumbers(prefix + "_prop1", length, list.numbers, "name");
    addTexts(prefix + "_names", length, ofNames_, kExodusNameBytes, list.names);
  }

  void describe() {
    constexpr float kVersion = 6.02F;
    file_.attributes = {{"api_version", kVersion},
                        {"version", kVersion},
                        {"floating_point_word_size", std::int32_t{sizeof(double)}},
                        {"file_size", std::int32_t{1}},  // each axis is a separate variable
                        {"maximum_name_length", std::int32_t{kExodusNameBytes - 1}},
                        {"int64_status", std::int32_t{0}},  // integers have 32 bits
                        {"title", concat("hexahedral mesh by hexhex", '\0')}};
    ofNames_ = addDimension("len_name", kExodusNameBytes);
    addTexts("coor_names", addDimension("num_dim", 3), ofNames_, kExodusNameBytes, {"x", "y", "z"});
    addTexts("info_records", addDimension("num_info", 1),
             addDimension("len_line", kExodusLineBytes), kExodusLineBytes,
             {concat(kExodusMaker, version())});
  }

  void addPoints() {
    const std::uint32_t length = addDimension("num_nodes", points_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Write write = [this, axis](LineWriter& values) {
        const auto put = [&](char* place, std::size_t i) {
          return putBigBytes(place, points_[i][axis]);
        };
        values.write(points_.size(), sizeof(double), put, &progress_);
      };
      addVariable(concat("coord", "xyz"[axis]), NetcdfType::Double, {length}, write);
    }
  }

  void addBlocks() {
    if (const std::size_t all = groups_.cells.groups.back().end; all > 0) {
      addDimension("num_elem", all);
    }
    ExodusList& blocks = blocks_;
    for (const ElementGroup& group : groups_.cells.groups) {
      const std::size_t count = group.end - group.begin;
      const std::string n = blocks.add(static_cast<std::int32_t>(group.number), group.name, count);
      if (count == 0) continue;
      const std::size_t corners = all_[groups_.cells.at(group.begin)].size();
      const std::size_t each = curved_ != nullptr ? kExodusPlaces.size() : corners;
      const Write write = [this, &group, count, each](LineWriter& values) {
        const auto put = [&](char* place, std::size_t i) {
          const std::size_t cell = groups_.cells.at(group.begin + i);
          for (std::size_t k = 0; k < each; ++k) place = putBigBytes(place, nodeOf(cell, k));
          return place;
        };
        values.write(count, each * sizeof(std::int32_t), put, &progress_);
      };
      const std::uint32_t length = addDimension("num_el_in_blk" + n, count);
      addVariable("connect" + n, NetcdfType::Int,
                  {length, addDimension("num_nod_per_el" + n, each)}, write, "elem_type",
                  curved_ != nullptr ? "HEX27" : std::string(kExodusTypes[corners]));
    }
    addList("eb", "num_el_blk", blocks);
  }

  /// Node k of a cell in Exodus order.
  [[nodiscard]] std::int32_t nodeOf(std::size_t cell, std::size_t k) const {
    if (curved_ == nullptr) return fromOne(all_[cell][k]);
    return fromOne(curved_->nodes[cell * kExodusPlaces.size() + order_[k]]);
  }

  /// Adds a side set for each group of boundary quads.
  void addSideSets() {
    const Array<Index> places = cellPlacesOf(groups_.cells);
    ExodusList& sets = sides_;
    for (const ElementGroup& group : groups_.quads.groups) {
      std::vector<std::int32_t> cells;
      std::vector<std::int32_t> sides;
      const std::size_t end = groups_.quads.boundaryEnd(group);  // interior quads follow
      for (std::size_t i = group.begin; i < end; ++i) {
        const std::size_t cell = groups_.quads.places[i] / 8;
        cells.push_back(fromOne(places.empty() ? cell : places[cell]));
        sides.push_back(kExodusSides[all_[cell].size()][groups_.quads.places[i] % 8]);
      }
      if (cells.empty() && !allGroups_) continue;
      const std::string n =
          sets.add(static_cast<std::int32_t>(group.number), group.name, cells.size());
      if (cells.empty()) continue;
      const std::uint32_t length = addDimension("num_side_ss" + n, cells.size());
      addNumbers("elem_ss" + n, length, std::move(cells));
      addNumbers("side_ss" + n, length, std::move(sides));
    }
    addList("ss", "num_side_sets", sets);
  }

  /// Adds a node set for each group of edges and of vertices.
  void addNodeSets() {
    ExodusList& sets = nodes_;
    const auto add = [&](const auto& ofKind) {
      for (const ElementGroup& group : ofKind.groups) {
        std::vector<std::int32_t> vertices;
        for (const Index vertex : verticesOf(ofKind, group)) vertices.push_back(fromOne(vertex));
        if (curved_ != nullptr && &ofKind.groups == &groups_.edges.groups) {
          for (std::size_t i = group.begin; i < group.end; ++i) {
            vertices.push_back(fromOne(edgeNodes_[3 * i + 2]));  // midpoint of the edge
          }
        }
        const std::string n = sets.add(fromOne(sets.names.size()), group.name, vertices.size());
        if (vertices.empty()) continue;
        const std::uint32_t length = addDimension("num_nod_ns" + n, vertices.size());
        addNumbers("node_ns" + n, length, std::move(vertices));
      }
    };
    add(groups_.edges);
    add(groups_.vertices);
    addList("ns", "num_node_sets", sets);
  }

  AllCells all_;
  const LagrangeMesh* curved_;
  const Array<Vec3>& points_;
  std::vector<std::uint32_t> order_ = quadraticOrder(kExodusPlaces);  ///< of curved cells
  Array<Index> edgeNodes_;  ///< of curved meshes: three per tagged edge
  const MeshGroups& groups_;
  bool allGroups_;
  mutable LoopProgress progress_;
  NetcdfFile file_;
  std::uint32_t ofNames_ = 0;  ///< dimension of their length
  ExodusList blocks_;
  ExodusList sides_;
  ExodusList nodes_;
};

// Reading.

class ExodusReader {
 public:
  ExodusReader(std::unique_ptr<HdfReader> file, const Input& input, ElementParts parts)
      : file_(std::move(file)), input_(input), parts_(parts) {}

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
  /// Whether there is a variable, with all values that it announces.
  [[nodiscard]] bool has(const std::string& name) const {
    if (!file_->has(name)) return false;
    file_->requireStored(name);
    return true;
  }
  /// Rows of characters, each up to its first zero byte; none if there is no such variable.
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const {
    std::vector<std::string> rows;
    const auto shape = has(name) ? file_->shape(name) : std::vector<std::uint64_t>();
    if (shape.size() != 2 || shape[0] == 0 || shape[1] == 0) return rows;
    const std::string all = file_->text(name);
    for (std::size_t begin = 0; begin < all.size(); begin += static_cast<std::size_t>(shape[1])) {
      const std::string row = all.substr(begin, static_cast<std::size_t>(shape[1]));
      rows.push_back(row.substr(0, row.find('\0')));
    }
    return rows;
  }

  void readPoints() {
    const bool together = has("coord");  // all axes, in older files
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name = together ? "coord" : concat("coord", "xyz"[axis]);
      if (!has(name)) {
        input_.fail(ErrorCode::FileUnsupported, "the file lacks the variable \"", name,
                    "\": it has no nodes in space.");
      }
      std::vector<double> numbers = file_->reals(name);
      if (together) {
        const std::vector<std::uint64_t> shape = file_->shape(name);
        if (shape.size() != 2 || shape[0] != 3) {
          input_.fail(ErrorCode::FileUnsupported, "the file has no nodes in space.");
        }
        const auto each = static_cast<std::ptrdiff_t>(numbers.size() / 3);
        const auto begin = numbers.begin() + each * static_cast<std::ptrdiff_t>(axis);
        numbers = std::vector<double>(begin, begin + each);
      }
      setCoordinates(lists_, 0, axis, numbers, input_);
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
    [[nodiscard]] std::vector<std::int32_t> tags(int dimension) const {
      std::vector<NumberedGroup> all;
      all.reserve(size());
      for (std::size_t i = 0; i < size(); ++i) all.push_back({nameOf(i), numberOf(i)});
      return tagsOfGroups(all, dimension);
    }
    [[nodiscard]] std::size_t size() const { return std::max(numbers.size(), names.size()); }
    /// Gives the blocks that splitBlocks() has made of one group its name and number.
    void joinKinds() {
      for (std::size_t i = 0; i < std::min(names.size(), numbers.size()); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          const std::string begin = names[k].substr(0, kBeforeEnd);
          for (const std::size_t corners : {4U, 5U, 6U}) {
            if (names[i] != concat(begin, kExodusEnds[corners])) continue;
            names[i] = names[k];
            numbers[i] = numbers[k];
          }
        }
      }
    }
  };
  Groups groupsOf(const std::string& prefix) const {
    Groups groups;
    groups.names = texts(prefix + "_names");
    const std::string status = prefix + "_status";
    if (has(prefix + "_prop1")) {
      groups.numbers = file_->integers(prefix + "_prop1");
    } else if (has(status)) {
      std::uint64_t count = 1;
      for (const std::uint64_t size : file_->shape(status)) count *= size;
      groups.numbers.resize(count);
      std::iota(groups.numbers.begin(), groups.numbers.end(), 1);
    }
    return groups;
  }

  void readBlocks() {
    Groups groups = groupsOf("eb");
    const std::vector<std::string> by = texts("info_records");
    if (!by.empty() && by[0].starts_with(kExodusMaker)) groups.joinKinds();
    const std::vector<std::int32_t> tags = groups.tags(3);
    std::uint64_t next = 1;
    for (std::size_t b = 0; b < groups.size(); ++b) {
      // Empty blocks have no variable.
      const std::string name = concat("connect", b + 1);
      if (!has(name)) {
        if (has(concat("facconn", b + 1))) failOn("nfaced");
        continue;
      }
      readBlock(name, tags[b], next);
      elements_ = static_cast<std::int64_t>(next) - 1;
      lists_.addName(3, tags[b], groups.nameOf(b));
    }
    if (lists_.blocks.empty()) input_.fail(ErrorCode::FileUnsupported, "the file has no elements.");
  }

  [[noreturn]] void failOn(const std::string& type) const {
    input_.fail(ErrorCode::FileUnsupported, "elements of the type \"", type,
                "\" are not supported. Leave their block out.");
  }

  void readBlock(const std::string& name, std::int32_t region, std::uint64_t& next) {
    const std::string named = file_->attribute(name, "elem_type");
    const std::string type = lowerCase(named);
    const std::vector<std::uint64_t> shape = file_->shape(name);
    if (type == "nsided" || type == "nfaced" || shape.size() != 2) failOn(named);
    ElementBlock& block = lists_.blocks.emplace_back();
    const auto each = static_cast<std::size_t>(shape[1]);
    block.type = typeOf(type, each);
    const auto count = static_cast<std::size_t>(shape[0]);
    next += count;
    if (block.type == nullptr) return;
    const bool isRead =
        block.type->meditVertices == each ||
        (each <= kExodusPlaces.size() && block.type->plural.starts_with("hexahedra"));
    block.nodesEach = isRead ? each : 0;
    block.numbers.resize(count);
    for (std::size_t i = 0; i < count; ++i) block.numbers[i] = next - count + i;
    block.regions.assign(count, region);
    if (!isRead || parts_ == ElementParts::Types) return;  // others are only counted
    const std::vector<std::int64_t> nodes = file_->integers(name);
    block.nodes.resize(nodes.size());
    const bool isCurved = each == 20 || each == kExodusPlaces.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t k = i % each;
      block.nodes[i] = nodeOf(nodes[isCurved ? i - k + kExodusPlaces[k] : i], name);
    }
  }

  /// @param name  in lower case; often lacks the number of nodes
  [[nodiscard]] const VolumeCells* typeOf(const std::string& name, std::size_t nodes) const {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kNouns = {
        {{"hex", "hexahedra"}, {"tet", "tetrahedra"}, {"wedge", "prisms"}, {"pyr", "pyramids"}}};
    for (const auto& [word, noun] : kNouns) {
      if (!name.starts_with(word)) continue;
      const VolumeCells* const type = volumeCells(noun, nodes);
      if (type != nullptr && nodes <= kExodusPlaces.size()) return type;
      input_.fail(ErrorCode::FileUnsupported, noun, " with ", nodes,
                  " nodes are not known. Leave their block out.");
    }
    if (name.starts_with("bex_hex")) return volumeCells("Bezier hexahedra");
    constexpr std::array<std::string_view, 9> kFlat = {"shell", "quad", "tri",    "bar",   "beam",
                                                       "truss", "edge", "sphere", "circle"};
    const auto begins = [&name](std::string_view word) { return name.starts_with(word); };
    if (std::any_of(kFlat.begin(), kFlat.end(), begins)) return nullptr;
    input_.fail(ErrorCode::FileUnsupported, "elements of the type ", quoted(std::string_view(name)),
                " are not supported. Leave their block out.");
  }

  [[nodiscard]] Index nodeOf(std::int64_t number, const std::string& variable) const {
    if (number >= 1 && static_cast<std::uint64_t>(number) <= lists_.points.size()) {
      return static_cast<Index>(number - 1);
    }
    input_.fail(ErrorCode::IndexOutOfRange, "the variable \"", variable, "\" names node ", number,
                ", but the ", lists_.points.size(), " nodes are numbered from 1.");
  }

  void readSides() {
    const Groups groups = groupsOf("ss");
    const std::vector<std::int32_t> tags = groups.tags(2);
    lists_.sideNumbers = kExodusSides;
    for (std::size_t s = 0; s < groups.size(); ++s) {
      const std::string end = concat("_ss", s + 1);
      if (!has("elem" + end)) continue;
      if (!has("side" + end)) {
        input_.fail(ErrorCode::FileSyntax, "the file lacks the variable \"side", end, "\".");
      }
      const std::vector<std::int64_t> elements = file_->integers("elem" + end);
      const std::vector<std::int64_t> sides = file_->integers("side" + end);
      if (elements.size() != sides.size()) {
        input_.fail(ErrorCode::FileSyntax, "side set ", s + 1,
                    " has not as many sides as elements.");
      }
      const std::int32_t tag = tags[s];
      lists_.addName(2, tag, groups.nameOf(s));
      for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] < 1 || sides[i] > 6 || elements[i] < 1 || elements[i] > elements_) {
          input_.fail(ErrorCode::IndexOutOfRange, "side set ", s + 1, " names side ", sides[i],
                      " of element ", elements[i], ", but elements are numbered up to ", elements_,
                      " and have at most 6 sides.");
        }
        lists_.sides.push_back(
            {static_cast<std::uint64_t>(elements[i]), static_cast<std::uint8_t>(sides[i]), tag});
      }
    }
  }

  void readNodeSets() {
    const Groups groups = groupsOf("ns");
    for (std::size_t s = 0; s < groups.size(); ++s) {
      const std::string name = concat("node_ns", s + 1);
      if (!has(name)) continue;
      const std::int32_t tag = tagOfGroup(groups.nameOf(s), groups.numberOf(s));
      NodeSet& set = lists_.nodeSets.emplace_back(NodeSet{groups.nameOf(s), tag, {}});
      for (const std::int64_t node : file_->integers(name)) {
        set.nodes.push_back(nodeOf(node, name));
      }
    }
  }

  std::unique_ptr<HdfReader> file_;  ///< NetCDF's variables are datasets
  std::int64_t elements_ = 0;        ///< of all blocks
  const Input& input_;
  ElementParts parts_;
  ElementLists lists_;
};

}  // namespace

ElementLists readExodus(const Input& input, ElementParts parts, Stage& stage) {
  const auto readNewer = [&](const Input& file) {
    return ExodusReader(HdfReader::open(file), input, parts).read();
  };
  // Refuse other formats before reading the whole file.
  const std::string head = firstBytes(input);
  if (head == kHdfMark) return readNewer(input);
  if (!head.empty()) requireNetcdf(head, input.name());
  Array<char> room;
  const std::string_view bytes = input.text(room, stage, "");
  if (bytes.starts_with(kHdfMark)) return readNewer({bytes, input.name()});
  return ExodusReader(openNetcdf(bytes, input.name()), input, parts).read();
}

namespace {

// Exodus files of parts with Nemesis maps, `NAME.e.N.K`: shared nodes and cells, and the sizes of
// the whole mesh.

std::vector<std::int32_t> fromOneAll(const Array<std::uint64_t>& numbers, std::size_t count) {
  std::vector<std::int32_t> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) result.push_back(fromOne(numbers[i]));
  return result;
}

/// Numbers in a file that are sums over all parts, filled in later.
struct GlobalCounts {
  std::uint64_t position;
  std::vector<std::uint64_t> ofPart;
};

class NemesisFile final : public ExodusFile {
 public:
  NemesisFile(const MeshPart& part, const PartsInfo& info, const MeshGroups& groups, Stage& stage)
      : ExodusFile(part.mesh, groups, stage, true), part_(part), groups_(groups) {
    addScalar("nem_ftype", 0);  // one file for each part
    addDimension("num_processors", info.parts);
    inFile_ = addDimension("num_procs_file", 1);
    addDimension("num_nodes_global", info.pointCount);
    addDimension("num_elems_global", info.cellCount);
    addGlobalSets();
    addMaps();
    addNodes();
    addCells();
  }

  /// The file positions for the sizes of the mesh's blocks and sets, and this part's contributions;
  /// each node of a set counts in the part that owns it.
  [[nodiscard]] std::vector<GlobalCounts> globalCounts(std::uint64_t mostBytes) const {
    std::vector<GlobalCounts> counts;
    if (!blocks_.numbers.empty()) {
      counts.push_back({file_.positionOf("el_blk_cnt_global", mostBytes), blocks_.counts});
    }
    if (!sides_.numbers.empty()) {
      counts.push_back({file_.positionOf("ss_side_cnt_global", mostBytes), sides_.counts});
    }
    if (!nodes_.numbers.empty()) {
      counts.push_back({file_.positionOf("ns_node_cnt_global", mostBytes), ownedNodes()});
    }
    return counts;
  }

 private:
  [[nodiscard]] std::vector<std::uint64_t> ownedNodes() const {
    std::vector<std::uint64_t> counts;
    const auto add = [&](const auto& ofKind) {
      for (const ElementGroup& group : ofKind.groups) {
        const Array<Index> vertices = verticesOf(ofKind, group);
        counts.push_back(static_cast<std::uint64_t>(
            std::count_if(vertices.begin(), vertices.end(),
                          [this](Index v) { return part_.pointOwners[v] == part_.part; })));
      }
    };
    add(groups_.edges);
    add(groups_.vertices);
    return counts;
  }

  void addScalar(const std::string& name, std::int32_t number) {
    const Write write = [number](LineWriter& values) {
      const auto put = [number](char* place, std::size_t) { return putBigBytes(place, number); };
      values.write(1, sizeof(number), put, nullptr);
    };
    addVariable(name, NetcdfType::Int, {}, write);
  }
  /// Adds a list, and its length as a dimension; nothing if it is empty, as NetCDF expects.
  void addListOf(const std::string& name, const std::string& dimension,
                 std::vector<std::int32_t> numbers) {
    if (numbers.empty()) return;
    const std::uint32_t length = addDimension(dimension, numbers.size());
    addNumbers(name, length, std::move(numbers));
  }
  void addStatus(const std::string& name, bool isThere) {
    addNumbers(name, inFile_, {isThere ? 1 : 0});
  }

  /// Adds blocks and sets of the whole mesh. Their sizes are filled in once all parts are known.
  void addGlobalSets() {
    addCounted("el_blk", "num_el_blk_global", blocks_, {"el_blk_cnt_global"});
    addCounted("ss", "num_ss_global", sides_, {"ss_side_cnt_global", "ss_df_cnt_global"});
    addCounted("ns", "num_ns_global", nodes_, {"ns_node_cnt_global", "ns_df_cnt_global"});
  }
  void addCounted(const std::string& prefix, const std::string& dimension, const ExodusList& list,
                  const std::vector<std::string>& counts) {
    if (list.numbers.empty()) return;
    const std::uint32_t length = addDimension(dimension, list.numbers.size());
    addNumbers(prefix + "_ids_global", length, list.numbers);
    for (const std::string& name : counts) {
      addNumbers(name, length, std::vector<std::int32_t>(list.numbers.size(), 0));
    }
  }

  /// Adds global numbers of nodes, and of cells in block order.
  void addMaps() {
    if (part_.ownCells == 0) return;
    addNumbers("node_num_map", dimensionOf("num_nodes"),
               fromOneAll(part_.globalPoints, part_.ownPoints));
    std::vector<std::int32_t> cells;
    for (std::size_t i = 0; i < part_.ownCells; ++i) {
      cells.push_back(fromOne(part_.globalCells[groups_.cells.at(i)]));
    }
    addNumbers("elem_num_map", dimensionOf("num_elem"), std::move(cells));
  }

  /// Shared nodes or cells, grouped by part.
  struct Shared {
    std::vector<std::int32_t> ids;
    std::vector<std::int32_t> ends;
    std::vector<std::int32_t> elements;
    std::vector<std::int32_t> parts;

    void add(std::size_t element, std::uint32_t part) {
      elements.push_back(fromOne(element));
      parts.push_back(static_cast<std::int32_t>(part));
    }
    void endPart() {
      ids.push_back(fromOne(ids.size()));
      ends.push_back(static_cast<std::int32_t>(elements.size()));
    }
  };

  /// Adds the lists of interior and of border nodes or cells.
  /// @param kind  "n" or "e"
  /// @param word  "node" or "elem"
  void addBorder(const std::string& kind, const std::string& word,
                 const std::vector<bool>& atBorder) {
    std::vector<std::int32_t> inner;
    std::vector<std::int32_t> border;
    for (std::size_t i = 0; i < atBorder.size(); ++i) {
      (atBorder[i] ? border : inner).push_back(fromOne(i));
    }
    addStatus("int_" + kind + "_stat", !inner.empty());
    addStatus("bor_" + kind + "_stat", !border.empty());
    if (kind == "n") addStatus("ext_n_stat", false);
    addListOf(word + "_mapi", "num_int_" + word, std::move(inner));
    addListOf(word + "_mapb", "num_bor_" + word, std::move(border));
  }
  /// @return  the dimension of the concatenated lists
  std::uint32_t addShared(const std::string& kind, Shared shared) {
    const std::size_t count = shared.ids.size();
    const std::uint32_t maps = addDimension("num_" + kind + "_cmaps", count);
    const std::uint32_t all = addDimension(kind + "cnt_cmap", shared.elements.size());
    addNumbers(kind + "_comm_ids", maps, std::move(shared.ids));
    addNumbers(kind + "_comm_stat", maps, std::vector<std::int32_t>(count, 1));
    addNumbers(kind + "_comm_data_idx", maps, std::move(shared.ends));
    addNumbers(kind + "_comm_" + kind + "ids", all, std::move(shared.elements));
    addNumbers(kind + "_comm_proc", all, std::move(shared.parts));
    return all;
  }

  /// Adds the nodes shared with each neighbour.
  void addNodes() {
    std::vector<bool> atBorder(part_.ownPoints, false);
    Shared shared;
    for (const PartNeighbour& neighbour : part_.neighbours) {
      for (const Index v : neighbour.vertices) {
        atBorder[v] = true;
        shared.add(v, neighbour.part);
      }
      shared.endPart();
    }
    addBorder("n", "node", atBorder);
    if (!shared.ids.empty()) addShared("n", std::move(shared));
  }

  /// Adds the faces shared with each neighbour.
  void addCells() {
    const Array<Index> places = cellPlacesOf(groups_.cells);
    std::vector<bool> atBorder(part_.ownCells, false);
    Shared shared;
    std::vector<std::int32_t> sides;
    for (const PartNeighbour& neighbour : part_.neighbours) {
      if (neighbour.faces.empty()) continue;
      for (const PartFace& face : neighbour.faces) {
        const std::size_t place = places.empty() ? face.cell : places[face.cell];
        atBorder[place] = true;
        shared.add(place, neighbour.part);
        sides.push_back(kExodusSides.hexahedron[face.side]);
      }
      shared.endPart();
    }
    addBorder("e", "elem", atBorder);
    if (sides.empty()) return;
    addNumbers("e_comm_sids", addShared("e", std::move(shared)), std::move(sides));
  }

  const MeshPart& part_;
  const MeshGroups& groups_;
  std::uint32_t inFile_ = 0;
};

class ExodusSink final : public PartSink {
 public:
  ExodusSink(std::filesystem::path file, Context& context, ProcessTeam* team)
      : context_(context), file_(std::move(file)), team_(team), files_(team) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "Exodus files");
    requireInt32(info.pointCount, "Exodus numbers vertices");
    requireInt32(info.cellCount, "Exodus numbers cells");
    counts_.resize(info.parts);
  }

  [[nodiscard]] bool takesAnyOrder() const override { return true; }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    files_.write(part.part, fileOf(part.part), [&](OutputFile& output) {
      const MeshGroups groups = groupPart(part, info_, stage);
      const NemesisFile file(part, info_, groups, stage);
      file.write(output, context_.threads(), kMostExodusBytes);
      counts_[part.part] = file.globalCounts(kMostExodusBytes);
    });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    const std::vector<std::uint64_t> sums = addUp();
    files_.commit([&](std::uint32_t part, OutputFile& file) {
      auto sum = sums.begin();
      for (const GlobalCounts& counts : counts_[part]) {
        std::string bytes(sizeof(std::int32_t) * counts.ofPart.size(), '\0');
        char* place = bytes.data();
        for (std::size_t k = 0; k < counts.ofPart.size(); ++k) {
          place = putBigBytes(place, static_cast<std::int32_t>(*sum++));
        }
        file.writeBytesAt(counts.position, bytes.data(), bytes.size());
      }
    });
  }

 private:
  /// The sums over all parts, in all processes: as many numbers as any part has.
  [[nodiscard]] std::vector<std::uint64_t> addUp() const {
    std::vector<std::uint64_t> sums;
    const auto add = [&sums](std::size_t i, std::uint64_t number) {
      if (sums.size() <= i) sums.push_back(0);
      sums[i] += number;
    };
    for (const std::vector<GlobalCounts>& ofPart : counts_) {
      std::size_t i = 0;
      for (const GlobalCounts& counts : ofPart) {
        for (const std::uint64_t number : counts.ofPart) add(i++, number);
      }
    }
    if (team_ == nullptr) return sums;
    const GatheredNumbers all = team_->gather(std::exchange(sums, {}));
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      for (std::size_t i = 0; i < all.of(r).size(); ++i) add(i, all.of(r)[i]);
    }
    return sums;
  }
  [[nodiscard]] std::filesystem::path fileOf(std::uint32_t part) const {
    return concat(file_.string(), '.', info_.parts, '.', padded(part, info_.parts));
  }

  Context& context_;
  std::filesystem::path file_;
  ProcessTeam* team_;
  PartsInfo info_;
  FileSet files_;
  std::vector<std::vector<GlobalCounts>> counts_;  ///< per part
};

}  // namespace

std::unique_ptr<PartSink> openExodusPartSink(const std::filesystem::path& file, Context& context,
                                             ProcessTeam* team) {
  return std::make_unique<ExodusSink>(file, context, team);
}

// Whole meshes.

void writeExodus(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage,
                 std::uint64_t mostBytes) {
  requireInt32(mesh.points.size(), "An Exodus file numbers vertices");
  const OtherCells& others = othersOf(options);
  requireInt32(AllCells(mesh, others).size(), "An Exodus file numbers cells");
  MeshGroups groups(mesh, options, stage);
  splitBlocks(groups.cells, {mesh, others});
  ExodusFile(mesh, groups, stage, false, nullptr, {}, others)
      .write(output, stage.context().threads(), mostBytes);
}

void writeExodus(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                 Stage& stage) {
  writeExodus(mesh, output, options, stage, kMostExodusBytes);
}

void writeQuadraticExodus(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                          Stage& stage) {
  requireInt32(mesh.points.size(), "An Exodus file numbers nodes");
  const HexMesh straight = straightMesh(mesh);
  const MeshGroups groups(straight, options, stage);
  GroupNodes nodes = nodesOfGroups(mesh, straight, groups.edges, {}, stage);
  ExodusFile(straight, groups, stage, false, &mesh, std::move(nodes.edges))
      .write(output, stage.context().threads(), kMostExodusBytes);
}

}  // namespace hexhex::io
