// The sections of legacy VTK files, as text or as bytes, for whoever writes one: at once or in
// pieces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/line_writer.hpp>

namespace hexhex {

/// Numbers as text: in the form of version 2.0, which every program reads.
struct VtkText {
  static constexpr std::string_view kEncoding = "ASCII";
  static constexpr std::size_t kRoom = kNumberRoom + 1;

  template <std::size_t n>
  static char* reals(char* place, const std::array<double, n>& numbers) {
    return put(putNumbers(place, numbers), '\n');
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    return put(putNumbers(put(put(place, corners), ' '), cell), '\n');
  }
  static char* type(char* place, std::uint32_t type) { return put(put(place, type), '\n'); }
  static char* integer(char* place, std::int32_t number) { return put(put(place, number), '\n'); }
  static constexpr std::string_view kEndOfSection = {};
};

/// Numbers as bytes, the largest first.
struct VtkBytes {
  static constexpr std::string_view kEncoding = "BINARY";
  static constexpr std::size_t kRoom = 8;

  template <class T>
  static char* number(char* place, T number) {
    const auto bytes = littleBytes(number);
    return std::reverse_copy(bytes.begin(), bytes.end(), place);
  }
  template <std::size_t n>
  static char* reals(char* place, const std::array<double, n>& numbers) {
    for (const double value : numbers) place = number(place, value);
    return place;
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    place = number(place, static_cast<std::uint32_t>(corners));
    for (const Vertex vertex : cell) place = number(place, static_cast<std::uint32_t>(vertex));
    return place;
  }
  static char* type(char* place, std::uint32_t type) { return number(place, type); }
  static char* integer(char* place, std::int32_t value) { return number(place, value); }
  static constexpr std::string_view kEndOfSection = "\n";
};

/// Refuses what 32-bit indices cannot number.
template <class Numbers>
void requireVtkIndices(std::uint64_t points, const std::string& fileName) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (Numbers::kEncoding == VtkText::kEncoding || points <= kMost) return;
  throw Error(ErrorCode::TooLarge,
              fileName +
                  ": legacy binary .vtk files have vertex numbers of 31 bits, which do not "
                  "suffice for " +
                  std::to_string(points) + " points; write .vtu.");
}

/// Everything up to the points.
template <class Numbers>
void writeVtkHead(OutputFile& output, std::string_view title, std::uint64_t points) {
  output.write("# vtk DataFile Version 2.0\n").write(title).write('\n').write(Numbers::kEncoding);
  output.write("\nDATASET UNSTRUCTURED_GRID\nPOINTS ").write(points).write(" double\n");
}

/// @param tuples  points, or tuples of an array of doubles
template <class Numbers, std::size_t n>
void writeVtkReals(LineWriter& lines, std::span<const std::array<double, n>> tuples,
                   LoopProgress* progress = nullptr) {
  lines.write(
      tuples.size(), n * Numbers::kRoom,
      [tuples](char* place, std::size_t i) { return Numbers::reals(place, tuples[i]); }, progress);
}

/// Everything between points and cells.
template <class Numbers>
void writeVtkCellsHead(OutputFile& output, std::uint64_t cells, std::uint64_t corners) {
  output.write(Numbers::kEndOfSection);
  output.write("CELLS ").write(cells).write(' ').write((corners + 1) * cells).write('\n');
}

template <class Numbers, class Vertex, std::size_t corners>
void writeVtkCells(LineWriter& lines, std::span<const std::array<Vertex, corners>> cells,
                   LoopProgress* progress = nullptr) {
  lines.write(
      cells.size(), (corners + 1) * Numbers::kRoom,
      [cells](char* place, std::size_t i) { return Numbers::cell(place, cells[i]); }, progress);
}

/// All types, of cells of one kind.
template <class Numbers>
void writeVtkTypes(OutputFile& output, LineWriter& lines, std::uint64_t cells, std::uint32_t type,
                   LoopProgress* progress = nullptr) {
  output.write(Numbers::kEndOfSection);
  output.write("CELL_TYPES ").write(cells).write('\n');
  lines.write(
      cells, Numbers::kRoom,
      [type](char* place, std::size_t /*i*/) { return Numbers::type(place, type); }, progress);
  output.write(Numbers::kEndOfSection);
}

}  // namespace hexhex
