// What a walk through the charts of tets meets at a half-face: another chart, or a boundary plane
// (Section 5.1.1).
#pragma once

#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>

namespace hexhex::igm {

/// Either the rotation into the neighbour's chart (the translation follows from the parameters), or
/// the boundary, with the axis across it. One byte, so that all of them fit a cache.
class HalfFaceTransition {
 public:
  /// Leads to a neighbour that agrees on the parameters of the common corners.
  constexpr HalfFaceTransition() = default;

  /// @param isExact  whether the transition carries the parameters over without rounding
  [[nodiscard]] static constexpr HalfFaceTransition inner(lattice::Rotation rotation,
                                                          bool isExact) noexcept {
    return {static_cast<unsigned>(rotation.index()), isExact};
  }
  /// @param axis  along which the triangle is constant, or nearly so
  [[nodiscard]] static constexpr HalfFaceTransition boundary(std::size_t axis,
                                                             bool isConstant) noexcept {
    return {static_cast<unsigned>((1 + axis) * kBoundary), isConstant};
  }

  /// Whether anything about it is, or may be, rounded.
  [[nodiscard]] constexpr bool isInexact() const noexcept { return (code_ & kInexact) != 0; }
  /// Whether it leads to a neighbour in the same chart.
  [[nodiscard]] constexpr bool isTrivial() const noexcept { return code_ == 0; }
  [[nodiscard]] constexpr bool isBoundary() const noexcept { return code_ >= kBoundary; }

  /// Into the neighbour's chart; the identity at the boundary.
  [[nodiscard]] constexpr lattice::Rotation rotation() const noexcept {
    return lattice::Rotation(code_ % kInexact);
  }
  /// The axis across a boundary half-face; none for an inner one.
  [[nodiscard]] constexpr lattice::AxisSet plane() const noexcept {
    return (1U << code_ / kBoundary) >> 1;
  }

 private:
  // The bits of the byte: five for the rotation, one for inexactness, two for the axis plus one.
  static constexpr unsigned kInexact = 32;
  static constexpr unsigned kBoundary = 64;

  constexpr HalfFaceTransition(unsigned kind, bool isExact)
      : code_(static_cast<std::uint8_t>(kind | (isExact ? 0 : kInexact))) {}

  std::uint8_t code_ = 0;
};

}  // namespace hexhex::igm

template <>
inline constexpr bool hexhex::kLeftUninitialized<hexhex::igm::HalfFaceTransition> = true;
