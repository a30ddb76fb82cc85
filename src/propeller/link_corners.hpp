// Hex corners from blades (Section 5.3.4).
#pragma once

#include <vector>

#include <propeller/local_connectivity.hpp>

namespace hexhex {

/// Names a slot within one configuration.
struct SlotName {
  std::size_t propeller;
  std::size_t slot;
};

/// The hex corner between blades i and i + 1 of propeller p1, with p2 = blade i and p3 = blade i +
/// 1, seen from p2: there it lies between blades p3 and p1.
[[nodiscard]] inline SlotName rotateCorner(const Propeller* propellers, const Slot* slots,
                                           SlotName at) noexcept {
  const Slot& slot = slots[propellers[at.propeller].slotBegin + at.slot];
  const std::size_t count = propellers[slot.blade].slotCount;
  return {slot.blade, slot.back == 0 ? count - 1 : slot.back - std::size_t{1}};
}

/// Enumerates the hex corners of a configuration and numbers them in all three slots of each. False
/// if three blades do not close.
[[nodiscard]] bool linkCorners(const std::vector<Propeller>& propellers, std::vector<Slot>& slots,
                               std::vector<HexCorner>& corners);

}  // namespace hexhex
