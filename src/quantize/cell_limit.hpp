// The maximum number of hexahedra.
#pragma once

#include <hexhex/error.hpp>

namespace hexhex::quantization {

/// Larger meshes have more vertices than Index can number.
inline constexpr double kMostCells = 4e9;

inline void requireNumberable(double cells) {
  if (cells <= kMostCells) return;
  throw Error(ErrorCode::TooLarge,
              "A mesh of more than 4,000,000,000 cells cannot be numbered. "
              "Ask for fewer cells, or quantize for a part of them and "
              "extract with a scale.");
}

}  // namespace hexhex::quantization
