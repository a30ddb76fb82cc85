// Tables of whole numbers, packed for a page: differences, byte planes, zlib. The other side is
// decodeChunk() in viewer/src/format.ts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <base/stage.hpp>

namespace hexhex {

/// A table in compressed chunks of consecutive rows.
struct PackedTable {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t rowsPerChunk = 0;
  std::vector<std::string> chunks;  ///< a zlib stream each
};

/// Writes the numbers of rows [begin, end), row by row, to `to`. Called from several threads.
using FillRows = std::function<void(std::size_t begin, std::size_t end, std::uint32_t* to)>;

/// Packs a table. Neighbouring rows should be similar, and so should the columns of a row.
/// The result does not depend on the number of threads.
[[nodiscard]] PackedTable packTable(std::string_view name, std::size_t rows, std::size_t columns,
                                    const FillRows& fill, Stage& stage);

/// The base64 encoding (RFC 4648) of bytes.
[[nodiscard]] std::string toBase64(std::string_view bytes);

}  // namespace hexhex
