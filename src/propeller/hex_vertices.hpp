// Hex vertices: grid points of the image with their generators (Section 5.2).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
#include <propeller/lattice_lines.hpp>

namespace hexhex {

/// A simplex of the tet mesh with hex vertices in its interior, given by corners of its owner, the
/// smallest tet around it. Its hex vertices are numbered consecutively.
struct Generator {
  Index tet;
  Index firstVertex;
  Index vertexCount;
  CornerMask simplex;

  [[nodiscard]] GeneratorKind kind() const noexcept {
    return static_cast<GeneratorKind>(dimension(simplex));
  }
};

/// A generator of lower dimension than a cell, as seen from one of the tets around it.
struct GeneratorIncidence {
  Index generator;
  CornerMask simplex;
  /// For each direction in the tet's chart the local propeller that leads there inside this closed
  /// tet, or kNoPropeller. Filled by the local connectivity.
  std::array<std::uint8_t, kDirections> propeller;
};
inline constexpr std::uint8_t kNoPropeller = 255;

struct HexVertices {
  Array<Vec3> positions;        ///< per hex vertex
  Array<Index> generatorOf;     ///< per hex vertex
  Array<Generator> generators;  ///< by owner, then dimension, then corners
  Array<Index> generatorBegin;  ///< per tet (+1): the generators that it owns
  LatticeLines lines;           ///< hex vertices by tet and grid point
  Array<Index> incidenceBegin;  ///< per tet (+1): its range in `incidences`
  Array<GeneratorIncidence> incidences;

  /// A generator of a tet's boundary, by its corners in that tet.
  [[nodiscard]] const GeneratorIncidence& incidence(Index tet, CornerMask simplex) const noexcept {
    Index i = incidenceBegin[tet];
    while (incidences[i].simplex != simplex) ++i;
    return incidences[i];
  }
  /// The same by its number.
  [[nodiscard]] const GeneratorIncidence& incidenceOf(Index tet, Index generator) const noexcept {
    Index i = incidenceBegin[tet];
    while (incidences[i].generator != generator) ++i;
    return incidences[i];
  }
};

/// Thrown by this and later stages where the map must have a hex vertex and none was found: the
/// rasterization's epsilon was too small (Section 5.2.3).
struct MissingVertex {
  std::optional<Index> tet;  ///< where it is missing; unknown if only the number of cells tells
};

/// Rasterizes all tets. Vertices are numbered by owner, generator, and position: along an edge from
/// its smaller vertex on, otherwise in the order of the owner's sweep.
/// @param map      scaled
/// @param epsilon  as in ExtractOptions
/// @throws Error TooLarge if the vertices cannot be numbered in 32 bits
/// @throws MissingVertex
[[nodiscard]] HexVertices extractVertices(const PreparedMap& map, double epsilon, Stage& stage);

}  // namespace hexhex
