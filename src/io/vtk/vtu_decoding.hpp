// Arrays of `.vtu` files that are not plain bytes: base64, compressed, or both.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::io {

/// How an array is stored.
struct VtuEncoding {
  bool base64 = false;
  bool compressed = false;      ///< in blocks, with zlib; only if hasZlib()
  std::size_t lengthBytes = 4;  ///< of the numbers in front of the data
};

/// The bytes of an array.
/// @param text  from the array's first byte on; what follows the array is ignored
/// @param fail  throws an error about the array with this sentence
[[nodiscard]] Array<char> decodeVtuArray(std::string_view text, const VtuEncoding& encoding,
                                         Stage& stage,
                                         const std::function<void(const char* sentence)>& fail);

}  // namespace hexhex::io
