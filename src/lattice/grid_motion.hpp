// Motions of the grid: rotations and translations that relate charts, be they transitions of an
// integer-grid map (Section 3.2), of a seamless one, or gauges of a chart that many tets share.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>

namespace hexhex::lattice {

/// u -> R u + t with one of the 24 rotations and any translation.
template <class T>
struct GridMotion {
  Rotation rotation;
  std::array<T, 3> translation{};

  /// The motion with a given rotation that takes one point to the other.
  [[nodiscard]] static constexpr GridMotion taking(const std::array<T, 3>& from,
                                                   const std::array<T, 3>& to,
                                                   Rotation rotation) noexcept {
    const std::array<T, 3> turned = rotation(from);
    return {rotation, {to[0] - turned[0], to[1] - turned[1], to[2] - turned[2]}};
  }

  /// Not defaulted: GCC would call memcmp.
  [[nodiscard]] constexpr bool operator==(const GridMotion& other) const noexcept {
    unsigned difference = rotation == other.rotation ? 0 : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      difference |= translation[k] == other.translation[k] ? 0U : 1U;
    }
    return difference == 0;
  }
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return *this == GridMotion{}; }

  /// Applies to a point; another number type of the same size is converted first.
  template <class Number>
  requires(sizeof(Number) == sizeof(T)) [[nodiscard]] constexpr std::array<T, 3> operator()(
      const std::array<Number, 3>& u) const noexcept {
    std::array<T, 3> image = rotation(
        std::array<T, 3>{static_cast<T>(u[0]), static_cast<T>(u[1]), static_cast<T>(u[2])});
    for (std::size_t k = 0; k < 3; ++k) image[k] += translation[k];
    return image;
  }
  /// Applies to a point whose coordinates are multiples of 1/unit, times unit.
  template <class Number>
  [[nodiscard]] constexpr std::array<Number, 3> operator()(const std::array<Number, 3>& u,
                                                           Number unit) const noexcept {
    std::array<Number, 3> image = rotation(u);
    for (std::size_t k = 0; k < 3; ++k) image[k] += static_cast<Number>(translation[k]) * unit;
    return image;
  }
  /// The same for the corners of a tet.
  template <class Number>
  [[nodiscard]] constexpr std::array<std::array<Number, 3>, 4> operator()(
      const std::array<std::array<Number, 3>, 4>& tet, Number unit) const noexcept {
    return {(*this)(tet[0], unit), (*this)(tet[1], unit), (*this)(tet[2], unit),
            (*this)(tet[3], unit)};
  }
  [[nodiscard]] constexpr Direction operator()(Direction d) const noexcept { return rotation(d); }

  /// The image of the cell with smallest corner z, also named by its smallest corner.
  template <class Point>
  [[nodiscard]] constexpr std::array<T, 3> cell(const Point& z) const noexcept {
    std::array<T, 3> image = (*this)(z);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const Direction d = rotation(direction(axis, 1));
      if (signOf(d) < 0) --image[static_cast<std::size_t>(axisOf(d))];
    }
    return image;
  }

  [[nodiscard]] constexpr GridMotion inverse() const noexcept {
    return taking(translation, {}, rotation.inverse());
  }
};

/// Composition: (a * b)(u) = a(b(u)).
template <class T, class Number>
[[nodiscard]] constexpr GridMotion<T> operator*(const GridMotion<T>& a,
                                                const GridMotion<Number>& b) noexcept {
  return {a.rotation * b.rotation, a(b.translation)};
}

/// Between charts of an integer-grid map.
using Transition = GridMotion<std::int32_t>;
/// Between charts of a seamless map, on its lattice; or between integer charts of any size.
using LatticeMotion = GridMotion<std::int64_t>;

}  // namespace hexhex::lattice

/// Where each tet has its own chart, the table of transitions is as large as the map.
template <>
inline constexpr bool hexhex::kLeftUninitialized<hexhex::lattice::Transition> = true;
