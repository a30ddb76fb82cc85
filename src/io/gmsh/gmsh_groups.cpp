#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include <io/core/number_source.hpp>
#include <io/gmsh/gmsh_groups.hpp>

namespace hexhex {
namespace {

/// The first number of a list, which begins with its length; 0 if it is empty.
template <class Source>
std::int64_t firstOfGmshList(Source& source, const char* what) {
  const std::uint64_t count = source.size("the length of a list");
  requireRoom(source, count, {.integers = 1}, "numbers");
  const std::int64_t first = count > 0 ? source.integer(what) : 0;
  if (count > 1) source.skip(static_cast<std::size_t>(count - 1), {.integers = 1});
  return first;
}

/// Entities of one dimension: their tags, where they are, their groups and bounding entities.
template <class Source>
void readEntitiesOf(Source& source, std::size_t dimension, std::uint64_t count, GmshTags& tags) {
  const std::size_t reals = dimension == 0 ? 3 : 6;
  requireRoom(source, count, {.integers = 1, .reals = reals}, "entities");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t entity = source.integer("the tag of an entity");
    for (std::size_t k = 0; k < reals; ++k) {
      static_cast<void>(source.real("a coordinate of an entity"));
    }
    const std::int64_t physical = firstOfGmshList(source, "the tag of a physical group");
    if (dimension > 0) firstOfGmshList(source, "the tag of a bounding entity");
    tags.addEntity({static_cast<std::int64_t>(dimension), entity}, withoutSign(physical));
  }
}

}  // namespace

/// Lines "dimension number name", as text in binary files, too.
void readGmshNames(std::string_view section, GmshTags& tags) {
  while (!section.empty()) {
    const std::size_t length = std::min(section.find('\n'), section.size());
    const std::string_view line = section.substr(0, length);
    section.remove_prefix(std::min(length + 1, section.size()));
    GmshGroup group;
    const char* const end = line.data() + line.size();
    const auto dimension = std::from_chars(line.data(), end, group.first);
    if (dimension.ec != std::errc{} || dimension.ptr == end || *dimension.ptr != ' ') continue;
    const auto number = std::from_chars(dimension.ptr + 1, end, group.second);
    const std::size_t quote = line.find('"');
    if (number.ec != std::errc{} || quote == std::string_view::npos) continue;
    const std::string_view name = line.substr(quote + 1);
    tags.addName(group, name.substr(0, std::min(name.find('"'), name.size())));
  }
}

void readGmshEntities(GmshFile& file, GmshTags& tags) {
  file.withSource([&tags](auto& source) {
    std::array<std::uint64_t, 4> counts{};
    for (std::uint64_t& count : counts) count = source.size("the number of entities");
    for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
      readEntitiesOf(source, dimension, counts[dimension], tags);
    }
  });
  file.endSection("Entities");
}

}  // namespace hexhex
