// From the picture on one side of a cut to the picture on the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <atlas/charts.hpp>

namespace hexhex {

/// Names a jump, or says that there are none or several.
using JumpId = std::uint8_t;
inline constexpr JumpId kNoJump = 0;
inline constexpr JumpId kManyJumps = std::numeric_limits<JumpId>::max();

/// What all faces of a cut usually have in common.
struct Jump {
  Index from;      ///< the chart on this side
  Index to;        ///< the chart on the other side
  Gauge map;       ///< takes places of the one to places of the other
  JumpId inverse;  ///< from the other side back

  [[nodiscard]] bool isSame(const Jump& other) const noexcept {
    return from == other.from && to == other.to && map == other.map;
  }
};

/// The different jumps of an atlas. There are few: one for each side of a sheet of cuts. Of more
/// than there are names for, those that come late have none.
class Jumps {
 public:
  Jumps();

  /// The jump across a half-face that is not glued, found or added together with its inverse;
  /// kManyJumps, which stands for any, if there is no picture on one of the sides, or no name left.
  [[nodiscard]] JumpId across(const PreparedMap& map, const Charts& charts, HalfFace halfFace);

  [[nodiscard]] const Jump& operator[](JumpId id) const noexcept { return jumps_[id]; }

 private:
  [[nodiscard]] JumpId add(const Jump& jump);
  [[nodiscard]] std::size_t slotOf(const Jump& jump) const noexcept;
  void grow();

  std::vector<Jump> jumps_;    ///< by id; what has the id kNoJump is none
  std::vector<JumpId> slots_;  ///< hash table, at most half full
  JumpId last_ = kNoJump;
};

}  // namespace hexhex
