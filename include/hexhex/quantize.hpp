// Turns a seamless map into an integer-grid map: chooses integers for translations, planes and
// singular curves, and deforms the map to match them.
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

/// Target resolution: set exactly one of the first three members and leave the others at 0.
struct QuantizeOptions {
  double cells = 0;       ///< desired number of hexahedra
  double scale = 0;       ///< approximate scale factor for the parameters of the map
  double edgeLength = 0;  ///< average edge length of a hexahedron in space
  /// If no valid map is found at this resolution, use the first finer one that works.
  bool densify = false;
  /// Tagged interior triangles remain planes of the mesh, except those with this tag (0: no
  /// exception), such as walls of another motorcycle complex (2 if read with
  /// ReadOptions::keepWalls).
  std::int32_t wallTag = 0;
  /// Maximum deviation from seamlessness, relative to the parametric extent of the map.
  double tolerance = 1e-5;
};

/// How close the preimages of small parametric cubes are to cubes in space: the scaled Jacobian of
/// the inverse map of a tet, at most 1.
struct MapDistortion {
  double worst = 1;
  double median = 1;
};

struct QuantizeReport {
  double cellsWanted = 0;
  std::uint64_t cells = 0;
  double scale = 0;          ///< final scale of the seamless map's parameters
  double displacement = 0;   ///< largest parameter change needed to make the map seamless
  std::uint64_t blocks = 0;  ///< in the motorcycle complex
  std::uint64_t arcs = 0;
  std::uint64_t shortestArc = 0;  ///< in hexahedra
  std::uint64_t longestArc = 0;
  std::string integersBy;        ///< "HiGHS", or "rounding" if HiGHS is not available
  std::uint64_t attempts = 0;    ///< number of target cell counts tried
  std::uint64_t splitEdges = 0;  ///< each split adds a vertex to the tet mesh
  std::uint64_t addedTets = 0;   ///< by these splits
  MapDistortion distortionBefore;
  MapDistortion distortionAfter;
};

struct QuantizedMap {
  TetMap map;
  QuantizeReport report;
};

/// How far a map is from an integer-grid map.
enum class SeamlessKind : std::uint8_t {
  Seamless,        ///< charts differ by rotations and translations, and everything is axis-aligned
  AlmostSeamless,  ///< seamless to within a hundredth of its extent
  Neither
};

struct SeamlessReport {
  SeamlessKind kind = SeamlessKind::Neither;
  double displacement = 0;   ///< of the nearest seamless map, if there is one, in parameter units
  double cells = 0;          ///< its volume, in unit cubes
  double integerFactor = 0;  ///< smallest factor for all parameters that makes the map an
                             ///< integer-grid map without quantization; 0: there is none
  std::string problem;       ///< for Neither: why, and where
};

/// Checks whether a map can be the input of quantize(): whether it is seamless within the tolerance
/// of QuantizeOptions, or nearly so. A seamless map has no flipped tets.
/// @pre canQuantize()
[[nodiscard]] SeamlessReport examineSeamless(const TetMapView& map, Context& context);

/// Whether a map with this first defect might be seamless and is worth examining.
[[nodiscard]] bool mayBeSeamless(ErrorCode code) noexcept;

/// Formats the call that the user should make: "`hexhex quantize map.hexex --cells 1000`" for
/// ("cells", "1000"); the other option is "scale".
using QuantizeCall = std::function<std::string(std::string_view option, std::string_view value)>;

/// Explains what a non-integer map lacks and which call to make next; empty if it is neither
/// seamless nor almost seamless.
[[nodiscard]] std::string adviceFor(const SeamlessReport& report, const QuantizeCall& call);

/// Adds advice to an extraction error: for a seamless map, adviceFor() replaces the sentence; for
/// other maps, the reason why they are not seamless is added. Other errors, and all errors in
/// builds without quantization, are returned unchanged.
[[nodiscard]] Error withAdvice(const Error& error, const TetMapView& map, const QuantizeCall& call,
                               Context& context);

/// Whether this build supports quantization (requires Eigen).
[[nodiscard]] bool canQuantize() noexcept;

/// Quantizes a map. Its singularities, if any, must be axis-aligned, its charts must differ by
/// rotations of the grid and arbitrary translations, its boundary triangles must be perpendicular
/// to an axis, and its tets must be positive. Preserves the valences of singular curves, the
/// topology, tagged features and regions; may split edges of the tet mesh. Deterministic.
///
/// Makes the map exactly seamless, cuts it into boxes along its motorcycle complex (Brückler et al.
/// 2022), solves an integer program for the lengths of the arcs, and deforms the map to match them
/// by minimizing a foldover-free energy (Garanzha et al. 2021). The result has passed the exact
/// check.
///
/// @throws Error  TransitionResidual, FlippedTet and others, with their places, if the map is not
///         seamless; FlippedTet if it cannot be deformed to match the integers and densify is not
///         set; InvalidArgument for options out of range, or if canQuantize() is false
[[nodiscard]] QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options,
                                    Context& context);

/// The same, with all cores and without progress.
[[nodiscard]] QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options);

/// Labels of the faces of a tet, each opposite its corner: the direction that a boundary triangle
/// faces in the polycube, 0 to 5 for +x, -x, +y, -y, +z, -z; -1 for interior triangles.
using FaceFlags = std::array<std::int8_t, 4>;

/// Computes the seamless map of a polycube from labels of the boundary triangles. Each connected
/// set of triangles with the same axis becomes a plane, and the tets are deformed to match these
/// planes with little distortion and without flips. Parameters are in units of space. Tets at the
/// boundary are split where the labels leave them no room; the given points come first in the map.
/// Pass the result to quantize() to obtain the mesh of the polycube.
/// @param flags  one entry per tet
/// @throws Error InvalidArgument for other labels than these (with the face), for labels that
///         define no polycube (with the face, edge or vertex), or if canQuantize() is false;
///         FlippedTet for tets that are not positive in space or cannot be deformed to match; the
///         errors of broken meshes
[[nodiscard]] TetMap mapFromFlags(const TetMesh& tets, std::span<const FaceFlags> flags,
                                  Context& context);

}  // namespace HEXHEX_API_NAMESPACE
