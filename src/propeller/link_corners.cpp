#include <propeller/link_corners.hpp>

namespace hexhex {

bool linkCorners(const std::vector<Propeller>& propellers, std::vector<Slot>& slots,
                 std::vector<HexCorner>& corners) {
  for (std::size_t p = 0; p < propellers.size(); ++p) {
    const Propeller& propeller = propellers[p];
    // On the boundary there is no corner behind the last blade.
    const std::size_t count =
        propeller.closed ? propeller.slotCount : propeller.slotCount - std::size_t{1};
    for (std::size_t i = 0; i < count; ++i) {
      if (slots[propeller.slotBegin + i].corner != kNoCorner) continue;
      const auto number = static_cast<std::uint16_t>(corners.size());
      corners.push_back({static_cast<std::uint16_t>(p), static_cast<std::uint16_t>(i)});
      SlotName at{p, i};
      for (int side = 0; side < 3; ++side) {
        Slot& slot = slots[propellers[at.propeller].slotBegin + at.slot];
        if (slot.corner != kNoCorner) return false;
        slot.corner = number;
        at = rotateCorner(propellers.data(), slots.data(), at);
      }
      if (at.propeller != p || at.slot != i) return false;
    }
  }
  return true;
}

}  // namespace hexhex
