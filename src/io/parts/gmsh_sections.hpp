// What a part adds to a file of Gmsh 4.1 with partitioned entities, and what is between: a file is
//
//     head, nodes of each part, head of elements, elements of each part, head of ghosts, ghosts of
//     each part, end.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/parts.hpp>

#include <io/core/bytes.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex::io {

/// Bytes that are collected.
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
  std::uint32_t part;    ///< from 1
  Vec3 low;
  Vec3 high;
};

/// How much there is in a file, or of one part.
struct GmshSums {
  std::uint64_t nodeBlocks = 0;
  std::uint64_t nodes = 0;
  std::uint64_t elementBlocks = 0;
  std::uint64_t elements = 0;
  std::uint64_t ghosts = 0;
  std::uint64_t largestElement = 0;
  std::vector<PartitionEntity> entities;

  /// Those of the next part.
  void add(const GmshSums& part);
  /// As numbers, and back from them.
  [[nodiscard]] std::vector<std::uint64_t> packed() const;
  static GmshSums unpacked(std::span<const std::uint64_t> numbers);
};

/// What one part adds to a file.
struct PartSections {
  GmshSums sums;
  GmshBytes nodes;  ///< one block, if there are any nodes
  GmshBytes elements;
  GmshBytes ghosts;
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

/// @param onlyOwned  whether vertices that another part owns are left out, and ghosts' elements
[[nodiscard]] PartSections gmshSectionsOf(const MeshPart& part, const MeshGroups& groups,
                                          GmshNumbers& numbers, bool onlyOwned);

// What is between the sections of parts.
[[nodiscard]] std::string gmshHead(const GmshNumbers& numbers, const PartsInfo& info,
                                   const GmshSums& sums);
[[nodiscard]] std::string gmshElementsHead(const GmshSums& sums);
[[nodiscard]] std::string gmshGhostsHead(const GmshSums& sums);
[[nodiscard]] std::string gmshEnd(const GmshSums& sums);

}  // namespace hexhex::io
