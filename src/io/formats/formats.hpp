// What each format holds, and the functions that read and write it: whole, in parts, piece by
// piece, and of higher order. The table of all formats, in registry.cpp, is made of them.
//
// Readers throw Error FileNotFound; FileSyntax, with a line or byte; FileUnsupported for what they
// do not read; IndexOutOfRange; NotFinite; TooLarge. Writers throw FileWrite, InvalidArgument for
// features that are not in the mesh, and TooLarge for numbers that the format does not hold. Groups
// that are written are those of mesh_groups.hpp. Numbers of texts have the fewest digits (at most
// 17) that read back to the same double, unless it says otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/element_lists.hpp>

namespace hexhex::io {

// What is done with a format. Who calls a reader or writer keeps its time and, of a writer, opens
// the file and commits it.
using ReadMap = TetMap(const Input& input, const ReadOptions& options, Stage& stage);
/// Of a format that is a folder of files.
using WriteFolder = void(const HexMesh& mesh, const std::filesystem::path& file,
                         const WriteOptions& options, Context& context);
using WriteMap = void(const TetMap& map, OutputFile& output, const WriteOptions& options,
                      Stage& stage);
/// Tets without a map, whether there is one or not.
using ReadTets = TetCells(const Input& input, Stage& stage);
using ReadMesh = HexMesh(const Input& input, Stage& stage);
using WriteMesh = void(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage);
// Cells of higher order.
using HoldsCurved = bool(const Input& input, Stage& stage);
using ReadCurved = LagrangeMesh(const Input& input, Stage& stage);
using WriteCurved = void(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                         Stage& stage);
/// Arcs, or arcs and patches. @param map  that the mesh was extracted from; null: not known
using WritePiecewise = void(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                            OutputFile& output, Stage& stage);
// Meshes piece by piece. Sinks throw Error FileWrite also for a device or a pipe where the format
// takes positions.
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
// Some programs append walls of a motorcycle complex (`W`, then W times `v v v distance`) or
// features (`vertices edges faces`, then that many vertices, pairs, and triples), or walls and then
// features: a line with one number alone announces walls, one with three features. As the format
// gives features no tags, they get tag 1; where all triangles of the boundary are listed, these are
// left out. Walls serve the complex and are no features, unless ReadOptions::keepWalls asks for
// those inside of the object, with tag 2. Features that are written lose their tags.
inline constexpr std::int32_t kHexexFeatureTag = 1;
inline constexpr std::int32_t kHexexWallTag = 2;
ReadMap readHexex;
WriteMap writeHexex;

// MEDIT's formats (Gamma Mesh Format): `.mesh`, text, and `.meshb`, bytes. Sections of vertices and
// elements, which are numbered from 1; each has a reference, which is one integer. Comments ('#')
// and other sections are ignored.
//
// This library writes the numbers of groups as references, 0 where there is no tag beside others;
// and 1 for all quads of a boundary and all cells if none of them has a tag. Other programs do
// likewise. What is read with references that are not all 0 or all 1 has these as tags and regions;
// vertices have tags where the file says that they are corners.
ReadMesh readMedit;
ReadTets readMeditTets;
/// Sections Vertices, Quadrilaterals (the boundary, facing outwards, and tagged quads) and
/// Hexahedra. Tagged edges stay out: viewers that read no more than what they show stumble over the
/// section.
WriteMesh writeMedit;
/// Of version 1 to 4, of this machine's byte order. No more than a few kilobytes are in memory.
ReadMesh readMeshb;
ReadTets readMeshbTets;
/// The same sections and tagged edges. The version is the smallest that holds the file: 2 below
/// 2^31 bytes, 3 (positions of 64 bits) above, 4 (all integers of 64 bits) from 2^31 vertices or
/// elements on.
WriteMesh writeMeshb;
/// The same as a given version, 2 to 4, that must hold the mesh. For tests: what needs one is too
/// large for them.
void writeMeshbVersion(const HexMesh& mesh, OutputFile& output, std::uint32_t version,
                       Stage& stage);
/// Files with one section Vertices in front of one section Hexahedra and without comments; others
/// as a whole.
ReadPieces readMeditTo, readMeshbTo;
/// Vertices and hexahedra only: the boundary is not known before the last cell came.
OpenSink openMeditSink, openMeshbSink;

// `.vtu`: VTK's XML, an unstructured grid. Data may be appended (raw or base64), inline base64 or
// ascii, and compressed with zlib, if the library was built with it. They are written as raw bytes,
// appended, which ParaView and VTK read without conversion.
//
// Written are points (Float64), cells, the cell array `scaled_jacobian` (Float64) of hexahedra and,
// if the mesh knows where its vertices came from, the point arrays `generator_kind` (UInt8: 0
// vertex, 1 edge, 2 face, 3 cell), `generator_tet` (UInt32) and `generator_corners` (UInt8), as in
// HexMesh; then tags and regions as addTags() describes them. These are read, other arrays ignored.
//
// Of several pieces in one file, points at the same position are one, and cells that vtkGhostType
// marks as another piece's are left out. Field arrays are left out, too: they name points.
//
// The map of tets is an array: one of 12 numbers per cell (as it is written) or 3 per point, with
// the name that ReadOptions and WriteOptions tell.
ReadMesh readVtu;
ReadTets readVtuTets;
ReadMap readVtuMap;
WriteMesh writeVtu;
WriteMap writeVtuMap;
/// With little memory if the file's data are appended and it is no pipe; with generators, then.
ReadPieces readVtuTo;
/// No array scaled_jacobian: it takes the vertices of all cells.
OpenSink openVtuSink;
/// Cells of type 72, VTK_LAGRANGE_HEXAHEDRON, with the arrays of straight meshes; or no straight
/// hexahedra but some with 20 or 27 nodes. Tags of nodes that are no corners are ignored; other
/// volume cells are an error.
HoldsCurved holdsLagrangeVtu;
ReadCurved readLagrangeVtu;
WriteCurved writeLagrangeVtu;
/// `.vtu`, or `.vtp`: a line per segment. Point arrays: `hex_edge` (Int32;
/// -1 at hex vertices), `parameter` (Float64 along the hex edge; 0 at hex vertices), and generators
/// as in meshes. Cell arrays: `hex_edge`, and `tet_kind`, `tet`, `tet_corners` for the simplex that
/// the segment lies in.
WritePiecewise writeArcsVtu, writeArcsVtp;
/// A polygon per tet or triangle. Point arrays: `point_kind` (UInt8: 0 hex vertex, 1 of an arc, 2
/// of a patch) and generators. Cell arrays: `hex_face`, `tet_kind`, `tet`, `tet_corners`. Field
/// array `corner_uv` (Float64, 2 components): (u, v) of the corners of all polygons, in the order
/// of their connectivity.
WritePiecewise writePatchesVtu, writePatchesVtp;

// `.pvtu`: NAME.pvtu, and in the folder NAME a piece `NAME_K.vtu` for each part: as writeVtu()
// writes it, without scaled_jacobian, with GlobalPointIds and GlobalCellIds and, if there are
// ghosts, vtkGhostType. Read are pieces of any program: where all of them give vertices and cells
// global numbers, these are the numbers in the mesh; elsewhere points at the same position are one,
// unless a piece has several there.
ReadMesh readPvtu;
OpenPartSink openPvtuSink;

// `.vtk`: legacy VTK, an unstructured grid, ASCII or binary, of versions 1.0 to 5.1. Points, cells,
// and regions as this library writes them. Written in version 2.0, the narrow form that every
// program reads: HexaLab, OpenFOAM and MFEM read ASCII only; bytes are limited to 2^31 points.
ReadMesh readVtkLegacy;
ReadTets readVtkLegacyTets;
ReadMap readVtkLegacyMap;
WriteMesh writeVtkLegacy, writeVtkLegacyBinary;
WriteMap writeVtkLegacyMap, writeVtkLegacyMapBinary;
/// Files up to version 4 with nothing but hexahedra; others as a whole.
ReadPieces readVtkLegacyTo;
/// Without regions.
OpenSink openVtkLegacySink, openVtkLegacyBinarySink;
/// Hexahedra with 20 or 27 nodes.
HoldsCurved holdsCurvedVtkLegacy;
ReadCurved readCurvedVtkLegacy;

// `.vtkhdf`: VTK's format in HDF5, for ParaView from 5.10 on; only in builds with HDF5
// (HEXHEX_HAS_HDF5). An unstructured grid, version 1.0 of the format, with the same arrays as
// `.vtu` has; parts are in one file, with the arrays of the pieces of `.pvtu`; tags of edges and
// quads by global numbers.
WriteMesh writeVtkHdf;
OpenPartSink openVtkHdfPartSink;
/// Of versions 1 and 2, without steps of time. Several partitions are joined as pieces of `.pvtu`.
ReadMesh readVtkHdf;
/// Of one partition.
ReadTets readVtkHdfTets;
HoldsCurved holdsCurvedVtkHdf;
ReadCurved readCurvedVtkHdf;

/// Labels of triangles among the cells of a file, which may stand beside a tet mesh or apart.
struct TriangleLabels {
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int64_t> labels;
};
/// @param array  the name of the cell array
/// @throws Error FileUnsupported if there is no such array of whole numbers, or no triangle
using ReadLabels = TriangleLabels(const Input& input, std::string_view array, Stage& stage);
ReadLabels readVtuLabels, readVtkLegacyLabels;

// `.ovm` and `.ovmb`: the text and binary files of OpenVolumeMesh, with maps or hex meshes in them.
//
// A map is the property `HexHex::Parametrization`: for each half-face of a tet the parameters of
// the vertex opposite it, in the tet's chart. Also carried: valences of edges (`edge_valance`),
// rotations across half-faces (`HalffaceTransiton`), features (`AlgoHex::FeatureVertices`,
// `...Edges`, `...Faces`), and with hex meshes the generators of vertices (`v_tet_generator_type`).
//
// The format has no order of a cell's corners, and no generators by corners; so that both come back
// as they were, they are written as further properties, `hexhex::corner_order` (only where needed),
// `hexhex::generator_tet` and `hexhex::generator_corners`, which other programs ignore.
//
// Cells that are read may list their half-faces in any order; a mesh that is inside out is turned.
// Meshes that the format cannot hold are refused: NonManifoldFace, Orientation, RepeatedVertex.
ReadMap readOvmMap, readOvmbMap;
ReadMesh readOvmHexMesh, readOvmbHexMesh;
ReadTets readOvmTets, readOvmbTets;
WriteMap writeOvmMap, writeOvmbMap;
WriteMesh writeOvmHexMesh, writeOvmbHexMesh;
/// Arcs as `.ovmb`. Vertices are hex vertices and inner points of arcs, edges are segments.
/// Properties of the field: `v_type` (0 hex vertex, 1 of an arc), `v_igm_uv` (place along the arc,
/// 0), `v_tet_generator_type`, `v_tet_generator_index`, `e_linear_hex_edge`,
/// `e_tet_generator_type`, `e_tet_generator_index`; and this library's `hexhex::generator_tet` and
/// `hexhex::generator_corners` of vertices and edges. Without a map, indices are left out.
WritePiecewise writeArcsOvmb;
/// The same with the inner points of patches (`v_type` 2, `v_igm_uv` their (u, v)), the sides of
/// polygons (`e_linear_hex_edge` -1 inside faces; without a map, -1 for all that tells their
/// simplex) and polygons: `f_linear_hex_face`, `f_intersected_tet_index`.
WritePiecewise writePatchesOvmb;

// `.msh`: Gmsh. Read are nodes, hexahedra and tags of MSH 1, 2.x, 4.0 and 4.1, ASCII and binary;
// other elements and sections are ignored. Vertices are in the order of the file, whatever their
// tags.
//
// Written are MSH 4.1 (binary or ASCII) and MSH 2.2 (ASCII). Node i has the tag i + 1. Elements are
// tagged vertices (type 15), tagged edges (type 1), boundary and tagged quads (type 3), then all
// cells (type 5), numbered from 1 in this order. Each group is an entity (of vertices: each vertex
// is one) and a physical group, both with the group's number, which no other group has, of whatever
// dimension; cells without regions are the physical group "hexahedra".
ReadMesh readGmsh;
ReadTets readGmshTets;
WriteMesh writeGmsh41Binary, writeGmsh41Text, writeGmsh22Text;
/// Binary files of version 4.1 with one block of nodes, which are numbered from 1, and one of
/// hexahedra; others as a whole.
ReadPieces readGmshTo;
/// As writeGmsh41Binary(), without a boundary.
OpenSink openGmsh41BinarySink;
/// MSH 4.1 as text, with the groups of straight meshes: edges, quads and hexahedra have the order
/// of the cells.
WriteCurved writeLagrangeGmsh;
/// Hexahedra of order 1 to 9 with all their nodes, or with 20: all of one type, which the first
/// ones have; and their tags, by the corners of tagged elements.
HoldsCurved holdsCurvedGmsh;
ReadCurved readCurvedGmsh;
/// Gmsh 4.1, binary: one file, whose entities are divided among parts, with ghost cells; or the
/// same for each part, `NAME_K.msh`, K from 1 on, with what it needs of others. Nodes and cells
/// have their global numbers, from 1 on. No tags of edges and vertices.
OpenPartSink openGmshPartSink, openSplitGmshPartSink;

// `.inp`: Abaqus and CalculiX input. Written are nodes and elements of type C3D8, numbered from 1,
// and for each group of vertices, edges and quads a node set, and for each group of boundary quads
// an element surface. Names are in upper case: element set HEXAHEDRA, node sets N_BOUNDARY,
// N_SURFACE_7, N_CURVE_3, N_POINT_1, surfaces S_BOUNDARY, S_SURFACE_7. Numbers take at most 20
// characters, since programs cut longer ones off: they read back to the same double where 20
// characters suffice, which is so for most; others are rounded, to at least 13 significant digits.
//
// Read are nodes; elements C3D8 and their variants, continuum shells, and hexahedra with 20 nodes
// as curved cells; other volume elements are counted. A region is a set that *ELEMENT or *SOLID
// SECTION names; an element surface is tagged quads. The tag is what a name of this library says,
// or the number of the set in its order. *INCLUDE is followed.
[[nodiscard]] ElementLists readAbaqus(const Input& input, ElementParts parts, Stage& stage);
using AbaqusFormat = ElementFormat<readAbaqus>;
WriteMesh writeAbaqus;
/// Order 2 only: elements C3D20, without the nodes in faces and inside. Node sets have the nodes in
/// the middle of edges, too.
WriteCurved writeQuadraticAbaqus;

// `.unv`: I-deas universal files, as SALOME and Gmsh write them; read only. Nodes are data sets
// 2411 and 781, elements 2412, groups 2467, 2477, 2452 and 2435. Groups of hexahedra are regions,
// those of quads, triangles and beams tags of these, and those of nodes as hexMeshOf() has them.
// The tag is what a name of this library says, or the number. Hexahedra with 20 nodes are curved
// cells; other volume elements are counted.
[[nodiscard]] ElementLists readUnv(const Input& input, ElementParts parts, Stage& stage);
using UnvFormat = ElementFormat<readUnv>;

// `.ele`: TetGen's tets, with their points in the file of the same name and the extension `.node`;
// read only. Numbered from 0 or 1. The first attribute of tets is their region, where all are whole
// numbers; marks of the triangles in a file with the extension `.face` are their tags, unless all
// are the same of -1, 0 and 1. Other attributes are ignored.
ReadTets readTetgen;
struct TetgenText {
  std::string_view text;
  std::string name;
};
/// @param faces  may be empty
[[nodiscard]] TetCells parseTetgen(const TetgenText& nodes, const TetgenText& faces,
                                   const Input& input, Stage& stage);

// `.exo`, `.e`: Exodus II, for the codes of Sandia and MOOSE, in NetCDF's classic layouts, and read
// also in its newer one, over HDF5. Written
// are an element block HEX8 for each region, a side set for each group of boundary quads, and node
// sets for the tags of edges and vertices; sets and blocks are named as their groups. Side sets and
// blocks have the numbers of their groups. Tagged quads inside the mesh are left out. The cells are
// in order of their regions. Offsets have 64 bits; sizes, too, where an array needs it.
//
// Read are blocks as regions, side sets as tagged quads, node sets as hexMeshOf() has them. The tag
// is what a name of this library says, or the ID. Hexahedra with 20 and 27 nodes are curved cells;
// other volume elements are counted.
[[nodiscard]] ElementLists readExodus(const Input& input, ElementParts parts, Stage& stage);
using ExodusFormat = ElementFormat<readExodus>;
/// Of an array in the layout that all readers know: 4 GB.
inline constexpr std::uint64_t kMostExodusBytes = 0xffff'fff0;
/// @param mostBytes  of an array before sizes have 64 bits; less in tests
void writeExodus(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage,
                 std::uint64_t mostBytes = kMostExodusBytes);
/// Order 2 only: blocks of HEX27. Node sets of edges have the nodes in their middle, too.
WriteCurved writeQuadraticExodus;
/// `NAME.e.N.K` for NAME.e: with Nemesis' maps of inner and shared nodes and cells. No ghosts.
OpenPartSink openExodusPartSink;

// `.cgns`: the CFD General Notation System, in HDF5; only in builds with HDF5. Writes one base with
// one unstructured zone: a section HEXA_8 for each region, QUAD_4 for each group of boundary quads
// and tagged quads inside, BAR_2 and NODE for the tags of edges and vertices, named as their
// groups; and a boundary condition, of the type FamilySpecified, for each group of boundary quads.
// The cells are in order of their regions. An empty mesh is an error.
WriteMesh writeCgns;
/// Order 2 only: sections HEXA_27, QUAD_9 and BAR_3.
WriteCurved writeQuadraticCgns;
/// Unstructured zones; several only where 1-to-1 connections say which vertices they share.
/// Sections of cells are regions where there are several, or this library named them. Boundary
/// conditions of faces and edges tag these, and those of cells are regions; the name of their
/// family, or their own, is the group's, and the tag is what a name of this library says, or the
/// number of the group in its order. Conditions of vertices are as sets of nodes in hexMeshOf().
/// Hexahedra with 20 and 27 nodes are curved cells; other volume elements are counted.
[[nodiscard]] ElementLists readCgns(const Input& input, ElementParts parts, Stage& stage);
using CgnsFormat = ElementFormat<readCgns>;
/// A zone for each part that has cells, with 1-to-1 connections of shared vertices and global
/// numbers, from 1 on, as solutions. No ghosts.
OpenPartSink openCgnsPartSink;

// MFEM mesh v1.0, text, only by the name of the format, since MFEM's files have the extension of
// MEDIT's. Writes cells (attribute: their region, or 1), boundary quads and tagged quads inside
// (attribute: the number of their group), and vertices.
WriteMesh writeMfem;
/// Nodes as a grid function of the space L2 with equidistant nodes, ends included, which lists them
/// cell by cell.
WriteCurved writeLagrangeMfem;
/// `NAME.000000` and so on: MFEM's parallel mesh, v1.2. Vertices, edges and faces that parts share
/// are in the same order in all of them. No ghosts.
OpenPartSink openMfemPartSink;

// OpenFOAM's `polyMesh`, a folder of text files. Writes points, faces, owner, neighbour and
// boundary: inner faces in upper-triangular order, then a patch for each group of boundary quads,
// named as the group; and a cell zone for each region. Tagged vertices, edges and quads inside the
// mesh are left out. Faces of more than two cells are an error.
//
// The file is `CASE/X.foam`, which becomes an empty file, as ParaView opens it, next to
// `CASE/constant/polyMesh`; or the name of the folder `polyMesh` itself. Folders are created.
// `polyMesh` is replaced as a whole, in one step; what else was in it is in the new one, too.
WriteFolder writeOpenFoam;
/// A decomposed case, beside NAME.foam or in the folder that is named: for each part
/// `processorK/constant/polyMesh`, with processor patches and the addresses of points, cells, faces
/// and patches in the mesh that writeOpenFoam() writes with a patch angle of 0. No ghosts.
/// @throws Error FileWrite if there are processor folders of more parts
OpenPartSink openOpenFoamPartSink;

}  // namespace hexhex::io
