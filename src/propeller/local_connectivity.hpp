// Propellers: the local structure around hex vertices, once per generator (Sections 4.2 and 5.3).
//
// Around a hex vertex, propellers (outgoing hex edges) are the vertices, pairs of a propeller and
// one of its blades (hex face corners) the edges, and hex corners the triangles of a small
// triangulated sphere, or disk on the boundary. A pair (propeller, i) of a propeller and its i-th
// blade is a slot; slot i also stands for the hex corner between blades i and i + 1.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <propeller/hex_vertices.hpp>

namespace hexhex::propeller {

inline constexpr std::uint16_t kNoCorner = 0xffff;

/// One blade of a propeller, and the hex corner behind it.
struct Slot {
  Index tet;                     ///< owner of the casing
  lattice::Direction direction;  ///< of the blade, in that tet
  std::uint16_t blade;           ///< the propeller that is the blade
  std::uint16_t back;            ///< index of this propeller among that one's blades
  std::uint16_t corner;          ///< hex corner between this blade and the next; kNoCorner if none
};

struct Propeller {
  Index slotBegin;
  std::uint16_t slotCount;       ///< number of blades, counter-clockwise
  bool closed;                   ///< inside the mesh: the first blade follows the last
  lattice::Direction direction;  ///< in the tet of slot 0, into which that slot's casing leads
};

/// One hex corner, named by the first of its three slots.
struct HexCorner {
  std::uint16_t propeller;
  std::uint16_t slot;
};

/// The structure around all vertices of a generator, or of all generators of a kind whose structure
/// is constant; for the latter, `tet` of all slots is kNone and stands for the generator's own tet.
struct Configuration {
  Index propellerBegin;
  Index cornerBegin;
  std::uint16_t propellerCount;
  std::uint16_t cornerCount;
};

/// Configuration 0 is that of all cell generators, 1 + d that of boundary faces with inward normal
/// in direction d (constant local connectivity property, Section 5.3.1); the rest belong to one
/// generator each.
inline constexpr Index kConstantConfigurations = 1 + lattice::kDirections;

struct Configurations {
  std::vector<Configuration> configurations;
  std::vector<Propeller> propellers;
  std::vector<Slot> slots;
  std::vector<HexCorner> corners;
};

struct LocalConnectivity : Configurations {
  Array<Index> configurationOf;  ///< per generator

  [[nodiscard]] const Configuration& configuration(Index generator) const noexcept {
    return configurations[configurationOf[generator]];
  }
  [[nodiscard]] const Propeller& propeller(const Configuration& configuration,
                                           std::size_t p) const noexcept {
    return propellers[configuration.propellerBegin + p];
  }
  [[nodiscard]] const Slot& slot(const Propeller& propeller, std::size_t i) const noexcept {
    return slots[propeller.slotBegin + i];
  }
};

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

/// Hex corners from blades (Section 5.3.4): enumerates those of a configuration and numbers them in
/// all three slots of each. False if three blades do not close.
[[nodiscard]] bool linkCorners(const std::vector<Propeller>& propellers, std::vector<Slot>& slots,
                               std::vector<HexCorner>& corners);

/// Extracts propellers, blades and hex corners of all generators, and records in
/// `vertices.incidences` which propeller each direction of each tet leads to. (Algorithm 6)
/// @param signs  normal signs of every tet
[[nodiscard]] LocalConnectivity extractLocalConnectivity(const igm::PreparedMap& map,
                                                         const Array<lattice::NormalSigns>& signs,
                                                         HexVertices& vertices, Stage& stage);

/// Names propellers and blades by directions in the chart of a tet.
class SlotFinder {
 public:
  SlotFinder(const igm::PreparedMap& map, const Array<lattice::NormalSigns>& signs,
             const HexVertices& vertices, const LocalConnectivity& local)
      : topology_(map.topology),
        exact_(map.exact),
        signs_(signs),
        vertices_(vertices),
        local_(local) {}

  /// The propeller that leaves a vertex in direction `along`, and its blade in direction `beside`,
  /// where the tet holds the beginning of the quarter plane that they span.
  [[nodiscard]] SlotName find(Index tet, Index generator, lattice::Direction along,
                              lattice::Direction beside) const;

 private:
  [[nodiscard]] std::size_t findPropeller(Index tet, Index generator,
                                          lattice::Direction along) const;
  [[nodiscard]] Slot casingKey(Index tet, Index generator, lattice::Direction along,
                               lattice::Direction beside) const;

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  const Array<lattice::NormalSigns>& signs_;
  const HexVertices& vertices_;
  const LocalConnectivity& local_;
};

}  // namespace hexhex::propeller
