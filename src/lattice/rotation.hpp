// The 24 rotations of the integer grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lattice/direction.hpp>

namespace hexhex::lattice {

/// One of the 24 orientation-preserving symmetries of the cube, as an index into constant tables.
/// Rotation 0 is the identity.
class Rotation {
 public:
  static constexpr int kCount = 24;

  constexpr Rotation() = default;
  constexpr explicit Rotation(int index) : index_(static_cast<std::uint8_t>(index)) {}
  /// The rotation that sends +x to `x` and +y to `y` (perpendicular directions).
  static constexpr Rotation fromAxes(Direction x, Direction y);

  [[nodiscard]] constexpr int index() const noexcept { return index_; }
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return index_ == 0; }
  [[nodiscard]] constexpr bool operator==(const Rotation&) const = default;

  [[nodiscard]] constexpr Direction operator()(Direction d) const noexcept;
  template <class Number>
  [[nodiscard]] constexpr std::array<Number, 3> operator()(
      const std::array<Number, 3>& v) const noexcept;

  [[nodiscard]] constexpr Rotation inverse() const noexcept;
  /// The coordinate axis of rotation; -1 for the identity and for rotations about diagonals.
  [[nodiscard]] constexpr int axis() const noexcept;
  /// Composition: (a * b)(v) = a(b(v)).
  friend constexpr Rotation operator*(Rotation a, Rotation b) noexcept;

 private:
  std::uint8_t index_ = 0;
};

namespace detail {

struct RotationTables {
  /// image[r][d]: where rotation r sends direction d.
  std::array<std::array<Direction, kDirections>, Rotation::kCount> image{};
  /// byAxes[x][y]: the rotation that sends +x to x and +y to y.
  std::array<std::array<std::uint8_t, kDirections>, kDirections> byAxes{};
  std::array<std::uint8_t, Rotation::kCount> inverse{};
};

constexpr RotationTables makeRotationTables() {
  RotationTables tables;
  std::uint8_t count = 0;
  for (Direction x = 0; x < kDirections; ++x) {
    for (Direction y = 0; y < kDirections; ++y) {
      if (axisOf(x) == axisOf(y)) continue;
      const Direction z = cross(x, y);
      tables.image[count] = {x, opposite(x), y, opposite(y), z, opposite(z)};
      tables.byAxes[x][y] = count;
      ++count;
    }
  }
  for (std::size_t r = 0; r < Rotation::kCount; ++r) {
    std::array<Direction, kDirections> source{};
    for (Direction d = 0; d < kDirections; ++d) source[tables.image[r][d]] = d;
    tables.inverse[r] = tables.byAxes[source[0]][source[2]];
  }
  return tables;
}

inline constexpr RotationTables kRotationTables = makeRotationTables();

/// Per rotation and axis: the axis that is sent to this one or its opposite, and the sign, 1 or -1.
struct AxisSources {
  std::array<std::array<std::uint8_t, 3>, Rotation::kCount> axis{};
  std::array<std::array<std::int8_t, 3>, Rotation::kCount> sign{};
};

inline constexpr AxisSources kAxisSources = [] {
  AxisSources sources;
  for (std::size_t r = 0; r < Rotation::kCount; ++r) {
    for (std::uint8_t from = 0; from < 3; ++from) {
      const Direction to = kRotationTables.image[r][2U * from];
      sources.axis[r][static_cast<std::size_t>(axisOf(to))] = from;
      sources.sign[r][static_cast<std::size_t>(axisOf(to))] = static_cast<std::int8_t>(signOf(to));
    }
  }
  return sources;
}();

inline constexpr std::array<std::array<std::uint8_t, Rotation::kCount>, Rotation::kCount>
    kProducts = [] {
      std::array<std::array<std::uint8_t, Rotation::kCount>, Rotation::kCount> products{};
      for (std::size_t a = 0; a < Rotation::kCount; ++a) {
        for (std::size_t b = 0; b < Rotation::kCount; ++b) {
          const auto& inner = kRotationTables.image[b];
          const auto& outer = kRotationTables.image[a];
          products[a][b] = kRotationTables.byAxes[outer[inner[0]]][outer[inner[2]]];
        }
      }
      return products;
    }();

}  // namespace detail

constexpr Rotation Rotation::fromAxes(Direction x, Direction y) {
  return Rotation(detail::kRotationTables.byAxes[x][y]);
}

constexpr Direction Rotation::operator()(Direction d) const noexcept {
  return detail::kRotationTables.image[index_][d];
}

template <class Number>
constexpr std::array<Number, 3> Rotation::operator()(
    const std::array<Number, 3>& v) const noexcept {
  const auto& axis = detail::kAxisSources.axis[index_];
  const auto& sign = detail::kAxisSources.sign[index_];
  std::array<Number, 3> rotated{};
  for (std::size_t k = 0; k < 3; ++k) {
    rotated[k] = static_cast<Number>(static_cast<Number>(sign[k]) * v[axis[k]]);
  }
  return rotated;
}

constexpr Rotation operator*(Rotation a, Rotation b) noexcept {
  return Rotation(detail::kProducts[a.index_][b.index_]);
}

constexpr Rotation Rotation::inverse() const noexcept {
  return Rotation(detail::kRotationTables.inverse[index_]);
}

constexpr int Rotation::axis() const noexcept {
  for (int k = 0; k < 3 && !isIdentity(); ++k) {
    if ((*this)(direction(k, 1)) == direction(k, 1)) return k;
  }
  return -1;
}

/// A set of coordinate axes: bit k for axis k.
using AxisSet = unsigned;

inline constexpr AxisSet kAllAxes = 7;

namespace detail {

inline constexpr auto kAxisImages = [] {
  std::array<std::array<std::uint8_t, kAllAxes + 1>, Rotation::kCount> images{};
  for (int r = 0; r < Rotation::kCount; ++r) {
    for (AxisSet axes = 0; axes <= kAllAxes; ++axes) {
      unsigned image = 0;
      for (int axis = 0; axis < 3; ++axis) {
        image |= ((axes >> axis) & 1U) << axisOf(Rotation(r)(direction(axis, 1)));
      }
      images[static_cast<std::size_t>(r)][axes] = static_cast<std::uint8_t>(image);
    }
  }
  return images;
}();

}  // namespace detail

/// The image of a set of axes.
[[nodiscard]] constexpr AxisSet imageOf(AxisSet axes, Rotation rotation) noexcept {
  return detail::kAxisImages[static_cast<std::size_t>(rotation.index())][axes];
}

/// The parameter rotation across a half-face that AlgoHex stores as index 0..23 in its property
/// `HalffaceTransiton`: the inverse of the rotation by its unit quaternion of that index.
[[nodiscard]] Rotation rotationFromAlgoHex(int index);

}  // namespace hexhex::lattice
