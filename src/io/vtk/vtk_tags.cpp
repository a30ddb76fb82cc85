// What writers of this library add to a mesh: generators, tags and regions in arrays.
#include <algorithm>

#include <io/vtk/vtk_reader.hpp>

namespace hexhex::io {
namespace {

/// An array that is used if it is as this library writes it.
std::optional<VtkColumn> findGenerators(const VtkSource& source, std::string_view name,
                                        VtkScalar scalar) {
  const VtkSourceArray* const array =
      source.find(VtkSection::PointData, name, 1, VtkNumbers::Integers);
  if (array == nullptr || !array->appended || source.points == 0) return std::nullopt;
  VtkColumn column = array->load(VtkNumbers::Integers, std::nullopt);
  if (column.scalar != scalar || column.count != source.points) return std::nullopt;
  return column;
}

/// Calls f(i, number) for all numbers of an array, which must fit into 32 bits.
template <class F>
void forEachNumber(const VtkSource& source, const VtkSourceArray& array, const F& f) {
  constexpr std::size_t kSlice = std::size_t{1} << 16;  // half a megabyte at a time
  const VtkColumn column = source.load(array);
  Array<std::int64_t> numbers;
  for (std::uint64_t begin = 0; begin < column.count; begin += kSlice) {
    numbers.resize(std::min<std::uint64_t>(kSlice, column.count - begin));
    source.copy(column, begin, numbers.size(), numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!std::in_range<std::int32_t>(numbers[i])) {
        source.fail(
            ErrorCode::FileUnsupported,
            "the array \"" + array.name + "\" has the value " + std::to_string(numbers[i]) +
                ", which does not fit into 32 bits.",
            Place{array.section == VtkSection::CellData ? PlaceKind::Cell : PlaceKind::Vertex,
                  begin + i});
      }
      f(static_cast<std::size_t>(begin) + i, static_cast<std::int32_t>(numbers[i]));
    }
  }
}

std::vector<FeatureVertex> readVertexTags(const VtkSource& source) {
  std::vector<FeatureVertex> features;
  const VtkSourceArray* const array =
      source.find(VtkSection::PointData, kVtkVertexTags, 1, VtkNumbers::Integers);
  if (array == nullptr) return features;
  forEachNumber(source, *array, [&](std::size_t vertex, std::int32_t tag) {
    if (tag != 0) features.push_back({static_cast<Index>(vertex), tag});
  });
  return features;
}

/// Rows of vertices and a tag.
/// @tparam Feature  FeatureEdge, FeatureFace or FeatureQuad
template <class Feature>
std::vector<Feature> readRows(const VtkSource& source, std::string_view name) {
  constexpr std::size_t kVertices = decltype(Feature::vertices){}.size();
  std::vector<Feature> features;
  const VtkSourceArray* const array =
      source.find(VtkSection::FieldData, name, kVertices + 1, VtkNumbers::Integers);
  if (array == nullptr) return features;
  const VtkColumn column = source.load(*array);
  if (column.count % array->components != 0) {
    source.fail(ErrorCode::FileSyntax,
                "the array \"" + array->name + "\" has " + std::to_string(column.count) +
                    " numbers, which are no rows of " + std::to_string(array->components) + ".");
  }
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(column.count));
  source.copy(column, 0, numbers.size(), numbers.data());
  features.resize(numbers.size() / array->components);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::int64_t* const row = numbers.data() + array->components * i;
    bool good = std::in_range<std::int32_t>(row[kVertices]);
    for (std::size_t k = 0; k < kVertices; ++k) {
      good = good && row[k] >= 0 && static_cast<std::uint64_t>(row[k]) < source.points;
      features[i].vertices[k] = static_cast<Index>(row[k]);
    }
    features[i].tag = static_cast<std::int32_t>(row[kVertices]);
    if (good) continue;
    source.fail(ErrorCode::IndexOutOfRange,
                "row " + std::to_string(i) + " of the array \"" + array->name +
                    "\" (counted from 0) names a point that does not exist, or a tag that does "
                    "not fit into 32 bits. If a program has changed the points since, remove the "
                    "array.");
  }
  return features;
}

const VtkSourceArray* findRegions(const VtkSource& source) {
  return source.find(VtkSection::CellData, kVtkRegions, 1, VtkNumbers::Integers);
}

}  // namespace

VtkGenerators findVtkGenerators(const VtkSource& source) {
  return {findGenerators(source, kVtkGeneratorTets, std::uint32_t{}),
          findGenerators(source, kVtkGeneratorCorners, std::uint8_t{})};
}

void readVtkGenerators(const VtkSource& source, Array<Index>& tets, Array<CornerSet>& corners) {
  const VtkGenerators generators = findVtkGenerators(source);
  if (!generators.tets || !generators.corners) return;
  corners.resize(source.points);
  source.copy(*generators.corners, 0, corners.size(), corners.data());
  const auto isSimplex = [](CornerSet set) { return set >= 1 && set <= 15; };
  if (!std::all_of(corners.begin(), corners.end(), isSimplex)) {
    corners.clear();  // arrays of the same names, but something else
    return;
  }
  tets.resize(source.points);
  source.copy(*generators.tets, 0, tets.size(), tets.data());
}

HexFeatures readVtkHexFeatures(const VtkSource& source) {
  return {readVertexTags(source), readRows<FeatureEdge>(source, kVtkEdgeTags),
          readRows<FeatureQuad>(source, kVtkQuadTags)};
}

Features readVtkTetFeatures(const VtkSource& source) {
  return {readVertexTags(source), readRows<FeatureEdge>(source, kVtkEdgeTags),
          readRows<FeatureFace>(source, kVtkTriangleTags)};
}

bool hasVtkRegions(const VtkSource& source) { return findRegions(source) != nullptr; }

Array<std::int32_t> readVtkRegions(const VtkSource& source, std::span<const std::size_t> cells) {
  Array<std::int32_t> regions;
  const VtkSourceArray* const array = findRegions(source);
  if (array == nullptr) return regions;
  regions.resize(cells.size());
  std::size_t next = 0;
  forEachNumber(source, *array, [&](std::size_t cell, std::int32_t region) {
    if (next < cells.size() && cells[next] == cell) regions[next++] = region;
  });
  return regions;
}

}  // namespace hexhex::io
