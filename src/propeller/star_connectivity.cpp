// Local connectivity of one generator (Sections 5.3.2 to 5.3.4).
#include <algorithm>
#include <string>

#include <propeller/star_connectivity.hpp>

namespace hexhex::propeller {

void StarConnectivity::fail(const char* what) const {
  throw Error(ErrorCode::Internal,
              std::string("Local connectivity failed: ") + what +
                  ". The sanitized map passed all checks, so this is a bug; please report it with "
                  "the map.",
              {PlaceKind::Tet, star_.front().tet});
}

const StarConnectivity::Result& StarConnectivity::run(Index tet, lattice::CornerMask simplex) {
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

void StarConnectivity::collectStar(Index tet, lattice::CornerMask simplex) {
  star_.clear();
  const auto add = [&](Index t, lattice::CornerMask corners) {
    StarTet& entry = star_.emplace_back(StarTet{t, corners, {}});
    entry.propeller.fill(kNoPropeller);
  };
  if (lattice::dimension(simplex) == 0) {
    const Index vertex = topology_.tets[tet][lattice::firstCorner(simplex)];
    for (const adjacency::CornerIndex corner : topology_.star(vertex)) {
      add(corner / 4, lattice::cornerBit(adjacency::localOf(corner)));
    }
    return;  // ascending already
  }
  forEachTetAround(topology_, exact_.transitions, tet, simplex,
                   [&](Index t, lattice::CornerMask corners, lattice::Rotation /*rotation*/) {
                     add(t, corners);
                   });
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
    for (lattice::Direction d = 0; d < lattice::kDirections; ++d) {
      const lattice::CornerMask simplex = lattice::holder(signs_[tet], entry.simplex, d);
      if (simplex == lattice::kNoSimplex || !adjacency::ownsSimplex(topology_, tet, simplex))
        continue;
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

/// Records a propeller in all tets around its holder, with its direction in each.
void StarConnectivity::announce(std::uint16_t propeller, Index tet,
                                lattice::CornerMask holderSimplex, lattice::Direction d) {
  forEachTetAround(topology_, exact_.transitions, tet, holderSimplex,
                   [&](Index t, lattice::CornerMask /*corners*/, lattice::Rotation rotation) {
                     inStar(t).propeller[rotation(d)] = propeller;
                   });
}

lattice::Direction StarConnectivity::directionIn(Index tet, std::size_t propeller) {
  const StarTet& entry = inStar(tet);
  for (lattice::Direction d = 0; d < lattice::kDirections; ++d) {
    if (entry.propeller[d] == propeller) return d;
  }
  fail("a propeller is unknown in a tet around its holder");
}

StarConnectivity::Quadrant StarConnectivity::anyCasing(std::size_t propeller) {
  const Holder& at = holders_[propeller];
  Quadrant found{kNone, 0, 0};
  forEachTetAround(topology_, exact_.transitions, at.tet, at.simplex,
                   [&](Index tet, lattice::CornerMask /*corners*/, lattice::Rotation rotation) {
                     if (found.tet != kNone) return;
                     const lattice::Direction first = rotation(at.direction);
                     for (lattice::Direction second = 0; second < lattice::kDirections; ++second) {
                       if (lattice::axisOf(second) == lattice::axisOf(first)) continue;
                       if (lattice::casing(signs_[tet], inStar(tet).simplex, first, second) !=
                           lattice::kNoSimplex) {
                         found = {tet, first, second};
                         return;
                       }
                     }
                   });
  if (found.tet == kNone) fail("a propeller has no blade");
  return found;
}

bool StarConnectivity::turn(Quadrant& quadrant, bool counterClockwise) {
  lattice::Direction target = counterClockwise ? lattice::cross(quadrant.first, quadrant.second)
                                               : lattice::cross(quadrant.second, quadrant.first);
  lattice::Direction from = quadrant.second;
  lattice::Direction axis = quadrant.first;
  Index tet = quadrant.tet;
  // A turn by a right angle meets every tet around the holder at most once; the doubled bound also
  // covers tets that it only touches.
  for (std::size_t steps = 0; steps <= 2 * star_.size(); ++steps) {
    const lattice::CornerMask holderSimplex =
        lattice::holder(signs_[tet], inStar(tet).simplex, axis);
    if (holderSimplex == lattice::kNoSimplex) fail("a turn around a propeller left its holder");
    const int exit =
        lattice::exitOfTurn(exact_.corners[tet], signs_[tet], holderSimplex, from, target);
    if (exit == lattice::kStaysInside) {
      quadrant = {tet, axis, target};
      return true;
    }
    if (exit == lattice::kNoExit) fail("a turn around a propeller leaves a tet through no face");
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, exit);
    const adjacency::HalfFace mate = topology_.mate[halfFace];
    if (mate == kNone) return false;
    const lattice::Rotation rotation = exact_.transitions.across(halfFace).rotation;
    from = rotation(from);
    target = rotation(target);
    axis = rotation(axis);
    tet = adjacency::tetOf(mate);
  }
  fail("a turn around a propeller does not end");
}

StarConnectivity::Quadrant StarConnectivity::canonical(const Quadrant& quadrant) {
  const lattice::CornerMask simplex = lattice::casing(
      signs_[quadrant.tet], inStar(quadrant.tet).simplex, quadrant.first, quadrant.second);
  if (simplex == lattice::kNoSimplex)
    fail("a quarter plane does not lead into the tet it was traced to");
  if (simplex == lattice::kWholeTet) return quadrant;
  const int face = lattice::oppositeCorner(simplex);
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(quadrant.tet, face);
  const adjacency::HalfFace mate = topology_.mate[halfFace];
  if (mate == kNone || adjacency::tetOf(mate) > quadrant.tet) return quadrant;
  const lattice::Rotation rotation = exact_.transitions.across(halfFace).rotation;
  return {adjacency::tetOf(mate), rotation(quadrant.first), rotation(quadrant.second)};
}

/// Enumerates the casings of a propeller counter-clockwise; on the boundary, from the first on.
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
  lattice::Direction from = directionIn(tet, propeller);
  lattice::Direction to = slot.direction;
  for (std::size_t steps = 0;; ++steps) {
    if (steps > 2 * star_.size()) fail("the turn from a propeller to its blade does not end");
    const int exit =
        lattice::exitOfTurn(exact_.corners[tet], signs_[tet], inStar(tet).simplex, from, to);
    if (exit == lattice::kStaysInside) break;
    if (exit == lattice::kNoExit)
      fail("the turn from a propeller to its blade leaves a tet through no face");
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, exit);
    const adjacency::HalfFace mate = topology_.mate[halfFace];
    if (mate == kNone) fail("the turn from a propeller to its blade leaves the mesh");
    const lattice::Rotation rotation = exact_.transitions.across(halfFace).rotation;
    from = rotation(from);
    to = rotation(to);
    tet = adjacency::tetOf(mate);
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

}  // namespace hexhex::propeller
