#include <propeller/slot_finder.hpp>

namespace hexhex {

SlotName SlotFinder::find(Index tet, Index generator, Direction along, Direction beside) const {
  const std::size_t p = findPropeller(tet, generator, along);
  const Slot key = casingKey(tet, generator, along, beside);
  const Propeller& propeller = local_.propeller(local_.configuration(generator), p);
  for (std::size_t i = 0; i < propeller.slotCount; ++i) {
    const Slot& slot = local_.slot(propeller, i);
    if (slot.tet == key.tet && slot.direction == key.direction) return {p, i};
  }
  throw MissingVertex{tet};
}

std::size_t SlotFinder::findPropeller(Index tet, Index generator, Direction along) const {
  const Index configuration = local_.configurationOf[generator];
  if (configuration == 0) return along;
  if (configuration < kConstantConfigurations) {
    // Propellers of a boundary face: all directions but the one that leads outside.
    const Direction outward = opposite(static_cast<Direction>(configuration - 1));
    return along > outward ? along - std::size_t{1} : along;
  }
  const std::uint8_t propeller = vertices_.incidenceOf(tet, generator).propeller[along];
  if (propeller == kNoPropeller) throw MissingVertex{tet};
  return propeller;
}

/// Names the blade's casing as the slots do.
Slot SlotFinder::casingKey(Index tet, Index generator, Direction along, Direction beside) const {
  if (local_.configurationOf[generator] < kConstantConfigurations) {
    return {kNone, beside, 0, 0, 0};
  }
  const CornerMask simplex =
      casing(signs_[tet], vertices_.incidenceOf(tet, generator).simplex, along, beside);
  if (dimension(simplex) == 2) {
    const int face = oppositeCorner(simplex);
    const HalfFace halfFace = halfFaceOf(tet, face);
    const HalfFace mate = topology_.mate[halfFace];
    if (mate != kNone && tetOf(mate) < tet) {
      return {tetOf(mate), exact_.transitions.across(halfFace)(beside), 0, 0, 0};
    }
  }
  return {tet, beside, 0, 0, 0};
}

}  // namespace hexhex
