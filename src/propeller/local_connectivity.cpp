// Local connectivity of all generators (Section 5.3, Algorithm 6).
#include <algorithm>
#include <cassert>
#include <span>

#include <propeller/local_connectivity.hpp>
#include <propeller/star_connectivity.hpp>

namespace hexhex::propeller {

bool linkCorners(const std::vector<Propeller>& propellers, std::vector<Slot>& slots,
                 std::vector<HexCorner>& corners) {
  for (std::size_t p = 0; p < propellers.size(); ++p) {
    const Propeller& propeller = propellers[p];
    // On the boundary, no corner follows the last blade.
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

namespace {

constexpr std::size_t kLocalConnectivityGrain = 256;

/// Appends the structure around the vertices of one generator.
void append(Configurations& to, const StarConnectivity::Result& structure) {
  to.configurations.push_back({static_cast<Index>(to.propellers.size()),
                               static_cast<Index>(to.corners.size()),
                               static_cast<std::uint16_t>(structure.propellers.size()),
                               static_cast<std::uint16_t>(structure.corners.size())});
  for (Propeller propeller : structure.propellers) {
    propeller.slotBegin += static_cast<Index>(to.slots.size());
    to.propellers.push_back(propeller);
  }
  to.slots.insert(to.slots.end(), structure.slots.begin(), structure.slots.end());
  to.corners.insert(to.corners.end(), structure.corners.begin(), structure.corners.end());
}

/// Appends the structures of a block of generators.
void append(Configurations& to, const Configurations& block) {
  if (to.slots.size() + block.slots.size() >= kNone) {  // the longest of these arrays
    throw Error(
        ErrorCode::TooLarge,
        "Irregular vertices have more than 2^32 hex faces around their edges. Use the atlas "
        "engine.");
  }
  const auto propellerBase = static_cast<Index>(to.propellers.size());
  const auto slotBase = static_cast<Index>(to.slots.size());
  const auto cornerBase = static_cast<Index>(to.corners.size());
  for (Configuration configuration : block.configurations) {
    configuration.propellerBegin += propellerBase;
    configuration.cornerBegin += cornerBase;
    to.configurations.push_back(configuration);
  }
  for (Propeller propeller : block.propellers) {
    propeller.slotBegin += slotBase;
    to.propellers.push_back(propeller);
  }
  to.slots.insert(to.slots.end(), block.slots.begin(), block.slots.end());
  to.corners.insert(to.corners.end(), block.corners.begin(), block.corners.end());
}

/// Adds a propeller and its blades to a structure, by their directions.
void addPropeller(StarConnectivity::Result& structure, lattice::Direction d,
                  std::span<const lattice::Direction> blades, bool closed) {
  structure.propellers.push_back({static_cast<Index>(structure.slots.size()),
                                  static_cast<std::uint16_t>(blades.size()), closed, d});
  for (const lattice::Direction blade : blades)
    structure.slots.push_back({kNone, blade, 0, 0, kNoCorner});
}

/// Finds the propellers that are the blades, and the hex corners.
void linkBlades(StarConnectivity::Result& structure) {
  auto& [propellers, slots, corners] = structure;
  for (const Propeller& propeller : propellers) {
    for (std::size_t i = 0; i < propeller.slotCount; ++i) {
      Slot& slot = slots[propeller.slotBegin + i];
      while (propellers[slot.blade].direction != slot.direction) ++slot.blade;
      const Index bladeBegin = propellers[slot.blade].slotBegin;
      while (slots[bladeBegin + slot.back].direction != propeller.direction) ++slot.back;
    }
  }
  static_cast<void>(linkCorners(propellers, slots, corners));
}

/// The four directions perpendicular to d, counter-clockwise.
std::array<lattice::Direction, 4> around(lattice::Direction d) {
  const auto first = static_cast<lattice::Direction>((d + 2) % lattice::kDirections);
  const lattice::Direction second = lattice::cross(d, first);
  return {first, second, lattice::opposite(first), lattice::opposite(second)};
}

void addConstantConfigurations(Configurations& configurations) {
  StarConnectivity::Result cell;
  for (lattice::Direction d = 0; d < lattice::kDirections; ++d)
    addPropeller(cell, d, around(d), true);
  linkBlades(cell);
  append(configurations, cell);
  for (lattice::Direction inward = 0; inward < lattice::kDirections; ++inward) {
    StarConnectivity::Result boundary;
    for (lattice::Direction d = 0; d < lattice::kDirections; ++d) {
      if (d == lattice::opposite(inward)) continue;
      if (d == inward) {
        addPropeller(boundary, d, around(d), true);
      } else {
        // A half disk: along the boundary, inward, along the boundary.
        addPropeller(boundary, d,
                     std::array{lattice::cross(inward, d), inward, lattice::cross(d, inward)},
                     false);
      }
    }
    linkBlades(boundary);
    append(configurations, boundary);
  }
}

/// The constant configuration of a generator, or kNone.
Index constantConfiguration(const igm::PreparedMap& map, const Array<lattice::NormalSigns>& signs,
                            const Generator& generator) {
  if (generator.simplex == lattice::kWholeTet) return 0;
  if (lattice::dimension(generator.simplex) != 2) return kNone;
  const int face = lattice::oppositeCorner(generator.simplex);
  if (!map.topology.isBoundary(adjacency::halfFaceOf(generator.tet, face))) return kNone;
  for (lattice::Direction d = 0; d < lattice::kDirections; ++d) {
    if (signs[generator.tet].dot(face, d) > 0) return 1 + Index{d};
  }
  return kNone;
}

/// Records the star's propellers in the incidences of its tets. Each incidence belongs to one
/// generator, so generators can be processed in parallel.
void publish(const std::vector<StarConnectivity::StarTet>& star, HexVertices& vertices) {
  for (const StarConnectivity::StarTet& entry : star) {
    Index i = vertices.incidenceBegin[entry.tet];
    while (vertices.incidences[i].simplex != entry.simplex) ++i;
    vertices.incidences[i].propeller = entry.propeller;
  }
}

}  // namespace

LocalConnectivity extractLocalConnectivity(const igm::PreparedMap& map,
                                           const Array<lattice::NormalSigns>& signs,
                                           HexVertices& vertices, Stage& stage) {
  LocalConnectivity local;
  addConstantConfigurations(local);
  const std::size_t generators = vertices.generators.size();
  local.configurationOf.resize(generators);
  std::vector<Configurations> blocks(blockCount(generators, kLocalConnectivityGrain));
  parallelBlocks(stage, generators, kLocalConnectivityGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   StarConnectivity star(map, signs);
                   for (std::size_t g = begin; g < end; ++g) {
                     const Generator& generator = vertices.generators[g];
                     local.configurationOf[g] = constantConfiguration(map, signs, generator);
                     if (local.configurationOf[g] != kNone) continue;
                     append(blocks[block], star.run(generator.tet, generator.simplex));
                     publish(star.star(), vertices);
                   }
                 });
  auto next = static_cast<Index>(local.configurations.size());
  for (const Configurations& block : blocks) append(local, block);
  for (Index& configuration : local.configurationOf) {
    if (configuration == kNone) configuration = next++;
  }
  assert(next == local.configurations.size());
  return local;
}

SlotName SlotFinder::find(Index tet, Index generator, lattice::Direction along,
                          lattice::Direction beside) const {
  const std::size_t p = findPropeller(tet, generator, along);
  const Slot key = casingKey(tet, generator, along, beside);
  const Propeller& propeller = local_.propeller(local_.configuration(generator), p);
  for (std::size_t i = 0; i < propeller.slotCount; ++i) {
    const Slot& slot = local_.slot(propeller, i);
    if (slot.tet == key.tet && slot.direction == key.direction) return {p, i};
  }
  failForMissingVertex(tet);
}

std::size_t SlotFinder::findPropeller(Index tet, Index generator, lattice::Direction along) const {
  const Index configuration = local_.configurationOf[generator];
  if (configuration == 0) return along;
  if (configuration < kConstantConfigurations) {
    // Propellers of a boundary face: all directions except the one that leads outside.
    const lattice::Direction outward =
        lattice::opposite(static_cast<lattice::Direction>(configuration - 1));
    return along > outward ? along - std::size_t{1} : along;
  }
  const std::uint16_t propeller = vertices_.incidenceOf(tet, generator).propeller[along];
  if (propeller == kNoPropeller) failForMissingVertex(tet);
  return propeller;
}

/// Names the blade's casing as the slots do.
Slot SlotFinder::casingKey(Index tet, Index generator, lattice::Direction along,
                           lattice::Direction beside) const {
  if (local_.configurationOf[generator] < kConstantConfigurations) {
    return {kNone, beside, 0, 0, 0};
  }
  const lattice::CornerMask simplex =
      lattice::casing(signs_[tet], vertices_.incidenceOf(tet, generator).simplex, along, beside);
  if (lattice::dimension(simplex) == 2) {
    const int face = lattice::oppositeCorner(simplex);
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, face);
    const adjacency::HalfFace mate = topology_.mate[halfFace];
    if (mate != kNone && adjacency::tetOf(mate) < tet) {
      return {adjacency::tetOf(mate), exact_.transitions.across(halfFace)(beside), 0, 0, 0};
    }
  }
  return {tet, beside, 0, 0, 0};
}

}  // namespace hexhex::propeller
