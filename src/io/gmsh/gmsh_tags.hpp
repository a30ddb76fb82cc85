// What the elements of a `.msh` file are tagged with: the number of their physical group, or what
// its name says; and the nodes that they name, by tags of the file's choice. This library calls
// groups "point_7", "curve_7", "surface_7" and "region_7" for the tag 7 ("_m7" for -7), and
// "boundary", "hexahedra" and "patch_7" where there is no tag.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// Dimension of elements, and the number of a physical group.
using GmshGroup = std::pair<std::int64_t, std::int64_t>;

/// The number of a group. Its sign tells the direction of an entity.
[[nodiscard]] constexpr std::int64_t withoutSign(std::int64_t number) noexcept {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// The tag that a name of this library gives, or nothing if another program chose it.
[[nodiscard]] inline std::optional<std::int32_t> tagInGroupName(std::string_view name) {
  constexpr std::array<std::string_view, 4> kTagged = {"point_", "curve_", "surface_", "region_"};
  if (name == "boundary" || name == "hexahedra" || name.starts_with("patch_")) return 0;
  for (const std::string_view prefix : kTagged) {
    if (!name.starts_with(prefix)) continue;
    std::string_view digits = name.substr(prefix.size());
    const bool negative = digits.starts_with('m');
    if (negative) digits.remove_prefix(1);
    if (negative && digits.starts_with('-')) return {};  // one sign is enough
    std::int64_t tag = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), tag);
    if (result.ec != std::errc{} || result.ptr != digits.data() + digits.size()) return {};
    tag = negative ? -tag : tag;
    if (!std::in_range<std::int32_t>(tag)) return {};
    return static_cast<std::int32_t>(tag);
  }
  return {};
}

/// Tags of elements by their groups or entities.
class GmshTags {
 public:
  /// The name of a physical group.
  void addName(GmshGroup group, std::string_view name) {
    if (const std::optional<std::int32_t> tag = tagInGroupName(name)) named_.emplace(group, *tag);
  }
  /// The first physical group of an entity of MSH 4.1; 0 if it has none.
  void addEntity(GmshGroup entity, std::int64_t physical) { physicals_.emplace(entity, physical); }

  /// The tag of a physical group; 0 without one.
  [[nodiscard]] std::int32_t ofPhysical(GmshGroup group) const {
    const auto found = named_.find(group);
    if (found != named_.end()) return found->second;
    return std::in_range<std::int32_t>(group.second) ? static_cast<std::int32_t>(group.second) : 0;
  }
  [[nodiscard]] std::int32_t ofEntity(GmshGroup entity) const {
    const auto found = physicals_.find(entity);
    return found == physicals_.end() ? 0 : ofPhysical({entity.first, found->second});
  }

 private:
  // As many as the file has groups and entities, which are few.
  std::map<GmshGroup, std::int32_t> named_;
  std::map<GmshGroup, std::int64_t> physicals_;
};

/// Finds nodes by their tags.
class NodeTags {
 public:
  NodeTags() = default;
  /// @param tags  of the nodes in their order; fewer than kNone
  explicit NodeTags(const Array<std::uint64_t>& tags) : count_(tags.size()) {
    if (tags.empty()) return;
    first_ = tags[0];
    std::size_t i = 0;
    while (i < tags.size() && tags[i] == first_ + i) ++i;
    if (i < tags.size()) sortTags(tags);
  }

  /// The node with a tag, or kNone.
  [[nodiscard]] Index find(std::uint64_t tag) const {
    if (sorted_.empty()) {
      return tag - first_ < count_ ? static_cast<Index>(tag - first_) : kNone;
    }
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), Entry{tag, 0});
    return found == sorted_.end() || found->first != tag ? kNone : found->second;
  }

  /// A node whose tag an earlier node has, too; kNone if there is none.
  [[nodiscard]] Index repeated() const {
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) return sorted_[i].second;
    }
    return kNone;
  }

 private:
  using Entry = std::pair<std::uint64_t, Index>;

  void sortTags(const Array<std::uint64_t>& tags) {
    sorted_.resize(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_[i] = {tags[i], static_cast<Index>(i)};
    std::sort(sorted_.begin(), sorted_.end());
  }

  // The usual case needs no table: consecutive tags from first_ on.
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
  Array<Entry> sorted_;
};

}  // namespace hexhex::io
