// From a seamless map to an integer-grid map: chooses integers for translations, planes and
// singular curves, and bends the map onto them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// How fine the mesh is to be. Exactly one of the first three is given, the others are 0.
struct QuantizeOptions {
  double cells = 0;       ///< hexahedra wanted
  double scale = 0;       ///< the map's parameters are to be multiplied by about so much
  double edgeLength = 0;  ///< of a hexahedron in space, on the average
  /// If no valid map is found so: takes a denser one, the first one that works.
  bool densify = false;
  /// Tagged triangles inside of the object stay planes of the mesh, but for those with this tag (0:
  /// none), such as walls of another motorcycle complex (2, if ReadOptions::keepWalls read them).
  std::int32_t wallTag = 0;
  /// A map may be so far from being seamless, as a share of its size in parameters.
  double tolerance = 1e-5;
};

/// How well the edges of small cubes in the map form a cube in space: the scaled Jacobian of a
/// tet's inverse map, at most 1.
struct MapDistortion {
  double worst = 1;
  double median = 1;
};

struct QuantizeReport {
  double cellsWanted = 0;
  std::uint64_t cells = 0;
  double scale = 0;          ///< of the seamless map's parameters, finally
  double displacement = 0;   ///< largest change of a parameter that made the map seamless
  std::uint64_t blocks = 0;  ///< of the motorcycle complex
  std::uint64_t arcs = 0;
  std::uint64_t shortestArc = 0;  ///< in hexahedra
  std::uint64_t longestArc = 0;
  std::string integersBy;        ///< "HiGHS", or "rounding" where it is missing
  std::uint64_t attempts = 0;    ///< numbers of cells that were tried
  std::uint64_t splitEdges = 0;  ///< each adds a vertex to the tet mesh
  std::uint64_t addedTets = 0;   ///< by that
  MapDistortion distortionBefore;
  MapDistortion distortionAfter;
};

struct QuantizedMap {
  TetMap map;
  QuantizeReport report;
};

/// What lies between a map and an integer-grid map.
enum class SeamlessKind : std::uint8_t {
  Seamless,        ///< charts differ by rotations and translations, all is aligned with axes
  AlmostSeamless,  ///< up to a hundredth of its size
  Neither
};

struct SeamlessReport {
  SeamlessKind kind = SeamlessKind::Neither;
  double displacement = 0;   ///< of the nearest seamless map, in parameter units; if there is one
  double cells = 0;          ///< volume of that in unit cubes
  double integerFactor = 0;  ///< smallest number with which all parameters have to be multiplied to
                             ///< be those of an integer-grid map, which needs no quantization; 0:
                             ///< there is none
  std::string problem;       ///< why it is neither, and where
};

/// Whether quantize() can begin with a map: seamless to within the tolerance of QuantizeOptions, or
/// nearly so; a seamless map has no flipped tets.
/// @pre canQuantize()
[[nodiscard]] SeamlessReport examineSeamless(const TetMapView& map, Context& context);

/// Whether a map is worth a look at whether it is seamless, by the defect that was found first.
[[nodiscard]] bool mayBeSeamless(ErrorCode code) noexcept;

/// How a caller quantizes: "`hexhex quantize map.hexex --cells 1000`" for ("cells", "1000"); the
/// other option is "scale".
using QuantizeCall = std::function<std::string(std::string_view option, std::string_view value)>;

/// What a map that is not integer lacks, and the call to go on with; empty if it is neither.
[[nodiscard]] std::string adviceFor(const SeamlessReport& report, const QuantizeCall& call);

/// The error of an extraction, with that advice in place of its sentence where the map is seamless,
/// and otherwise with why it is not. Other errors, and those of builds that cannot quantize, stay.
[[nodiscard]] Error withAdvice(const Error& error, const TetMapView& map, const QuantizeCall& call,
                               Context& context);

/// Whether this build can quantize (it was made with Eigen).
[[nodiscard]] bool canQuantize() noexcept;

/// What becomes of a map without singularities or with axis-aligned ones whose charts differ by
/// rotations of the grid and any translations, whose boundary triangles are perpendicular to an
/// axis, and whose tets are positive. Valences of singular curves, the topology, tagged features
/// and regions stay as they are; edges of the tet mesh may be split. Deterministic.
///
/// The map is made exactly seamless, cut into boxes by its motorcycle complex (Brueckner et al.
/// 2022), integers for the arcs of that are found by an integer program, and the map is bent onto
/// these by a foldover-free energy (Garanzha et al. 2021). The result has passed the exact check.
///
/// @throws Error  TransitionResidual, FlippedTet and others with their places for a map that is not
///                seamless; FlippedTet if it cannot be bent onto the integers, and densify is not
///                set; InvalidArgument for options out of range, or if canQuantize() is false
[[nodiscard]] QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options,
                                    Context& context);

/// The same with all cores and without progress.
[[nodiscard]] QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options);

/// Labels of a tet's faces, each opposite its corner: which way a boundary triangle is to face in a
/// polycube, 0 to 5 for +x, -x, +y, -y, +z, -z; and -1 for triangles inside of the object.
using FaceFlags = std::array<std::int8_t, 4>;

/// The seamless map of a polycube, from labels of the boundary triangles: each connected piece of
/// one axis becomes a plane, and the tets are bent onto these planes with little distortion and
/// without flips. Parameters are in units of space. Tets at the boundary are split where labels
/// leave them no room; the given points come first in the map. What quantize() makes of it is the
/// polycube's mesh.
/// @param flags  per tet
/// @throws Error InvalidArgument for other labels than these (with the face), or those of no
///               polycube (with the face, edge or vertex), or if canQuantize() is false; FlippedTet
///               for tets that are not positive in space, or cannot be bent; those of broken meshes
[[nodiscard]] TetMap mapFromFlags(const TetMesh& tets, std::span<const FaceFlags> flags,
                                  Context& context);

}  // namespace HEXHEX_API_NAMESPACE
