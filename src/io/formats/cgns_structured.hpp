// Structured zones of CGNS files: their vertices have places (i, j, k) from 1 on, i fastest.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <tuple>

#include <hexhex/types.hpp>

namespace hexhex::io {

using ZonePlace = std::array<std::int64_t, 3>;

/// The places from one to another, along each axis up or down. Where there is one axis, as of lists
/// of elements, the others have one place.
struct ZoneRange {
  ZonePlace first = {1, 1, 1};
  ZonePlace last = {1, 1, 1};

  /// The number of places. @pre  both ends are in a zone that fits into memory
  [[nodiscard]] std::uint64_t count() const {
    std::uint64_t product = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      product *= static_cast<std::uint64_t>(std::abs(last[k] - first[k]) + 1);
    }
    return product;
  }
  /// The only axis along which there is one place; nothing if there are none or several.
  [[nodiscard]] std::optional<std::size_t> flatAxis() const {
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < 3; ++k) {
      if (first[k] != last[k]) continue;
      if (found) return std::nullopt;
      found = k;
    }
    return found;
  }
  [[nodiscard]] ZoneRange ascending() const {
    ZoneRange range;
    for (std::size_t k = 0; k < 3; ++k) {
      std::tie(range.first[k], range.last[k]) = std::minmax(first[k], last[k]);
    }
    return range;
  }
  /// Calls f(place) for each, i fastest, along each axis from its first to its last.
  template <class F>
  void forEach(const F& f) const {
    const auto step = [this](std::size_t k) { return first[k] <= last[k] ? 1 : -1; };
    for (std::int64_t z = first[2]; z != last[2] + step(2); z += step(2)) {
      for (std::int64_t y = first[1]; y != last[1] + step(1); y += step(1)) {
        for (std::int64_t x = first[0]; x != last[0] + step(0); x += step(0)) f(ZonePlace{x, y, z});
      }
    }
  }
};

/// The numbers of things, such as vertices, along the axes of a zone.
struct ZoneGrid {
  ZonePlace size = {0, 1, 1};

  [[nodiscard]] bool has(const ZonePlace& place) const {
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && place[k] >= 1 && place[k] <= size[k];
    return inside;
  }
  /// The number of a place, from 0 on.
  [[nodiscard]] std::uint64_t numberOf(const ZonePlace& place) const {
    return static_cast<std::uint64_t>(place[0] - 1 +
                                      size[0] * (place[1] - 1 + size[1] * (place[2] - 1)));
  }
  /// Of vertices: the cells between them, or the faces across an axis.
  [[nodiscard]] ZoneGrid between(std::optional<std::size_t> across = std::nullopt) const {
    ZoneGrid grid = *this;
    for (std::size_t k = 0; k < 3; ++k) grid.size[k] -= across == k ? 0 : 1;
    return grid;
  }
  /// The vertices of a face across an axis.
  /// @param first   index of the zone's first vertex
  /// @param corner  the face's lowest one
  [[nodiscard]] Quad faceAt(std::size_t first, std::size_t axis, const ZonePlace& corner) const {
    Quad face{};
    for (std::size_t c = 0; c < face.size(); ++c) {
      ZonePlace place = corner;
      place[(axis + 1) % 3] += (c + 1) / 2 % 2;
      place[(axis + 2) % 3] += c / 2;
      face[c] = static_cast<Index>(first + numberOf(place));
    }
    return face;
  }
};

}  // namespace hexhex::io
