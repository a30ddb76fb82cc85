// A part as a data set of VTK.
#pragma once

#include <hexhex/parts.hpp>

#include <io/vtk/vtk_data_set.hpp>

namespace hexhex::io {

/// VTK's mark of points and cells that another part owns.
inline constexpr std::uint8_t kVtkDuplicate = 1;

/// Points, generators, tags, regions, global numbers and, if there are ghosts in the mesh, which
/// points and cells of the part belong to others. All parts have the same arrays of points and
/// cells. Empty arrays of tags are left out.
/// @param part, piece  outlive the data set
[[nodiscard]] VtkDataSet partDataSet(const MeshPart& part, const PartsInfo& info, VtkPiece& piece);

}  // namespace hexhex::io
