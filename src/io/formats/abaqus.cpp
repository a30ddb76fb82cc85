// Abaqus input files, `.inp` (see formats.hpp): keyword lines begin with '*', data lines follow.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>

#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

constexpr SideNumbers kAbaqusSides = {
    {1, 2, 3, 4}, {1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}, {6, 4, 3, 5, 1, 2}};
constexpr std::string_view kAbaqusHeading = "hexahedral mesh by hexhex";

// Reading.

/// Removes and returns the next word of a line, up to a comma.
std::string_view takeField(std::string_view& line) {
  const std::size_t comma = std::min(line.find(','), line.size());
  const std::string_view word = trimmed(line.substr(0, comma));
  line.remove_prefix(std::min(comma + 1, line.size()));
  return word;
}

/// A keyword line such as "*Element, type=C3D8", in lower case; a flag has an empty value.
struct AbaqusKeyword {
  std::string name;
  std::map<std::string, std::string> parameters;

  [[nodiscard]] bool has(const std::string& parameter) const {
    return parameters.contains(parameter);
  }
  [[nodiscard]] std::string value(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? std::string() : found->second;
  }
};

/// An element type. Names of volumes have "3D" behind letters for the family and before the number
/// of nodes, which letters for the formulation follow.
struct AbaqusType {
  const VolumeCells* cells = nullptr;  ///< null unless it is a volume that is known
  std::size_t nodes = 0;               ///< 0 unless it is a volume
};

AbaqusType abaqusType(std::string_view name) {
  for (const std::size_t corners : {6U, 8U}) {  // continuum shells are prisms and hexahedra
    for (const char* const family : {"sc", "css"}) {
      if (name.starts_with(concat(family, corners))) return {&typeWith(corners), corners};
    }
  }
  // C3D8, AC3D8, ...; cohesive COH3D8; Q3D8, F3D8; but not M3D4, R3D4, T3D2, CONN3D2, and not F3D3
  // and F3D4, which are faces of cavities
  constexpr std::string_view kLastOfFamily = "chqf";
  const std::size_t place = name.find("3d");
  if (place == std::string_view::npos || place == 0) return {};
  if (kLastOfFamily.find(name[place - 1]) == std::string_view::npos) return {};
  AbaqusType type{nullptr, 1};
  std::from_chars(name.data() + place + 2, name.data() + name.size(), type.nodes);
  if (name[place - 1] == 'f' && type.nodes <= 4) return {};
  if (type.nodes > 27) return type;  // in an order that is not known
  for (const std::string_view noun : {"hexahedra", "tetrahedra", "prisms", "pyramids"}) {
    if (type.cells == nullptr) type.cells = volumeCells(noun, type.nodes);
  }
  return type;
}

/// The number of corners of a shell or membrane (4 or 3) or of a beam or truss (2), as which Gmsh
/// writes groups of quads, triangles and lines; 0 for other elements. Corners come first.
std::size_t cornersOfFacet(std::string_view name) {
  constexpr std::array<std::string_view, 13> kQuads = {"cps4",   "cps4r",   "cpe4",  "s4",  "s4r",
                                                       "s4rs",   "m3d4",    "m3d4r", "s8r", "cps8",
                                                       "sfm3d4", "sfm3d4r", "m3d9"};
  constexpr std::array<std::string_view, 10> kTriangles = {
      "cps3", "cpe3", "s3", "s3r", "ds3", "stri3", "m3d3", "sfm3d3", "cps6", "stri65"};
  constexpr std::array<std::string_view, 4> kLines = {"t3d2", "b31", "t2d2", "t3d3"};
  const auto isIn = [name](const auto& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (isIn(kQuads)) return 4;
  if (isIn(kTriangles)) return 3;
  return isIn(kLines) ? 2 : 0;
}

/// Reads a file and those that it includes.
class AbaqusReader {
 public:
  AbaqusReader(const Input& input, ElementParts parts, Stage& stage)
      : input_(input), wanted_(parts), stage_(stage) {}

  ElementLists read() {
    Array<char> room;
    const File& file = add({input_.text(room, stage_, "*"), input_.name(), input_.path()});
    main_ = &file;
    readLines({&file, 0, file.text.size()});
    if (!prefix_.empty()) input_.fail(ErrorCode::FileSyntax, "*END INSTANCE is missing.");
    if (wanted_ == ElementParts::All) finish();
    return std::move(lists_);
  }

 private:
  struct File {
    std::string_view text;
    std::string name;
    std::filesystem::path path;
    Array<char> bytes = {};  ///< of an included one
  };
  /// Lines that each instance reads, with numbers and names of its own.
  struct Part {
    const File* file;
    std::size_t begin;
    std::size_t end;
  };
  struct Surface {
    std::string name;
    std::vector<ElementSide> sides;
  };
  using Sets = std::map<std::string, std::vector<std::uint64_t>>;

  static constexpr std::uint64_t kOfAssembly = std::uint64_t{1} << 62;
  static constexpr std::uint64_t kOfInstance = std::uint64_t{1} << 40;  ///< times its position
  static constexpr std::uint64_t kItemsPerByte = 2;  // of text: at most 16 times its size
  static constexpr std::uint64_t kItemsPerSide = 2 * sizeof(ElementSide) / sizeof(std::uint64_t);

  const File& add(File&& file) {
    textSize_ += file.text.size();
    return files_.emplace(realPath(file.path), std::move(file)).first->second;
  }
  [[nodiscard]] static std::filesystem::path realPath(const std::filesystem::path& file) {
    std::error_code unknown;
    std::filesystem::path path = std::filesystem::canonical(file, unknown);
    return unknown ? file : path;
  }

  void readLines(const Part& lines) {
    constexpr std::uint64_t kMostTimes = 128;
    read_ += lines.end - lines.begin;
    if (read_ > kMostTimes * textSize_) {
      fail(concat("instances and *INCLUDE repeat lines to more than ", kMostTimes,
                  " times the size of the files"),
           ErrorCode::TooLarge);
    }
    itemsLeft_ += kItemsPerByte * (lines.end - lines.begin);
    TextScanner scanner(lines.file->text.substr(0, lines.end), lines.file->name);
    scanner.moveTo(lines.begin);
    TextScanner* const outer = std::exchange(scanner_, &scanner);
    while (nextLine()) {
      if (!line_.starts_with("*")) {
        failIfFirst();
        continue;  // data of an ignored keyword
      }
      const AbaqusKeyword keyword = readKeyword();
      if (keyword.name == "*include") {
        include(keyword, lines.file->path);
      } else if (keyword.name == "*part" && wanted_ == ElementParts::All && hasInstances()) {
        skipPart(keyword.value("name"), *lines.file);
      } else {
        readBlock(keyword);
      }
    }
    scanner_ = outer;
  }

  /// Whether there are instances, which read parts; otherwise these are read where they stand.
  bool hasInstances() {
    if (!hasInstances_) {
      const std::string_view line = line_;
      hasInstances_ = hasInstances(*main_);
      line_ = line;
    }
    return *hasInstances_;
  }
  bool hasInstances(const File& file) {
    if (!searched_.insert(&file).second) return false;
    TextScanner scanner(file.text, file.name);
    TextScanner* const outer = std::exchange(scanner_, &scanner);
    bool found = false;
    while (!found && nextLine()) {
      if (!line_.starts_with("*")) continue;
      const AbaqusKeyword keyword = readKeyword();
      found = keyword.name == "*instance" ||
              (keyword.name == "*include" && hasInstances(included(keyword, file.path)));
    }
    scanner_ = outer;
    return found;
  }

  void skipPart(const std::string& name, const File& file) {
    if (inPart_) fail("a part begins in another one");
    const std::size_t begin = scanner_->position();
    std::size_t end = begin;
    for (; nextLine(); end = scanner_->position()) {
      if (!line_.starts_with("*")) continue;
      const std::string keyword = keywordOf(line_);
      if (keyword == "*endpart") break;
      if (keyword != "*part" && keyword != "*assembly") continue;
      scanner_->moveTo(end);
      break;
    }
    parts_.emplace(name, Part{&file, begin, end});
  }

  /// Moves to the next line that is neither blank nor a comment. @return false at the end of the
  /// file
  bool nextLine() {
    while (scanner_->position() < scanner_->text().size()) {
      line_ = trimmed(scanner_->takeLine());
      if (!line_.starts_with("**") && !line_.empty()) return true;
    }
    return false;
  }
  /// Moves to the next data line; returns false and stays in place at a keyword.
  bool nextData() {
    const std::size_t before = scanner_->position();
    if (nextLine() && !line_.starts_with("*")) return true;
    scanner_->moveTo(std::min(before, scanner_->text().size()));
    return false;
  }

  /// The keyword of a line: "* Node" is "*NODE", and "*END INSTANCE" one word.
  [[nodiscard]] static std::string keywordOf(std::string_view line) {
    std::string keyword = lowerCase(takeField(line));
    std::erase_if(keyword, isSpace);
    return keyword;
  }
  AbaqusKeyword readKeyword() {
    begun_ = true;
    std::string text(line_);
    while (text.ends_with(',') && nextLine()) text += line_;
    std::string_view rest = text;
    static_cast<void>(takeField(rest));
    AbaqusKeyword keyword{keywordOf(text), {}};
    while (!rest.empty()) {
      const std::string_view word = takeField(rest);
      const std::size_t equals = std::min(word.find('='), word.size());
      std::string_view value = trimmed(word.substr(std::min(equals + 1, word.size())));
      if (value.size() > 1 && value.starts_with('"') && value.ends_with('"')) {
        value = value.substr(1, value.size() - 2);
      }
      const std::string name = lowerCase(trimmed(word.substr(0, equals)));
      // File names are case-sensitive.
      keyword.parameters[name] = name == "input" ? std::string(value) : lowerCase(value);
    }
    return keyword;
  }

  void readBlock(const AbaqusKeyword& keyword) {
    if (keyword.has("input") && (keyword.name == "*node" || keyword.name == "*element")) {
      fail("data lines in a file of their own (INPUT=...) are not read. Put the file's lines here",
           ErrorCode::FileUnsupported);
    }
    if (wanted_ == ElementParts::Types && keyword.name != "*element") return;
    constexpr std::array<std::string_view, 4> kOutsideParts = {"*assembly", "*endassembly",
                                                               "*instance", "*endinstance"};
    if (inPart_ && std::find(kOutsideParts.begin(), kOutsideParts.end(), keyword.name) !=
                       kOutsideParts.end()) {
      fail(quoted(std::string_view(keyword.name)) + " cannot be in a part");
    }
    if (keyword.name == "*node") {
      readNodes(keyword);
    } else if (keyword.name == "*element") {
      readElements(keyword);
    } else if (keyword.name == "*nset") {
      readSet(keyword, keyword.value("nset"), nodeSets_);
    } else if (keyword.name == "*elset") {
      readSet(keyword, keyword.value("elset"), elementSets_);
      if (!keyword.has("internal")) listedSets_.push_back(prefix_ + keyword.value("elset"));
    } else if (keyword.name == "*surface") {
      readSurface(keyword);
    } else if (keyword.name == "*heading") {
      isOwn_ = nextData() && line_ == kAbaqusHeading;
    } else if (keyword.name == "*solidsection") {
      sections_.push_back(prefix_ + keyword.value("elset"));
    } else if (keyword.name == "*endassembly") {
      if (instances_.size() < 2) scope_ = 0;
    } else if (keyword.name == "*instance") {
      readInstance(keyword);
    } else if (keyword.name == "*endinstance") {
      placeInstance();
    } else {
      refuse(keyword.name);
    }
  }

  /// Refuses keywords that generate or transform parts of the mesh.
  void refuse(const std::string& keyword) const {
    constexpr std::array<std::string_view, 8> kMakers = {
        "*ngen",  "*nfill",  "*ncopy",  "*nmap",
        "*elgen", "*elcopy", "*system", "*symmetricmodelgeneration"};
    if (std::find(kMakers.begin(), kMakers.end(), keyword) == kMakers.end()) return;
    fail("the keyword " + quoted(std::string_view(keyword)) +
             " makes or moves nodes or elements, which is not supported. Let the program that "
             "made the file write all nodes and elements",
         ErrorCode::FileUnsupported);
  }

  /// Reads where an instance is: a translation, and behind it a rotation about the line through two
  /// points, by an angle in degrees; and its part.
  void readInstance(const AbaqusKeyword& keyword) {
    const std::string name = keyword.value("name");
    if (!prefix_.empty()) fail("*END INSTANCE is missing above");
    scope_ = kOfInstance * instances_.size();
    if (scope_ >= kOfAssembly) fail("the assembly has too many instances", ErrorCode::TooLarge);
    if (!instances_.emplace(name, scope_).second) {
      fail("two instances have the name " + quoted(std::string_view(name)));
    }
    longest_ = std::max(longest_, name.size());
    const auto part = parts_.find(keyword.value("part"));
    if (part == parts_.end() && keyword.has("part")) {
      fail("no part above has the name " + quoted(std::string_view(keyword.value("part"))));
    }
    prefix_ = name + '.';
    firstPoint_ = lists_.points.size();
    for (const std::size_t count : {3U, 7U}) {
      if (!nextData()) break;
      std::string_view rest = line_;
      for (std::size_t k = 0; k < count; ++k) {
        const std::string_view word = takeField(rest);
        place_.push_back(word.empty() ? 0 : real(word));
      }
    }
    if (part == parts_.end()) return;
    inPart_ = true;
    readLines(part->second);
    inPart_ = false;
  }

  void placeInstance() {
    scope_ = kOfAssembly;
    prefix_.clear();
    const std::vector<double> place = std::exchange(place_, {});
    if (place.empty()) return;
    const auto points = std::span(lists_.points).subspan(firstPoint_);
    for (Vec3& point : points) point = plus(point, {place[0], place[1], place[2]});
    if (place.size() == 3) return;
    const Vec3 begin{place[3], place[4], place[5]};
    const Vec3 along = minus(Vec3{place[6], place[7], place[8]}, begin);
    if (!(length(along) > 0)) fail("the axis of the instance's rotation has no direction");
    const Vec3 axis = times(1 / length(along), along);
    const double angle = place[9] * std::numbers::pi / 180;
    for (Vec3& point : points) {  // the formula of Rodrigues
      const Vec3 arm = minus(point, begin);
      const Vec3 middle = times(dot(axis, arm) * (1 - std::cos(angle)), axis);
      const Vec3 turned =
          plus(times(std::cos(angle), arm), times(std::sin(angle), cross(axis, arm)));
      point = plus(begin, plus(turned, middle));
    }
  }

  void include(const AbaqusKeyword& keyword, const std::filesystem::path& path) {
    constexpr int kDeepest = 32;
    if (depth_ == kDeepest) fail("files include each other without end");
    const File& file = included(keyword, path);
    ++depth_;
    readLines({&file, 0, file.text.size()});
    --depth_;
  }

  const File& included(const AbaqusKeyword& keyword, const std::filesystem::path& path) {
    const std::string name = keyword.value("input");
    if (name.empty()) fail("*INCLUDE needs the name of a file: INPUT=...");
    if (path.empty()) fail("a text in memory cannot include files", ErrorCode::FileUnsupported);
    const std::filesystem::path file = path.parent_path() / name;
    const auto known = files_.find(realPath(file));
    if (known != files_.end()) return known->second;
    constexpr std::size_t kMost = 1000;
    if (files_.size() > kMost) fail(concat("more than ", kMost, " files are included"));
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) {
      fail("there is no file " + quoted(std::string_view(file.string())) + " to include",
           ErrorCode::FileNotFound);
    }
    Array<char> bytes = readWholeFile(file, stage_);
    const std::string_view text = withoutByteOrderMark(asText(bytes));
    return add({text, file.string(), file, std::move(bytes)});
  }

  void readNodes(const AbaqusKeyword& keyword) {
    if (keyword.has("system") && keyword.value("system") != "r") {
      fail("nodes in cylindrical or spherical coordinates are not supported",
           ErrorCode::FileUnsupported);
    }
    const std::string set = keyOf(keyword.value("nset"), 'n');
    std::vector<std::uint64_t>* const items = set.empty() ? nullptr : &nodeSets_[set];
    ofNodeSets_ |= scope_;
    while (nextData()) {
      std::string_view rest = line_;
      nodeNumbers_.push_back(scoped(takeField(rest), "the number of a node"));
      Vec3 point{};
      for (double& coordinate : point) {
        if (rest.empty()) break;  // missing coordinates are 0
        const std::string_view word = takeField(rest);
        if (!word.empty()) coordinate = real(word);
      }
      lists_.points.push_back(point);
      if (items != nullptr) items->push_back(nodeNumbers_.back());
    }
  }

  void readElements(const AbaqusKeyword& keyword) {
    const std::string name = keyword.value("type");
    if (name.empty()) fail("*ELEMENT needs a type: TYPE=C3D8");
    const AbaqusType type = abaqusType(name);
    ElementBlock& block = lists_.blocks.emplace_back();
    block.type = type.cells;
    block.nodesEach = type.nodes;
    const std::string set = keyOf(keyword.value("elset"), 'e');
    if (!set.empty()) blockSets_.push_back(set);
    if (scope_ == kOfAssembly && type.nodes > 0) {
      fail("the assembly has elements of its own, which are not read. Give them a part",
           ErrorCode::FileUnsupported);
    }
    ofElementSets_ |= scope_;
    if (scope_ == kOfAssembly) return;  // masses, connectors and the like
    if (type.nodes > 0 && keyword.has("offset")) {
      fail(
          "OFFSET makes nodes of elements, which is not supported. Let the program that made the "
          "file write them",
          ErrorCode::FileUnsupported);
    }
    while (nextData()) {
      std::string_view rest = line_;
      const std::uint64_t number = scoped(takeField(rest), "the number of an element");
      if (type.nodes == 0) {
        readFacet(cornersOfFacet(name), number, rest, set);
        continue;
      }
      if (type.cells == nullptr) {
        fail("elements of the type " + quoted(std::string_view(name)) + " are not known",
             ErrorCode::FileUnsupported);
      }
      block.numbers.push_back(number);
      if (wanted_ == ElementParts::Types) return;
      if (!set.empty()) elementSets_[set].push_back(number);
      for (std::size_t k = 0; k < type.nodes; ++k) {
        if (trimmed(rest).empty()) {
          if (!nextData()) fail(concat("the nodes of element ", number ^ scope_, " are missing"));
          rest = line_;
        }
        block.listed.push_back(scoped(takeField(rest), "a node of an element"));
      }
      const bool hasPressures = name.starts_with("coh3d");  // of pores, at further nodes
      if (rest.find_first_not_of(", \t") != std::string_view::npos && !hasPressures) {
        fail(concat("more nodes than the ", type.nodes, " of element ", number ^ scope_));
      }
      if (type.nodes == 27) putFacesInOrder(std::span(block.listed).last(7));
    }
  }

  /// C3D27 lists the node in the middle before those of the faces S1 to S6.
  static void putFacesInOrder(std::span<std::uint64_t> nodes) {
    constexpr std::array<std::size_t, 7> kPlaces = {6, 4, 3, 5, 1, 2, 0};  // of VTK's last nodes
    std::array<std::uint64_t, 7> listed{};
    std::copy(nodes.begin(), nodes.end(), listed.begin());
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = listed[kPlaces[k]];
  }

  void readFacet(std::size_t nodes, std::uint64_t number, std::string_view rest,
                 const std::string& set) {
    if (nodes == 0 || wanted_ == ElementParts::Types) return;
    FlatElement& facet = facets_.emplace_back(FlatElement{number, nodes, {}});
    for (std::size_t k = 0; k < nodes; ++k) {
      facet.nodes[k] = scoped(takeField(rest), "a node of an element");
    }
    if (!set.empty()) facetSets_[set].push_back(number);
  }

  void readSet(const AbaqusKeyword& keyword, const std::string& name, Sets& sets) {
    if (name.empty()) fail("the set has no name");
    const std::string key = keyOf(name, &sets == &nodeSets_ ? 'n' : 'e');
    std::vector<std::uint64_t>& set = sets[key];
    const std::uint64_t ofAssembly = &sets == &nodeSets_ ? ofNodeSets_ : ofElementSets_;
    Scope scope = {prefix_, instances_.size() > 1 ? scope_ : scope_ & ofAssembly};
    // Flattened files still name what they were of.
    if (keyword.has("instance") && !instances_.empty()) scope = scopeOf(keyword.value("instance"));
    while (nextData()) {
      std::string_view rest = line_;
      if (keyword.has("generate")) {
        addRange(rest, scope.numbers, set);
        continue;
      }
      while (!trimmed(rest).empty()) {
        const std::string_view word = takeField(rest);
        if (word.empty()) continue;
        std::uint64_t number = 0;
        if (parseInteger(word, number)) {
          set.push_back(scoped(word, kOfMember, scope.numbers));
          continue;
        }
        const Named named = nameOf(word, scope, sets);
        if (parseInteger(named.word, number)) {
          set.push_back(scoped(named.word, kOfMember, named.scope));
          continue;
        }
        const auto other = sets.find(named.key);
        if (other == sets.end()) {
          if (&sets == &elementSets_ && addFacetSet(named.key, key)) continue;
          fail("the set names " + quoted(word) + ", which is no number, and no set above");
        }
        append(other->second, set);
      }
    }
  }

  /// @param items  a copy: a set may name itself
  void append(std::vector<std::uint64_t> items, std::vector<std::uint64_t>& set) {
    takeRoom(items.size());
    set.insert(set.end(), items.begin(), items.end());
  }

  /// Elements that are no cells have sets of their own; those of other types are not kept.
  /// @return whether elements above have this set
  bool addFacetSet(const std::string& named, const std::string& name) {
    const auto facets = facetSets_.find(named);
    if (facets == facetSets_.end()) {
      return std::find(blockSets_.begin(), blockSets_.end(), named) != blockSets_.end();
    }
    append(facets->second, facetSets_[name]);
    return true;
  }

  /// Where numbers and names without an instance in front belong.
  struct Scope {
    std::string prefix;  ///< of names
    std::uint64_t numbers;
  };
  [[nodiscard]] Scope scopeOf(std::string_view instance) const {
    const auto found = instances_.find(std::string(instance));
    if (found == instances_.end()) fail("there is no instance " + quoted(instance));
    return {found->first + '.', found->second};
  }
  /// A word of a set or surface: a number, or a set by its key.
  struct Named {
    std::string word;  ///< without the instance
    std::uint64_t scope;
    std::string key;
  };
  [[nodiscard]] Named nameOf(std::string_view word, Scope scope, const Sets& sets) const {
    const bool quotes = word.size() > 1 && word.front() == '"' && word.back() == '"';
    std::string name = lowerCase(quotes ? word.substr(1, word.size() - 2) : word);
    for (std::size_t dot = name.find('.'); dot <= longest_; dot = name.find('.', dot + 1)) {
      const auto found = instances_.find(name.substr(0, dot));
      if (found == instances_.end() || sets.contains(scope.prefix + name)) continue;
      scope = {found->first + '.', found->second};
      name.erase(0, dot + 1);
      break;
    }
    std::string key = scope.prefix + name;
    // A set of the only part.
    if (instances_.size() == 1 && !sets.contains(key)) key = instances_.begin()->first + '.' + name;
    return {name, scope.numbers, key};
  }
  /// The name of a set or surface, if it has one, with the instance in front.
  /// @param kind  of nodes, elements or surfaces, which may have the same name
  std::string keyOf(const std::string& name, char kind) {
    if (name.empty()) return {};
    std::string key = prefix_ + name;
    if (plainNames_.emplace(kind + key, name).second) ++uses_[kind + name];
    return key;
  }

  /// Adds a range "first, last, step" to a set.
  void addRange(std::string_view rest, std::uint64_t offset, std::vector<std::uint64_t>& set) {
    const std::uint64_t first = scoped(takeField(rest), "the first of a range", offset);
    const std::uint64_t last = scoped(takeField(rest), "the last of a range", offset);
    const std::string_view word = takeField(rest);
    const std::uint64_t step = word.empty() ? 1 : integer(word, "the step of a range");
    if (step == 0 || last < first) fail("a range is \"first, last, step\", upwards");
    takeRoom((last - first) / step + 1);
    for (std::uint64_t i = first;; i += step) {
      set.push_back(i);
      if (last - i < step) break;
    }
  }
  /// Bounds the size of sets: a short line may generate a huge range.
  void takeRoom(std::uint64_t items) {
    if (items > itemsLeft_) {
      fail("the sets have far more members than the file has nodes and elements",
           ErrorCode::TooLarge);
    }
    itemsLeft_ -= items;
  }

  void readSurface(const AbaqusKeyword& keyword) {
    const std::string type = keyword.value("type");
    Surface& surface = surfaces_.emplace_back(Surface{keyOf(keyword.value("name"), 's'), {}});
    const Scope scope = {prefix_, instances_.size() > 1 ? scope_ : 0};
    while (nextData()) {
      if (!type.empty() && type != "element") continue;
      std::string_view rest = line_;
      const Named elements = nameOf(takeField(rest), scope, elementSets_);
      const std::string face = lowerCase(takeField(rest));
      // Others are the whole surface, or a side of a shell.
      if (face.size() != 2 || face[0] != 's' || face[1] < '1' || face[1] > '6') continue;
      const auto side = static_cast<std::uint8_t>(face[1] - '0');
      const auto set = elementSets_.find(elements.key);
      if (set == elementSets_.end()) {
        surface.sides.push_back(
            {scoped(elements.word, "an element or a set of them", elements.scope), side, 0});
      } else {
        takeRoom(kItemsPerSide * set->second.size());
        for (const std::uint64_t element : set->second) {
          surface.sides.push_back({element, side, 0});
        }
      }
    }
  }

  /// Resolves node numbers, and turns names of groups into tags.
  void finish() {
    if (nodeNumbers_.empty()) {
      input_.fail(ErrorCode::FileUnsupported, "the file has no *NODE section.");
    }
    const std::uint64_t digits = instances_.empty() ? kAllDigits : kOfInstance - 1;
    const NodeTags nodes = nodesByNumber(nodeNumbers_, input_, digits);
    lists_.nameNodes(nodes, input_, "*NODE section", digits);
    tagRegions();
    tagSurfaces();
    for (const std::size_t corners : {4U, 3U, 2U}) tagFacets(corners, nodes);
    for (auto& [name, set] : nodeSets_) {
      NodeSet& added = lists_.nodeSets.emplace_back(
          NodeSet{ownName(name, 'n'), static_cast<std::int32_t>(lists_.nodeSets.size()) + 1, {}});
      for (const std::uint64_t number : set) {
        const Index node = nodes.find(number);
        if (node != kNone) added.nodes.push_back(node);
      }
      set = {};
    }
  }

  /// The name of a set or surface without its instance, unless another of its kind would have the
  /// same.
  [[nodiscard]] const std::string& plainName(const std::string& key, char kind) const {
    const auto plain = plainNames_.find(kind + key);
    return plain != plainNames_.end() && uses_.at(kind + plain->second) == 1 ? plain->second : key;
  }

  /// The plain name of a group without the prefix "E_", "N_" or "S_" that the writer adds.
  [[nodiscard]] std::string ownName(const std::string& key, char kind) const {
    const std::string& name = plainName(key, kind);
    const bool prefixed = name.size() > 2 && name[1] == '_' &&
                          std::string_view("ens").find(name[0]) != std::string_view::npos;
    return prefixed && (isOwn_ || tagInGroupName(name.substr(2))) ? name.substr(2) : name;
  }

  /// Sets of volume elements alone that *ELSET lists, large ones first, so that the smallest set of
  /// an element is its region. Gmsh and meshio write regions so.
  [[nodiscard]] std::vector<std::string> volumeSets() const {
    if (listedSets_.empty()) return {};
    ElementTags volumes;
    for (const ElementBlock& block : lists_.blocks) {
      for (const std::uint64_t number : block.numbers) volumes.add(number, 1);
    }
    volumes.sort();
    std::vector<std::string> names;
    for (const std::string& name : listedSets_) {
      const auto& items = elementSets_.at(name);
      const auto isVolume = [&](std::uint64_t element) { return volumes.find(element) != 0; };
      if (std::all_of(items.begin(), items.end(), isVolume)) names.push_back(name);
    }
    std::stable_sort(names.begin(), names.end(), [this](const auto& a, const auto& b) {
      return elementSets_.at(a).size() > elementSets_.at(b).size();
    });
    return names;
  }

  /// Tags regions: the sets named by *ELEMENT and, with more weight, *SOLID SECTION or, in files
  /// without these, *ELSET, numbered from 1 in this order; and the sets that this library writes.
  void tagRegions() {
    std::vector<std::string>& names = blockSets_;
    const std::vector<std::string> later = sections_.empty() ? volumeSets() : sections_;
    names.insert(names.end(), later.begin(), later.end());
    for (const auto& [name, set] : elementSets_) {
      if (ownName(name, 'e') != plainName(name, 'e')) names.push_back(name);
    }
    GroupTags tags;
    for (const std::string& name : names) tags.reserve(ownName(name, 'e'));
    std::set<std::string> done;
    ElementTags regions;
    for (const std::string& name : names) {
      const auto set = elementSets_.find(name);
      if (set == elementSets_.end()) continue;
      if (!done.insert(name).second) continue;
      const std::int32_t tag = tags.next(ownName(name, 'e'));
      lists_.addName(3, tag, ownName(name, 'e'));
      for (const std::uint64_t element : set->second) regions.add(element, tag);
    }
    regions.sort();
    lists_.setRegions(regions);
  }

  void tagSurfaces() {
    lists_.sideNumbers = kAbaqusSides;
    for (const Surface& surface : surfaces_) facetTags_.reserve(ownName(surface.name, 's'));
    for (Surface& surface : surfaces_) {
      const std::int32_t tag = facetTags_.next(ownName(surface.name, 's'));
      lists_.addName(2, tag, ownName(surface.name, 's'));
      for (ElementSide side : surface.sides) {
        side.tag = tag;
        lists_.sides.push_back(side);
      }
    }
  }

  /// A quad, triangle or line gets the tag of the first set that contains nothing else; sets named
  /// by *ELEMENT come last.
  void tagFacets(std::size_t corners, const NodeTags& nodes) {
    std::map<std::uint64_t, std::pair<const FlatElement*, std::int32_t>> facets;
    for (const FlatElement& facet : facets_) {
      if (facet.corners == corners) facets.emplace(facet.number, std::pair(&facet, 0));
    }
    for (const Sets* sets : {&elementSets_, &facetSets_}) {
      for (const auto& [name, set] : *sets) {
        const auto isUntagged = [&](std::uint64_t number) { return facets[number].second == 0; };
        if (!std::all_of(set.begin(), set.end(),
                         [&](std::uint64_t number) { return facets.contains(number); }) ||
            std::none_of(set.begin(), set.end(), isUntagged)) {
          continue;
        }
        const std::int32_t tag = facetTags_.next(plainName(name, 'e'));
        lists_.addName(corners == 2 ? 1 : 2, tag, plainName(name, 'e'));
        for (const std::uint64_t number : set) {
          if (isUntagged(number)) facets[number].second = tag;
        }
      }
    }
    for (const auto& [number, entry] : facets) lists_.addFlat(*entry.first, entry.second, nodes);
  }

  [[nodiscard]] std::uint64_t integer(std::string_view word, const char* what) const {
    std::uint64_t number = 0;
    if (parseInteger(word, number)) return number;
    fail(concat("expected ", what, ", found ", quoted(word)));
  }
  static constexpr const char* kOfMember = "a member of a set";
  /// A number of the file with what such numbers begin with.
  [[nodiscard]] std::uint64_t scoped(std::string_view word, const char* what,
                                     std::uint64_t scope) const {
    const std::uint64_t number = integer(word, what);
    if (number < kOfInstance || instances_.empty()) return scope | number;
    fail(concat("in an assembly, ", what, " must be below ", kOfInstance, ", found ", number));
  }
  [[nodiscard]] std::uint64_t scoped(std::string_view word, const char* what) const {
    return scoped(word, what, scope_);
  }
  [[nodiscard]] double real(std::string_view word) const {
    double value = 0;
    const NumberProblem problem = parseNumber(word, value);
    if (problem == NumberProblem::None) return value;
    const bool infinite = problem == NumberProblem::NotFinite || problem == NumberProblem::Overflow;
    fail("expected a coordinate of a node, found " + quoted(word),
         infinite ? ErrorCode::NotFinite : ErrorCode::FileSyntax);
  }

  void failIfFirst() const {
    if (begun_) return;
    fail("a file of Abaqus begins with a keyword like *NODE, found " + quoted(line_) +
         " (files of AVS have this extension, too, and are not read)");
  }
  /// Throws an error at the last line read.
  [[noreturn]] void fail(const std::string& sentence,
                         ErrorCode code = ErrorCode::FileSyntax) const {
    TextScanner at = *scanner_;
    at.moveTo(static_cast<std::size_t>(line_.data() - at.text().data()));
    at.fail(code, sentence + ".");
  }

  const Input& input_;
  ElementParts wanted_;
  Stage& stage_;
  TextScanner* scanner_ = nullptr;
  std::string_view line_;
  bool begun_ = false;
  bool isOwn_ = false;  ///< whether this library wrote the file
  int depth_ = 0;       ///< nesting depth of *INCLUDE
  std::map<std::string, Part> parts_;
  bool inPart_ = false;
  std::map<std::filesystem::path, File> files_;
  const File* main_ = nullptr;
  std::set<const File*> searched_;  ///< for instances
  std::optional<bool> hasInstances_;
  std::uint64_t textSize_ = 0;                      ///< of all files
  std::uint64_t read_ = 0;                          ///< of it, as often as it was
  std::map<std::string, std::uint64_t> instances_;  ///< and what their numbers begin with
  std::size_t longest_ = 0;                         ///< of their names
  std::string prefix_;               ///< of names: the instance that is read, and a dot
  std::uint64_t scope_ = 0;          ///< what numbers begin with,
  std::uint64_t ofNodeSets_ = 0;     ///< in sets if the assembly has nodes
  std::uint64_t ofElementSets_ = 0;  ///< and elements
  std::size_t firstPoint_ = 0;       ///< of the instance
  std::vector<double> place_;        ///< of the instance, until all its nodes are known
  std::map<std::string, std::string> plainNames_;  ///< of sets and surfaces, by key
  std::map<std::string, std::size_t> uses_;        ///< how many have a plain name
  std::uint64_t itemsLeft_ = 1024;                 ///< how many more members sets may have
  ElementLists lists_;
  Array<std::uint64_t> nodeNumbers_;
  Sets nodeSets_;
  Sets elementSets_;
  std::vector<std::string> blockSets_;   ///< names of sets that are regions: from *ELEMENT,
  std::vector<std::string> sections_;    ///< and from *SOLID SECTION
  std::vector<std::string> listedSets_;  ///< names from *ELSET
  std::vector<Surface> surfaces_;
  std::vector<FlatElement> facets_;
  Sets facetSets_;  ///< named by *ELEMENT
  GroupTags facetTags_;
};

}  // namespace

ElementLists readAbaqus(const Input& input, ElementParts parts, Stage& stage) {
  return AbaqusReader(input, parts, stage).read();
}

namespace {

constexpr std::size_t kLongestNumber = 20;
constexpr std::size_t kNamesPerLine = 16;

/// Writes a number with at most 20 characters.
char* putShort(char* place, double number) {
  char* end = put(place, number);
  // 13 digits always fit: sign, digit, point, 12 digits, and an exponent like "e-308".
  for (int digits = 16; static_cast<std::size_t>(end - place) > kLongestNumber; --digits) {
    end = std::to_chars(place, place + kNumberRoom, number, std::chars_format::general, digits).ptr;
  }
  return end;
}

std::string upperCase(std::string name) {
  for (char& c : name) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return name;
}

/// The vertices of an edge, the smaller one first, and its midpoint node.
using EdgeMiddle = std::pair<std::array<Index, 2>, Index>;
EdgeMiddle edgeMiddle(Index a, Index b, Index node) {
  return {{std::min(a, b), std::max(a, b)}, node};
}

/// Cells of order 2 without face and interior nodes, as in C3D20.
struct QuadraticCells {
  Array<Vec3> points;
  Array<std::array<Index, 20>> cells;
  Array<EdgeMiddle> middles;  ///< ascending

  explicit QuadraticCells(const LagrangeMesh& mesh) : cells(mesh.cellCount()) {
    // VTK's order: corners, then midpoints of the edges around the bottom, around the top, and of
    // the vertical ones.
    std::vector<std::uint32_t> places = vtkNodeOrder(2);
    places.resize(20);
    auto edges = adjacency::kHexEdges;
    std::swap(edges[10], edges[11]);
    const auto corners = static_cast<std::ptrdiff_t>(mesh.vertexCount);
    points.assign(mesh.points.begin(), mesh.points.begin() + corners);
    Array<Index> numbers(mesh.points.size());
    std::fill(numbers.begin(), numbers.end(), kNone);
    std::iota(numbers.begin(), numbers.begin() + corners, Index{0});
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::array<Index, 20>& cell = cells[i];
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Index node = mesh.nodes[i * mesh.nodesPerCell() + places[k]];
        if (numbers[node] == kNone) {
          numbers[node] = static_cast<Index>(points.size());
          points.push_back(mesh.points[node]);
        }
        cell[k] = numbers[node];
      }
      for (std::size_t e = 0; e < edges.size(); ++e) {
        middles.push_back(edgeMiddle(cell[edges[e][0]], cell[edges[e][1]], cell[8 + e]));
      }
    }
    sortUnique(middles);
  }
};

class AbaqusWriter {
 public:
  /// @param cells  with their corners
  AbaqusWriter(const AllCells& cells, OutputFile& output, Stage& stage)
      : cells_(cells), output_(output), lines_(output, stage.context().threads()), stage_(stage) {}

  /// @param elementType  "C3D8R"
  /// @param hexahedra  with all nodes
  /// @param middles  midpoint nodes of edges, ascending; empty for straight cells
  template <std::size_t nodes>
  void write(const Array<Vec3>& points, std::string_view elementType,
             const Array<std::array<Index, nodes>>& hexahedra, const MeshGroups& groups,
             const Array<EdgeMiddle>& middles) {
    output_.write("*HEADING\n").write(kAbaqusHeading).write('\n');
    writeNodes(points);
    writeElements(elementType, std::span<const std::array<Index, nodes>>(hexahedra), 0);
    std::size_t first = hexahedra.size();
    forEachOtherKind(cells_.others(), [&](auto cells) {
      this->writeElements(concat("C3D", cells[0].size()), cells, first);
      first += cells.size();
    });
    for (const ElementGroup& group : groups.cells.groups) {
      if (group.name == "hexahedra" || group.name == "all_cells") continue;  // the set of all
      writeSet("*ELSET, ELSET=E_", group, group.end - group.begin,
               [&](std::size_t i) { return groups.cells.at(group.begin + i); });
    }
    writeNodeSets(groups.quads, middles);
    writeNodeSets(groups.edges, middles);
    writeNodeSets(groups.vertices, middles);
    for (const ElementGroup& group : groups.quads.groups) writeSurface(groups.quads, group);
  }

 private:
  void writeNodes(const Array<Vec3>& points) {
    LoopProgress progress(stage_, points.size());
    output_.write("*NODE\n");
    const auto node = [&points](char* place, std::size_t i) {
      place = put(place, std::uint64_t{i} + 1);
      for (const double coordinate : points[i]) place = putShort(put(place, ", "), coordinate);
      return put(place, '\n');
    };
    lines_.write(points.size(), 4 * (kNumberRoom + 2), node, &progress);
  }

  /// @param first  index of the first element
  template <std::size_t nodes>
  void writeElements(std::string_view type, std::span<const std::array<Index, nodes>> elements,
                     std::size_t first) {
    const bool mixed = cells_.others().count() > 0;
    LoopProgress progress(stage_, elements.size());
    output_.write("*ELEMENT, TYPE=")
        .write(type)
        .write(mixed ? ", ELSET=ALL_CELLS\n" : ", ELSET=HEXAHEDRA\n");
    const auto cell = [&](char* place, std::size_t i) {
      place = put(place, std::uint64_t{first + i + 1});
      for (std::size_t k = 0; k < nodes; ++k) {
        place = put(place, k + 1 == kNamesPerLine ? ",\n" : ", ");
        place = put(place, std::uint64_t{elements[i][k]} + 1);
      }
      return put(place, '\n');
    };
    lines_.write(elements.size(), (nodes + 1) * (kNumberRoom + 2), cell, &progress);
  }

  template <class Groups>
  void writeNodeSets(const Groups& groups, const Array<EdgeMiddle>& middles) {
    for (const ElementGroup& group : groups.groups) {
      Array<Index> nodes = verticesOf(groups, group);
      if (!middles.empty()) addMiddles(groups, group, middles, nodes);
      writeSet("*NSET, NSET=N_", group, nodes.size(), [&](std::size_t i) { return nodes[i]; });
    }
  }

  /// Appends the midpoint nodes of the edges of a group's elements.
  template <class Groups>
  static void addMiddles(const Groups& groups, const ElementGroup& group,
                         const Array<EdgeMiddle>& middles, Array<Index>& nodes) {
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const auto& element = groups.elements[i];
      for (std::size_t k = 0; element.size() > 1 && k < element.size(); ++k) {
        const EdgeMiddle wanted = edgeMiddle(element[k], element[(k + 1) % element.size()], 0);
        const auto found = std::lower_bound(middles.begin(), middles.end(), wanted);
        if (found != middles.end() && found->first == wanted.first) nodes.push_back(found->second);
      }
    }
    sortUnique(nodes);
  }

  /// @param indexAt  returns the index of the i-th of n members
  template <class F>
  void writeSet(std::string_view keyword, const ElementGroup& group, std::size_t n,
                const F& indexAt) {
    output_.write(keyword).write(upperCase(group.name)).write('\n');
    const auto entry = [&](char* place, std::size_t i) {
      const bool ends = i + 1 == n || (i + 1) % kNamesPerLine == 0;
      return put(put(place, std::uint64_t{indexAt(i)} + 1), ends ? "\n" : ", ");
    };
    lines_.write(n, kNumberRoom + 2, entry, nullptr);
  }

  /// Writes a surface of a group's boundary quads, without interior ones.
  void writeSurface(const QuadGroups& quads, const ElementGroup& group) {
    const std::size_t count = quads.boundaryEnd(group) - group.begin;
    if (count == 0) return;
    output_.write("*SURFACE, TYPE=ELEMENT, NAME=S_").write(upperCase(group.name)).write('\n');
    const auto face = [&](char* place, std::size_t i) {
      const std::uint64_t side = quads.places[group.begin + i];
      place = put(put(place, side / 8 + 1), ", S");
      const auto& sides = kAbaqusSides[cells_[side / 8].size()];
      return put(put(place, std::uint64_t{sides[side % 8]}), '\n');
    };
    lines_.write(count, kNumberRoom + 5, face, nullptr);
  }

  const AllCells& cells_;
  OutputFile& output_;
  LineWriter lines_;
  Stage& stage_;
};

}  // namespace

void writeAbaqus(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                 Stage& stage) {
  const MeshGroups groups(mesh, options, stage);
  const std::string_view type = options.elementType.empty() ? "C3D8" : options.elementType;
  const AllCells all(mesh, othersOf(options));
  AbaqusWriter(all, output, stage).write(mesh.points, type, mesh.cells, groups, {});
}

void writeQuadraticAbaqus(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                          Stage& stage) {
  const HexMesh straight = straightMesh(mesh);
  const MeshGroups groups(straight, options, stage);
  const QuadraticCells cells(mesh);
  AbaqusWriter({straight, noOthers()}, output, stage)
      .write(cells.points, "C3D20", cells.cells, groups, cells.middles);
}

}  // namespace hexhex::io
