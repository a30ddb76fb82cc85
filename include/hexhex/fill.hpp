// Fills closed surfaces and STEP files with tets, using an installed mesher that runs as a separate
// program.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// A triangulated surface.
struct TriangleMesh {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> triangles;  ///< three vertices each
};

/// Reads a surface: `.stl`, `.ply` (text and binary), `.obj`, `.off`, `.vtp`, `.vtk`. Polygons are
/// split into triangles, convex ones around their first corner. Equal vertices are merged, and
/// triangles left without three distinct corners are dropped.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported, NotFinite
[[nodiscard]] TriangleMesh readTriangleMesh(const std::filesystem::path& file, Context& context);

/// The surface of a part: what readTriangleMesh() reads, or the boundary of what readTetMesh()
/// reads.
/// @throws Error  as these and boundaryOf()
[[nodiscard]] TriangleMesh readSurfaceOf(const std::filesystem::path& file, Context& context);

/// The boundary of tets as a surface, its triangles facing outwards.
/// @throws Error IndexOutOfRange for vertices that do not exist; NonManifoldFace
[[nodiscard]] TriangleMesh boundaryOf(const TetMesh& tets, Context& context);

enum class Mesher : std::uint8_t {
  Auto,     ///< the first of the others that is installed and succeeds
  TetWild,  ///< fTetWild: the Python package pytetwild; surfaces only
  Netgen,   ///< the Python package netgen-mesher
  Gmsh,     ///< the Python package gmsh, or the program of that name
  TetGen    ///< the program of that name; surfaces only
};

/// Python packages are looked up in the Python interpreter named by the environment variable
/// HEXHEX_PYTHON, or else in `python3`; programs on the PATH.
struct FillOptions {
  Mesher mesher = Mesher::Auto;
  double tetSize = 0;  ///< edge length; 0: derived from `cells`
  /// Desired number of hexahedra. Tet edges get the length of hexahedron edges, but the number of
  /// tets stays between about 3,000 and 20,000, since maps of more tets take long. 0: the latter.
  double cells = 0;
  double featureAngle = 40;  ///< preserve edges where the surface turns by more, in degrees (Gmsh)
};

struct FillReport {
  std::string mesher;  ///< including its version, if known
  double tetSize = 0;  ///< requested edge length; 0 for a STEP file if the mesher chose it
  std::uint64_t tets = 0;
  // For surfaces:
  std::uint64_t triangles = 0;
  std::uint64_t bodies = 0;         ///< each filled separately
  std::uint64_t voids = 0;          ///< inside the bodies
  double volume = 0;                ///< enclosed by the surface
  double filledVolume = 0;          ///< of the tets
  std::uint64_t flatTriangles = 0;  ///< removed first, as they have no area
};

struct FilledPart {
  TetMesh tets;
  std::optional<FillReport> report;  ///< empty if the file held tets
  /// Sentences on what may not be as expected, such as meshers that changed the shape before
  /// another one kept it.
  std::vector<std::string> warnings;
};

/// Fills the interior of a surface with tets. Each body is closed and filled separately; a closed
/// surface inside another one bounds a void, and one inside a void bounds a body again. Triangles
/// may have any orientation.
/// @throws Error NonManifoldEdge for an open surface, or edges with more than two triangles;
///         NonManifoldVertex where the surface touches itself at a point; Orientation if it is
///         one-sided; NotMeshable if it intersects itself, has no thickness or a triangle with zero
///         area, or if all meshers fail or
///         change the number of its components or handles; FileUnsupported if no mesher is
///         installed; InvalidArgument for options out of range; EmptyMesh
[[nodiscard]] FilledPart fillSurface(const TriangleMesh& surface, const FillOptions& options,
                                     Context& context);

/// Reads the tets of a part from a file in a format of readTetMesh(), or fills a surface in a
/// format of readTriangleMesh() or a STEP file (`.step`, `.stp`).
/// @throws Error  as these functions and fillSurface(); InvalidArgument if a mesher or a size is
///         requested but the file holds tets
[[nodiscard]] FilledPart readPart(const std::filesystem::path& file, const FillOptions& options,
                                  Context& context);

}  // namespace HEXHEX_API_NAMESPACE
