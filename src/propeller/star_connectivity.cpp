#include <algorithm>
#include <string>

#include <propeller/star_connectivity.hpp>

namespace hexhex {

void StarConnectivity::fail(const char* what) const {
  throw Error(ErrorCode::Internal,
              std::string("Local connectivity failed: ") + what +
                  ". The sanitized map passed all checks, so this is a bug; please report it with "
                  "the map.",
              {PlaceKind::Tet, star_.front().tet});
}

const StarConnectivity::Result& StarConnectivity::run(Index tet, CornerMask simplex) {
  result_.propellers.clear();
  result_.slots.clear();
  result_.corners.clear();
  holders_.clear();
  collectStar(tet, simplex);
  findPropellers();
  for (std::size_t p = 0; p < holders_.size(); ++p) findCasings(p);
  findBlades();
  if (!linkCorners(result_.propellers, result_.slots, result_.corners)) {
    fail("three blades do not close to a hex corner");
  }
  return result_;
}

void StarConnectivity::collectStar(Index tet, CornerMask simplex) {
  star_.clear();
  const auto add = [&](Index t, CornerMask corners) {
    StarTet& entry = star_.emplace_back(StarTet{t, corners, {}});
    entry.propeller.fill(kNoPropeller);
  };
  if (dimension(simplex) == 0) {
    const Index vertex = topology_.tets[tet][firstCorner(simplex)];
    for (const CornerIndex corner : topology_.star(vertex)) {
      add(corner / 4, cornerBit(localOf(corner)));
    }
    return;  // ascending already
  }
  forEachTetAround(topology_, exact_.transitions, tet, simplex,
                   [&](Index t, CornerMask corners, Rotation /*rotation*/) { add(t, corners); });
  std::sort(star_.begin(), star_.end(),
            [](const StarTet& a, const StarTet& b) { return a.tet < b.tet; });
}

StarConnectivity::StarTet& StarConnectivity::inStar(Index tet) {
  const auto found = std::lower_bound(star_.begin(), star_.end(), tet,
                                      [](const StarTet& entry, Index t) { return entry.tet < t; });
  if (found == star_.end() || found->tet != tet) fail("a walk left the star of its generator");
  return *found;
}

void StarConnectivity::findPropellers() {
  for (const StarTet& entry : star_) {
    const Index tet = entry.tet;
    for (Direction d = 0; d < kDirections; ++d) {
      const CornerMask simplex = holder(signs_[tet], entry.simplex, d);
      if (simplex == kNoSimplex || !ownsSimplex(topology_, tet, simplex)) continue;
      if (holders_.size() == kMaxPropellers) {
        throw Error(ErrorCode::TooLarge,
                    "More than " + std::to_string(kMaxPropellers) +
                        " hex edges meet at one point. Use the atlas engine.",
                    {PlaceKind::Tet, tet});
      }
      announce(static_cast<std::uint16_t>(holders_.size()), tet, simplex, d);
      holders_.push_back({tet, simplex, d});
    }
  }
  result_.propellers.resize(holders_.size());
}

/// Notes a propeller in all tets around its holder, in each with its direction there.
void StarConnectivity::announce(std::uint16_t propeller, Index tet, CornerMask holderSimplex,
                                Direction d) {
  forEachTetAround(topology_, exact_.transitions, tet, holderSimplex,
                   [&](Index t, CornerMask /*corners*/, Rotation rotation) {
                     inStar(t).propeller[rotation(d)] = propeller;
                   });
}

Direction StarConnectivity::directionIn(Index tet, std::size_t propeller) {
  const StarTet& entry = inStar(tet);
  for (Direction d = 0; d < kDirections; ++d) {
    if (entry.propeller[d] == propeller) return d;
  }
  fail("a propeller is unknown in a tet around its holder");
}

StarConnectivity::Quadrant StarConnectivity::anyCasing(std::size_t propeller) {
  const Holder& at = holders_[propeller];
  Quadrant found{kNone, 0, 0};
  forEachTetAround(topology_, exact_.transitions, at.tet, at.simplex,
                   [&](Index tet, CornerMask /*corners*/, Rotation rotation) {
                     if (found.tet != kNone) return;
                     const Direction first = rotation(at.direction);
                     for (Direction second = 0; second < kDirections; ++second) {
                       if (axisOf(second) == axisOf(first)) continue;
                       if (casing(signs_[tet], inStar(tet).simplex, first, second) != kNoSimplex) {
                         found = {tet, first, second};
                         return;
                       }
                     }
                   });
  if (found.tet == kNone) fail("a propeller has no blade");
  return found;
}

bool StarConnectivity::turn(Quadrant& quadrant, bool counterClockwise) {
  Direction target = counterClockwise ? cross(quadrant.first, quadrant.second)
                                      : cross(quadrant.second, quadrant.first);
  Direction from = quadrant.second;
  Direction axis = quadrant.first;
  Index tet = quadrant.tet;
  // A turn by a right angle meets every tet around the holder at most once; the doubled bound also
  // covers tets that it only touches.
  for (std::size_t steps = 0; steps <= 2 * star_.size(); ++steps) {
    const CornerMask holderSimplex = holder(signs_[tet], inStar(tet).simplex, axis);
    if (holderSimplex == kNoSimplex) fail("a turn around a propeller left its holder");
    const int exit = exitOfTurn(exact_.corners[tet], signs_[tet], holderSimplex, from, target);
    if (exit == kStaysInside) {
      quadrant = {tet, axis, target};
      return true;
    }
    if (exit == kNoExit) fail("a turn around a propeller leaves a tet through no face");
    const HalfFace halfFace = halfFaceOf(tet, exit);
    const HalfFace mate = topology_.mate[halfFace];
    if (mate == kNone) return false;
    const Rotation rotation = exact_.transitions.across(halfFace).rotation;
    from = rotation(from);
    target = rotation(target);
    axis = rotation(axis);
    tet = tetOf(mate);
  }
  fail("a turn around a propeller does not end");
}

StarConnectivity::Quadrant StarConnectivity::canonical(const Quadrant& quadrant) {
  const CornerMask simplex =
      casing(signs_[quadrant.tet], inStar(quadrant.tet).simplex, quadrant.first, quadrant.second);
  if (simplex == kNoSimplex) fail("a quarter plane does not lead into the tet it was traced to");
  if (simplex == kWholeTet) return quadrant;
  const int face = oppositeCorner(simplex);
  const HalfFace halfFace = halfFaceOf(quadrant.tet, face);
  const HalfFace mate = topology_.mate[halfFace];
  if (mate == kNone || tetOf(mate) > quadrant.tet) return quadrant;
  const Rotation rotation = exact_.transitions.across(halfFace).rotation;
  return {tetOf(mate), rotation(quadrant.first), rotation(quadrant.second)};
}

/// Enumerates the casings of a propeller counter-clockwise: on the boundary from the first on.
void StarConnectivity::findCasings(std::size_t propeller) {
  const auto same = [](const Quadrant& a, const Quadrant& b) {
    return a.tet == b.tet && a.second == b.second;
  };
  const Quadrant any = canonical(anyCasing(propeller));
  Quadrant start = any;
  bool closed = false;
  // Each tet holds at most four casings of a propeller.
  const std::size_t limit = 4 * star_.size() + 1;
  for (std::size_t steps = 0; turn(start, false); ++steps) {
    start = canonical(start);
    closed = same(start, any);
    if (closed) break;
    if (steps > limit) fail("the casings of a propeller do not close");
  }
  Propeller& entry = result_.propellers[propeller];
  entry.slotBegin = static_cast<Index>(result_.slots.size());
  entry.closed = closed;
  entry.direction = start.first;
  Quadrant current = start;
  do {
    result_.slots.push_back({current.tet, current.second, 0, 0, kNoCorner});
    if (!turn(current, true)) break;
    current = canonical(current);
    if (result_.slots.size() - entry.slotBegin > limit) {
      fail("the casings of a propeller do not close");
    }
  } while (!same(current, start));
  entry.slotCount = static_cast<std::uint16_t>(result_.slots.size() - entry.slotBegin);
}

void StarConnectivity::findBlades() {
  constexpr std::uint16_t kUnknown = 0xffff;
  for (Slot& slot : result_.slots) slot.blade = kUnknown;
  for (std::size_t p = 0; p < result_.propellers.size(); ++p) {
    for (std::size_t i = 0; i < result_.propellers[p].slotCount; ++i) {
      // The relation is symmetric: each pair is traced from one side.
      if (result_.slots[result_.propellers[p].slotBegin + i].blade == kUnknown) traceBlade(p, i);
    }
  }
}

/// Turns from a propeller to its blade, from tet to tet around the generator.
void StarConnectivity::traceBlade(std::size_t propeller, std::size_t slotIndex) {
  Slot& slot = result_.slots[result_.propellers[propeller].slotBegin + slotIndex];
  Index tet = slot.tet;
  Direction from = directionIn(tet, propeller);
  Direction to = slot.direction;
  for (std::size_t steps = 0;; ++steps) {
    if (steps > 2 * star_.size()) fail("the turn from a propeller to its blade does not end");
    const int exit = exitOfTurn(exact_.corners[tet], signs_[tet], inStar(tet).simplex, from, to);
    if (exit == kStaysInside) break;
    if (exit == kNoExit)
      fail("the turn from a propeller to its blade leaves a tet through no face");
    const HalfFace halfFace = halfFaceOf(tet, exit);
    const HalfFace mate = topology_.mate[halfFace];
    if (mate == kNone) fail("the turn from a propeller to its blade leaves the mesh");
    const Rotation rotation = exact_.transitions.across(halfFace).rotation;
    from = rotation(from);
    to = rotation(to);
    tet = tetOf(mate);
  }
  const std::uint16_t blade = inStar(tet).propeller[to];
  if (blade == kNoPropeller) fail("a blade is not a propeller");
  // Seen from the blade, the same quarter plane is one of its casings.
  const Quadrant seen = canonical({tet, to, from});
  const Propeller& other = result_.propellers[blade];
  for (std::size_t j = 0; j < other.slotCount; ++j) {
    Slot& back = result_.slots[other.slotBegin + j];
    if (back.tet != seen.tet || back.direction != seen.second) continue;
    slot.blade = blade;
    slot.back = static_cast<std::uint16_t>(j);
    back.blade = static_cast<std::uint16_t>(propeller);
    back.back = static_cast<std::uint16_t>(slotIndex);
    return;
  }
  fail("a propeller is no blade of its blade");
}

}  // namespace hexhex
