// Formats of meshes in parts: what each of them writes. (docs/parts.md)
#pragma once

#include <filesystem>
#include <memory>

#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>

#include <io/core/input_file.hpp>

namespace hexhex::io {

using OpenPartSink = std::unique_ptr<PartSink>(const std::filesystem::path& file,
                                               const WriteOptions& options, Context& context,
                                               ProcessTeam* team);

/// `NAME.pvtu`, and in the folder NAME a piece `NAME_K.vtu` for each part: as writeVtu() writes it,
/// without scaled_jacobian, with GlobalPointIds and GlobalCellIds and, if there are ghosts,
/// vtkGhostType.
OpenPartSink openPvtuSink;

/// Glues such pieces: those of any program that gives all vertices and cells global numbers.
/// @throws Error  as readVtu() of each piece; FileUnsupported without global numbers
[[nodiscard]] HexMesh readPvtu(const Input& input, Context& context);

/// A decomposed case of OpenFOAM, beside NAME.foam or in the folder that is named: for each part
/// `processorK/constant/polyMesh`, with processor patches and the addresses of points, cells, faces
/// and patches in the mesh that writeOpenFoam() writes with a patch angle of 0.
/// @throws Error FileWrite if there are processor folders of more parts; FileUnsupported for ghosts
OpenPartSink openOpenFoamPartSink;

/// One `.vtkhdf` file with all parts, in builds with HDF5: version 1.0 of the format, with the
/// arrays of the pieces above; tags of edges and quads by global numbers.
OpenPartSink openVtkHdfPartSink;

/// `NAME.e.N.K` for NAME.e: Exodus with Nemesis' maps of inner and shared nodes and cells.
/// @throws Error FileUnsupported for ghosts
OpenPartSink openExodusPartSink;

/// Gmsh 4.1, binary: one file, whose entities are divided among parts, with ghost cells; or the
/// same for each part, `NAME_K.msh`, K from 1 on, with what it needs of others. Nodes and cells
/// have their global numbers, from 1 on. No tags of edges and vertices.
OpenPartSink openGmshPartSink;
OpenPartSink openSplitGmshPartSink;

/// `NAME.000000` and so on: MFEM's parallel mesh, v1.2. Vertices, edges and faces that parts share
/// are in the same order in all of them.
/// @throws Error FileUnsupported for ghosts
OpenPartSink openMfemPartSink;

/// One `.cgns` file, in builds with HDF5: a zone for each part that has cells, with 1-to-1
/// connections of shared vertices and global numbers, from 1 on, as solutions.
/// @throws Error FileUnsupported for ghosts; TooLarge for a part beyond 32 bits
OpenPartSink openCgnsPartSink;

}  // namespace hexhex::io
