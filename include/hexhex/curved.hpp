// Curved meshes: the exact images of integer-grid edges and faces, and hexahedra of any order.
//
// A map bends hex edges and faces at every tet that they cross. Arcs and patches are these images
// as they are, piece by piece (Section 5.5 of the paper); Lagrange cells follow them with
// polynomials through the preimages of a refined grid, on the boundary or everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Hex edges as polylines. An inner point is where the edge leaves one simplex of the tet mesh for
/// another; a segment lies in the interior of one simplex: a tet, or a face or edge inside which
/// the hex edge runs. Arc e has the inner points pointBegin[e] to pointBegin[e + 1] - 1, and the
/// segments from number pointBegin[e] + e on, one more than inner points.
struct Arcs {
  /// Per arc: the hex vertices at its beginning and end. Arcs of the same two vertices may be
  /// different ones.
  Array<std::array<Index, 2>> ends;
  Array<std::uint64_t> pointBegin;  ///< per arc (+1)

  // Per inner point:
  Array<Vec3> points;                 ///< position
  Array<double> parameters;           ///< place along the arc, in (0, 1), not descending
  Array<Index> generatorTet;          ///< the simplex that is crossed there (a vertex, an edge or
  Array<CornerSet> generatorCorners;  ///< a face): as in HexMesh

  // Per segment: the simplex that it lies in (an edge, a face, or a tet), as in HexMesh.
  Array<Index> segmentTet;
  Array<CornerSet> segmentCorners;

  [[nodiscard]] std::size_t count() const noexcept { return ends.size(); }
  [[nodiscard]] std::uint64_t firstSegment(std::size_t arc) const noexcept {
    return pointBegin[arc] + arc;
  }
};

/// Hex faces as planar polygons: one per tet whose interior the open face meets, and one per
/// triangle of the tet mesh that it contains a part of. They meet along whole sides.
///
/// Polygons name points of one common numbering: hex vertices, then inner points of arcs, then
/// those of patches.
struct Patches {
  /// Per face: its hex vertices, at (u, v) = (0, 0), (1, 0), (1, 1), (0, 1).
  Array<Quad> vertices;
  /// Per face: the arc from its vertex i to vertex i + 1 (mod 4).
  Array<std::array<Index, 4>> arcs;
  Array<std::uint8_t> reversedArcs;   ///< per face: bit i if that arc runs from i + 1 to i
  Array<std::uint64_t> polygonBegin;  ///< per face (+1): its polygons

  // Per polygon:
  Array<std::uint64_t> cornerBegin;  ///< (+1): its corners, counter-clockwise in (u, v)
  Array<Index> polygonTet;           ///< the simplex whose interior it lies in (a tet or a face),
  Array<CornerSet> polygonCorners;   ///< as in HexMesh

  // Per corner of a polygon:
  Array<Index> corners;                     ///< a point of the common numbering
  Array<std::array<double, 2>> parameters;  ///< (u, v) in the face, in [0, 1]

  // Per inner point of a face:
  Array<Vec3> points;
  Array<Index> generatorTet;          ///< the vertex or edge of the tet mesh that crosses the face,
  Array<CornerSet> generatorCorners;  ///< as in HexMesh

  [[nodiscard]] std::size_t count() const noexcept { return vertices.size(); }
};

/// A mesh with the exact shapes of its edges and faces.
struct PiecewiseLinearMesh {
  HexMesh mesh;     ///< what extract() returns, bit for bit
  Arcs arcs;        ///< one per hex edge
  Patches patches;  ///< one per hex face, if asked for

  /// Position of a point of the common numbering.
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

/// Extracts a mesh with its arcs and, if asked for, its patches. All combinatorial decisions are
/// exact. The result does not depend on the number of threads or on the engine; memory grows with
/// its size.
/// @throws Error  as extract(); TooLarge for more points than an Index can number
[[nodiscard]] PiecewiseLinearMesh extractPiecewiseLinear(const TetMapView& map,
                                                         PiecewiseLinearParts parts,
                                                         const ExtractOptions& options,
                                                         Context& context,
                                                         ExtractStatistics* statistics = nullptr);

/// The highest order of Lagrange cells.
inline constexpr int kMaxOrder = 9;

/// Hexahedra of an order p: each has (p + 1)^3 nodes, the preimages of the grid refined by p, from
/// which CurvedNodes::Blended moves those inside. Neighbours share the nodes of their common face.
/// Nodes 0, 1, ... are the hex vertices in the numbering of extract().
struct LagrangeMesh {
  int order = 1;
  Array<Vec3> points;  ///< one per node
  /// (p + 1)^3 per cell: node (i, j, k), which lies i / p of the way from corner 0 to corner 1, j /
  /// p to corner 3, and k / p to corner 4, is number i + (p + 1) (j + (p + 1) k).
  Array<Index> nodes;
  std::uint64_t vertexCount = 0;  ///< of the nodes, those that are hex vertices

  // Per node, as in HexMesh: where its preimage is, also if it was moved from there.
  Array<Index> generatorTet;
  Array<CornerSet> generatorCorners;

  // Of the straight mesh, as in HexMesh; a tagged edge or quad stands for all its nodes:
  HexFeatures features = {};
  Array<std::int32_t> regions = {};

  [[nodiscard]] std::size_t nodesPerCell() const noexcept {
    const auto n = static_cast<std::size_t>(order) + 1;
    return n * n * n;
  }
  [[nodiscard]] std::size_t cellCount() const noexcept { return nodes.size() / nodesPerCell(); }
};

/// Extracts cells of order `order`: those of extract() with the same options, in the same order.
/// @param order  1 to kMaxOrder
/// @throws Error  as extract(); InvalidArgument for other orders
[[nodiscard]] LagrangeMesh extractLagrange(const TetMapView& map, int order,
                                           const ExtractOptions& options, Context& context,
                                           ExtractStatistics* statistics = nullptr);

/// The straight mesh between the corners: what extract() returns (its coordinates up to rounding if
/// scale times order exceeds 255, which may make the lattice coarser that parameters are rounded
/// to).
/// @throws Error InvalidArgument for arrays that do not fit each other
[[nodiscard]] HexMesh straightMesh(const LagrangeMesh& mesh);

/// Per cell: the smallest determinant of the Jacobian matrix, divided by the lengths of its
/// columns, at the nodes and at the Gauss points of order p + 1. In [-1, 1]; a bad cell has a value
/// that is not positive; certify() finds also those that are bad elsewhere only.
/// @throws Error InvalidArgument for arrays that do not fit each other
[[nodiscard]] Array<double> scaledJacobians(const LagrangeMesh& mesh, Context& context);

/// Quality and validity of every cell, as of straight ones. Where doubles do not tell the sign,
/// integers do at corners, and up to order 3 everywhere.
/// @throws Error InvalidArgument for arrays that do not fit each other
[[nodiscard]] Certificate certify(const LagrangeMesh& mesh, Context& context);

/// Writes the arcs of a mesh. `.vtu` and `.vtp` (VTK XML, binary appended): hex vertices and inner
/// points, and a line per segment with the number of its hex edge; arrays docs/curved.md explains.
/// `.ovmb` (OpenVolumeMesh, polyhedral, without faces and cells): the same, with the property names
/// that tools of the field use. The file appears complete or not at all.
/// @throws Error FileUnsupported, FileWrite; TooLarge for files that cannot number the elements
void writeArcs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
               Context& context);

/// The same with the map that the mesh was extracted from, so that `.ovmb` files tell the indices
/// of the tet simplices that points and segments lie in: in the numbering of the file that
/// writeMap() writes for this map as `.ovm` or `.ovmb`.
/// @param map  after a repair, the repaired one (ExtractStatistics::repairedMap)
/// @throws Error  also InvalidArgument if it is another map, and as writeMap() for `.ovmb`
void writeArcs(const PiecewiseLinearMesh& mesh, const TetMapView& map,
               const std::filesystem::path& file, Context& context);

/// Writes the patches of a mesh: `.vtu` and `.vtp`, a polygon each; or `.ovmb` (OpenVolumeMesh,
/// polyhedral, without cells), with the property names that tools of the field use.
/// @throws Error FileUnsupported, FileWrite; TooLarge for files that cannot number the elements
void writePatches(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context);

/// The same with the map, as for arcs; then also the sides of polygons inside faces know their
/// simplices.
/// @throws Error  as writeArcs() with a map
void writePatches(const PiecewiseLinearMesh& mesh, const TetMapView& map,
                  const std::filesystem::path& file, Context& context);

/// Writes Lagrange cells: `.vtu` (VTK_LAGRANGE_HEXAHEDRON in the node order of VTK 9), `.msh` (Gmsh
/// 4.1), `.mesh` (MFEM, with its nodes as a discontinuous grid function). Tags, regions and groups
/// of the boundary are written as those of straight meshes: docs/features.md tells what formats
/// hold.
/// @param options  format, patchAngle; scaledJacobians: of the cells, by scaledJacobians(); empty:
///                 computed
/// @throws Error FileUnsupported, FileWrite; InvalidArgument for arrays that do not fit each
///         other, and for features that are not in the mesh
void writeLagrangeMesh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);

/// Whether a file has cells that readLagrangeMesh() reads: VTK_LAGRANGE_HEXAHEDRON in `.vtu` and
/// `.vtkhdf`, and hexahedra with 20 or 27 nodes in these, `.vtk`, `.inp`, `.unv`, `.cgns`, `.exo`
/// and `.e`, of VTK's formats only where no hexahedra are straight; and in `.msh`, where also those
/// of order 3 to 9 are read, if the first hexahedra are such ones.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported
[[nodiscard]] bool holdsLagrangeCells(const std::filesystem::path& file, Context& context);

/// Reads cells of order 2 from these formats, where nodes that hexahedra with 20 lack are where
/// their shape functions place them; or hexahedra of a `.vtu`, `.vtkhdf` or `.msh` file of any
/// order, with their nodes in the order of VTK 9. What writeLagrangeMesh() wrote comes back node by
/// node, with its generators, tags and regions; of other files, nodes at corners get the first
/// numbers, and what is tagged at other nodes is left out.
/// @throws Error FileNotFound, FileSyntax, IndexOutOfRange, NotFinite; FileUnsupported without such
///         cells, for other volume cells beside them, for orders that differ or exceed kMaxOrder,
///         and for other extensions; TooLarge
[[nodiscard]] LagrangeMesh readLagrangeMesh(const std::filesystem::path& file, Context& context);

/// Throw FileUnsupported unless the functions above know the extension, or the format: to fail
/// before long work.
void requireArcFormat(const std::filesystem::path& file);
void requirePatchFormat(const std::filesystem::path& file);
/// @param order  of the cells; 0: not known yet
void requireLagrangeFormat(const std::filesystem::path& file, std::string_view format = {},
                           int order = 0);

}  // namespace HEXHEX_API_NAMESPACE
