// What each format holds, and the functions that read and write it: whole, in parts, piece by
// piece, and of higher order. The table of formats in registry.cpp is built from them.
//
// Readers throw Error FileNotFound; FileSyntax, with a line or byte; FileUnsupported for content
// that they do not support; IndexOutOfRange; NotFinite; TooLarge. Writers throw FileWrite,
// InvalidArgument for features that are not in the mesh, and TooLarge for numbers beyond the limits
// of the format. Groups written are those of mesh_groups.hpp. Text files have the fewest digits (at
// most 17) that read back to the same double, unless noted otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/element_lists.hpp>

namespace hexhex::io {

// Types of readers and writers. The caller measures the time; for writers, it also opens and
// commits the file.
using ReadMap = TetMap(const Input& input, const ReadOptions& options, Stage& stage);
/// For formats that are folders of files.
using WriteFolder = void(const HexMesh& mesh, const std::filesystem::path& file,
                         const WriteOptions& options, Context& context);
using WriteMap = void(const TetMap& map, OutputFile& output, const WriteOptions& options,
                      Stage& stage);
/// Reads tets, ignoring a map if there is one.
using ReadTets = TetCells(const Input& input, Stage& stage);
using ReadMesh = HexMesh(const Input& input, Stage& stage);
using WriteMesh = void(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage);
// Cells of higher order.
using HoldsCurved = bool(const Input& input, Stage& stage);
using ReadCurved = LagrangeMesh(const Input& input, Stage& stage);
using WriteCurved = void(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                         Stage& stage);
/// Arcs, or arcs and patches. @param map  the mesh was extracted from; null: not available
using WritePiecewise = void(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                            OutputFile& output, Stage& stage);
// Meshes piece by piece. Sinks of formats that need random access also throw Error FileWrite for a
// device or a pipe.
using OpenSink = std::unique_ptr<MeshSink>(const std::filesystem::path& file, Context& context);
using ReadPieces = void(MeshSink& sink, const Input& input, Context& context);
// Meshes in parts. (docs/user/parts.md)
using OpenPartSink = std::unique_ptr<PartSink>(const std::filesystem::path& file, Context& context,
                                               ProcessTeam* team);

// `.hexex`: the exchange format of parametrized tetrahedral meshes. Text, separated by white space:
//
//     <number of vertices>
//     x y z                                                (per vertex)
//     <number of tets>
//     v0 v1 v2 v3  u v w  u v w  u v w  u v w              (per tet: 0-based corners, parameters)
//
// Some programs append walls of a motorcycle complex (`W`, then W times `v v v distance`), features
// (`vertices edges faces`, then as many vertices, pairs and triples), or walls followed by
// features: a line with a single number announces walls, one with three numbers features. Features
// have no tags in this format; they get tag 1, or are dropped if they list all boundary triangles.
// Walls are not features, but ReadOptions::keepWalls reads those in the interior as features with
// tag 2. Features are written without their tags.
inline constexpr std::int32_t kHexexFeatureTag = 1;
inline constexpr std::int32_t kHexexWallTag = 2;
ReadMap readHexex;
WriteMap writeHexex;

// MEDIT's formats (Gamma Mesh Format): `.mesh`, text, and `.meshb`, binary. Sections of vertices
// and elements, numbered from 1; each element has an integer reference. Comments ('#') and other
// sections are ignored.
//
// References written are group numbers, 0 for untagged elements beside tagged ones; if nothing is
// tagged, 1 for all boundary quads and cells. Other programs do likewise, so references become tags
// and regions on reading unless all are 0 or all are 1; vertices are tagged where the file lists
// them as corners.
//
// Writes sections Vertices, Quadrilaterals (the boundary, facing outwards, and tagged quads) and
// Hexahedra, and in binary files tagged edges: viewers that read only what they display fail on
// this section of text. Binary files have the lowest version that can hold the mesh: 2 below 2^31
// bytes, 3 (64-bit positions) above, 4 (all integers 64-bit) from 2^31 vertices or elements on; 1
// to 4 are read, in native byte order.
//
// Of order 2 only: HexahedraQ2, in the order of HexahedraQ2Ordering, else in that of libMeshb, with
// QuadrilateralsQ2 and, in binary files, EdgesP2; if they come before straight hexahedra.
template <bool binary>
struct MeditFormat {
  static ReadMesh readMesh;
  static ReadTets readTets;
  static HoldsCurved holdsCurved;
  static ReadCurved readCurved;
  /// Streams regular files with one section of vertices before one of hexahedra, without comments;
  /// loads others as a whole.
  static ReadPieces readTo;
  static WriteMesh write;
  static WriteCurved writeCurved;
  /// Without a boundary.
  static OpenSink openSink;
};
using Medit = MeditFormat<false>;
using Meshb = MeditFormat<true>;
/// Writes a given version, 2 to 4, which must be able to hold the mesh. For tests: meshes that
/// require a higher version are too large for them.
void writeMeshbVersion(const HexMesh& mesh, OutputFile& output, std::uint32_t version,
                       Stage& stage);

// `.vtu`: VTK's XML format for unstructured grids. Reads appended data (raw or base64), inline
// base64 or ascii, and zlib compression if built with zlib. Writes appended raw data, which
// ParaView and VTK read without conversion.
//
// Writes points (Float64), cells, the cell array `scaled_jacobian` (Float64) of hexahedra and, if
// the mesh has generators, the point arrays `generator_kind` (UInt8: 0 vertex, 1 edge, 2 face, 3
// cell), `generator_tet` (UInt32) and `generator_corners` (UInt8), as in HexMesh; then tags and
// regions as described at addTags(). Reads the same; other arrays are ignored.
//
// If a file has several pieces, points at the same position are merged, and cells that vtkGhostType
// marks as duplicates are dropped. Field arrays are dropped as well, since they refer to points.
//
// The map of tets is an array with 12 components per cell (as written) or 3 per point, named by
// ReadOptions and WriteOptions.
ReadMesh readVtu;
ReadTets readVtuTets;
ReadMap readVtuMap;
WriteMesh writeVtu;
WriteMap writeVtuMap;
/// Streams files with appended data, including generators; loads others, and pipes, as a whole.
/// Also of structured grids, whose cells become hexahedra: `.vts`, `.vtr`, `.vti`.
ReadPieces readVtuTo;
/// Writes no array scaled_jacobian, which would need the vertices of all cells.
OpenSink openVtuSink;
/// Cells of type 72, VTK_LAGRANGE_HEXAHEDRON, with the arrays of straight meshes; or hexahedra with
/// 20 or 27 nodes, if there are no straight ones. Tags of nodes other than corners are ignored;
/// other volume cells are an error.
HoldsCurved holdsLagrangeVtu;
ReadCurved readLagrangeVtu;
WriteCurved writeLagrangeVtu;
/// `.vtu` or `.vtp`. Arcs: a line per segment. Point arrays: `hex_edge` (Int32; -1 at hex
/// vertices), `parameter` (Float64 along the hex edge; 0 at hex vertices), and generators as in
/// meshes. Cell arrays: `hex_edge`, and `tet_kind`, `tet`, `tet_corners` of the simplex that
/// contains the segment.
///
/// Patches: a polygon per tet or triangle. Point arrays: `point_kind` (UInt8: 0 hex vertex, 1 on an
/// arc, 2 in a patch) and generators. Cell arrays: `hex_face`, `tet_kind`, `tet`, `tet_corners`.
/// Field array `corner_uv` (Float64, 2 components): (u, v) of the corners of all polygons, in order
/// of the connectivity.
template <bool polyData>
struct PiecewiseVtk {
  static WritePiecewise writeArcs;
  static WritePiecewise writePatches;
};

// `.pvtu`: NAME.pvtu, and in the folder NAME a piece `NAME_K.vtu` for each part, as written by
// writeVtu() without scaled_jacobian, with GlobalPointIds and GlobalCellIds and, if there are
// ghosts, vtkGhostType. Reads pieces of any program: global numbers of vertices and cells are used
// if all pieces have them; otherwise points at the same position are merged, unless a piece has
// several there.
ReadMesh readPvtu;
OpenPartSink openPvtuSink;

// `.vtk`: legacy VTK unstructured and structured grids, ASCII or binary, versions 1.0 to 5.1.
// Points, cells, and regions as this library writes them. Writes version 2.0, which every program
// reads; HexaLab, OpenFOAM and MFEM read ASCII only. Binary files are limited to 2^31 points.
ReadMesh readVtkLegacy;
ReadTets readVtkLegacyTets;
ReadMap readVtkLegacyMap;
/// Streams files up to version 4 that hold only hexahedra; loads others as a whole.
ReadPieces readVtkLegacyTo;
template <bool binary>
struct VtkLegacyWriting {
  static WriteMesh writeMesh;
  static WriteMap writeMap;
  /// Writes no regions.
  static OpenSink openSink;
};
/// Hexahedra with 20 or 27 nodes.
HoldsCurved holdsCurvedVtkLegacy;
ReadCurved readCurvedVtkLegacy;

// `.vtkhdf`: VTK's HDF5 format, for ParaView 5.10 or later; only in builds with HDF5
// (HEXHEX_HAS_HDF5). An unstructured grid, version 1.0 of the format, with the arrays of `.vtu`;
// parts go into one file, with the arrays of `.pvtu` pieces; tags of edges and quads use global
// numbers.
WriteMesh writeVtkHdf;
OpenPartSink openVtkHdfPartSink;
/// Versions 1 and 2, without time steps. Partitions are joined like pieces of `.pvtu`.
ReadMesh readVtkHdf;
/// Files with one partition only.
ReadTets readVtkHdfTets;
HoldsCurved holdsCurvedVtkHdf;
ReadCurved readCurvedVtkHdf;

/// Labels of the triangles among the cells of a file, which may be in a tet mesh or on their own.
struct TriangleLabels {
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int64_t> labels;
};
/// @param array  name of the cell array
/// @throws Error FileUnsupported if there is no such integer array, or no triangle
using ReadLabels = TriangleLabels(const Input& input, std::string_view array, Stage& stage);
ReadLabels readVtuLabels, readVtkLegacyLabels;

// Surfaces. They return what the file holds: vertices as listed, and polygons triangulated as fans
// around their first corner.
using ReadTriangles = TriangleMesh(const Input& input, Stage& stage);
/// `.vtp`, and the data set POLYDATA of `.vtk`. Lines and vertices are ignored; strips are refused.
ReadTriangles readVtp, readVtkLegacySurface;
ReadTriangles readStl, readObj, readOff, readPly;
/// Whether a `.vtk` file holds a surface, from its first lines.
bool holdsVtkLegacySurface(const Input& input);
/// Adds the triangles of a polygon: those at its first corner if all its angles are convex,
/// otherwise ears, cut off one by one.
void addPolygon(TriangleMesh& mesh, std::span<const Index> corners);
/// Merges vertices at the same position, and drops triangles with repeated corners.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

// `.ovm` and `.ovmb`: text and binary files of OpenVolumeMesh, with maps or hex meshes.
//
// A map is the property `HexHex::Parametrization`: for each half-face of a tet, the parameters of
// the opposite vertex in the tet's chart. Also stored: valences of edges (`edge_valance`),
// rotations across half-faces (`HalffaceTransiton`), features (`AlgoHex::FeatureVertices`,
// `...Edges`, `...Faces`), and for hex meshes the generators of vertices (`v_tet_generator_type`).
//
// The format defines no order of a cell's corners, and no generators by corners. To preserve both,
// further properties are written, which other programs ignore: `hexhex::corner_order` (only where
// needed), `hexhex::generator_tet` and `hexhex::generator_corners`.
//
// Readers accept half-faces in any order and reorient a mesh that is inside out. Writers refuse
// meshes that the format cannot represent: NonManifoldFace, Orientation, RepeatedVertex.
template <bool binary>
struct OvmFormat {
  static ReadMap readMap;
  static ReadTets readTets;
  static ReadMesh readMesh;
  static WriteMap writeMap;
  static WriteMesh writeMesh;
};
using OvmText = OvmFormat<false>;
using OvmBinary = OvmFormat<true>;
/// Writes arcs as `.ovmb`: vertices are hex vertices and inner points of arcs, edges are segments.
/// Properties known to other tools: `v_type` (0 hex vertex, 1 on an arc), `v_igm_uv` (position
/// along the arc, 0), `v_tet_generator_type`, `v_tet_generator_index`, `e_linear_hex_edge`,
/// `e_tet_generator_type`, `e_tet_generator_index`; of this library: `hexhex::generator_tet` and
/// `hexhex::generator_corners` of vertices and edges. Without a map, indices are left out.
WritePiecewise writeArcsOvmb;
/// The same, plus the inner points of patches (`v_type` 2, `v_igm_uv` their (u, v)), the sides of
/// polygons (`e_linear_hex_edge` -1 inside faces; without a map, their generator properties are -1)
/// and polygons: `f_linear_hex_face`, `f_intersected_tet_index`.
WritePiecewise writePatchesOvmb;

// `.msh`: Gmsh. Reads nodes, hexahedra and tags of MSH 1, 2.x, 4.0 and 4.1, ASCII and binary; other
// elements and sections are ignored. Vertices are in file order, whatever their tags.
//
// Writes MSH 4.1 (binary or ASCII) and MSH 2.2 (ASCII). Node i has the tag i + 1. Elements are
// tagged vertices (type 15), tagged edges (type 1), boundary and tagged quads (type 3), then all
// cells (type 5), numbered from 1 in this order. Each group is an entity (for vertices: one entity
// per vertex) and a physical group, both with the group's number, which is unique across
// dimensions; cells without regions form the physical group "hexahedra".
[[nodiscard]] ElementLists readGmsh(const Input& input, ElementParts parts, Stage& stage);
using GmshFormat = ElementFormat<readGmsh>;
WriteMesh writeGmsh41Binary, writeGmsh41Text, writeGmsh22Text;
/// Streams binary files of version 4.1 with one block of nodes, numbered from 1, and one of
/// hexahedra; loads others as a whole.
ReadPieces readGmshTo;
/// As writeGmsh41Binary(), without a boundary.
OpenSink openGmsh41BinarySink;
/// MSH 4.1 text with the groups of straight meshes; edges, quads and hexahedra have the order of
/// the cells.
WriteCurved writeLagrangeGmsh;
/// Gmsh 4.1, binary: one file whose entities are partitioned, with ghost cells; or one
/// self-contained file per part, `NAME_K.msh`, K from 1 on. Nodes and cells have their global
/// numbers, from 1 on. Tags of edges and vertices are not written.
OpenPartSink openGmshPartSink, openSplitGmshPartSink;

// `.inp`: Abaqus and CalculiX input. Writes nodes and C3D8 elements, numbered from 1; a node set
// for each group of vertices, edges and quads; and an element surface for each group of boundary
// quads. Names are in upper case: element set HEXAHEDRA, node sets N_BOUNDARY, N_SURFACE_7,
// N_CURVE_3, N_POINT_1, surfaces S_BOUNDARY, S_SURFACE_7. Numbers take at most 20 characters, since
// programs truncate longer ones: most read back to the same double, others are rounded to at least
// 13 significant digits.
//
// Reads nodes; C3D8 elements and their variants, continuum shells, and hexahedra with 20 nodes as
// curved cells; other volume elements are counted. A region is a set named by *ELEMENT or *SOLID
// SECTION; an element surface becomes tagged quads. The tag comes from a name written by this
// library, otherwise it is the position of the set in the file. *INCLUDE is followed. Instances
// have vertices of their own; sets with the same name in two of them have the instance in front.
[[nodiscard]] ElementLists readAbaqus(const Input& input, ElementParts parts, Stage& stage);
using AbaqusFormat = ElementFormat<readAbaqus>;
WriteMesh writeAbaqus;
/// Order 2 only: C3D20 elements, without face and interior nodes. Node sets include the midpoints
/// of edges.
WriteCurved writeQuadraticAbaqus;

// `.unv`: I-deas universal files, as written by SALOME and Gmsh; read only. Nodes are data sets
// 2411 and 781, elements 2412, groups 2467, 2477, 2452 and 2435. Groups of hexahedra are regions;
// those of quads, triangles and beams tag them; node groups are treated as in hexMeshOf(). The tag
// comes from a name written by this library, otherwise it is the number. Hexahedra with 20 nodes
// are curved cells; other volume elements are counted.
[[nodiscard]] ElementLists readUnv(const Input& input, ElementParts parts, Stage& stage);
using UnvFormat = ElementFormat<readUnv>;

// `.ele`: TetGen's tets, with points in the file of the same name and the extension `.node`; read
// only. Numbered from 0 or 1. The first attribute of tets is their region if it is an integer for
// all; markers of triangles in a `.face` file are their tags, unless all are equal to one of -1, 0
// and 1. Other attributes are ignored.
ReadTets readTetgen;
struct TetgenText {
  std::string_view text;
  std::string name;
};
/// @param faces  may be empty
[[nodiscard]] TetCells parseTetgen(const TetgenText& nodes, const TetgenText& faces,
                                   const Input& input, Stage& stage);

// `.exo`, `.e`: Exodus II, for Sandia's codes and MOOSE, in NetCDF's classic layouts; the HDF5
// layout is read as well. Writes an element block HEX8 for each region, a side set for each group
// of boundary quads, and node sets for the tags of edges and vertices, named as their groups. Side
// sets and blocks have the numbers of their groups. Tagged interior quads are left out. Cells are
// sorted by region. Offsets have 64 bits, and so do sizes where an array needs it.
//
// Reads blocks as regions, side sets as tagged quads, and node sets as in hexMeshOf(). The tag
// comes from a name written by this library, otherwise it is the ID. Hexahedra with 20 and 27 nodes
// are curved cells; other volume elements are counted.
[[nodiscard]] ElementLists readExodus(const Input& input, ElementParts parts, Stage& stage);
using ExodusFormat = ElementFormat<readExodus>;
/// Maximum size of an array in the layout that all readers support: 4 GB.
inline constexpr std::uint64_t kMostExodusBytes = 0xffff'fff0;
WriteMesh writeExodus;
/// @param mostBytes  maximum size of an array before 64-bit sizes are used; smaller in tests
void writeExodus(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage,
                 std::uint64_t mostBytes);
/// Order 2 only: blocks of HEX27. Node sets of edges include their midpoints.
WriteCurved writeQuadraticExodus;
/// `NAME.e.N.K` for NAME.e, with Nemesis maps of interior and shared nodes and cells. No ghosts.
OpenPartSink openExodusPartSink;

// `.cgns`: the CFD General Notation System, over HDF5; only in builds with HDF5. Writes one base
// with one unstructured zone: a section HEXA_8 for each region, QUAD_4 for each group of boundary
// quads and tagged interior quads, BAR_2 and NODE for the tags of edges and vertices, named as
// their groups; and a boundary condition of type FamilySpecified for each group of boundary quads.
// Cells are sorted by region. An empty mesh is an error.
WriteMesh writeCgns;
/// Order 2 only: sections HEXA_27, QUAD_9 and BAR_3.
WriteCurved writeQuadraticCgns;
/// Reads zones, structured ones with i fastest; several only if 1-to-1 connections identify their
/// shared vertices. Sections of cells and structured zones are regions if there are several, or if
/// this library named them. Boundary conditions on faces and edges tag these, and those on cells
/// are regions. A group is named by the family of its condition or zone, or by these themselves;
/// its tag comes from a name written by this library, otherwise it is the position of the group.
/// Conditions on vertices are treated as node sets in hexMeshOf(), unless they are planes of a
/// structured zone. Hexahedra with 20 and 27 nodes are curved cells; other volume elements are
/// counted.
[[nodiscard]] ElementLists readCgns(const Input& input, ElementParts parts, Stage& stage);
using CgnsFormat = ElementFormat<readCgns>;
/// A zone for each nonempty part, with 1-to-1 connections of shared vertices, and global numbers,
/// from 1 on, as solutions. No ghosts.
OpenPartSink openCgnsPartSink;

// MFEM mesh v1.0, text. Its files have the extension of MEDIT's, whose readers recognize them; to
// be written, the format is selected by name. Writes cells (attribute: their region, or 1),
// boundary quads and tagged interior quads (attribute: the number of their group), and vertices.
//
// Reads conforming meshes, v1.0 to 1.3. Attributes are regions and tags unless all are 1; those
// with a set of their own have its name. Nodes of order 1 are vertices; with nodes of order 2
// to 9, in H1 or in L2 with closed bases, cells are curved. Periodic meshes and nodes of other
// cells are refused.
[[nodiscard]] ElementLists readMfem(const Input& input, ElementParts parts, Stage& stage);
using MfemFormat = ElementFormat<readMfem>;
/// Whether a regular file, or bytes, begin as MFEM's meshes do.
[[nodiscard]] bool isMfem(const Input& input);
WriteMesh writeMfem;
/// Nodes as a grid function in L2 with closed equidistant nodes, listed cell by cell.
WriteCurved writeLagrangeMfem;
/// `NAME.000000` and so on: MFEM's parallel mesh, v1.2. Shared vertices, edges and faces are in the
/// same order in all parts. No ghosts.
OpenPartSink openMfemPartSink;

// OpenFOAM's `polyMesh`, a folder of text files. Writes points, faces, owner, neighbour and
// boundary: inner faces in upper-triangular order, then a patch for each group of boundary quads,
// named as the group; and a cell zone for each region. Tagged vertices, edges and interior quads
// are left out. Faces of more than two cells are an error.
//
// The file is `CASE/X.foam`, written empty for ParaView, next to `CASE/constant/polyMesh`; or the
// folder `polyMesh` itself. Folders are created. `polyMesh` is replaced atomically; its other
// contents are kept.
//
// Reads text files, plain or compressed. Patches are tags and cell zones regions, numbered as they
// come unless this library named them.
ReadMesh readOpenFoam;
WriteFolder writeOpenFoam;
/// A decomposed case, beside NAME.foam or in the named folder: for each part
/// `processorK/constant/polyMesh`, with processor patches and the addresses of points, cells, faces
/// and patches in the mesh that writeOpenFoam() writes with patch angle 0. No ghosts.
/// @throws Error FileWrite if there are processor folders of more parts
OpenPartSink openOpenFoamPartSink;

}  // namespace hexhex::io
