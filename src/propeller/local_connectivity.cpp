#include <algorithm>
#include <span>

#include <propeller/link_corners.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/star_connectivity.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 256;

/// A constant configuration: propellers in the given directions, with given cycles of blades.
class ConstantConfiguration {
 public:
  void add(Direction d, std::span<const Direction> blades, bool closed) {
    propellers_.push_back(
        {static_cast<Index>(slots_.size()), static_cast<std::uint16_t>(blades.size()), closed, d});
    for (const Direction blade : blades) slots_.push_back({kNone, blade, 0, 0, kNoCorner});
  }

  void appendTo(LocalConnectivity& local) {
    for (const Propeller& propeller : propellers_) {
      for (std::size_t i = 0; i < propeller.slotCount; ++i) {
        Slot& slot = slots_[propeller.slotBegin + i];
        slot.blade = static_cast<std::uint16_t>(indexOf(slot.direction));
        const Propeller& blade = propellers_[slot.blade];
        while (slots_[blade.slotBegin + slot.back].direction != propeller.direction) {
          ++slot.back;
        }
      }
    }
    std::vector<HexCorner> corners;
    static_cast<void>(linkCorners(propellers_, slots_, corners));
    local.configurations.push_back({static_cast<Index>(local.propellers.size()),
                                    static_cast<Index>(local.corners.size()),
                                    static_cast<std::uint16_t>(propellers_.size()),
                                    static_cast<std::uint16_t>(corners.size())});
    for (Propeller& propeller : propellers_) {
      propeller.slotBegin += static_cast<Index>(local.slots.size());
    }
    local.propellers.insert(local.propellers.end(), propellers_.begin(), propellers_.end());
    local.slots.insert(local.slots.end(), slots_.begin(), slots_.end());
    local.corners.insert(local.corners.end(), corners.begin(), corners.end());
  }

 private:
  [[nodiscard]] std::size_t indexOf(Direction d) const {
    std::size_t p = 0;
    while (propellers_[p].direction != d) ++p;
    return p;
  }

  std::vector<Propeller> propellers_;
  std::vector<Slot> slots_;
};

/// The four directions across d, counter-clockwise.
std::array<Direction, 4> around(Direction d) {
  const auto first = static_cast<Direction>((d + 2) % kDirections);
  const Direction second = cross(d, first);
  return {first, second, opposite(first), opposite(second)};
}

void addConstantConfigurations(LocalConnectivity& local) {
  ConstantConfiguration cell;
  for (Direction d = 0; d < kDirections; ++d) cell.add(d, around(d), true);
  cell.appendTo(local);
  for (Direction inward = 0; inward < kDirections; ++inward) {
    ConstantConfiguration boundary;
    for (Direction d = 0; d < kDirections; ++d) {
      if (d == opposite(inward)) continue;
      if (d == inward) {
        boundary.add(d, around(d), true);
      } else {
        // A half disk: along the boundary, inward, along the boundary.
        const std::array<Direction, 3> blades = {cross(inward, d), inward, cross(d, inward)};
        boundary.add(d, blades, false);
      }
    }
    boundary.appendTo(local);
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

/// What one block of generators yields; joined afterwards.
struct BlockResult {
  std::vector<Configuration> configurations;
  std::vector<Propeller> propellers;
  std::vector<Slot> slots;
  std::vector<HexCorner> corners;

  /// All begins count from the block's own arrays.
  void append(const StarConnectivity::Result& star) {
    configurations.push_back({static_cast<Index>(propellers.size()),
                              static_cast<Index>(corners.size()),
                              static_cast<std::uint16_t>(star.propellers.size()),
                              static_cast<std::uint16_t>(star.corners.size())});
    for (Propeller propeller : star.propellers) {
      propeller.slotBegin += static_cast<Index>(slots.size());
      propellers.push_back(propeller);
    }
    slots.insert(slots.end(), star.slots.begin(), star.slots.end());
    corners.insert(corners.end(), star.corners.begin(), star.corners.end());
  }

  void appendTo(LocalConnectivity& local) const {
    const auto propellerBase = static_cast<Index>(local.propellers.size());
    const auto slotBase = static_cast<Index>(local.slots.size());
    const auto cornerBase = static_cast<Index>(local.corners.size());
    for (Configuration configuration : configurations) {
      configuration.propellerBegin += propellerBase;
      configuration.cornerBegin += cornerBase;
      local.configurations.push_back(configuration);
    }
    for (Propeller propeller : propellers) {
      propeller.slotBegin += slotBase;
      local.propellers.push_back(propeller);
    }
    local.slots.insert(local.slots.end(), slots.begin(), slots.end());
    local.corners.insert(local.corners.end(), corners.begin(), corners.end());
  }
};

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
  std::vector<BlockResult> blocks(blockCount(generators, kGrain));
  parallelBlocks(stage, generators, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   StarConnectivity star(map, signs);
                   for (std::size_t g = begin; g < end; ++g) {
                     const Generator& generator = vertices.generators[g];
                     local.configurationOf[g] = constantConfiguration(map, signs, generator);
                     if (local.configurationOf[g] != kNone) continue;
                     blocks[block].append(star.run(generator.tet, generator.simplex));
                     publish(star.star(), vertices);
                   }
                 });
  auto next = static_cast<Index>(local.configurations.size());
  for (const BlockResult& block : blocks) block.appendTo(local);
  for (Index& configuration : local.configurationOf) {
    if (configuration == kNone) configuration = next++;
  }
  return local;
}

}  // namespace hexhex
