// How a walk through the charts of tets passes the faces between them.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <lattice/rotation.hpp>

namespace hexhex {

namespace detail {

/// Passages by kind: rotations, then boundaries across each axis.
struct PassageTable {
  static constexpr std::size_t kFirstBoundary = Rotation::kCount;
  static constexpr std::size_t kKinds = kFirstBoundary + 3;

  struct Step {
    Rotation rotation;
    std::uint8_t plane = 0;
  };
  /// By kind, and by the rotation that leads to the half-face.
  std::array<std::array<Step, Rotation::kCount>, kKinds> step{};
};

inline constexpr PassageTable kPassageTable = [] {
  PassageTable table;
  for (int here = 0; here < Rotation::kCount; ++here) {
    const auto h = static_cast<std::size_t>(here);
    for (int r = 0; r < Rotation::kCount; ++r) {
      table.step[static_cast<std::size_t>(r)][h].rotation = Rotation(r) * Rotation(here);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int image = axisOf(Rotation(here)(direction(axis, 1)));
      table.step[PassageTable::kFirstBoundary + static_cast<std::size_t>(image)][h] = {
          Rotation(here), static_cast<std::uint8_t>(1U << axis)};
    }
  }
  return table;
}();

}  // namespace detail

/// What a half-face is to a walk, in a byte, so that walks look at one array and guess nothing: a
/// way into the neighbour's chart by a rotation (the translation follows from the parameters), or
/// the boundary, across an axis.
class Passage {
 public:
  /// To a neighbour that agrees on the parameters of the common corners.
  constexpr Passage() = default;

  /// To another one.
  /// @param isExact  whether a transition carries the parameters over without rounding
  [[nodiscard]] static constexpr Passage across(Rotation rotation, bool isExact) noexcept {
    return {static_cast<unsigned>(rotation.index()), isExact};
  }
  /// Out of the mesh.
  /// @param axis  along which the triangle is constant, or nearly so
  [[nodiscard]] static constexpr Passage boundary(std::size_t axis, bool isConstant) noexcept {
    return {static_cast<unsigned>(detail::PassageTable::kFirstBoundary + axis), isConstant};
  }
  /// Makes it rough. Several threads may do so at the same time.
  void roughen() noexcept {
    const std::atomic_ref shared(code_);
    const auto rough = static_cast<std::uint8_t>(shared.load(std::memory_order_relaxed) | kRough);
    shared.store(rough, std::memory_order_relaxed);
  }

  /// Whether anything about it is rounded, or may be.
  [[nodiscard]] constexpr bool isRough() const noexcept { return (code_ & kRough) != 0; }
  /// Whether there is more to it than to pass.
  [[nodiscard]] constexpr bool isPlain() const noexcept { return code_ == 0; }

  /// The rotation into the chart behind, after the one that leads here; at the boundary, the same.
  [[nodiscard]] constexpr Rotation after(Rotation here) const noexcept {
    return step(here).rotation;
  }
  /// The axis of the boundary as a bit, in the chart from which a rotation leads here; 0 inside.
  [[nodiscard]] constexpr unsigned planeBefore(Rotation here) const noexcept {
    return step(here).plane;
  }

 private:
  static constexpr unsigned kRough = 32;

  constexpr Passage(unsigned kind, bool isSmooth)
      : code_(static_cast<std::uint8_t>(kind | (isSmooth ? 0 : kRough))) {}
  [[nodiscard]] constexpr const detail::PassageTable::Step& step(Rotation here) const noexcept {
    return detail::kPassageTable.step[code_ % kRough][static_cast<std::size_t>(here.index())];
  }

  std::uint8_t code_ = 0;
};

}  // namespace hexhex
