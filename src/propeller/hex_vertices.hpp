// Vertex extraction (Section 5.2): the lattice points of the map's image, and their generators, the
// simplices of the tet mesh whose interiors contain them.
//
// Enumeration, numbers and look-up are those of src/sweep, which curved meshes use, too; but here
// epsilon is positive, so that an exact predicate decides at both ends of every line, as in the
// paper. The tests compare everything shared with the atlas engine with brute force.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::propeller {

/// A simplex of the tet mesh with hex vertices in its interior, given by corners of its owner, the
/// smallest tet around it. Its hex vertices are numbered consecutively.
struct Generator {
  Index tet;
  Index firstVertex;
  Index vertexCount;
  lattice::CornerMask simplex;
};

/// A generator of lower dimension than a cell, as seen from one of the tets around it.
struct GeneratorIncidence {
  Index generator;
  lattice::CornerMask simplex;
  /// For each direction in the tet's chart, the local propeller that leads there inside this closed
  /// tet, or kNoPropeller. Filled by the local connectivity.
  std::array<std::uint16_t, lattice::kDirections> propeller;
};
inline constexpr std::uint16_t kNoPropeller = 0xffff;
/// Most hex edges at one point. There are fewer than twice as many hex corners: 16 bits suffice.
inline constexpr std::size_t kMaxPropellers = 0x8000;

struct HexVertices {
  sweep::VertexTables tables;   ///< hex vertices by tet and grid point
  Array<Index> generatorOf;     ///< per hex vertex
  Array<Generator> generators;  ///< by owner, then dimension, then corners
  Array<Index> incidenceBegin;  ///< per tet (+1): its range in `incidences`
  Array<GeneratorIncidence> incidences;

  /// Sweeps the map.
  /// @param map      scaled
  /// @param epsilon  as in extraction::EngineOptions
  /// @throws Error TooLarge if the vertices cannot be numbered in 32 bits
  HexVertices(const igm::PreparedMap& map, double epsilon, Stage& stage);

  /// A generator of a tet's boundary, by its number.
  [[nodiscard]] const GeneratorIncidence& incidenceOf(Index tet, Index generator) const noexcept {
    Index i = incidenceBegin[tet];
    while (incidences[i].generator != generator) ++i;
    return incidences[i];
  }
};

/// Fails because the map must have a hex vertex that was not found.
/// @param tet  unknown if only the number of cells reveals it
[[noreturn]] void failForMissingVertex(std::optional<Index> tet);

}  // namespace hexhex::propeller
