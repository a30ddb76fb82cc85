#include <atlas/jumps.hpp>

namespace hexhex {

Jumps::Jumps() : jumps_(1), slots_(64, kNoJump) {}

JumpId Jumps::across(const PreparedMap& map, const Charts& charts, HalfFace halfFace) {
  const Index here = tetOf(halfFace);
  const Index there = tetOf(map.topology.mate[halfFace]);
  Jump jump{charts.chart[here], charts.chart[there], {}, kNoJump};
  if (jump.from == Charts::kNoChart || jump.to == Charts::kNoChart) return kManyJumps;
  jump.map = charts.gauge(there) * map.exact.transitions.across(halfFace) / charts.gauge(here);
  // Neighbouring faces mostly belong to one cut.
  if (jumps_[last_].isSame(jump) && last_ != kNoJump) return last_;
  const JumpId found = slots_[slotOf(jump)];
  if (found != kNoJump) return last_ = found;
  if (jumps_.size() + 2 > kManyJumps) return kManyJumps;
  const JumpId id = add(jump);
  const Jump back{jump.to, jump.from, Gauge{} / jump.map, id};
  const bool isOwnInverse = back.isSame(jump);
  jumps_[id].inverse = isOwnInverse ? id : add(back);
  return last_ = id;
}

JumpId Jumps::add(const Jump& jump) {
  if (2 * jumps_.size() > slots_.size()) grow();
  const auto id = static_cast<JumpId>(jumps_.size());
  slots_[slotOf(jump)] = id;
  jumps_.push_back(jump);
  return id;
}

/// The slot of a jump, or the one that it would get.
std::size_t Jumps::slotOf(const Jump& jump) const noexcept {
  std::uint64_t hash = std::uint64_t{jump.from} << 32 | jump.to;
  const auto mix = [&](std::uint64_t value) { hash = (hash ^ value) * 0x9e3779b97f4a7c15U; };
  mix(static_cast<std::uint64_t>(jump.map.rotation.index()));
  for (const std::uint32_t coordinate : jump.map.translation) mix(coordinate);
  std::size_t i = static_cast<std::size_t>(hash >> 32) & (slots_.size() - 1);
  while (slots_[i] != kNoJump && !jumps_[slots_[i]].isSame(jump)) i = (i + 1) & (slots_.size() - 1);
  return i;
}

void Jumps::grow() {
  slots_.assign(2 * slots_.size(), kNoJump);
  for (std::size_t id = 1; id < jumps_.size(); ++id) {
    slots_[slotOf(jumps_[id])] = static_cast<JumpId>(id);
  }
}

}  // namespace hexhex
