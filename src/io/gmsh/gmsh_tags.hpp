// What the elements of a `.msh` file are tagged with: the number of their physical group, or what
// its name says. This library calls groups "point_7", "curve_7", "surface_7" and "region_7" for the
// tag 7 ("_m7" for -7), and "boundary", "hexahedra" and "patch_7" where there is no tag.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace hexhex {

/// Dimension of elements, and the number of a physical group.
using GmshGroup = std::pair<std::int64_t, std::int64_t>;

/// The number of a group. Its sign tells which way an entity runs.
[[nodiscard]] constexpr std::int64_t withoutSign(std::int64_t number) noexcept {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// The tag that a name of this library gives, or nothing if it is somebody else's.
[[nodiscard]] inline std::optional<std::int32_t> tagInGroupName(std::string_view name) {
  constexpr std::array<std::string_view, 4> kTagged = {"point_", "curve_", "surface_", "region_"};
  if (name == "boundary" || name == "hexahedra" || name.starts_with("patch_")) return 0;
  for (const std::string_view prefix : kTagged) {
    if (!name.starts_with(prefix)) continue;
    std::string_view digits = name.substr(prefix.size());
    const bool negative = digits.starts_with('m');
    if (negative) digits.remove_prefix(1);
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

}  // namespace hexhex
