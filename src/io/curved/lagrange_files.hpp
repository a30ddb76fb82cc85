// Lagrange cells in files.
#pragma once

#include <filesystem>
#include <string_view>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// The end of errors of those who read straight hexahedra.
inline constexpr std::string_view kHowCurvedCellsAreRead =
    " Cells of order 2 are curved: `hexhex view` and `hexhex improve` read them, and `hexhex "
    "convert` writes them as .vtu, .msh or MFEM .mesh.";

/// Of a mesh whose cells list their nodes in VTK's order: puts them in that of LagrangeMesh, and
/// vertices in front of other nodes.
void fromVtkOrder(LagrangeMesh& mesh, Stage& stage);

/// Whether a `.vtu` file has cells of type 72, which is VTK_LAGRANGE_HEXAHEDRON, or no straight
/// hexahedra but some with 20 or 27 nodes.
[[nodiscard]] bool holdsLagrangeVtu(const Input& input, Context& context);

/// Reads them, and generators, tags and regions as writeLagrangeVtu() writes them; tags of nodes
/// that are no corners are ignored. Other volume cells are an error.
[[nodiscard]] LagrangeMesh readLagrangeVtu(const Input& input, Context& context);

/// The same of legacy `.vtk` files, which have cells with 20 or 27 nodes.
[[nodiscard]] bool holdsCurvedVtkLegacy(const Input& input, Context& context);
[[nodiscard]] LagrangeMesh readCurvedVtkLegacy(const Input& input, Context& context);

/// `.vtu`: cell type 72, with the arrays of straight meshes.
void writeLagrangeVtu(const LagrangeMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& options, Context& context);

/// MSH 4.1 as text, with the groups of straight meshes: edges, quads and hexahedra have the order
/// of the cells.
/// @throws Error FileWrite; InvalidArgument for tagged edges and quads that no cell has
void writeLagrangeGmsh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);

/// MFEM: boundary quads with attributes as in straight meshes; nodes as a grid function of the
/// space L2 with equidistant nodes, ends included, which lists them cell by cell.
void writeLagrangeMfem(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);

}  // namespace hexhex::io
