// From a closed surface, or from a STEP file, to tets: by a mesher that is installed, which runs as
// a program of its own.
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

/// A surface of triangles.
struct TriangleMesh {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> triangles;  ///< three vertices each
};

/// Reads a surface: `.stl`, `.ply` (text and binary), `.obj`, `.off`. Polygons become triangles
/// around their first corner. Vertices at the same position become one, and triangles without three
/// different corners, which that makes, are left out.
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
  Auto,     ///< the first of the others that is installed
  TetWild,  ///< fTetWild: the Python package pytetwild; surfaces only
  Netgen,   ///< the Python package netgen-mesher
  Gmsh,     ///< the Python package gmsh, or the program of this name
  TetGen    ///< the program of this name; surfaces only
};

/// Python packages are looked for in the Python that the variable HEXHEX_PYTHON of the environment
/// names, or else in `python3`; programs on the PATH.
struct FillOptions {
  Mesher mesher = Mesher::Auto;
  double tetSize = 0;  ///< length of an edge; 0: as cells says
  /// Hexahedra that are wanted: edges of tets are as long as theirs, but there are 3,000 to 20,000
  /// tets, about, since maps of more take long. 0: the latter.
  double cells = 0;
  double featureAngle = 40;  ///< edges where the surface turns by more, in degrees, stay (Gmsh)
};

struct FillReport {
  std::string mesher;  ///< with its version, where it tells
  double tetSize = 0;  ///< that was asked for; 0 of a STEP file: the mesher chose it
  std::uint64_t tets = 0;
  // Of surfaces:
  std::uint64_t triangles = 0;
  std::uint64_t bodies = 0;  ///< filled one by one
  std::uint64_t voids = 0;   ///< in them
  double volume = 0;         ///< inside of the surface
  double filledVolume = 0;   ///< of the tets
};

struct FilledPart {
  TetMesh tets;
  std::optional<FillReport> report;  ///< nothing if the file held tets
};

/// Fills the inside of a surface with tets. Each of its bodies is closed and filled by itself; a
/// closed surface in another one bounds a void, and one in that a body again. Triangles may be
/// listed in any orientation.
/// @throws Error NonManifoldEdge for a surface that is open, or whose edges have more than two
///               triangles; NonManifoldVertex where it touches itself in a point; Orientation if it
///               has one side only; NotMeshable if it intersects itself, has no thickness or a
///               triangle without area, and if the mesher fails; FileUnsupported if no mesher is
///               installed; InvalidArgument for options out of range; EmptyMesh
[[nodiscard]] FilledPart fillSurface(const TriangleMesh& surface, const FillOptions& options,
                                     Context& context);

/// Reads the tets of a part from a file that readTetMesh() reads, or fills what readTriangleMesh()
/// reads, or a STEP file (`.step`, `.stp`).
/// @throws Error  as these and fillSurface(); InvalidArgument if a mesher or a size is asked for,
///                but the file holds tets
[[nodiscard]] FilledPart readPart(const std::filesystem::path& file, const FillOptions& options,
                                  Context& context);

}  // namespace HEXHEX_API_NAMESPACE
