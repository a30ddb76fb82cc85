// Rotations of parameters in floating point, made so that nothing in them is for the processor to
// guess: across cuts, rotations are as good as random.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>

namespace hexhex {

namespace detail {

struct TurnTable {
  struct Turn {
    std::array<std::uint8_t, 3> from{};  ///< per axis: the one that is turned into it,
    Vec3 sign{};                         ///< and 1, or -1 if reversed
    std::array<std::int32_t, 3> integerSign{};
  };
  std::array<Turn, Rotation::kCount> turn{};
  std::array<std::uint8_t, Rotation::kCount> inverse{};
};

inline constexpr TurnTable kTurnTable = [] {
  TurnTable table;
  for (int r = 0; r < Rotation::kCount; ++r) {
    const auto index = static_cast<std::size_t>(r);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const Direction to = Rotation(r)(direction(axis, 1));
      table.turn[index].from[static_cast<std::size_t>(axisOf(to))] = axis;
      table.turn[index].sign[static_cast<std::size_t>(axisOf(to))] = signOf(to);
      table.turn[index].integerSign[static_cast<std::size_t>(axisOf(to))] = signOf(to);
    }
    table.inverse[index] = static_cast<std::uint8_t>(Rotation(r).inverse().index());
  }
  return table;
}();

}  // namespace detail

/// rotation(u), to the bit.
[[nodiscard]] constexpr Vec3 turned(Rotation rotation, const Vec3& u) noexcept {
  const auto& turn = detail::kTurnTable.turn[static_cast<std::size_t>(rotation.index())];
  return {turn.sign[0] * u[turn.from[0]], turn.sign[1] * u[turn.from[1]],
          turn.sign[2] * u[turn.from[2]]};
}

[[nodiscard]] constexpr GridPoint turned(Rotation rotation, const GridPoint& z) noexcept {
  const auto& turn = detail::kTurnTable.turn[static_cast<std::size_t>(rotation.index())];
  return {turn.integerSign[0] * z[turn.from[0]], turn.integerSign[1] * z[turn.from[1]],
          turn.integerSign[2] * z[turn.from[2]]};
}

/// rotation.inverse(), looked up.
[[nodiscard]] constexpr Rotation inverseOf(Rotation rotation) noexcept {
  return Rotation(detail::kTurnTable.inverse[static_cast<std::size_t>(rotation.index())]);
}

}  // namespace hexhex
