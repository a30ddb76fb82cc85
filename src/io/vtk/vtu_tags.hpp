// Tags and regions in the arrays of a `.vtu` file, as writeVtu() and writeVtuMap() write them: the
// point array feature_vertex, the field arrays feature_edges, feature_triangles and feature_quads
// (rows of vertices and a tag), and the cell array region.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/features.hpp>
#include <hexhex/types.hpp>

#include <io/vtk/vtk_data_set.hpp>
#include <io/vtk/vtu_file.hpp>

namespace hexhex {

/// Arrays of integers with these names and the right number of components are read; others of the
/// same names are somebody else's, and left alone.
/// @throws Error FileSyntax if an array has too few or too many numbers; FileUnsupported for a tag
///         or region that does not fit into 32 bits
[[nodiscard]] std::vector<FeatureVertex> readVtuVertexTags(const VtuFile& file);

/// @param cells    the numbers of the cells that are wanted, ascending
[[nodiscard]] Array<std::int32_t> readVtuRegions(const VtuFile& file,
                                                 std::span<const std::size_t> cells);

/// The numbers of a field array with so many components.
[[nodiscard]] std::vector<std::int64_t> readVtuRows(const VtuFile& file, std::string_view name,
                                                    std::size_t components);
/// Throws about a row of a field array.
[[noreturn]] void failAboutVtuRow(const VtuFile& file, std::string_view name, std::size_t row);

/// @tparam Feature  FeatureEdge, FeatureFace or FeatureQuad
/// @throws Error  the same, and IndexOutOfRange for a vertex that is no point
template <class Feature>
[[nodiscard]] std::vector<Feature> readVtuFeatures(const VtuFile& file, std::string_view name) {
  constexpr std::size_t kVertices = decltype(Feature::vertices){}.size();
  const std::vector<std::int64_t> rows = readVtuRows(file, name, kVertices + 1);
  std::vector<Feature> features(rows.size() / (kVertices + 1));
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::int64_t* const row = rows.data() + (kVertices + 1) * i;
    bool good = std::in_range<std::int32_t>(row[kVertices]);
    for (std::size_t k = 0; k < kVertices; ++k) {
      good = good && row[k] >= 0 && static_cast<std::uint64_t>(row[k]) < file.pointCount();
      features[i].vertices[k] = static_cast<Index>(row[k]);
    }
    if (!good) failAboutVtuRow(file, name, i);
    features[i].tag = static_cast<std::int32_t>(row[kVertices]);
  }
  return features;
}

}  // namespace hexhex
