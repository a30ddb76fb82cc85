#include <algorithm>
#include <optional>

#include <io/vtk/vtu_tags.hpp>

namespace hexhex {
namespace {

/// Calls f(i, number) for all numbers of an array, which must fit into 32 bits.
template <class F>
void forEachNumber(const VtuFile& file, const VtuColumn& column, std::string_view name,
                   const F& f) {
  constexpr std::size_t kSlice = std::size_t{1} << 16;  // half a megabyte at a time
  Array<std::int64_t> numbers;
  for (std::uint64_t begin = 0; begin < column.count; begin += kSlice) {
    numbers.resize(std::min<std::uint64_t>(kSlice, column.count - begin));
    file.copy(column, begin, numbers.size(), numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!std::in_range<std::int32_t>(numbers[i])) {
        file.fail(ErrorCode::FileUnsupported, "the array \"" + std::string(name) +
                                                  "\" has the value " + std::to_string(numbers[i]) +
                                                  ", which does not fit into 32 bits.");
      }
      f(static_cast<std::size_t>(begin) + i, static_cast<std::int32_t>(numbers[i]));
    }
  }
}

}  // namespace

std::vector<FeatureVertex> readVtuVertexTags(const VtuFile& file) {
  std::vector<FeatureVertex> features;
  const std::optional<VtuColumn> column = file.findIntegers(kVtkVertexTags, VtuSection::Points, 1);
  if (!column) return features;
  forEachNumber(file, *column, kVtkVertexTags, [&](std::size_t vertex, std::int32_t tag) {
    if (tag != 0) features.push_back({static_cast<Index>(vertex), tag});
  });
  return features;
}

Array<std::int32_t> readVtuRegions(const VtuFile& file, std::span<const std::size_t> cells) {
  Array<std::int32_t> regions;
  const std::optional<VtuColumn> column = file.findIntegers(kVtkRegions, VtuSection::Cells, 1);
  if (!column) return regions;
  regions.resize(cells.size());
  std::size_t next = 0;
  forEachNumber(file, *column, kVtkRegions, [&](std::size_t cell, std::int32_t region) {
    if (next < cells.size() && cells[next] == cell) regions[next++] = region;
  });
  return regions;
}

std::vector<std::int64_t> readVtuRows(const VtuFile& file, std::string_view name,
                                      std::size_t components) {
  std::vector<std::int64_t> rows;
  const std::optional<VtuColumn> column = file.findIntegers(name, VtuSection::Field, components);
  if (!column) return rows;
  if (column->count % components != 0) {
    file.fail(ErrorCode::FileSyntax,
              "the array \"" + std::string(name) + "\" has " + std::to_string(column->count) +
                  " numbers, which are no rows of " + std::to_string(components) + ".");
  }
  rows.resize(static_cast<std::size_t>(column->count));
  file.copy(*column, 0, rows.size(), rows.data());
  return rows;
}

void failAboutVtuRow(const VtuFile& file, std::string_view name, std::size_t row) {
  file.fail(ErrorCode::IndexOutOfRange,
            "row " + std::to_string(row) + " of the array \"" + std::string(name) +
                "\" (counted from 0) names a point that does not exist, or a tag that does not fit "
                "into 32 bits. If a program has changed the points since, remove the array.");
}

}  // namespace hexhex
