// NetCDF files in the classic format: a header with dimensions, attributes and variables, then the
// values of each variable, big-endian.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <hexhex/types.hpp>

#include <io/core/hdf_reader.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

enum class NetcdfType : std::uint32_t {
  Char = 2,
  Int = 4,
  Float = 5,
  Double = 6
};  ///< codes of the format

struct NetcdfDimension {
  std::string name;
  std::uint64_t length = 0;  ///< 0: the record dimension, which has no records
};
struct NetcdfAttribute {
  std::string name;
  std::variant<std::string, std::int32_t, float> value;
};
struct NetcdfVariable {
  std::string name;
  NetcdfType type = NetcdfType::Int;
  std::vector<std::uint32_t>
      dimensions;  ///< by their indices in the file; the last one varies fastest
  std::vector<NetcdfAttribute> attributes;
  std::function<void(LineWriter&)> write;  ///< writes all values; null if there are none
};

struct NetcdfFile {
  std::vector<NetcdfDimension> dimensions;
  std::vector<NetcdfAttribute> attributes;
  std::vector<NetcdfVariable> variables;

  /// Position in the file of a variable's values.
  [[nodiscard]] std::uint64_t positionOf(std::string_view name, std::uint64_t mostBytes) const;

  /// @param threads    as in Context
  /// @param mostBytes  maximum size of a variable in the layout CDF-2; larger ones require CDF-5
  void write(OutputFile& output, int threads, std::uint64_t mostBytes) const;
};

/// Refuses a file, given its first bytes, that is not in a classic layout.
/// @throws Error FileSyntax
void requireNetcdf(std::string_view head, const std::string& fileName);

/// Opens a file in one of the classic layouts CDF-1, CDF-2 and CDF-5. Its variables are datasets,
/// as in the HDF5 files that are NetCDF-4; of their attributes, "elem_type" is known.
/// @param bytes  of the whole file; must outlive the result, as must the name
/// @throws Error FileSyntax with the byte
[[nodiscard]] std::unique_ptr<HdfReader> openNetcdf(std::string_view bytes,
                                                    const std::string& fileName);

}  // namespace hexhex::io
