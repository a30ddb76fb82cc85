// Bytes of numbers for LineWriter, whose "lines" may as well be records of a binary file.
#pragma once

#include <algorithm>
#include <array>

#include <hexhex/types.hpp>

#include <io/core/line_writer.hpp>
#include <io/ovm/ovmb_bytes.hpp>

namespace hexhex {

/// Puts the bytes of a number, least first, and returns the place behind.
template <class T>
[[nodiscard]] char* putBytes(char* place, T number) {
  const auto bytes = littleBytes(number);
  return std::copy(bytes.begin(), bytes.end(), place);
}

/// The same of three coordinates.
[[nodiscard]] inline char* putBytes(char* place, const Vec3& point) {
  for (const double coordinate : point) place = putBytes(place, coordinate);
  return place;
}

/// Writes the bytes of a number, least first.
template <class T>
void writeBytesOf(OutputFile& output, T number) {
  const auto bytes = littleBytes(number);
  output.writeBytes(bytes.data(), bytes.size());
}

}  // namespace hexhex
