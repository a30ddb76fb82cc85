// Transition functions: the automorphisms of the integer grid that relate charts (Section 3.2).
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>

namespace hexhex::lattice {

/// u -> R u + t with one of the 24 rotations and an integer translation.
struct Transition {
  Rotation rotation;
  GridPoint translation{};

  [[nodiscard]] constexpr bool operator==(const Transition&) const = default;
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return *this == Transition{}; }

  /// Applies to a point whose coordinates are multiples of 1/unit, times unit. With unit 1: a point
  /// of the grid.
  template <class Number>
  [[nodiscard]] constexpr std::array<Number, 3> operator()(const std::array<Number, 3>& u,
                                                           Number unit) const noexcept {
    std::array<Number, 3> image = rotation(u);
    for (std::size_t k = 0; k < 3; ++k) image[k] += static_cast<Number>(translation[k]) * unit;
    return image;
  }
  [[nodiscard]] constexpr GridPoint operator()(const GridPoint& z) const noexcept {
    return (*this)(z, std::int32_t{1});
  }
  [[nodiscard]] constexpr Direction operator()(Direction d) const noexcept { return rotation(d); }

  [[nodiscard]] constexpr Transition inverse() const noexcept {
    const Rotation back = rotation.inverse();
    GridPoint t = back(translation);
    for (std::int32_t& component : t) component = -component;
    return {back, t};
  }

  /// Composition: (a * b)(u) = a(b(u)).
  friend constexpr Transition operator*(const Transition& a, const Transition& b) noexcept {
    return {a.rotation * b.rotation, a(b.translation)};
  }
};

}  // namespace hexhex::lattice

/// The table of a map's transitions is as large as the map where each tet has a chart of its own.
template <>
inline constexpr bool hexhex::kLeftUninitialized<hexhex::lattice::Transition> = true;
