// Plain types of the public API: the inputs and outputs of an extraction.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <hexhex/array.hpp>  // IWYU pragma: export
#include <hexhex/export.h>
#include <hexhex/features.hpp>  // IWYU pragma: export

namespace hexhex HEXHEX_API_NAMESPACE {

/// A point or vector: x, y, z (in space) or u, v, w (a parameter, in units of one hexahedron).
using Vec3 = std::array<double, 3>;

/// Index of an element of an input mesh, or of a hex vertex. 0-based.
using Index = std::uint32_t;

/// "No such element".
inline constexpr Index kNone = std::numeric_limits<Index>::max();

/// Corner indices of a tetrahedron, of a hexahedron (VTK order), and of a quadrilateral.
using Tet = std::array<Index, 4>;
using Hex = std::array<Index, 8>;
using Quad = std::array<Index, 4>;

/// Parameters of the four corners of a tetrahedron: entry i belongs to corner i.
using TetParameters = std::array<Vec3, 4>;

/// Valence offset of a tet edge, as stored by frame-field tools (`edge_valance`): the number of
/// hexahedra around the edge minus the regular number (4 inside, 2 on the boundary).
struct EdgeValence {
  Index vertex0 = 0;
  Index vertex1 = 0;
  int offset = 0;
};

/// A tetrahedral mesh with an integer-grid map; owns its arrays.
struct TetMap {
  std::vector<Vec3> points;               ///< one per vertex
  std::vector<Tet> tets;                  ///< four distinct vertices each
  std::vector<TetParameters> parameters;  ///< one per tet, in its own chart

  // Optional data that files may hold besides the map; empty if absent. See TetMapView.
  std::vector<EdgeValence> edgeValences = {};
  std::vector<std::array<std::int8_t, 4>> rotations = {};
  Features features = {};                  ///< tagged vertices, edges and triangles of the tets
  std::vector<std::int32_t> regions = {};  ///< per tet: material or volume, 0 for none; may be
                                           ///< empty
};

/// A tetrahedral mesh without a map.
struct TetMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  Features features = {};                  ///< tagged vertices, edges and triangles of the tets
  std::vector<std::int32_t> regions = {};  ///< per tet: material or volume, 0 for none; may be
                                           ///< empty
};

/// A view of a map in the caller's arrays, plus optional data that the caller may already have.
struct TetMapView {
  std::span<const Vec3> points;
  std::span<const Tet> tets;
  std::span<const TetParameters> parameters;

  /// Optional: edges with their valence offsets; unlisted edges are regular. Empty: computed from
  /// sums of angles.
  std::span<const EdgeValence> edgeValences = {};

  /// Optional: for face f (opposite corner f) of each tet, the index 0..23 of the rotation across
  /// it, in the numbering of AlgoHex's `HalffaceTransiton`; -1 if unknown. Empty: computed.
  std::span<const std::array<std::int8_t, 4>> rotations = {};

  /// Optional: tagged simplices, whose tags are transferred to vertices, edges and quads of the
  /// mesh. See extract().
  FeaturesView features = {};

  /// Optional: one number per tet, inherited by the cells. Empty: none.
  std::span<const std::int32_t> regions = {};

  TetMapView() = default;
  TetMapView(std::span<const Vec3> points_, std::span<const Tet> tets_,
             std::span<const TetParameters> parameters_)
      : points(points_), tets(tets_), parameters(parameters_) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a map converts to a view of itself.
  TetMapView(const TetMap& map)
      : points(map.points),
        tets(map.tets),
        parameters(map.parameters),
        edgeValences(map.edgeValences),
        rotations(map.rotations),
        features(map.features),
        regions(map.regions) {}
};

/// Dimension of the simplex of the tet mesh whose interior contains a hex vertex (its generator).
enum class GeneratorKind : std::uint8_t { Vertex = 0, Edge = 1, Face = 2, Cell = 3 };

/// A simplex of a tet as a set of its corners: bit i for corner i. 1, 2, 4, 8 are the vertices of
/// the tet, 15 is the tet itself.
using CornerSet = std::uint8_t;

[[nodiscard]] constexpr GeneratorKind generatorKind(CornerSet corners) noexcept {
  return static_cast<GeneratorKind>(std::popcount(corners) - 1);
}

/// A hexahedral mesh. The corners of a cell are in VTK_HEXAHEDRON order: 0 1 2 3 around one face, 4
/// 5 6 7 above them, with positive orientation: det(p1-p0, p3-p0, p4-p0) > 0 for undistorted cells.
struct HexMesh {
  Array<Vec3> points;  ///< one per hex vertex
  Array<Hex> cells;    ///< eight vertex indices each

  // Origin of each vertex: the simplex of the tet mesh (its generator) whose interior contains it.
  // Empty for meshes read from files without generators.
  Array<Index> generatorTet;          ///< per vertex: the smallest tet that contains the simplex
  Array<CornerSet> generatorCorners;  ///< per vertex: the simplex, as corners of that tet

  HexFeatures features = {};         ///< tagged vertices, edges and quads, if known
  Array<std::int32_t> regions = {};  ///< per cell: its region; may be empty
};

}  // namespace HEXHEX_API_NAMESPACE
