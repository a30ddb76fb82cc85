// MFEM mesh v1.0, for simulations. Written only, and only by the name of the format, since MFEM's
// files have the extension of MEDIT's.
#pragma once

#include <cstdint>
#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>

namespace hexhex {

/// What all files begin with: cells and quads by their vertices, with attributes.
class MfemElements {
 public:
  /// @param mesh  must outlive this
  /// @throws Error InvalidArgument for features that are not in the mesh
  MfemElements(const HexMesh& mesh, double patchAngle, Stage& stage, int threads);

  [[nodiscard]] std::size_t count() const { return mesh_.cells.size() + quads_.elements.size(); }
  /// @param progress  advances by count()
  void write(OutputFile& output, LineWriter& lines, LoopProgress& progress) const;

 private:
  const HexMesh& mesh_;
  QuadGroups quads_;
  Array<std::uint32_t> attributes_;  ///< per quad
  Array<std::uint32_t> regions_;     ///< per cell; empty: all are 1
};

/// Writes cells (attribute 1), boundary quads and tagged quads inside (attribute: the number of
/// their group, see mesh_groups.hpp), and vertices. Numbers have the fewest digits (at most 17)
/// that read back to the same double.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context);

}  // namespace hexhex
