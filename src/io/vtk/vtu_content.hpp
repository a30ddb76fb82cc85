// The bytes of `.vtu` arrays that do not lie in memory as they go into the file. `Output` is
// anything with a buffered writeBytes(const void*, std::size_t).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

namespace hexhex {

inline constexpr std::uint8_t kVtkTet = 10;
inline constexpr std::uint8_t kVtkHexahedron = 12;

/// Writes valueOf(i) for every i in [0, count).
template <class T, class Output, class F>
void writeValues(Output& output, std::size_t count, const F& valueOf) {
  std::array<T, 1024> values;  // some kilobytes: any number that keeps calls from showing
  for (std::size_t begin = 0; begin < count; begin += values.size()) {
    const std::size_t size = std::min(values.size(), count - begin);
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<T>(valueOf(begin + i));
    output.writeBytes(values.data(), size * sizeof(T));
  }
}

template <class Output>
void writeGeneratorKinds(Output& output, std::span<const CornerSet> corners) {
  writeValues<std::uint8_t>(output, corners.size(),
                            [corners](std::size_t i) { return generatorKind(corners[i]); });
}

/// @param wide  as Int64, not Int32
template <class Output, class Vertex, std::size_t corners>
void writeConnectivity(Output& output, std::span<const std::array<Vertex, corners>> cells,
                       bool wide) {
  // Indices that fit have the same bytes with and without a sign.
  if (wide == (sizeof(Vertex) == sizeof(std::int64_t))) {
    output.writeBytes(cells.data(), cells.size_bytes());
    return;
  }
  const auto vertex = [cells](std::size_t i) { return cells[i / corners][i % corners]; };
  if (wide) {
    writeValues<std::int64_t>(output, corners * cells.size(), vertex);
  } else {
    writeValues<std::int32_t>(output, corners * cells.size(), vertex);
  }
}

/// The ends of the corners of cells from number `first` on.
template <class Output>
void writeOffsets(Output& output, std::uint64_t first, std::size_t count, bool wide,
                  std::uint64_t corners = 8) {
  const auto end = [first, corners](std::size_t i) { return corners * (first + i + 1); };
  if (wide) {
    writeValues<std::int64_t>(output, count, end);
  } else {
    writeValues<std::int32_t>(output, count, end);
  }
}

template <class Output>
void writeTypes(Output& output, std::size_t count, std::uint8_t type = kVtkHexahedron) {
  writeValues<std::uint8_t>(output, count, [type](std::size_t /*cell*/) { return type; });
}

}  // namespace hexhex
