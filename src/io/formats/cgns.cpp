// CGNS files (see formats.hpp): a tree of nodes in HDF5, as the standard maps it ("SIDS-to-HDF"). A
// node is a group with its name, label, data type and data.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <deque>
#include <hdf5.h>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>
#include <base/numbered_sets.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/cgns_structured.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

// Reading: zones with sections of elements or structured ones, boundary conditions that name
// elements or vertices, and connections between zones.

constexpr std::int64_t kCgnsMixed = 20;
constexpr std::int64_t kCgnsPolygons = 22;
constexpr std::int64_t kCgnsPolyhedra = 23;

/// A face of a structured zone takes as much memory as so many members of a condition.
constexpr std::uint64_t kMembersOfFace = 8;

/// An element type of the standard.
struct CgnsType {
  std::int64_t number;
  std::size_t nodes;
  std::size_t corners;         ///< up to 4; for types that are not volumes
  std::string_view noun = {};  ///< for volumes
};

constexpr std::array<CgnsType, 20> kCgnsTypes = {{{2, 1, 1},
                                                  {3, 2, 2},
                                                  {4, 3, 2},
                                                  {5, 3, 3},
                                                  {6, 6, 3},
                                                  {7, 4, 4},
                                                  {8, 8, 4},
                                                  {9, 9, 4},
                                                  {10, 4, 4, "tetrahedra"},
                                                  {11, 10, 4, "tetrahedra"},
                                                  {12, 5, 5, "pyramids"},
                                                  {13, 14, 5, "pyramids"},
                                                  {14, 6, 6, "prisms"},
                                                  {15, 15, 6, "prisms"},
                                                  {16, 18, 6, "prisms"},
                                                  {17, 8, 8, "hexahedra"},
                                                  {18, 20, 8, "hexahedra"},
                                                  {19, 27, 8, "hexahedra"},
                                                  {21, 13, 5, "pyramids"},
                                                  {24, 4, 2}}};

class CgnsReader {
 public:
  CgnsReader(const Input& input, ElementParts parts, Stage& stage)
      : input_(input), parts_(parts), file_(HdfReader::openAny(input, stage)) {}

  ElementLists read() {
    for (const std::string& base : nodes("", "CGNSBase_t")) {
      for (const std::string& path : nodes(base, "Zone_t")) zones_.push_back({path});
    }
    if (zones_.empty()) input_.fail(ErrorCode::FileUnsupported, "the file has no zones.");
    for (Zone& zone : zones_) readZone(zone);
    if (parts_ == ElementParts::All) {
      connect();
      tagElements();
    }
    return std::move(lists_);
  }

 private:
  struct Zone {
    std::string path;
    std::size_t firstPoint = 0;
    std::size_t points = 0;
    std::size_t axes = 1;      ///< 3: structured
    ZoneGrid grid = {};        ///< of its vertices
    std::uint64_t before = 0;  ///< offset of its element numbers
    std::uint64_t last = 0;    ///< largest element number in the file
    bool isJoined = false;     ///< with another zone

    [[nodiscard]] Index vertexAt(const ZonePlace& place) const {
      return static_cast<Index>(firstPoint + grid.numberOf(place));
    }
  };
  /// A named set of elements, numbered uniquely across zones.
  struct Group {
    std::string name;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;  ///< first and last
  };
  /// An element that is not a volume.
  struct Flat {
    std::uint64_t number;
    std::size_t corners;
    std::array<Index, 4> nodes;
  };

  // The tree: a node is a group with a label that gives its kind.

  /// The paths of the children with this label.
  [[nodiscard]] std::vector<std::string> nodes(const std::string& parent, std::string_view label,
                                               std::string_view name = {}) const {
    std::vector<std::string> found;
    for (const std::string& member : file_->members(parent.empty() ? "/" : parent)) {
      if (member.starts_with(' ') || (!name.empty() && member != name)) continue;
      std::string path = parent.empty() ? "" : parent + '/';
      path += member;
      if (file_->attribute(path, "type") == "LK") {
        input_.fail(ErrorCode::FileUnsupported, "\"", path,
                    "\" is a link into another file. Save the mesh as one file.");
      }
      if (file_->attribute(path, "label") == label) found.push_back(path);
    }
    return found;
  }
  [[nodiscard]] static std::string nameOf(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
  }
  [[nodiscard]] static std::string parentOf(const std::string& path) {
    return path.substr(0, path.rfind('/'));
  }
  [[nodiscard]] std::string textOf(const std::string& path) const {
    std::string text = file_->text(path + "/ data");
    text.resize(std::min(text.find('\0'), text.size()));
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }
  /// The text of the first child with this label; empty if there is none.
  [[nodiscard]] std::string textIn(const std::string& parent, std::string_view label) const {
    const std::vector<std::string> found = nodes(parent, label);
    return found.empty() ? std::string() : textOf(found[0]);
  }
  /// The integers of the child with this label and name; empty if there is none.
  [[nodiscard]] std::vector<std::int64_t> integersIn(const std::string& parent,
                                                     std::string_view label,
                                                     std::string_view name) const {
    const std::vector<std::string> found = nodes(parent, label, name);
    if (found.empty()) return {};
    return file_->integers(found[0] + "/ data");
  }

  void readZone(Zone& zone) {
    const std::string type = textIn(zone.path, "ZoneType_t");
    const bool isStructured = type == "Structured";
    if (!isStructured && type != "Unstructured") {
      input_.fail(ErrorCode::FileUnsupported, "the zone \"", zone.path,
                  "\" is neither structured nor unstructured.");
    }
    zone.before = lastNumber_;
    zone.firstPoint = lists_.points.size();
    if (parts_ == ElementParts::All) readPoints(zone);
    zone.grid.size[0] = static_cast<std::int64_t>(zone.points);
    if (isStructured) {
      readCells(zone);
    } else {
      for (const std::string& section : nodes(zone.path, "Elements_t")) readSection(zone, section);
    }
    lastNumber_ = zone.before + zone.last;
    if (parts_ == ElementParts::All) readConditions(zone);
  }

  /// The cells of a structured zone, whose sizes are numbers of vertices and, behind them, of cells
  /// along the axes.
  void readCells(Zone& zone) {
    const std::vector<std::int64_t> sizes = file_->integers(zone.path + "/ data");
    zone.axes = 3;
    if (sizes.size() != 9 || *std::min_element(sizes.begin(), sizes.begin() + 3) < 2) {
      input_.fail(ErrorCode::FileUnsupported, "the structured zone \"", zone.path,
                  "\" does not have three axes with two vertices or more, so it has no hexahedra.");
    }
    if (parts_ == ElementParts::Types) return;
    const auto points = static_cast<std::int64_t>(zone.points);
    std::copy_n(sizes.begin(), 3, zone.grid.size.begin());
    if (points / sizes[0] / sizes[1] / sizes[2] != 1 || sizes[0] * sizes[1] * sizes[2] != points) {
      input_.fail(ErrorCode::FileSyntax, "the structured zone \"", zone.path, "\" has ", points,
                  " vertices, but its size is ", sizes[0], " x ", sizes[1], " x ", sizes[2],
                  ". Planes of rind are not read.");
    }
    const ZoneRange cells = {{1, 1, 1}, zone.grid.between().size};
    ElementBlock& block = lists_.blocks.emplace_back();
    block.type = volumeCells("hexahedra");
    block.nodesEach = 8;
    block.nodes.reserve(8 * static_cast<std::size_t>(cells.count()));
    block.numbers.reserve(static_cast<std::size_t>(cells.count()));
    cells.forEach([&](ZonePlace corner) {
      block.numbers.push_back(zone.before + ++zone.last);
      for (std::size_t layer = 0; layer < 2; ++layer, ++corner[2]) {
        const Quad v = zone.grid.faceAt(zone.firstPoint, 2, corner);
        block.nodes.insert(block.nodes.end(), v.begin(), v.end());
      }
    });
    volumeGroups_.push_back(
        {nameByFamily(zone, zone.path), {{zone.before + 1, zone.before + zone.last}}});
  }

  void readPoints(Zone& zone) {
    const std::vector<std::string> grids = nodes(zone.path, "GridCoordinates_t");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name = concat("Coordinate", "XYZ"[axis]);
      const std::vector<std::string> found =
          grids.empty() ? std::vector<std::string>() : nodes(grids[0], "DataArray_t", name);
      if (found.empty()) {
        input_.fail(ErrorCode::FileUnsupported, "the zone \"", zone.path, "\" has no array \"",
                    name, "\".");
      }
      setCoordinates(lists_, zone.firstPoint, axis, file_->reals(found[0] + "/ data"), input_);
    }
    zone.points = lists_.points.size() - zone.firstPoint;
  }

  void readSection(Zone& zone, const std::string& section) {
    const std::vector<std::int64_t> kind = file_->integers(section + "/ data");
    const std::vector<std::int64_t> range = integersIn(section, "IndexRange_t", "ElementRange");
    if (kind.empty() || range.size() != 2 || range[0] < 1 || range[1] < range[0] ||
        range[1] > kMostElements) {
      input_.fail(ErrorCode::FileSyntax, "the section \"", section, "\" has no range of elements.");
    }
    const auto first = static_cast<std::uint64_t>(range[0]);
    const auto last = static_cast<std::uint64_t>(range[1]);
    const bool isKnown = kind[0] == kCgnsMixed || typeOf(kind[0], section) != nullptr;
    if (kind[0] == kCgnsPolyhedra) {
      input_.counts()->add(*volumeCells("polyhedra"), last - first + 1);
    }
    if (!isKnown) return;
    const std::vector<std::int64_t> values =
        integersIn(section, "DataArray_t", "ElementConnectivity");
    std::map<const CgnsType*, std::size_t> blocks;
    std::size_t place = 0;
    for (std::uint64_t number = first; number <= last; ++number) {
      const bool tellsType = kind[0] == kCgnsMixed && place < values.size();
      const CgnsType* const type = typeOf(tellsType ? values[place++] : kind[0], section);
      if (type == nullptr || type->nodes > values.size() - place) {
        input_.fail(ErrorCode::FileSyntax, "the section \"", section,
                    "\" lists too few nodes, or "
                    "elements of a type that a mixed one cannot have.");
      }
      addElement(zone, section, *type, number, values.data() + place, blocks);
      place += type->nodes;
    }
    zone.last = std::max(zone.last, last);
    const std::string name = nameOf(section);
    const bool isOwn = tagInGroupName(name).has_value();
    if (blocks.empty() && !isOwn) return;  // boundary conditions tag other flat elements
    (blocks.empty() ? flatGroups_ : volumeGroups_)
        .push_back({name, {{zone.before + first, zone.before + last}}});
  }

  /// The type of a section's elements; null for polygons and polyhedra, which are stored
  /// differently.
  [[nodiscard]] const CgnsType* typeOf(std::int64_t number, const std::string& section) const {
    if (number == kCgnsPolygons || number == kCgnsPolyhedra) return nullptr;
    const auto* const found =
        std::find_if(kCgnsTypes.begin(), kCgnsTypes.end(),
                     [number](const CgnsType& type) { return type.number == number; });
    if (found != kCgnsTypes.end()) return found;
    input_.fail(ErrorCode::FileUnsupported, "the section \"", section,
                "\" has elements of the type ", number,
                ", which are not supported: none of more than 27 nodes are.");
  }

  /// @param blocks  of the section
  void addElement(const Zone& zone, const std::string& section, const CgnsType& type,
                  std::uint64_t number, const std::int64_t* values,
                  std::map<const CgnsType*, std::size_t>& blocks) {
    const auto nodeAt = [&](std::size_t k) {
      if (values[k] >= 1 && static_cast<std::uint64_t>(values[k]) <= zone.points) {
        return static_cast<Index>(zone.firstPoint + static_cast<std::size_t>(values[k]) - 1);
      }
      input_.fail(ErrorCode::IndexOutOfRange, "the section \"", section, "\" names vertex ",
                  values[k], ", but its zone has ", zone.points, ", numbered from 1.");
    };
    const bool needsNodes = parts_ == ElementParts::All;
    if (type.noun.empty()) {
      if (!needsNodes) return;
      Flat& flat = flats_.emplace_back(Flat{zone.before + number, type.corners, {}});
      for (std::size_t k = 0; k < type.corners; ++k) flat.nodes[k] = nodeAt(k);
      return;
    }
    const auto [known, isNew] = blocks.emplace(&type, lists_.blocks.size());
    if (isNew) {
      ElementBlock& added = lists_.blocks.emplace_back();
      added.type = volumeCells(type.noun, type.nodes);
      added.nodesEach = type.nodes;
    }
    ElementBlock& block = lists_.blocks[known->second];
    block.numbers.push_back(zone.before + number);
    const bool isCurved = type.noun == "hexahedra" && type.nodes > type.corners;
    for (std::size_t k = 0; k < type.nodes && needsNodes; ++k) {
      block.nodes.push_back(nodeAt(isCurved ? kCgnsPlaces[k] : k));
    }
  }

  /// Boundary conditions name elements or vertices, by lists or ranges; those of one family form
  /// one group.
  void readConditions(const Zone& zone) {
    for (const std::string& all : nodes(zone.path, "ZoneBC_t")) {
      for (const std::string& condition : nodes(all, "BC_t")) {
        const std::string location = textIn(condition, "GridLocation_t");
        Group group{nameByFamily(zone, condition), {}};
        if (zone.axes == 3) {
          readStructured(zone, condition, location, std::move(group));
          continue;
        }
        const bool ofVertices = isOfVertices(location);
        readRanges(condition, "Point", ofVertices ? zone.points : zone.last, group);
        if (ofVertices && !group.ranges.empty()) {
          addNodes(zone, group);
        } else {
          readRanges(condition, "Element", zone.last, group);
          for (auto& [first, last] : group.ranges) {
            first += zone.before;
            last += zone.before;
          }
          // Gmsh says so of faces, too.
          const bool ofCells = location == "CellCenter" && !beginsFlat(group);
          (ofCells ? volumeGroups_ : flatGroups_).push_back(std::move(group));
        }
      }
    }
  }

  /// Where conditions and connections are, if they do not say so.
  [[nodiscard]] static bool isOfVertices(const std::string& location) {
    return location.empty() || location == "Vertex";
  }

  /// Conditions of structured zones name faces, by the vertices of a plane or by their lowest
  /// corners; or other vertices; or cells.
  void readStructured(const Zone& zone, const std::string& condition, const std::string& location,
                      Group group) {
    const bool ofVertices = isOfVertices(location);
    const bool ofCells = location == "CellCenter";
    if (!ofVertices && !ofCells && !location.ends_with("FaceCenter")) return;
    Group faces{group.name, {}};
    for (const ZoneRange& named : rangesIn(zone.axes, condition, "Point")) {
      ZoneRange range = named.ascending();
      const std::optional<std::size_t> across =
          ofCells ? std::nullopt : axisOf(condition, location, range);
      const ZoneGrid grid = ofVertices ? zone.grid : zone.grid.between(across);
      if (!grid.has(range.first) || !grid.has(range.last)) failCondition(condition);
      takeMembers((across ? kMembersOfFace : 1) * range.count());
      if (!across) {
        range.forEach([&](const ZonePlace& place) {
          const std::uint64_t number = grid.numberOf(place) + 1 + (ofVertices ? 0 : zone.before);
          group.ranges.emplace_back(number, number);
        });
        continue;
      }
      // Vertices of a plane: all but the last ones are the lowest corners of faces.
      if (ofVertices) range.last = ZoneGrid{range.last}.between(across).size;
      const std::uint64_t first = lastFace_ + 1;
      range.forEach([&](const ZonePlace& corner) {
        const Quad v = zone.grid.faceAt(zone.firstPoint, *across, corner);
        flats_.push_back({++lastFace_, v.size(), v});
      });
      if (lastFace_ >= first) faces.ranges.emplace_back(first, lastFace_);
    }
    if (ofVertices && !group.ranges.empty()) addNodes(zone, group);
    if (ofCells) volumeGroups_.push_back(std::move(group));
    if (!faces.ranges.empty()) flatGroups_.push_back(std::move(faces));
  }

  /// The axis across which a condition names faces; nothing if it names vertices.
  [[nodiscard]] std::optional<std::size_t> axisOf(const std::string& condition,
                                                  const std::string& location,
                                                  const ZoneRange& range) const {
    const bool ofFaces = location.ends_with("FaceCenter");
    const std::size_t letter = std::string_view("IJK").find(location.substr(0, 1));
    if (ofFaces && letter < 3) return letter;
    const std::optional<std::size_t> flat = range.flatAxis();
    if (flat || !ofFaces) return flat;
    input_.fail(ErrorCode::FileUnsupported, "the condition \"", condition,
                "\" does not say across which axis its faces are (IFaceCenter).");
  }

  /// The name of its family, or of the one that this belongs to, as do Gmsh's, or its own.
  [[nodiscard]] std::string nameByFamily(const Zone& zone, const std::string& condition) const {
    const std::string family = textIn(condition, "FamilyName_t");
    if (family.empty()) return nameOf(condition);
    const std::vector<std::string> found = nodes(parentOf(zone.path), "Family_t", family);
    const std::string above = found.empty() ? std::string() : textIn(found[0], "FamilyName_t");
    return above.empty() ? family : above;
  }
  [[nodiscard]] bool beginsFlat(const Group& group) const {
    return !group.ranges.empty() &&
           std::any_of(flats_.begin(), flats_.end(),
                       [&](const Flat& flat) { return flat.number == group.ranges[0].first; });
  }

  void readRanges(const std::string& condition, const std::string& what, std::uint64_t most,
                  Group& group) {
    const ZoneGrid all = {{static_cast<std::int64_t>(most), 1, 1}};
    for (const auto& [first, last] : rangesIn(1, condition, what)) {
      if (!all.has(first) || !all.has(last) || last < first) failCondition(condition);
      group.ranges.emplace_back(all.numberOf(first) + 1, all.numberOf(last) + 1);
      takeMembers(group.ranges.back().second - group.ranges.back().first + 1);
    }
  }
  /// The range and the list that a node has.
  /// @param what  "Point" or "Element"
  /// @param suffix  "Donor" for those in another zone
  [[nodiscard]] std::vector<ZoneRange> rangesIn(std::size_t axes, const std::string& node,
                                                const std::string& what,
                                                const std::string& suffix = {}) const {
    std::vector<ZoneRange> ranges;
    const std::vector<std::int64_t> range =
        integersIn(node, "IndexRange_t", what + "Range" + suffix);
    if (range.size() == 2 * axes) {
      ZoneRange& added = ranges.emplace_back();
      std::copy_n(range.begin(), axes, added.first.begin());
      std::copy_n(range.begin() + static_cast<std::ptrdiff_t>(axes), axes, added.last.begin());
    }
    const std::vector<std::int64_t> list = integersIn(node, "IndexArray_t", what + "List" + suffix);
    for (std::size_t i = 0; i + axes <= list.size(); i += axes) {
      ZoneRange& added = ranges.emplace_back();
      std::copy_n(list.begin() + static_cast<std::ptrdiff_t>(i), axes, added.first.begin());
      added.last = added.first;
    }
    return ranges;
  }
  [[noreturn]] void failCondition(const std::string& condition) const {
    input_.fail(ErrorCode::IndexOutOfRange, "the condition \"", condition,
                "\" names elements or vertices that its zone does not have.");
  }
  /// Bounds the members of conditions and connections: a range takes few bytes, however many it
  /// has.
  void takeMembers(std::uint64_t count) {
    if (count > 1) members_ += count;
    constexpr std::uint64_t kMostTimes = 8;
    constexpr std::uint64_t kFew = 1U << 16;  // small zones have more faces than vertices
    if (members_ <= kMostTimes * (lists_.points.size() + lastNumber_) + kFew) return;
    input_.fail(ErrorCode::TooLarge,
                "conditions and connections have far more members than the file has elements.");
  }

  void addNodes(const Zone& zone, const Group& group) {
    NodeSet& set = lists_.nodeSets.emplace_back(
        NodeSet{group.name, static_cast<std::int32_t>(lists_.nodeSets.size()) + 1, {}});
    for (const auto& [first, last] : group.ranges) {
      for (std::uint64_t i = first; i <= last; ++i) {
        set.nodes.push_back(static_cast<Index>(zone.firstPoint + i - 1));
      }
    }
  }

  // Several zones.

  /// Merges the vertices that connections identify.
  void connect() {
    if (zones_.size() == 1 && zones_[0].axes == 1) return;
    DisjointSets same(lists_.points.size());
    for (Zone& zone : zones_) connect(zone, same);
    for (const Zone& zone : zones_) {
      if (zone.isJoined || zones_.size() == 1) continue;
      input_.fail(ErrorCode::FileUnsupported,
                  "the file has several zones, and nothing says which vertices \"", zone.path,
                  "\" shares with others (Abutting1to1). Merge them into one zone.");
    }
    const NumberedSets numbered = numberSets(same, lists_.points.size());
    Array<Vec3> kept(numbered.count);
    // Iterating backwards keeps the first point of each set.
    for (std::size_t v = numbered.setOf.size(); v > 0; --v) {
      kept[numbered.setOf[v - 1]] = lists_.points[v - 1];
    }
    lists_.points = std::move(kept);
    const auto renumber = [&numbered](auto& list) {
      for (Index& v : list) v = numbered.setOf[v];
    };
    for (ElementBlock& block : lists_.blocks) renumber(block.nodes);
    for (NodeSet& set : lists_.nodeSets) renumber(set.nodes);
    for (Flat& flat : flats_) renumber(flat.nodes);
  }

  void connect(Zone& zone, DisjointSets& same) {
    for (const std::string& all : nodes(zone.path, "ZoneGridConnectivity_t")) {
      for (const bool byRange : {false, true}) {
        const char* const label = byRange ? "GridConnectivity1to1_t" : "GridConnectivity_t";
        for (const std::string& to : nodes(all, label)) {
          for (const auto& [a, b] : sharedBy(zone, to, byRange)) same.unite(a, b);
        }
      }
    }
  }

  /// Pairs of vertices identified by a connection; none for a periodic one.
  /// @param byRange  between ranges of two structured zones
  [[nodiscard]] std::vector<std::pair<Index, Index>> sharedBy(Zone& zone, const std::string& path,
                                                              bool byRange) {
    const bool abuts = byRange || textIn(path, "GridConnectivityType_t") == "Abutting1to1";
    if (!abuts || !isOfVertices(textIn(path, "GridLocation_t"))) return {};
    for (const std::string& property : nodes(path, "GridConnectivityProperty_t")) {
      if (!nodes(property, "Periodic_t").empty()) return {};
    }
    Zone* const other = zoneNamed(textOf(path), zone);
    if (other == nullptr) failConnection(path);
    const std::vector<ZoneRange> ranges = rangesIn(zone.axes, path, "Point");
    const std::vector<ZoneRange> donors = rangesIn(other->axes, path, "Point", "Donor");
    const std::vector<Index> here = verticesOf(zone, ranges, path);
    std::vector<Index> there = verticesOf(*other, donors, path);
    if (here.size() != there.size() || (byRange && ranges.size() * donors.size() != 1)) {
      failConnection(path);
    }
    if (byRange) there = transformed(ranges[0], *other, donors[0], path);
    std::vector<std::pair<Index, Index>> pairs(here.size());
    for (std::size_t i = 0; i < here.size(); ++i) pairs[i] = {here[i], there[i]};
    // Some programs name a connection on one side only.
    if (other != &zone && !pairs.empty()) zone.isJoined = other->isJoined = true;
    return pairs;
  }
  [[nodiscard]] std::vector<Index> verticesOf(const Zone& zone,
                                              const std::vector<ZoneRange>& ranges,
                                              const std::string& path) {
    std::vector<Index> vertices;
    for (const ZoneRange& range : ranges) {
      if (!zone.grid.has(range.first) || !zone.grid.has(range.last)) failConnection(path);
      takeMembers(range.count());
      range.forEach([&](const ZonePlace& place) { vertices.push_back(zone.vertexAt(place)); });
    }
    return vertices;
  }
  /// The vertices of a range, in the order of one in the zone connected with it: for each axis
  /// there, "Transform" has the number of the one here, negative if it runs the other way.
  [[nodiscard]] std::vector<Index> transformed(const ZoneRange& there, const Zone& zone,
                                               const ZoneRange& range,
                                               const std::string& path) const {
    std::vector<std::int64_t> axes = integersIn(path, "\"int[IndexDimension]\"", "Transform");
    if (axes.empty()) axes = {1, 2, 3};
    axes.resize(3);
    std::vector<Index> vertices;
    there.forEach([&](const ZonePlace& from) {
      ZonePlace place = range.first;
      for (std::size_t k = 0; k < 3; ++k) {
        for (const std::int64_t axis : {1, 2, 3}) {
          const std::int64_t sign = axes[k] == axis ? 1 : axes[k] == -axis ? -1 : 0;
          place[static_cast<std::size_t>(axis) - 1] += sign * (from[k] - there.first[k]);
        }
      }
      if (!zone.grid.has(place)) failConnection(path);
      vertices.push_back(zone.vertexAt(place));
    });
    if (vertices.back() != zone.vertexAt(range.last)) failConnection(path);
    return vertices;
  }
  [[noreturn]] void failConnection(const std::string& path) const {
    input_.fail(ErrorCode::FileSyntax, "the connection \"", path,
                "\" does not name vertices of two zones in pairs.");
  }
  /// The zone that a connection names, perhaps with the base in front; null if there is none.
  [[nodiscard]] Zone* zoneNamed(const std::string& donor, const Zone& from) {
    const std::string base = parentOf(from.path) + '/';
    const auto find = [this](const auto& fits) {
      const auto found = std::find_if(zones_.begin(), zones_.end(), fits);
      return found == zones_.end() ? nullptr : &*found;
    };
    for (const std::string& path : {base + donor, donor}) {
      if (Zone* const zone = find([&](const Zone& each) { return each.path == path; })) return zone;
    }
    return find([&](const Zone& each) {
      return each.path.starts_with(base) &&
             withoutSpaces(nameOf(each.path)) == withoutSpaces(nameOf(donor));
    });
  }
  /// Gmsh names a zone with underscores where connections to it have spaces.
  [[nodiscard]] static std::string withoutSpaces(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  }

  // Tags.

  void tagElements() {
    // A single section of cells is not a region, unless this library named it.
    if (volumeGroups_.size() == 1 && !tagInGroupName(volumeGroups_[0].name)) volumeGroups_.clear();
    ElementTags tags;
    std::vector<TagName> names;
    addTags(volumeGroups_, {3}, tags, names);
    addTags(flatGroups_, {1, 2}, tags, names);
    tags.sort();
    lists_.setRegions(tags);
    for (const auto& [number, corners, v] : flats_) {
      lists_.addFlat(std::span(v).first(corners), tags.find(number));
    }
    lists_.addNamesInUse(names);
  }

  static void addTags(const std::vector<Group>& groups, std::initializer_list<int> dimensions,
                      ElementTags& tags, std::vector<TagName>& names) {
    GroupTags numbers;
    for (const Group& group : groups) numbers.reserve(group.name);
    std::map<std::string, std::int32_t> known;
    for (const Group& group : groups) {
      const auto place = known.find(group.name);
      const std::int32_t tag = place == known.end() ? numbers.next(group.name) : place->second;
      if (place == known.end()) {
        known.emplace(group.name, tag);
        for (const int dimension : dimensions) names.push_back({dimension, tag, group.name});
      }
      for (const auto& [first, last] : group.ranges) {
        for (std::uint64_t i = first; i <= last; ++i) tags.add(i, tag);
      }
    }
  }

  static constexpr std::int64_t kMostElements = std::int64_t{1} << 40;

  const Input& input_;
  ElementParts parts_;
  std::unique_ptr<HdfReader> file_;
  ElementLists lists_;
  std::vector<Zone> zones_;
  std::uint64_t lastNumber_ = 0;
  std::uint64_t members_ = 0;  ///< of all ranges of conditions and connections
  std::uint64_t lastFace_ = std::uint64_t{1} << 62;  ///< number of a structured zone's last face
  std::vector<Flat> flats_;
  std::vector<Group> volumeGroups_;
  std::vector<Group> flatGroups_;
};

}  // namespace

ElementLists readCgns(const Input& input, ElementParts parts, Stage& stage) {
  if (firstBytes(input).ends_with("ADF ")) {
    input.fail(ErrorCode::FileUnsupported,
               "the file is in ADF, an older form of CGNS. Convert it to HDF5: "
               "adf2hdf FILE");
  }
  return CgnsReader(input, parts, stage).read();
}

namespace {

// Writing.

/// CGNS element types by number of nodes, for orders 1 and 2.
constexpr std::int32_t elementType(std::size_t nodes) {
  constexpr std::array<std::pair<std::size_t, std::int32_t>, 7> kSectionTypes = {
      {{1, 2}, {2, 3}, {3, 4}, {4, 7}, {8, 17}, {9, 9}, {27, 19}}};
  const auto* const found = std::find_if(kSectionTypes.begin(), kSectionTypes.end(),
                                         [nodes](const auto& type) { return type.first == nodes; });
  assert(found != kSectionTypes.end());
  return found->second;
}

/// The nodes of order-2 cells, which replace the corners of straight ones.
struct QuadraticNodes {
  const LagrangeMesh& mesh;
  GroupNodes ofGroups;
  std::vector<std::uint32_t> order = quadraticOrder(kCgnsPlaces);
};

/// The data of a tree node; type "MT" if it has none.
struct CgnsData {
  const char* type = "MT";
  hid_t ofHdf = -1;
  const void* values = nullptr;
  std::initializer_list<hsize_t> shape = {};  ///< the last index varies fastest

  CgnsData() = default;
  CgnsData(std::string_view text, std::initializer_list<hsize_t> size)
      : type("C1"), ofHdf(HDF5(H5T_NATIVE_SCHAR_g)), values(text.data()), shape(size) {}
  template <class T>
  CgnsData(const T* numbers, std::initializer_list<hsize_t> size) : values(numbers), shape(size) {
    if constexpr (std::same_as<T, double>) {
      type = "R8", ofHdf = HDF5(H5T_NATIVE_DOUBLE_g);
    } else if constexpr (std::same_as<T, float>) {
      type = "R4", ofHdf = HDF5(H5T_NATIVE_FLOAT_g);
    } else if constexpr (std::same_as<T, std::int64_t>) {
      type = "I8", ofHdf = HDF5(H5T_NATIVE_INT64_g);
    } else {
      static_assert(std::same_as<T, std::int32_t>);
      type = "I4", ofHdf = HDF5(H5T_NATIVE_INT32_g);
    }
  }
};

/// A CGNS tree being written.
class CgnsFile {
 public:
  explicit CgnsFile(const OutputFile& output) : file_(output, HdfFile::Order::OfCreation) {
    describe(file_.root(), "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    const std::string_view format =
        std::endian::native == std::endian::little ? "IEEE_LITTLE_32" : "IEEE_BIG_32";
    writeSet(file_.root(), " format", {format, {format.size() + 1}});
    std::array<unsigned, 3> version{};
    HDF5(H5get_libversion)(&version[0], &version[1], &version[2]);
    std::string text = concat("HDF5 Version ", version[0], ".", version[1], ".", version[2]);
    text.resize(kTextBytes);
    writeSet(file_.root(), " hdf5version", {text, {kTextBytes}});
  }

  [[nodiscard]] hid_t root() const noexcept { return file_.root(); }

  /// @param name  at most 32 characters, as is the label
  HdfObject add(hid_t parent, const std::string& name, const char* label,
                const CgnsData& data = {}) const {
    constexpr std::int32_t kFlags = 1;
    HdfObject node = file_.group(parent, name);
    describe(node.id(), name, label, data.type);
    file_.writeAttribute(node.id(), "flags", HDF5(H5T_NATIVE_INT32_g), file_.space({1}), &kFlags);
    if (data.values != nullptr) writeSet(node.id(), " data", data);
    return node;
  }
  HdfObject addText(hid_t parent, const char* name, const char* label,
                    std::string_view text) const {
    return add(parent, name, label, {text, {text.size()}});
  }

  void close() { file_.close(); }

 private:
  static constexpr std::size_t kTextBytes = 33;

  void describe(hid_t node, std::string name, std::string label, std::string type) const {
    constexpr std::size_t kTypeBytes = 3;
    const auto write = [&](const char* attribute, std::string& text, std::size_t bytes) {
      text.resize(bytes);
      file_.writeAttribute(node, attribute, file_.text(bytes, H5T_STR_NULLTERM).id(),
                           file_.space({}), text.data());
    };
    write("name", name, kTextBytes);
    write("label", label, kTextBytes);
    write("type", type, kTypeBytes);
  }

  void writeSet(hid_t node, const char* name, const CgnsData& data) const {
    const HdfObject set = file_.dataset(node, name, data.ofHdf, file_.space(data.shape));
    set.require(HDF5(H5Dwrite)(set.id(), data.ofHdf, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values));
  }

  HdfFile file_;
};

/// Begins the tree. @return  the base, which holds the zones
HdfObject addBase(const CgnsFile& file) {
  constexpr float kVersion = 3.4F;
  constexpr std::array<std::int32_t, 2> kDimensions = {3, 3};
  static_cast<void>(
      file.add(file.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", {&kVersion, {1}}));
  return file.add(file.root(), "Base", "CGNSBase_t", {kDimensions.data(), {2}});
}

/// @tparam Number  integer type for the 1-based numbers of vertices and elements
template <class Number>
class CgnsWriter {
 public:
  /// @param curved  null: cells are straight
  CgnsWriter(const CgnsFile& file, const HexMesh& mesh, Stage& stage,
             const QuadraticNodes* curved = nullptr)
      : file_(file),
        mesh_(mesh),
        curved_(curved),
        points_(curved != nullptr ? curved->mesh.points : mesh.points),
        progress_(stage, points_.size() + mesh.cells.size()) {}

  /// @param name  of the zone
  HdfObject writeZone(hid_t base, const std::string& name, const MeshGroups& groups) {
    const std::array<Number, 3> size = {static_cast<Number>(points_.size()),
                                        static_cast<Number>(groups.cells.groups.back().end), 0};
    HdfObject zone = file_.add(base, name, "Zone_t", {size.data(), {3, 1}});
    static_cast<void>(file_.addText(zone.id(), "ZoneType", "ZoneType_t", "Unstructured"));
    writePoints(zone.id());
    for (const ElementGroup& group : groups.cells.groups) {
      writeSection(zone.id(), group, curved_ != nullptr ? kCgnsPlaces.size() : 8,
                   [&](std::size_t i, std::size_t k) { return nodeOf(groups.cells.at(i), k); });
    }
    progress_.advance(mesh_.cells.size());
    const Number firstQuad = next_;
    // Writes corners of elements, or all nodes of curved ones.
    const auto writeAll = [&](const auto& ofKind, const Array<Index>* nodes) {
      for (const ElementGroup& group : ofKind.groups) {
        const std::size_t corners = std::tuple_size_v<std::decay_t<decltype(ofKind.elements[0])>>;
        const std::size_t each =
            nodes == nullptr ? corners : nodes->size() / ofKind.elements.size();
        writeSection(zone.id(), group, each, [&](std::size_t i, std::size_t k) {
          return nodes == nullptr ? ofKind.elements[i][k] : (*nodes)[i * each + k];
        });
      }
    };
    writeAll(groups.quads, curved_ != nullptr ? &curved_->ofGroups.quads : nullptr);
    writeBoundary(zone.id(), groups.quads, firstQuad);
    writeAll(groups.edges, curved_ != nullptr ? &curved_->ofGroups.edges : nullptr);
    writeAll(groups.vertices, nullptr);
    return zone;
  }

 private:
  /// Node k of a cell in CGNS order.
  [[nodiscard]] Index nodeOf(std::size_t cell, std::size_t k) const {
    if (curved_ == nullptr) return mesh_.cells[cell][k];
    return curved_->mesh.nodes[cell * kCgnsPlaces.size() + curved_->order[k]];
  }

  void writePoints(hid_t zone) {
    const HdfObject points = file_.add(zone, "GridCoordinates", "GridCoordinates_t");
    Array<double> values(points_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = points_[i][axis];
      static_cast<void>(file_.add(points.id(), concat("Coordinate", "XYZ"[axis]), "DataArray_t",
                                  {values.data(), {values.size()}}));
    }
    progress_.advance(points_.size());
  }

  /// @param each  nodes per element
  /// @param nodeAt  returns the k-th node of an element, given its position in the sorted list
  template <class F>
  void writeSection(hid_t zone, const ElementGroup& group, std::size_t each, const F& nodeAt) {
    if (group.begin == group.end) return;
    Array<Number> vertices((group.end - group.begin) * each);
    Number* place = vertices.data();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      for (std::size_t k = 0; k < each; ++k) *place++ = static_cast<Number>(nodeAt(i, k)) + 1;
    }
    const auto end = static_cast<Number>(next_ + static_cast<Number>(group.end - group.begin));
    const std::array<Number, 2> range = {next_, static_cast<Number>(end - 1)};
    next_ = end;
    const std::array<std::int32_t, 2> kind = {elementType(each), 0};
    const HdfObject section =
        file_.add(zone, group.name, "Elements_t", {kind.data(), {kind.size()}});
    static_cast<void>(
        file_.add(section.id(), "ElementRange", "IndexRange_t", {range.data(), {range.size()}}));
    static_cast<void>(file_.add(section.id(), "ElementConnectivity", "DataArray_t",
                                {vertices.data(), {vertices.size()}}));
  }

  /// Writes a boundary condition and a family for each group. Interior quads are not boundary.
  void writeBoundary(hid_t zone, const QuadGroups& quads, Number firstQuad) {
    const HdfObject conditions = file_.add(zone, "ZoneBC", "ZoneBC_t");
    for (const ElementGroup& group : quads.groups) {
      const std::size_t count = quads.boundaryEnd(group) - group.begin;
      if (count == 0) continue;
      const auto first = static_cast<Number>(firstQuad + static_cast<Number>(group.begin));
      const std::array<Number, 2> range = {
          first, static_cast<Number>(first + static_cast<Number>(count) - 1)};
      const HdfObject condition =
          file_.addText(conditions.id(), group.name.c_str(), "BC_t", "FamilySpecified");
      static_cast<void>(
          file_.add(condition.id(), "PointRange", "IndexRange_t", {range.data(), {2, 1}}));
      static_cast<void>(
          file_.addText(condition.id(), "GridLocation", "GridLocation_t", "FaceCenter"));
      static_cast<void>(file_.addText(condition.id(), "FamilyName", "FamilyName_t", group.name));
    }
  }

  const CgnsFile& file_;
  const HexMesh& mesh_;
  const QuadraticNodes* curved_;
  const Array<Vec3>& points_;
  LoopProgress progress_;
  Number next_ = 1;  ///< number of the next element
};

/// Whether numbers need 64 bits; libraries use the same type for the sizes of sections.
bool needsWide(const HexMesh& mesh, const MeshGroups& groups,
               const QuadraticNodes* curved = nullptr) {
  const std::size_t nodes = curved != nullptr ? curved->mesh.nodes.size() : 8 * mesh.cells.size();
  const auto largest = std::max<std::uint64_t>({mesh.points.size(), groups.elementCount(), nodes});
  return largest > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
}

/// Writes a zone for each part. Connections between two zones are written once both are known.
class CgnsPartSink final : public PartSink {
 public:
  CgnsPartSink(const std::filesystem::path& path, Context& context)
      : context_(context), target_(path, OutputFile::Target::Regular) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "Zones of CGNS files");
    file_.emplace(target_);
    base_.emplace(addBase(*file_));
    std::vector<ElementGroup> families;
    addMissingGroups(families, info.quadTags, true, "surface", "boundary");
    for (const ElementGroup& family : families) {
      static_cast<void>(file_->add(base_->id(), family.name, "Family_t"));
    }
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    std::optional<HdfObject>& zone = zones_.emplace_back();
    shared_.emplace_back();
    if (part.ownCells == 0) return;
    const MeshGroups groups = groupPart(part, info_, stage);
    if (needsWide(part.mesh, groups)) {
      throw Error(ErrorCode::TooLarge,
                  "A part is too large for a zone of a CGNS file. Ask for more parts.");
    }
    zone.emplace(CgnsWriter<std::int32_t>(*file_, part.mesh, stage)
                     .writeZone(base_->id(), nameOf(part.part), groups));
    for (const PartNeighbour& neighbour : part.neighbours) {
      std::vector<std::int32_t>& list = shared_.back()[neighbour.part];
      for (const Index v : neighbour.vertices) list.push_back(static_cast<std::int32_t>(v) + 1);
    }
    addGlobal(zone->id(), "GlobalNodeNumber", "Vertex", part.globalPoints,
              [](std::size_t i) { return i; });
    addGlobal(zone->id(), "GlobalCellNumber", "CellCenter", part.globalCells,
              [&groups](std::size_t i) { return groups.cells.at(i); });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    for (std::uint32_t p = 0; p < zones_.size(); ++p) {
      if (!shared_[p].empty()) connect(p);
    }
    zones_.clear();
    base_->close();
    file_->close();
    target_.commit();
  }

 private:
  [[nodiscard]] std::string nameOf(std::uint32_t part) const {
    return "Part_" + padded(part, info_.parts);
  }
  /// Writes global numbers, from 1 on, as a solution on the zone's vertices or cells.
  template <class At>
  void addGlobal(hid_t zone, const char* name, const char* location,
                 const Array<std::uint64_t>& numbers, const At& at) const {
    std::vector<std::int64_t> values;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      values.push_back(static_cast<std::int64_t>(numbers[at(i)]) + 1);
    }
    const HdfObject solution = file_->add(zone, name, "FlowSolution_t");
    static_cast<void>(file_->addText(solution.id(), "GridLocation", "GridLocation_t", location));
    static_cast<void>(
        file_->add(solution.id(), name, "DataArray_t", {values.data(), {values.size()}}));
  }
  void connect(std::uint32_t part) const {
    const HdfObject all =
        file_->add(zones_[part]->id(), "ZoneGridConnectivity", "ZoneGridConnectivity_t");
    for (const auto& [other, vertices] : shared_[part]) {
      const std::string donor = nameOf(other);
      const HdfObject to =
          file_->add(all.id(), "to_" + donor, "GridConnectivity_t", {donor, {donor.size()}});
      static_cast<void>(file_->addText(to.id(), "GridConnectivityType", "GridConnectivityType_t",
                                       "Abutting1to1"));
      static_cast<void>(file_->addText(to.id(), "GridLocation", "GridLocation_t", "Vertex"));
      const std::vector<std::int32_t>& there = shared_[other].at(part);
      static_cast<void>(file_->add(to.id(), "PointList", "IndexArray_t",
                                   {vertices.data(), {vertices.size(), 1}}));
      static_cast<void>(
          file_->add(to.id(), "PointListDonor", "IndexArray_t", {there.data(), {there.size(), 1}}));
    }
  }

  Context& context_;
  OutputFile target_;
  PartsInfo info_;
  std::optional<CgnsFile> file_;
  std::optional<HdfObject> base_;
  std::deque<std::optional<HdfObject>> zones_;                              ///< empty: no zone
  std::vector<std::map<std::uint32_t, std::vector<std::int32_t>>> shared_;  ///< by neighbour
};

/// @param curved  null: cells are straight
void writeBase(const OutputFile& target, const HexMesh& mesh, const MeshGroups& groups,
               Stage& stage, const QuadraticNodes* curved = nullptr) {
  CgnsFile tree(target);
  {
    const HdfObject base = addBase(tree);
    for (const ElementGroup& group : groups.quads.groups) {
      if (groups.quads.boundaryEnd(group) == group.begin) continue;
      static_cast<void>(tree.add(base.id(), group.name, "Family_t"));
    }
    if (needsWide(mesh, groups, curved)) {
      static_cast<void>(
          CgnsWriter<std::int64_t>(tree, mesh, stage, curved).writeZone(base.id(), "Zone", groups));
    } else {
      static_cast<void>(
          CgnsWriter<std::int32_t>(tree, mesh, stage, curved).writeZone(base.id(), "Zone", groups));
    }
  }
  tree.close();
}

void refuseEmpty(std::size_t cells, const OutputFile& output) {
  if (cells > 0) return;
  throw Error(ErrorCode::InvalidArgument,
              output.target().string() + ": the mesh is empty, which a CGNS file cannot hold.");
}

}  // namespace

void writeCgns(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage) {
  refuseEmpty(mesh.cells.size(), output);
  writeBase(output, mesh, MeshGroups(mesh, options, stage), stage);
}

void writeQuadraticCgns(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                        Stage& stage) {
  refuseEmpty(mesh.cellCount(), output);
  const HexMesh straight = straightMesh(mesh);
  const MeshGroups groups(straight, options, stage);
  const QuadraticNodes nodes = {mesh,
                                nodesOfGroups(mesh, straight, groups.edges, groups.quads, stage)};
  writeBase(output, straight, groups, stage, &nodes);
}

std::unique_ptr<PartSink> openCgnsPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* /*team*/) {
  return std::make_unique<CgnsPartSink>(file, context);
}

}  // namespace hexhex::io
