#include <algorithm>
#include <span>

#include <propeller/link_corners.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/star_connectivity.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 256;

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

/// Appends those of a block of generators.
void append(Configurations& to, const Configurations& block) {
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
void addPropeller(StarConnectivity::Result& structure, Direction d,
                  std::span<const Direction> blades, bool closed) {
  structure.propellers.push_back({static_cast<Index>(structure.slots.size()),
                                  static_cast<std::uint16_t>(blades.size()), closed, d});
  for (const Direction blade : blades) structure.slots.push_back({kNone, blade, 0, 0, kNoCorner});
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

/// The four directions across d, counter-clockwise.
std::array<Direction, 4> around(Direction d) {
  const auto first = static_cast<Direction>((d + 2) % kDirections);
  const Direction second = cross(d, first);
  return {first, second, opposite(first), opposite(second)};
}

void addConstantConfigurations(Configurations& configurations) {
  StarConnectivity::Result cell;
  for (Direction d = 0; d < kDirections; ++d) addPropeller(cell, d, around(d), true);
  linkBlades(cell);
  append(configurations, cell);
  for (Direction inward = 0; inward < kDirections; ++inward) {
    StarConnectivity::Result boundary;
    for (Direction d = 0; d < kDirections; ++d) {
      if (d == opposite(inward)) continue;
      if (d == inward) {
        addPropeller(boundary, d, around(d), true);
      } else {
        // A half disk: along the boundary, inward, along the boundary.
        addPropeller(boundary, d, std::array{cross(inward, d), inward, cross(d, inward)}, false);
      }
    }
    linkBlades(boundary);
    append(configurations, boundary);
  }
}

/// The constant configuration of a generator, or kNone.
Index constantConfiguration(const PreparedMap& map, const Array<NormalSigns>& signs,
                            const Generator& generator) {
  if (generator.simplex == kWholeTet) return 0;
  if (dimension(generator.simplex) != 2) return kNone;
  const int face = oppositeCorner(generator.simplex);
  if (!map.topology.isBoundary(halfFaceOf(generator.tet, face))) return kNone;
  for (Direction d = 0; d < kDirections; ++d) {
    if (signs[generator.tet].dot(face, d) > 0) return 1 + Index{d};
  }
  return kNone;
}

/// Notes the star's propellers in the incidences of its tets. Each incidence belongs to one
/// generator, so generators can be processed in parallel.
void publish(const std::vector<StarConnectivity::StarTet>& star, HexVertices& vertices) {
  for (const StarConnectivity::StarTet& entry : star) {
    Index i = vertices.incidenceBegin[entry.tet];
    const Index end = vertices.incidenceBegin[entry.tet + 1];
    while (i < end && vertices.incidences[i].simplex != entry.simplex) ++i;
    // With a too small epsilon the tet may have missed the generator's points: tracing will tell.
    if (i < end) vertices.incidences[i].propeller = entry.propeller;
  }
}

}  // namespace

LocalConnectivity extractLocalConnectivity(const PreparedMap& map, const Array<NormalSigns>& signs,
                                           HexVertices& vertices, Stage& stage) {
  LocalConnectivity local;
  addConstantConfigurations(local);
  const std::size_t generators = vertices.generators.size();
  local.configurationOf.resize(generators);
  std::vector<Configurations> blocks(blockCount(generators, kGrain));
  parallelBlocks(stage, generators, kGrain,
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
  return local;
}

}  // namespace hexhex
