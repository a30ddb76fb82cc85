#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include <io/gmsh/gmsh_elements.hpp>
#include <io/parts/gmsh_sections.hpp>

namespace hexhex::io {
namespace {

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
    addGhosts();
    if (!onlyOwned_) addGhostCells();
    sections_.sums.largestElement = numbers_.nextQuads(0) - 1;
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
  void open(std::uint32_t dimension, std::size_t group, std::uint32_t part, std::uint64_t count) {
    const std::uint32_t tag = numbers_.entityOf(dimension, group, part);
    const std::uint32_t parent = numbers_.groups(dimension)[group].number;
    sections_.sums.entities.push_back({dimension, tag, parent, part + 1, low_, high_});
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
  /// Which own cells of others are ghosts here.
  void addGhosts() {
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      sections_.ghosts.sizes({part_.globalCells[c] + 1});
      sections_.ghosts.integers({part_.ghostParts[c - part_.ownCells] + 1});
      sections_.ghosts.sizes({1});
      sections_.ghosts.integers({part_.part + 1});
      ++sections_.sums.ghosts;
    }
  }
  /// Those of others are in entities of their parts.
  void addGhostCells() {
    std::map<std::pair<std::uint32_t, std::size_t>, std::vector<std::size_t>> byEntity;
    for (std::size_t c = part_.ownCells; c < part_.mesh.cells.size(); ++c) {
      byEntity[{part_.ghostParts[c - part_.ownCells], groupOf(c)}].push_back(c);
    }
    for (const auto& [entity, cells] : byEntity) {
      open(3, entity.second, entity.first, cells.size());
      for (const std::size_t c : cells) {
        addElement(part_.globalCells[c] + 1, part_.mesh.cells[c]);
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
    if (nodes.empty()) return;
    sections_.sums.nodes = nodes.size();
    sections_.sums.nodeBlocks = 1;
    // Of the part's first volume.
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
  Vec3 low_{};
  Vec3 high_{};
  PartSections sections_;
};

/// Numbers of packed(): those of an entity, and others.
constexpr std::size_t kOfEntity = 10;
constexpr std::size_t kOthers = 6;

}  // namespace

void GmshSums::add(const GmshSums& part) {
  nodeBlocks += part.nodeBlocks;
  nodes += part.nodes;
  elementBlocks += part.elementBlocks;
  elements += part.elements;
  ghosts += part.ghosts;
  largestElement = std::max(largestElement, part.largestElement);
  entities.insert(entities.end(), part.entities.begin(), part.entities.end());
}

std::vector<std::uint64_t> GmshSums::packed() const {
  std::vector<std::uint64_t> numbers = {nodeBlocks, nodes,  elementBlocks,
                                        elements,   ghosts, largestElement};
  for (const PartitionEntity& entity : entities) {
    numbers.insert(numbers.end(), {entity.dimension, entity.tag, entity.parent, entity.part});
    for (const Vec3& point : {entity.low, entity.high}) {
      for (const double x : point) numbers.push_back(std::bit_cast<std::uint64_t>(x));
    }
  }
  return numbers;
}

GmshSums GmshSums::unpacked(std::span<const std::uint64_t> numbers) {
  GmshSums sums{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], {}};
  for (std::size_t i = kOthers; i < numbers.size(); i += kOfEntity) {
    const auto integer = [&](std::size_t k) { return static_cast<std::uint32_t>(numbers[i + k]); };
    const auto pointAt = [&](std::size_t k) {
      return Vec3{std::bit_cast<double>(numbers[i + k]), std::bit_cast<double>(numbers[i + k + 1]),
                  std::bit_cast<double>(numbers[i + k + 2])};
    };
    sums.entities.push_back(
        {integer(0), integer(1), integer(2), integer(3), pointAt(4), pointAt(7)});
  }
  return sums;
}

PartSections gmshSectionsOf(const MeshPart& part, const MeshGroups& groups, GmshNumbers& numbers,
                            bool onlyOwned) {
  return SectionMaker(part, groups, numbers, onlyOwned).make();
}

std::string gmshHead(const GmshNumbers& numbers, const PartsInfo& info, const GmshSums& sums) {
  GmshBytes bytes;
  bytes.add("$MeshFormat\n4.1 1 8\n");
  bytes.integers({1});
  bytes.add("\n$EndMeshFormat\n$PhysicalNames\n");
  bytes.add(std::to_string(numbers.groups(2).size() + numbers.groups(3).size()) + '\n');
  for (const unsigned dimension : {2U, 3U}) {
    for (const ElementGroup& group : numbers.groups(dimension)) {
      bytes.add(std::to_string(dimension) + ' ' + std::to_string(group.number) + " \"" +
                group.name + "\"\n");
    }
  }
  bytes.add("$EndPhysicalNames\n$Entities\n");
  Vec3 low{};
  Vec3 high{};
  for (std::size_t i = 0; i < sums.entities.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = i == 0 ? sums.entities[i].low[k] : std::min(low[k], sums.entities[i].low[k]);
      high[k] = i == 0 ? sums.entities[i].high[k] : std::max(high[k], sums.entities[i].high[k]);
    }
  }
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
      bytes.add(entity.low);
      bytes.add(entity.high);
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

}  // namespace hexhex::io
