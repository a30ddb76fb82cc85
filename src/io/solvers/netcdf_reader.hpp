// Reads files in NetCDF's classic layouts: "CDF-1", "CDF-2" and "CDF-5".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// Of a file, or its first bytes, whether it is in one of these layouts.
/// @throws Error FileSyntax; FileUnsupported for NetCDF's newer files, over HDF5
void requireNetcdf(std::string_view head, const std::string& fileName);

/// A variable of a file: where its values are, and how many.
struct NetcdfValues {
  std::string name;
  std::uint32_t type = 0;  ///< the format's
  std::vector<std::uint64_t> lengths;
  std::string elementType;  ///< the attribute "elem_type"
  std::uint64_t count = 0;
  std::uint64_t begin = 0;
};

class NetcdfReader {
 public:
  /// Reads the head.
  /// @param bytes  of the whole file; outlive this, and so does the name
  /// @throws Error FileSyntax with the byte; FileUnsupported for NetCDF's newer files, over HDF5
  NetcdfReader(std::string_view bytes, const std::string& fileName);

  /// Null if there is none.
  [[nodiscard]] const NetcdfValues* find(std::string_view name) const;
  /// The same of one that must be there. @throws Error FileSyntax
  [[nodiscard]] const NetcdfValues& get(std::string_view name) const;

  /// @throws Error FileSyntax for values of another kind
  [[nodiscard]] std::vector<std::int64_t> integers(const NetcdfValues& values) const;
  [[nodiscard]] std::vector<double> reals(const NetcdfValues& values) const;
  /// Rows of letters, each up to its first zero.
  [[nodiscard]] std::vector<std::string> texts(const NetcdfValues& values) const;

 private:
  std::string_view bytes_;
  const std::string& fileName_;
  std::vector<NetcdfValues> variables_;
};

}  // namespace hexhex::io
