// Lagrange cells in files.
#pragma once

#include <filesystem>

#include <hexhex/curved.hpp>

namespace hexhex::io {

/// Whether a `.vtu` file has cells of type 72, which is VTK_LAGRANGE_HEXAHEDRON.
[[nodiscard]] bool holdsLagrangeVtu(const std::filesystem::path& file, Context& context);

/// Reads them, and generators, tags and regions as writeLagrangeVtu() writes them; tags of nodes
/// that are no corners are ignored. Other volume cells are an error.
[[nodiscard]] LagrangeMesh readLagrangeVtu(const std::filesystem::path& file, Context& context);

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
