// Files in NetCDF's classic format: a head with dimensions, attributes and variables, then the
// values of one variable after the other, the largest byte of each first.
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
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

enum class NetcdfType : std::uint32_t {
  Char = 2,
  Int = 4,
  Float = 5,
  Double = 6
};  ///< the format's

struct NetcdfDimension {
  std::string name;
  std::uint64_t length = 0;  ///< 0: the number of records, of which there are none
};
struct NetcdfAttribute {
  std::string name;
  std::variant<std::string, std::int32_t, float> value;
};
struct NetcdfVariable {
  std::string name;
  NetcdfType type = NetcdfType::Int;
  std::vector<std::uint32_t>
      dimensions;  ///< by their places in the file; the last one runs fastest
  std::vector<NetcdfAttribute> attributes;
  std::function<void(LineWriter&)> write;  ///< all values; null if there is none
};

struct NetcdfFile {
  std::vector<NetcdfDimension> dimensions;
  std::vector<NetcdfAttribute> attributes;
  std::vector<NetcdfVariable> variables;

  /// Where the values of the variable of that name begin in the file.
  [[nodiscard]] std::uint64_t positionOf(std::string_view name, std::uint64_t mostBytes) const;

  /// @param threads    as in Context
  /// @param mostBytes  of a variable in the layout "CDF-2"; larger ones take the newer "CDF-5"
  void write(OutputFile& output, int threads, std::uint64_t mostBytes) const;
};

// Reads files in NetCDF's classic layouts, "CDF-1", "CDF-2" and "CDF-5", and its newer files, which
// are HDF5 files with a dataset for each variable ("NetCDF-4").

/// Of a file, or its first bytes, whether it is in one of these layouts.
/// @throws Error FileSyntax
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
  /// @throws Error FileSyntax with the byte
  NetcdfReader(std::string_view bytes, const std::string& fileName);
  /// Of a newer file.
  NetcdfReader(std::unique_ptr<HdfReader> file, const std::string& fileName);

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
  std::unique_ptr<HdfReader> hdf_;  ///< of a newer file; null: it is in bytes_
  const std::string& fileName_;
  std::vector<NetcdfValues> variables_;  ///< by name
};

}  // namespace hexhex::io
