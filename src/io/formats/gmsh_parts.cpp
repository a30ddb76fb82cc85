// Gmsh 4.1 with partitioned entities, binary: one file with all parts, or a file per part. The
// sections of a file are
//
//     head, nodes of each part, head of elements, elements of each part, head of ghosts, ghosts of
//     each part, end.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/parts.hpp>
#include <hexhex/team.hpp>

#include <base/box.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// A byte buffer.
class GmshBytes {
 public:
  void integers(std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) add(number);
  }
  void sizes(std::initializer_list<std::uint64_t> numbers) {
    for (const std::uint64_t number : numbers) add(number);
  }
  void add(const Vec3& point) {
    for (const double coordinate : point) add(coordinate);
  }
  void add(std::string_view text) { text_ += text; }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T number) {
    const auto bytes = littleBytes(number);
    text_.append(bytes.data(), bytes.size());
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

/// A surface or volume of one part.
struct PartitionEntity {
  std::uint32_t dimension;
  std::uint32_t tag;
  std::uint32_t parent;  ///< also the physical group
  std::uint32_t part;    ///< from 1 on
  Box box;
};

/// The contents of a file, or of one part, in numbers.
struct GmshSums {
  std::uint64_t nodeBlocks = 0;
  std::uint64_t nodes = 0;
  std::uint64_t elementBlocks = 0;
  std::uint64_t elements = 0;
  std::uint64_t ghosts = 0;
  std::uint64_t largestElement = 0;
  std::vector<PartitionEntity> entities;

  /// Adds the next part.
  void add(const GmshSums& part) {
    nodeBlocks += part.nodeBlocks;
    nodes += part.nodes;
    elementBlocks += part.elementBlocks;
    elements += part.elements;
    ghosts += part.ghosts;
    largestElement = std::max(largestElement, part.largestElement);
    entities.insert(entities.end(), part.entities.begin(), part.entities.end());
  }
  /// Conversion to numbers, and back, in processes of one team.
  [[nodiscard]] std::vector<std::uint64_t> packed() const {
    std::vector<std::uint64_t> numbers = {nodeBlocks, nodes,  elementBlocks,
                                          elements,   ghosts, largestElement};
    for (const PartitionEntity& entity : entities) {
      const auto words = std::bit_cast<EntityWords>(entity);
      numbers.insert(numbers.end(), words.begin(), words.end());
    }
    return numbers;
  }
  static GmshSums unpacked(std::span<const std::uint64_t> numbers) {
    GmshSums sums{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], {}};
    EntityWords words{};
    for (numbers = numbers.subspan(6); !numbers.empty(); numbers = numbers.subspan(words.size())) {
      std::copy_n(numbers.begin(), words.size(), words.begin());
      sums.entities.push_back(std::bit_cast<PartitionEntity>(words));
    }
    return sums;
  }

 private:
  using EntityWords = std::array<std::uint64_t, sizeof(PartitionEntity) / sizeof(std::uint64_t)>;
};

/// The contribution of one part to a file.
struct PartSections {
  GmshSums sums;
  GmshBytes nodes;  ///< one block, if there are any nodes
  GmshBytes elements;
  GmshBytes ghosts;
};

/// Assigns numbers to entities and elements, across all parts.
class GmshNumbers {
 public:
  explicit GmshNumbers(const PartsInfo& info) : info_(info), nextQuad_(info.cellCount + 1) {
    addMissingGroups(volumes_, regionTags(), hasZero_, "region", "hexahedra");
    if (info.regions.empty()) volumes_ = {{1, "hexahedra", 0, 0}};
    addMissingGroups(surfaces_, info.quadTags, true, "surface", "boundary");
    numberApart({&surfaces_, &volumes_});
  }
  [[nodiscard]] const std::vector<ElementGroup>& groups(std::size_t dimension) const {
    return dimension == 3 ? volumes_ : surfaces_;
  }
  /// The entity of a group in a part: unique, and above the entities of whole meshes.
  [[nodiscard]] std::uint32_t entityOf(std::size_t dimension, std::size_t group,
                                       std::uint32_t part) const {
    const std::vector<ElementGroup>& all = groups(dimension);
    std::uint64_t base = 0;
    for (const ElementGroup& each : all) base = std::max<std::uint64_t>(base, each.number);
    const std::uint64_t tag = base + 1 + group * info_.parts + part;
    requireInt32(tag, "Gmsh numbers entities");
    return static_cast<std::uint32_t>(tag);
  }
  [[nodiscard]] std::uint64_t nextQuads(std::size_t count) {
    return std::exchange(nextQuad_, nextQuad_ + count);
  }

 private:
  [[nodiscard]] std::vector<std::int32_t> regionTags() {
    std::vector<std::int32_t> tags = info_.regions;
    hasZero_ = std::erase(tags, 0) > 0;
    return tags;
  }
  const PartsInfo& info_;
  bool hasZero_ = false;
  std::vector<ElementGroup> volumes_;
  std::vector<ElementGroup> surfaces_;
  std::uint64_t nextQuad_;
};

/// Builds the sections of one part.
class SectionMaker {
 public:
  /// @param onlyOwned  whether to leave out vertices of other parts and ghost elements
  SectionMaker(const MeshPart& part, const MeshGroups& groups, GmshNumbers& numbers, bool onlyOwned)
      : part_(part), groups_(groups), numbers_(numbers), onlyOwned_(onlyOwned) {}

  [[nodiscard]] PartSections make() {
    for (const Vec3& point : part_.mesh.points) box_.add(point);
    addQuads();
    addCells();
    addNodes();
    addGhosts();
    if (!onlyOwned_) addGhostCells();
    sections_.sums.largestElement = numbers_.nextQuads(0) - 1;
    return std::move(sections_);
  }

 private:
  /// Opens the block of a group.
  void open(std::uint32_t dimension, std::size_t group, std::uint32_t part, std::uint64_t count) {
    const std::uint32_t tag = numbers_.entityOf(dimension, group, part);
    const std::uint32_t parent = numbers_.groups(dimension)[group].number;
    sections_.sums.entities.push_back({dimension, tag, parent, part + 1, box_});
    ++sections_.sums.elementBlocks;
    sections_.sums.elements += count;
    sections_.elements.integers({dimension, tag, dimension == 2 ? kGmshQuad : kGmshHexahedron});
    sections_.elements.sizes({count});
  }
  template <class Element>
  void addElement(std::uint64_t number, const Element& vertices) {
    sections_.elements.add(number);
    for (const Index v : vertices) sections_.elements.add(part_.globalPoints[v] + 1);
  }
  void addQuads() {
    for (std::size_t g = 0; g < groups_.quads.groups.size(); ++g) {
      const ElementGroup& group = groups_.quads.groups[g];
      if (group.begin == group.end) continue;
      open(2, g, part_.part, group.end - group.begin);
      std::uint64_t number = numbers_.nextQuads(group.end - group.begin);
      for (std::size_t i = group.begin; i < group.end; ++i) {
        addElement(number++, groups_.quads.elements[i]);
      }
    }
  }
  void addCells() {
    for (std::size_t g = 0; g < groups_.cells.groups.size(); ++g) {
      const ElementGroup& group = groups_.cells.groups[g];
      if (group.begin == group.end) continue;
      open(3, g, part_.part, group.end - group.begin);
      for (std::size_t i = group.begin; i < group.end; ++i) {
        const std::size_t cell = groups_.cells.at(i);
        addElement(part_.globalCells[cell] + 1, part_.mesh.cells[cell]);
      }
    }
  }
  /// Lists the ghosts by number: cells owned by other parts.
  void addGhosts() {
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      sections_.ghosts.sizes({part_.globalCells[c] + 1});
      sections_.ghosts.integers({part_.ghostParts[c - part_.ownCells] + 1});
      sections_.ghosts.sizes({1});
      sections_.ghosts.integers({part_.part + 1});
      ++sections_.sums.ghosts;
    }
  }
  /// Adds the elements of ghost cells, in entities of the parts that own them.
  void addGhostCells() {
    std::map<std::pair<std::uint32_t, std::size_t>, std::vector<std::size_t>> byEntity;
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      byEntity[{part_.ghostParts[c - part_.ownCells], groupOf(c)}].push_back(c);
    }
    for (const auto& [entity, cells] : byEntity) {
      open(3, entity.second, entity.first, cells.size());
      for (const std::size_t c : cells) addElement(part_.globalCells[c] + 1, part_.mesh.cells[c]);
    }
  }
  [[nodiscard]] std::size_t groupOf(std::size_t cell) const {
    if (part_.mesh.regions.empty()) return 0;
    const std::vector<ElementGroup>& groups = numbers_.groups(3);
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const ElementGroup& group) {
      return group.tag == part_.mesh.regions[cell];
    });
    return static_cast<std::size_t>(found - groups.begin());
  }
  void addNodes() {
    std::vector<Index> nodes;
    for (Index v = 0; v < part_.mesh.points.size(); ++v) {
      const bool isOwned = part_.pointOwners[v] == part_.part;
      if (onlyOwned_ ? isOwned : true) nodes.push_back(v);
    }
    if (nodes.empty()) return;
    sections_.sums.nodes = nodes.size();
    sections_.sums.nodeBlocks = 1;
    // In the part's first volume.
    const std::vector<PartitionEntity>& entities = sections_.sums.entities;
    const auto volume =
        std::find_if(entities.begin(), entities.end(),
                     [](const PartitionEntity& entity) { return entity.dimension == 3; });
    sections_.nodes.integers({3, volume->tag, 0});
    sections_.nodes.sizes({nodes.size()});
    for (const Index v : nodes) sections_.nodes.add(part_.globalPoints[v] + 1);
    for (const Index v : nodes) sections_.nodes.add(part_.mesh.points[v]);
  }

  const MeshPart& part_;
  const MeshGroups& groups_;
  GmshNumbers& numbers_;
  bool onlyOwned_;
  Box box_;
  PartSections sections_;
};

// The text between the sections of parts.

std::string gmshHead(const GmshNumbers& numbers, const PartsInfo& info, const GmshSums& sums) {
  GmshBytes bytes;
  bytes.add("$MeshFormat\n4.1 1 8\n");
  bytes.integers({1});
  bytes.add("\n$EndMeshFormat\n$PhysicalNames\n");
  bytes.add(concat(numbers.groups(2).size() + numbers.groups(3).size(), '\n'));
  for (const unsigned dimension : {2U, 3U}) {
    for (const ElementGroup& group : numbers.groups(dimension)) {
      bytes.add(concat(dimension, ' ', group.number, " \"", group.name, "\"\n"));
    }
  }
  bytes.add("$EndPhysicalNames\n$Entities\n");
  Box all;
  for (const PartitionEntity& entity : sums.entities) {
    all.add(entity.box.low);
    all.add(entity.box.high);
  }
  if (sums.entities.empty()) all = {{}, {}};
  bytes.sizes({0, 0, numbers.groups(2).size(), numbers.groups(3).size()});
  for (const unsigned dimension : {2U, 3U}) {
    for (const ElementGroup& group : numbers.groups(dimension)) {
      bytes.integers({group.number});
      bytes.add(all.low);
      bytes.add(all.high);
      bytes.sizes({1});
      bytes.integers({group.number});
      bytes.sizes({0});
    }
  }
  bytes.add("\n$EndEntities\n$PartitionedEntities\n");
  std::array<std::uint64_t, 4> counts{};
  for (const PartitionEntity& entity : sums.entities) ++counts[entity.dimension];
  bytes.sizes({info.parts, 0, 0, 0, counts[2], counts[3]});
  for (const unsigned dimension : {2U, 3U}) {
    for (const PartitionEntity& entity : sums.entities) {
      if (entity.dimension != dimension) continue;
      bytes.integers({entity.tag, dimension, entity.parent});
      bytes.sizes({1});
      bytes.integers({entity.part});
      bytes.add(entity.box.low);
      bytes.add(entity.box.high);
      bytes.sizes({1});
      bytes.integers({entity.parent});
      bytes.sizes({0});
    }
  }
  bytes.add("\n$EndPartitionedEntities\n$Nodes\n");
  bytes.sizes(
      {sums.nodeBlocks, sums.nodes, std::min<std::uint64_t>(sums.nodes, 1), info.pointCount});
  return bytes.text();
}

std::string gmshElementsHead(const GmshSums& sums) {
  GmshBytes bytes;
  bytes.add("\n$EndNodes\n$Elements\n");
  bytes.sizes({sums.elementBlocks, sums.elements, std::min<std::uint64_t>(sums.elements, 1),
               sums.largestElement});
  return bytes.text();
}

std::string gmshGhostsHead(const GmshSums& sums) {
  GmshBytes bytes;
  bytes.add("\n$EndElements\n");
  if (sums.ghosts == 0) return bytes.text();
  bytes.add("$GhostElements\n");
  bytes.sizes({sums.ghosts});
  return bytes.text();
}

std::string gmshEnd(const GmshSums& sums) {
  return sums.ghosts == 0 ? "" : "\n$EndGhostElements\n";
}

// The two kinds of sinks.

/// Copies everything written to a file.
void copyAll(OutputFile& from, OutputFile& to) {
  from.flush();
  std::string bytes;
  constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 22;
  for (std::uint64_t begin = 0; begin < from.position(); begin += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min(kPieceBytes, from.position() - begin)));
    from.readBytesAt(begin, bytes.data(), bytes.size());
    to.write(bytes);
  }
}

/// Base of the sinks for one file and for split files.
class GmshSink : public PartSink {
 public:
  GmshSink(Context& context, ProcessTeam* team) : context_(context), team_(team) {}
  void begin(const PartsInfo& info) override {
    info_ = info;
    numbers_.emplace(info_);
  }

 protected:
  [[nodiscard]] PartSections sectionsOf(const MeshPart& part, bool onlyOwned, Stage& stage) {
    const MeshGroups groups = groupPart(part, info_, stage);
    if (team_ != nullptr) passQuadsBefore(groups.quads.elements.size());
    return SectionMaker(part, groups, *numbers_, onlyOwned).make();
  }
  Context& context_;
  ProcessTeam* team_;
  PartsInfo info_;
  std::optional<GmshNumbers> numbers_;

 private:
  /// Reserves smaller numbers for the quads of processes of lower rank.
  void passQuadsBefore(std::uint64_t own) {
    const GatheredNumbers all = team_->gather(std::span(&own, 1));
    for (std::uint32_t r = 0; r < team_->rank(); ++r) {
      static_cast<void>(numbers_->nextQuads(all.numbers[r]));
    }
  }
};

/// Counts of everything precede the data but are known only at the end: nodes and elements are kept
/// in temporary files. In a team, the counts are known once each process has written its part.
class OneGmshFile final : public GmshSink {
 public:
  OneGmshFile(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), output_(file, team) {
    if (team != nullptr) return;
    nodes_.emplace(file, OutputFile::Target::Regular);
    elements_.emplace(file, OutputFile::Target::Regular);
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    const PartSections sections = sectionsOf(part, true, stage);
    if (team_ != nullptr) return writeTogether(sections);
    sums_.add(sections.sums);
    nodes_->write(sections.nodes.text());
    elements_->write(sections.elements.text());
    ghosts_.add(sections.ghosts.text());
  }
  void end() override {
    Stage stage(context_, "write mesh");
    if (team_ == nullptr) {
      OutputFile& output = output_.output();
      output.write(gmshHead(*numbers_, info_, sums_));
      copyAll(*nodes_, output);
      output.write(gmshElementsHead(sums_));
      copyAll(*elements_, output);
      output.write(gmshGhostsHead(sums_)).write(ghosts_.text()).write(gmshEnd(sums_));
      nodes_.reset();
      elements_.reset();
    }
    output_.commit();
  }

 private:
  static constexpr std::size_t kSections = 3;

  void writeTogether(const PartSections& own) {
    const std::array<const std::string*, kSections> mine = {&own.nodes.text(), &own.elements.text(),
                                                            &own.ghosts.text()};
    std::vector<std::uint64_t> numbers = {mine[0]->size(), mine[1]->size(), mine[2]->size()};
    const std::vector<std::uint64_t> packed = own.sums.packed();
    numbers.insert(numbers.end(), packed.begin(), packed.end());
    const GatheredNumbers gathered = team_->gather(numbers);
    std::array<std::uint64_t, kSections> before{};
    std::array<std::uint64_t, kSections> total{};
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      if (r == team_->rank()) before = total;
      const std::span<const std::uint64_t> theirs = gathered.of(r);
      for (std::size_t k = 0; k < kSections; ++k) total[k] += theirs[k];
      sums_.add(GmshSums::unpacked(theirs.subspan(kSections)));
    }
    const std::array<std::string, kSections + 1> between = {gmshHead(*numbers_, info_, sums_),
                                                            gmshElementsHead(sums_),
                                                            gmshGhostsHead(sums_), gmshEnd(sums_)};
    std::uint64_t place = 0;
    const auto write = [&](std::uint64_t position, const std::string& text) {
      output_.output().writeBytesAt(position, text.data(), text.size());
    };
    for (std::size_t k = 0; k <= kSections; ++k) {
      if (team_->rank() == 0) write(place, between[k]);
      place += between[k].size();
      if (k == kSections) break;
      write(place + before[k], *mine[k]);
      place += total[k];
    }
  }

  SharedFile output_;
  std::optional<OutputFile> nodes_;     ///< temporary, never committed
  std::optional<OutputFile> elements_;  ///< likewise
  GmshBytes ghosts_;
  GmshSums sums_;
};

class ManyGmshFiles final : public GmshSink {
 public:
  ManyGmshFiles(std::filesystem::path file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), file_(std::move(file)), files_(team) {}

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    std::string file = file_.string();
    file.insert(file.size() - file_.extension().string().size(), concat('_', part.part + 1));
    OutputFile& output = files_.add(file);
    const PartSections sections = sectionsOf(part, false, stage);
    const GmshSums& sums = sections.sums;
    output.write(gmshHead(*numbers_, info_, sums)).write(sections.nodes.text());
    output.write(gmshElementsHead(sums)).write(sections.elements.text());
    output.write(gmshGhostsHead(sums)).write(sections.ghosts.text()).write(gmshEnd(sums));
    files_.finishLast();
  }
  void end() override { files_.commit(); }

 private:
  std::filesystem::path file_;
  FileSet files_;
};

}  // namespace

std::unique_ptr<PartSink> openGmshPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* team) {
  return std::make_unique<OneGmshFile>(file, context, team);
}

std::unique_ptr<PartSink> openSplitGmshPartSink(const std::filesystem::path& file, Context& context,
                                                ProcessTeam* team) {
  return std::make_unique<ManyGmshFiles>(file, context, team);
}

}  // namespace hexhex::io
