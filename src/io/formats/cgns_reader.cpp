// Reads CGNS files (see formats.hpp) through HDF5: zones with sections of elements, boundary
// conditions that name elements, and connections between zones.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>
#include <base/numbered_sets.hpp>
#include <base/stage.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

constexpr std::int64_t kCgnsMixed = 20;
constexpr std::int64_t kCgnsPolygons = 22;
constexpr std::int64_t kCgnsPolyhedra = 23;

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
    std::uint64_t before = 0;  ///< offset of its element numbers
    std::uint64_t last = 0;    ///< largest element number in the file
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
    if (const std::string type = textIn(zone.path, "ZoneType_t"); type != "Unstructured") {
      input_.fail(ErrorCode::FileUnsupported, "the zone \"", zone.path,
                  "\" is not unstructured. Convert it to lists of "
                  "elements first.");
    }
    zone.before = lastNumber_;
    zone.firstPoint = lists_.points.size();
    if (parts_ == ElementParts::All) readPoints(zone);
    for (const std::string& section : nodes(zone.path, "Elements_t")) readSection(zone, section);
    lastNumber_ = zone.before + zone.last;
    if (parts_ == ElementParts::All) readConditions(zone);
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
        Group group{nameOfCondition(zone, condition), {}};
        const bool ofVertices = location.empty() || location == "Vertex";
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

  /// The name of its family, or of the one that this belongs to, as do Gmsh's, or its own.
  [[nodiscard]] std::string nameOfCondition(const Zone& zone, const std::string& condition) const {
    const std::string family = textIn(condition, "FamilyName_t");
    if (family.empty()) return nameOf(condition);
    const std::string base = zone.path.substr(0, zone.path.rfind('/'));
    const std::vector<std::string> found = nodes(base, "Family_t", family);
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
    const auto add = [&](std::int64_t first, std::int64_t last) {
      const auto end = static_cast<std::uint64_t>(last);
      if (first < 1 || last < first || end > most) {
        input_.fail(ErrorCode::IndexOutOfRange, "the condition \"", condition,
                    "\" names elements or vertices that its zone does "
                    "not have.");
      }
      group.ranges.emplace_back(static_cast<std::uint64_t>(first), end);
      members_ += end - static_cast<std::uint64_t>(first) + 1;
    };
    const std::vector<std::int64_t> range = integersIn(condition, "IndexRange_t", what + "Range");
    if (range.size() == 2) add(range[0], range[1]);
    for (const std::int64_t i : integersIn(condition, "IndexArray_t", what + "List")) add(i, i);
    // A range takes few bytes, however many elements it has.
    constexpr std::uint64_t kMostTimes = 8;
    if (members_ > kMostTimes * (lastNumber_ + lists_.points.size())) {
      input_.fail(ErrorCode::TooLarge,
                  "conditions have far more members than the file has elements.");
    }
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
    if (zones_.size() == 1) return;
    DisjointSets same(lists_.points.size());
    for (const Zone& zone : zones_) {
      std::size_t found = 0;
      for (const std::string& all : nodes(zone.path, "ZoneGridConnectivity_t")) {
        for (const std::string& to : nodes(all, "GridConnectivity_t")) {
          for (const auto& [a, b] : sharedBy(zone, to)) {
            ++found;
            same.unite(a, b);
          }
        }
      }
      if (found > 0) continue;
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

  /// Pairs of vertices identified by a connection; none for a periodic one.
  [[nodiscard]] std::vector<std::pair<Index, Index>> sharedBy(const Zone& zone,
                                                              const std::string& path) const {
    const std::string location = textIn(path, "GridLocation_t");
    const bool ofVertices = location.empty() || location == "Vertex";
    if (!ofVertices || textIn(path, "GridConnectivityType_t") != "Abutting1to1") return {};
    for (const std::string& property : nodes(path, "GridConnectivityProperty_t")) {
      if (!nodes(property, "Periodic_t").empty()) return {};
    }
    const std::string donor = nameOf(textOf(path));
    const auto other = std::find_if(zones_.begin(), zones_.end(),
                                    [&](const Zone& each) { return nameOf(each.path) == donor; });
    const std::vector<std::int64_t> here = integersIn(path, "IndexArray_t", "PointList");
    const std::vector<std::int64_t> there = integersIn(path, "IndexArray_t", "PointListDonor");
    const auto isIn = [](const std::vector<std::int64_t>& list, const Zone& of) {
      return std::all_of(list.begin(), list.end(), [&of](std::int64_t i) {
        return i >= 1 && static_cast<std::uint64_t>(i) <= of.points;
      });
    };
    if (other == zones_.end() || here.size() != there.size() || !isIn(here, zone) ||
        !isIn(there, *other)) {
      input_.fail(ErrorCode::FileSyntax, "the connection \"", path,
                  "\" does not name vertices of two zones in pairs.");
    }
    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t i = 0; i < here.size(); ++i) {
      pairs.emplace_back(zone.firstPoint + static_cast<std::size_t>(here[i]) - 1,
                         other->firstPoint + static_cast<std::size_t>(there[i]) - 1);
    }
    return pairs;
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
  std::uint64_t members_ = 0;  ///< of all boundary conditions
  std::vector<Flat> flats_;
  std::vector<Group> volumeGroups_;
  std::vector<Group> flatGroups_;
};

}  // namespace

ElementLists readCgns(const Input& input, ElementParts parts, Stage& stage) {
  if (firstBytes(input).starts_with("@(#)")) {
    input.fail(ErrorCode::FileUnsupported,
               "the file is in ADF, an older form of CGNS. Convert it to HDF5: "
               "adf2hdf FILE");
  }
  return CgnsReader(input, parts, stage).read();
}

}  // namespace hexhex::io
