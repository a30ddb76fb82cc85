// Arrays of `.vtu` files that are not plain bytes: base64, compressed, or both.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// How an array is stored.
struct VtuEncoding {
  bool base64 = false;
  bool compressed = false;      ///< in blocks, with zlib
  std::size_t lengthBytes = 4;  ///< of the numbers in front of the data
};

/// The bytes of an array.
/// @param text   from the array's first byte on; what follows the array is ignored
/// @param stage  for parallel work; null: one thread
/// @param[out] problem  what is wrong if nothing is returned; a sentence
[[nodiscard]] std::optional<Array<char>> decodeVtuArray(std::string_view text,
                                                        const VtuEncoding& encoding, Stage* stage,
                                                        std::string& problem);

}  // namespace hexhex
