// How a chunk is packed: column 0 is subtracted from the other columns, the row above from each row
// (modulo 2^32), signs go to the lowest bit, and the bytes are sorted by significance: what is left
// are long runs of the same few bytes, which zlib is good at.
#include <algorithm>
#include <new>
#include <string>
#include <zlib.h>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <view/table_codec.hpp>

namespace hexhex {
namespace {

/// Numbers per chunk: large enough for zlib, small enough for a string in a browser, and for work
/// on all cores.
constexpr std::size_t kNumbersPerChunk = std::size_t{1} << 18;

/// A sixth of the time of the best level, and pages that are hardly larger.
constexpr int kZlibLevel = 6;

/// 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
constexpr std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1U) ^ (difference >> 31U != 0 ? ~std::uint32_t{0} : 0U);
}

/// The differences, column by column.
Array<std::uint32_t> differences(const Array<std::uint32_t>& table, std::size_t rows,
                                 std::size_t columns) {
  Array<std::uint32_t> codes(table.size());
  for (std::size_t column = 0; column < columns; ++column) {
    std::uint32_t previous = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::uint32_t first = column == 0 ? 0 : table[row * columns];
      const std::uint32_t value = table[row * columns + column] - first;
      codes[column * rows + row] = zigzag(value - previous);
      previous = value;
    }
  }
  return codes;
}

/// The number of planes, then the planes, least significant bytes first.
std::string bytePlanes(const Array<std::uint32_t>& codes) {
  std::uint32_t used = 0;
  for (const std::uint32_t code : codes) used |= code;
  std::size_t planes = 0;
  while (planes < 4 && used >> (8 * planes) != 0) ++planes;
  std::string bytes(1 + planes * codes.size(), '\0');
  bytes[0] = static_cast<char>(planes);
  char* to = bytes.data() + 1;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    for (const std::uint32_t code : codes) *to++ = static_cast<char>(code >> (8 * plane));
  }
  return bytes;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), kZlibLevel);
  // The bound suffices for any content, so nothing else can happen.
  if (status != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  packed.shrink_to_fit();
  return packed;
}

}  // namespace

PackedTable packTable(std::string_view name, std::size_t rows, std::size_t columns,
                      const FillRows& fill, Stage& stage) {
  PackedTable packed{std::string(name), rows, columns, kNumbersPerChunk / columns, {}};
  packed.chunks.resize(blockCount(rows, packed.rowsPerChunk));
  parallelBlocks(
      stage, rows, packed.rowsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        Array<std::uint32_t> table((end - begin) * columns);
        fill(begin, end, table.data());
        packed.chunks[chunk] = deflated(bytePlanes(differences(table, end - begin, columns)));
      });
  return packed;
}

std::string toBase64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  char* to = text.data();
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    // The digits that no byte reaches stay '='.
    for (std::size_t k = 0; k <= count; ++k) to[k] = kDigits[group >> (18 - 6 * k) & 63U];
    to += 4;
  }
  return text;
}

}  // namespace hexhex
