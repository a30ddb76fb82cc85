// Changes between charts of a seamless map: rotations of the grid, and any translation.
#pragma once

#include <lattice/rotation.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex {

[[nodiscard]] constexpr LatticePoint operator+(const LatticePoint& a,
                                               const LatticePoint& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] constexpr LatticePoint operator-(const LatticePoint& a) noexcept {
  return {-a[0], -a[1], -a[2]};
}

/// u -> R u + t, exactly, with coordinates on a lattice: units for a seamless map, integers for a
/// quantized one.
struct ChartChange {
  Rotation rotation;
  LatticePoint translation{};

  [[nodiscard]] constexpr bool operator==(const ChartChange&) const = default;
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return *this == ChartChange{}; }

  [[nodiscard]] constexpr LatticePoint operator()(const LatticePoint& u) const noexcept {
    return rotation(u) + translation;
  }
  [[nodiscard]] constexpr ChartChange inverse() const noexcept {
    const Rotation back = rotation.inverse();
    return {back, -back(translation)};
  }
  /// Composition: (a * b)(u) = a(b(u)).
  friend constexpr ChartChange operator*(const ChartChange& a, const ChartChange& b) noexcept {
    return {a.rotation * b.rotation, a(b.translation)};
  }
};

}  // namespace hexhex
