// What all VTKHDF files have in common.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <io/core/hdf_file.hpp>

namespace hexhex::io {

/// HDF5's type of the numbers that VTK's XML calls so, in memory.
[[nodiscard]] inline hid_t vtkHdfTypeOf(std::string_view name) {
  if (name == "Float64") return HDF5(H5T_NATIVE_DOUBLE_g);
  if (name == "Int64") return HDF5(H5T_NATIVE_INT64_g);
  if (name == "Int32") return HDF5(H5T_NATIVE_INT32_g);
  if (name == "UInt32") return HDF5(H5T_NATIVE_UINT32_g);
  return HDF5(H5T_NATIVE_UINT8_g);
}

/// The attributes by which VTK knows the format.
inline void writeVtkHdfKind(const HdfFile& file, hid_t grid) {
  constexpr std::array<std::int64_t, 2> kVersion = {1, 0};
  file.writeAttribute(grid, "Version", HDF5(H5T_NATIVE_INT64_g), file.space({2}), kVersion.data());
  const std::string kind = "UnstructuredGrid";
  const HdfObject text = file.text(kind.size(), H5T_STR_NULLPAD);
  file.writeAttribute(grid, "Type", text.id(), file.space({}), kind.data());
}

}  // namespace hexhex::io
