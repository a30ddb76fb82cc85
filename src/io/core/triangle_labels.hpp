// Labels of triangles, as files hold them beside or apart from a tet mesh.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

#include <io/core/input_file.hpp>

namespace hexhex::io {

struct TriangleLabels {
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int64_t> labels;
};

/// Of the triangles among the cells of a file.
/// @param array  the name of the cell array
/// @throws Error FileUnsupported without such an array of whole numbers, or without triangles
[[nodiscard]] TriangleLabels readVtuLabels(const Input& input, std::string_view array,
                                           Context& context);
[[nodiscard]] TriangleLabels readVtkLegacyLabels(const Input& input, std::string_view array,
                                                 Context& context);

}  // namespace hexhex::io
