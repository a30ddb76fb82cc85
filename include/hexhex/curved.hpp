// Curved meshes: the exact images of integer-grid edges and faces, and hexahedra of any order.
//
// A map bends hex edges and faces at every tet that they cross. Arcs and patches represent these
// images exactly, piece by piece (Section 5.5 of the paper). Lagrange cells approximate them by
// polynomials through the preimages of a refined grid, on the boundary or everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Hex edges as polylines. At an inner point, the edge passes from one simplex of the tet mesh to
/// another. A segment lies in the interior of a single simplex: a tet, or a face or edge that
/// contains this piece of the hex edge. Arc e has inner points pointBegin[e] to
/// pointBegin[e + 1] - 1 and one segment more than inner points, numbered from pointBegin[e] + e.
struct Arcs {
  /// Per arc: the hex vertices at its beginning and end. Distinct arcs may have the same two
  /// vertices.
  Array<std::array<Index, 2>> ends;
  Array<std::uint64_t> pointBegin;  ///< per arc (+1)

  // Per inner point:
  Array<Vec3> points;        ///< position
  Array<double> parameters;  ///< position along the arc, in (0, 1), non-decreasing
  /// The simplex that is crossed there (a vertex, an edge or a face), as in HexMesh.
  Array<Index> generatorTet;
  Array<CornerSet> generatorCorners;

  // Per segment: the simplex that contains it (an edge, a face, or a tet), as in HexMesh.
  Array<Index> segmentTet;
  Array<CornerSet> segmentCorners;

  [[nodiscard]] std::size_t count() const noexcept { return ends.size(); }
  [[nodiscard]] std::uint64_t firstSegment(std::size_t arc) const noexcept {
    return pointBegin[arc] + arc;
  }
};

/// Hex faces as planar polygons: one for each tet whose interior the open face meets, and one for
/// each triangle of the tet mesh that partly coincides with it. Polygons meet along whole sides.
///
/// Polygons refer to points in a common numbering: hex vertices, then inner points of arcs, then
/// inner points of patches.
struct Patches {
  /// Per face: its hex vertices, at (u, v) = (0, 0), (1, 0), (1, 1), (0, 1).
  Array<Quad> vertices;
  /// Per face: the arc from its vertex i to vertex i + 1 (mod 4).
  Array<std::array<Index, 4>> arcs;
  Array<std::uint8_t> reversedArcs;   ///< per face: bit i if that arc runs from vertex i + 1 to i
  Array<std::uint64_t> polygonBegin;  ///< per face (+1): its polygons

  // Per polygon:
  Array<std::uint64_t> cornerBegin;  ///< (+1): its corners, counterclockwise in (u, v)
  /// The simplex whose interior contains the polygon (a tet or a face), as in HexMesh.
  Array<Index> polygonTet;
  Array<CornerSet> polygonCorners;

  // Per corner of a polygon:
  Array<Index> corners;                     ///< point in the common numbering
  Array<std::array<double, 2>> parameters;  ///< (u, v) in the face, in [0, 1]

  // Per inner point of a face:
  Array<Vec3> points;
  /// The vertex or edge of the tet mesh that crosses the face, as in HexMesh.
  Array<Index> generatorTet;
  Array<CornerSet> generatorCorners;

  [[nodiscard]] std::size_t count() const noexcept { return vertices.size(); }
};

/// A mesh with the exact shapes of its edges and faces.
struct PiecewiseLinearMesh {
  HexMesh mesh;     ///< the result of extract(), bit for bit
  Arcs arcs;        ///< one per hex edge
  Patches patches;  ///< one per hex face, if requested

  /// Position of a point in the common numbering.
  [[nodiscard]] const Vec3& point(std::uint64_t number) const noexcept {
    if (number < mesh.points.size()) return mesh.points[number];
    number -= mesh.points.size();
    if (number < arcs.points.size()) return arcs.points[number];
    return patches.points[number - arcs.points.size()];
  }
};

enum class PiecewiseLinearParts : std::uint8_t {
  Arcs,           ///< edges only
  ArcsAndPatches  ///< edges and faces
};

/// Extracts a mesh with its arcs and, if requested, its patches. All combinatorial decisions are
/// exact. The result does not depend on the number of threads or on the engine; memory is
/// proportional to its size.
/// @throws Error  as extract(); TooLarge for more points than an Index can number
[[nodiscard]] PiecewiseLinearMesh extractPiecewiseLinear(const TetMapView& map,
                                                         PiecewiseLinearParts parts,
                                                         const ExtractOptions& options,
                                                         Context& context,
                                                         ExtractStatistics* statistics = nullptr);

/// Maximum order of Lagrange cells.
inline constexpr int kMaxOrder = 9;

/// Hexahedra of order p: each has (p + 1)^3 nodes, which are the preimages of the grid refined by
/// p; CurvedNodes::Blended moves the inner nodes from there. Neighbours share the nodes of their
/// common face. Nodes 0, 1, ... are the hex vertices in the numbering of extract().
struct LagrangeMesh {
  int order = 1;
  Array<Vec3> points;  ///< one per node
  /// (p + 1)^3 per cell: node (i, j, k), which lies i / p of the way from corner 0 to corner 1, j /
  /// p to corner 3, and k / p to corner 4, has index i + (p + 1) (j + (p + 1) k).
  Array<Index> nodes;
  std::uint64_t vertexCount = 0;  ///< number of nodes that are hex vertices

  // Per node, as in HexMesh: the location of its preimage, even if the node was moved from there.
  Array<Index> generatorTet;
  Array<CornerSet> generatorCorners;

  // From the straight mesh, as in HexMesh; a tagged edge or quad includes all its nodes:
  HexFeatures features = {};
  Array<std::int32_t> regions = {};

  /// Cells, ascending, whose nodes on the boundary, on region interfaces or on tagged elements
  /// extractLagrange() moved off the image of the map because the cell or a neighbour was not
  /// positive. Not stored in files.
  std::vector<Index> straightenedCells = {};

  [[nodiscard]] std::size_t nodesPerCell() const noexcept {
    const auto n = static_cast<std::size_t>(order) + 1;
    return n * n * n;
  }
  [[nodiscard]] std::size_t cellCount() const noexcept { return nodes.size() / nodesPerCell(); }
};

/// Extracts cells of order `order`, which correspond to those of extract() with the same options,
/// in the same order.
/// @param order  1 to kMaxOrder
/// @throws Error  as extract(); InvalidArgument for other orders
[[nodiscard]] LagrangeMesh extractLagrange(const TetMapView& map, int order,
                                           const ExtractOptions& options, Context& context,
                                           ExtractStatistics* statistics = nullptr);

/// Returns the straight mesh of the corners, which is the result of extract(). (Coordinates may
/// differ by rounding if scale times order exceeds 255, since parameters may be rounded to a
/// coarser lattice then.)
/// @throws Error InvalidArgument for arrays of inconsistent sizes
[[nodiscard]] HexMesh straightMesh(const LagrangeMesh& mesh);

/// Per cell: the smallest Jacobian determinant, divided by the lengths of the columns, at the nodes
/// and at the Gauss points of order p + 1. In [-1, 1]; a value that is not positive indicates a bad
/// cell. certify() also detects cells that are bad only elsewhere.
/// @throws Error InvalidArgument for arrays of inconsistent sizes
[[nodiscard]] Array<double> scaledJacobians(const LagrangeMesh& mesh, Context& context);

/// Computes quality and validity of every cell, as for straight cells. If doubles cannot determine
/// a sign, integers do at corners, and up to order 3 everywhere.
/// @throws Error InvalidArgument for arrays of inconsistent sizes
[[nodiscard]] Certificate certify(const LagrangeMesh& mesh, Context& context);

/// Writes the arcs of a mesh. `.vtu` and `.vtp` (VTK XML, binary appended): hex vertices and inner
/// points, and a line per segment with the number of its hex edge; docs/user/curved.md describes
/// the arrays. `.ovmb` (OpenVolumeMesh, polyhedral, without faces and cells): the same, with the
/// property names common in the field. The file appears complete or not at all.
/// @throws Error FileUnsupported, FileWrite; TooLarge for files that cannot number the elements
void writeArcs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
               Context& context);

/// The same with the map that the mesh was extracted from, so that `.ovmb` files include the
/// indices of the tet simplices that contain points and segments, in the numbering of the `.ovm` or
/// `.ovmb` file that writeMap() writes for this map.
/// @param map  after a repair, the repaired map (ExtractOptions::repair)
/// @throws Error  also InvalidArgument for a different map, and as writeMap() for `.ovmb`
void writeArcs(const PiecewiseLinearMesh& mesh, const TetMapView& map,
               const std::filesystem::path& file, Context& context);

/// Writes the patches of a mesh: `.vtu` and `.vtp`, with one polygon each; or `.ovmb`
/// (OpenVolumeMesh, polyhedral, without cells), with the property names common in the field.
/// @throws Error FileUnsupported, FileWrite; TooLarge for files that cannot number the elements
void writePatches(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context);

/// The same with the map, as for arcs; the file then also includes the simplices of polygon sides
/// inside faces.
/// @throws Error  as writeArcs() with a map
void writePatches(const PiecewiseLinearMesh& mesh, const TetMapView& map,
                  const std::filesystem::path& file, Context& context);

/// Writes Lagrange cells: `.vtu` (VTK_LAGRANGE_HEXAHEDRON in the node order of VTK 9), `.msh` (Gmsh
/// 4.1), `.mesh` (MFEM, with its nodes as a discontinuous grid function). Tags, regions and
/// boundary groups are written as for straight meshes: docs/user/features.md lists what each format
/// stores.
/// @param options  format, patchAngle; scaledJacobians: as returned by scaledJacobians() for these
///                 cells; empty: computed
/// @throws Error FileUnsupported, FileWrite; InvalidArgument for arrays of inconsistent sizes, and
///         for features that are not in the mesh
void writeLagrangeMesh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);

/// Whether a file contains cells for readLagrangeMesh(): VTK_LAGRANGE_HEXAHEDRON in `.vtu` and
/// `.vtkhdf`, and hexahedra with 20 or 27 nodes in these, `.vtk`, `.inp`, `.unv`, `.cgns`, `.exo`
/// and `.e`; in VTK formats, only if there are no straight hexahedra. In `.mesh` and `.meshb`, with
/// 27 nodes, and `.msh`, the first hexahedra decide. `.msh` and MFEM's `.mesh` may also have order
/// 3 to 9.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported
[[nodiscard]] bool holdsLagrangeCells(const std::filesystem::path& file, Context& context);

/// Reads cells of order 2 from these formats, placing the nodes missing in 20-node hexahedra
/// according to their shape functions; or the Lagrange hexahedra of a `.vtu`, `.vtkhdf`, `.msh` or
/// MFEM file, all of the same order, with nodes in the order of VTK 9. Files from
/// writeLagrangeMesh() are restored node by node, with generators, tags and regions. For other
/// files, corner nodes are numbered first, and tags on other nodes are dropped.
/// @throws Error FileNotFound, FileSyntax, IndexOutOfRange, NotFinite; FileUnsupported if there are
///         no such cells, for other volume cells beside them, for orders that differ or exceed
///         kMaxOrder, and for other extensions; TooLarge
[[nodiscard]] LagrangeMesh readLagrangeMesh(const std::filesystem::path& file, Context& context);

/// Throw FileUnsupported unless the functions above support the extension or the format, so that
/// unsupported formats are detected before long work.
void requireArcFormat(const std::filesystem::path& file);
void requirePatchFormat(const std::filesystem::path& file);
/// @param order  of the cells; 0 if not known yet
void requireLagrangeFormat(const std::filesystem::path& file, std::string_view format = {},
                           int order = 0);

}  // namespace HEXHEX_API_NAMESPACE
