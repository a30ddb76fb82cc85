// Gmsh 4.1 with partitioned entities, binary: one file with all parts, or a file for each part.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/gmsh/gmsh_elements.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/part_groups.hpp>
#include <io/parts/parts.hpp>

namespace hexhex {
namespace {

/// Bytes that are collected.
class Bytes {
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
  template <class T>
  void add(T number) {
    const auto bytes = littleBytes(number);
    text_.append(bytes.data(), bytes.size());
  }
  void append(const Bytes& other) { text_ += other.text_; }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

/// A surface or volume of one part.
struct PartitionEntity {
  std::uint32_t dimension;
  std::uint32_t tag;
  std::uint32_t parent;  ///< also the physical group
  std::uint32_t part;    ///< from 1
  Vec3 low;
  Vec3 high;
};

/// Elements of one entity.
struct ElementBlock {
  std::uint32_t dimension;
  std::uint32_t tag;
  std::uint64_t count;
  Bytes elements;
};

struct GhostElement {
  std::uint64_t element;
  std::uint32_t part;   ///< whose it is, from 1
  std::uint32_t ghost;  ///< whose ghost it is, from 1
};

/// What one part adds to a file.
struct PartSections {
  std::vector<PartitionEntity> entities;
  Bytes nodes;  ///< one block, if there are any nodes
  std::uint64_t nodeCount = 0;
  std::vector<ElementBlock> blocks;
  std::vector<GhostElement> ghosts;
};

/// Numbers of entities and elements, across all parts.
class GmshNumbers {
 public:
  explicit GmshNumbers(const PartsInfo& info) : info_(info), nextQuad_(info.cellCount + 1) {
    addMissingGroups(volumes_, regionTags(), hasZero_, "region", "hexahedra");
    if (info.regions.empty()) volumes_ = {{1, "hexahedra", 0, 0}};
    addMissingGroups(surfaces_, info.quadTags, true, "surface", "boundary");
  }
  [[nodiscard]] const std::vector<ElementGroup>& groups(std::size_t dimension) const {
    return dimension == 3 ? volumes_ : surfaces_;
  }
  /// The entity of a group in a part: behind those of whole meshes, and different for all.
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

/// Makes the sections of one part.
class SectionMaker {
 public:
  /// @param onlyOwned  whether vertices that another part owns are left out
  SectionMaker(const MeshPart& part, const MeshGroups& groups, GmshNumbers& numbers, bool onlyOwned)
      : part_(part), groups_(groups), numbers_(numbers), onlyOwned_(onlyOwned) {}

  [[nodiscard]] PartSections make() {
    measure();
    addQuads();
    addCells();
    addNodes();
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      sections_.ghosts.push_back(
          {part_.globalCells[c] + 1, part_.ghostParts[c - part_.ownCells] + 1, part_.part + 1});
    }
    if (!onlyOwned_) addGhostCells();
    return std::move(sections_);
  }

 private:
  void measure() {
    if (part_.mesh.points.empty()) return;
    low_ = high_ = part_.mesh.points[0];
    for (const Vec3& point : part_.mesh.points) {
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], point[k]);
        high_[k] = std::max(high_[k], point[k]);
      }
    }
  }
  /// Opens the block of a group.
  ElementBlock& open(std::uint32_t dimension, std::size_t group, std::uint32_t part,
                     std::uint64_t count) {
    const std::uint32_t tag = numbers_.entityOf(dimension, group, part);
    const std::uint32_t parent = numbers_.groups(dimension)[group].number;
    sections_.entities.push_back({dimension, tag, parent, part + 1, low_, high_});
    sections_.blocks.push_back({dimension, tag, count, {}});
    return sections_.blocks.back();
  }
  template <class Element>
  void addElement(ElementBlock& block, std::uint64_t number, const Element& vertices) {
    block.elements.add(number);
    for (const Index v : vertices) block.elements.add(part_.globalPoints[v] + 1);
  }
  void addQuads() {
    for (std::size_t g = 0; g < groups_.quads.groups.size(); ++g) {
      const ElementGroup& group = groups_.quads.groups[g];
      if (group.begin == group.end) continue;
      ElementBlock& block = open(2, g, part_.part, group.end - group.begin);
      std::uint64_t number = numbers_.nextQuads(group.end - group.begin);
      for (std::size_t i = group.begin; i < group.end; ++i) {
        addElement(block, number++, groups_.quads.elements[i]);
      }
    }
  }
  void addCells() {
    for (std::size_t g = 0; g < groups_.cells.groups.size(); ++g) {
      const ElementGroup& group = groups_.cells.groups[g];
      if (group.begin == group.end) continue;
      ElementBlock& block = open(3, g, part_.part, group.end - group.begin);
      for (std::size_t i = group.begin; i < group.end; ++i) {
        const std::size_t cell = groups_.cells.at(i);
        addElement(block, part_.globalCells[cell] + 1, part_.mesh.cells[cell]);
      }
    }
  }
  /// Those of others are in entities of their parts.
  void addGhostCells() {
    std::map<std::pair<std::uint32_t, std::size_t>, std::vector<std::size_t>> byEntity;
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      byEntity[{part_.ghostParts[c - part_.ownCells], groupOf(c)}].push_back(c);
    }
    for (const auto& [entity, cells] : byEntity) {
      ElementBlock& block = open(3, entity.second, entity.first, cells.size());
      for (const std::size_t c : cells) {
        addElement(block, part_.globalCells[c] + 1, part_.mesh.cells[c]);
      }
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
    sections_.nodeCount = nodes.size();
    if (nodes.empty()) return;
    // Of the part's first volume.
    const auto volume =
        std::find_if(sections_.blocks.begin(), sections_.blocks.end(),
                     [](const ElementBlock& block) { return block.dimension == 3; });
    sections_.nodes.integers({3, volume->tag, 0});
    sections_.nodes.sizes({nodes.size()});
    for (const Index v : nodes) sections_.nodes.add(part_.globalPoints[v] + 1);
    for (const Index v : nodes) sections_.nodes.add(part_.mesh.points[v]);
  }

  const MeshPart& part_;
  const MeshGroups& groups_;
  GmshNumbers& numbers_;
  bool onlyOwned_;
  Vec3 low_{};
  Vec3 high_{};
  PartSections sections_;
};

/// Sums of all parts of a file.
struct FileSums {
  std::uint64_t nodeBlocks = 0;
  std::uint64_t nodes = 0;
  std::uint64_t elementBlocks = 0;
  std::uint64_t elements = 0;
  std::uint64_t largestElement = 0;
  std::vector<PartitionEntity> entities;
  std::vector<GhostElement> ghosts;

  void add(const PartSections& part, std::uint64_t largest) {
    nodeBlocks += part.nodeCount > 0 ? 1 : 0;
    nodes += part.nodeCount;
    elementBlocks += part.blocks.size();
    for (const ElementBlock& block : part.blocks) elements += block.count;
    largestElement = std::max(largestElement, largest);
    entities.insert(entities.end(), part.entities.begin(), part.entities.end());
    ghosts.insert(ghosts.end(), part.ghosts.begin(), part.ghosts.end());
  }
};

/// All before the nodes.
void writeHead(OutputFile& output, const GmshNumbers& numbers, const PartsInfo& info,
               const FileSums& sums) {
  output.write("$MeshFormat\n4.1 1 8\n");
  writeBytesOf(output, std::uint32_t{1});
  output.write("\n$EndMeshFormat\n$PhysicalNames\n");
  output.write(numbers.groups(2).size() + numbers.groups(3).size()).write('\n');
  for (const unsigned dimension : {2U, 3U}) {
    for (const ElementGroup& group : numbers.groups(dimension)) {
      output.write(dimension).write(' ').write(group.number);
      output.write(" \"").write(group.name).write("\"\n");
    }
  }
  output.write("$EndPhysicalNames\n$Entities\n");
  Vec3 low{};
  Vec3 high{};
  for (std::size_t i = 0; i < sums.entities.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = i == 0 ? sums.entities[i].low[k] : std::min(low[k], sums.entities[i].low[k]);
      high[k] = i == 0 ? sums.entities[i].high[k] : std::max(high[k], sums.entities[i].high[k]);
    }
  }
  Bytes bytes;
  bytes.sizes({0, 0, numbers.groups(2).size(), numbers.groups(3).size()});
  for (const unsigned dimension : {2U, 3U}) {
    for (const ElementGroup& group : numbers.groups(dimension)) {
      bytes.integers({group.number});
      bytes.add(low);
      bytes.add(high);
      bytes.sizes({1});
      bytes.integers({group.number});
      bytes.sizes({0});
    }
  }
  output.write(bytes.text()).write("\n$EndEntities\n$PartitionedEntities\n");
  bytes = {};
  std::array<std::uint64_t, 4> counts{};
  for (const PartitionEntity& entity : sums.entities) ++counts[entity.dimension];
  bytes.sizes({info.parts, 0, 0, 0, counts[2], counts[3]});
  for (const unsigned dimension : {2U, 3U}) {
    for (const PartitionEntity& entity : sums.entities) {
      if (entity.dimension != dimension) continue;
      bytes.integers({entity.tag, dimension, entity.parent});
      bytes.sizes({1});
      bytes.integers({entity.part});
      bytes.add(entity.low);
      bytes.add(entity.high);
      bytes.sizes({1});
      bytes.integers({entity.parent});
      bytes.sizes({0});
    }
  }
  output.write(bytes.text()).write("\n$EndPartitionedEntities\n$Nodes\n");
  bytes = {};
  bytes.sizes(
      {sums.nodeBlocks, sums.nodes, std::min<std::uint64_t>(sums.nodes, 1), info.pointCount});
  output.write(bytes.text());
}

void beginElements(OutputFile& output, const FileSums& sums) {
  output.write("\n$EndNodes\n$Elements\n");
  Bytes bytes;
  bytes.sizes({sums.elementBlocks, sums.elements, std::min<std::uint64_t>(sums.elements, 1),
               sums.largestElement});
  output.write(bytes.text());
}

void writeBlocks(OutputFile& output, const PartSections& part) {
  for (const ElementBlock& block : part.blocks) {
    Bytes bytes;
    bytes.integers(
        {block.dimension, block.tag, block.dimension == 2 ? kGmshQuad : kGmshHexahedron});
    bytes.sizes({block.count});
    output.write(bytes.text()).write(block.elements.text());
  }
}

void writeTail(OutputFile& output, const FileSums& sums) {
  output.write("\n$EndElements\n");
  if (sums.ghosts.empty()) return;
  output.write("$GhostElements\n");
  Bytes bytes;
  bytes.sizes({sums.ghosts.size()});
  for (const GhostElement& ghost : sums.ghosts) {
    bytes.sizes({ghost.element});
    bytes.integers({ghost.part});
    bytes.sizes({1});
    bytes.integers({ghost.ghost});
  }
  output.write(bytes.text()).write("\n$EndGhostElements\n");
}

/// Copies all that was written to a file.
void copyAll(OutputFile& from, OutputFile& to) {
  from.flush();
  std::string bytes;
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 22;
  for (std::uint64_t begin = 0; begin < from.position(); begin += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min(kPiece, from.position() - begin)));
    from.readBytesAt(begin, bytes.data(), bytes.size());
    to.write(bytes);
  }
}

/// What both kinds of files have in common.
class GmshSink : public PartSink {
 public:
  explicit GmshSink(Context& context) : context_(context) {}
  void begin(const PartsInfo& info) override {
    info_ = info;
    numbers_.emplace(info_);
  }

 protected:
  [[nodiscard]] PartSections sectionsOf(const MeshPart& part, const MeshGroups& groups,
                                        bool onlyOwned, FileSums& sums) {
    PartSections sections = SectionMaker(part, groups, *numbers_, onlyOwned).make();
    sums.add(sections, numbers_->nextQuads(0) - 1);
    return sections;
  }
  Context& context_;
  PartsInfo info_;
  std::optional<GmshNumbers> numbers_;
};

/// How much there is of everything is said in front, and known in the end: nodes and elements wait
/// in files of their own.
class OneGmshFile final : public GmshSink {
 public:
  OneGmshFile(const std::filesystem::path& file, Context& context)
      : GmshSink(context),
        output_(file, OutputFile::Target::Regular),
        nodes_(file, OutputFile::Target::Regular),
        elements_(file, OutputFile::Target::Regular) {}

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    const PartSections sections = sectionsOf(part, groupPart(part, info_, stage), true, sums_);
    nodes_.write(sections.nodes.text());
    writeBlocks(elements_, sections);
  }
  void end() override {
    Stage stage(context_, "write mesh");
    writeHead(output_, *numbers_, info_, sums_);
    copyAll(nodes_, output_);
    beginElements(output_, sums_);
    copyAll(elements_, output_);
    writeTail(output_, sums_);
    output_.commit();
  }

 private:
  OutputFile output_;
  OutputFile nodes_;     ///< never committed
  OutputFile elements_;  ///< likewise
  FileSums sums_;
};

class ManyGmshFiles final : public GmshSink {
 public:
  ManyGmshFiles(std::filesystem::path file, Context& context, ProcessTeam* team)
      : GmshSink(context), file_(std::move(file)), team_(team), files_(team) {}

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    std::string file = file_.string();
    file.insert(file.size() - file_.extension().string().size(),
                '_' + std::to_string(part.part + 1));
    OutputFile& output = files_.add(file);
    FileSums sums;
    const MeshGroups groups = groupPart(part, info_, stage);
    if (team_ != nullptr) passQuadsBefore(groups.quads.elements.size());
    const PartSections sections = sectionsOf(part, groups, false, sums);
    writeHead(output, *numbers_, info_, sums);
    output.write(sections.nodes.text());
    beginElements(output, sums);
    writeBlocks(output, sections);
    writeTail(output, sums);
    files_.finishLast();
  }
  void end() override { files_.commit(); }

 private:
  /// Quads of processes before this one have smaller numbers.
  void passQuadsBefore(std::uint64_t own) {
    const GatheredNumbers all = team_->gather(std::span(&own, 1));
    for (std::uint32_t r = 0; r < team_->rank(); ++r) {
      static_cast<void>(numbers_->nextQuads(all.numbers[r]));
    }
  }

  std::filesystem::path file_;
  ProcessTeam* team_;
  FileSet files_;
};

}  // namespace

std::unique_ptr<PartSink> openGmshPartSink(const std::filesystem::path& file,
                                           const WriteOptions& /*options*/, Context& context,
                                           ProcessTeam* /*team*/) {
  return std::make_unique<OneGmshFile>(file, context);
}

std::unique_ptr<PartSink> openSplitGmshPartSink(const std::filesystem::path& file,
                                                const WriteOptions& /*options*/, Context& context,
                                                ProcessTeam* team) {
  return std::make_unique<ManyGmshFiles>(file, context, team);
}

}  // namespace hexhex
