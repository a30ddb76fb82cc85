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

// Reads the classic layouts CDF-1, CDF-2 and CDF-5, and NetCDF-4, which is an HDF5 file with a
// dataset per variable.

/// Refuses a file, given its first bytes, that is not in a classic layout.
/// @throws Error FileSyntax
void requireNetcdf(std::string_view head, const std::string& fileName);

/// A variable of a file: position, type and shape of its values.
struct NetcdfValues {
  std::string name;
  std::uint32_t type = 0;  ///< type code of the format
  std::vector<std::uint64_t> lengths;
  std::string elementType;  ///< the attribute "elem_type"
  std::uint64_t count = 0;
  std::uint64_t begin = 0;
};

class NetcdfReader {
 public:
  /// Reads the header.
  /// @param bytes  of the whole file; must outlive this, as must the name
  /// @throws Error FileSyntax with the byte
  NetcdfReader(std::string_view bytes, const std::string& fileName);
  /// Opens a NetCDF-4 file.
  NetcdfReader(std::unique_ptr<HdfReader> file, const std::string& fileName);

  /// The variable of a name; null if there is none.
  [[nodiscard]] const NetcdfValues* find(std::string_view name) const;
  /// The same for a mandatory variable. @throws Error FileSyntax
  [[nodiscard]] const NetcdfValues& get(std::string_view name) const;

  /// @throws Error FileSyntax if values are of another kind
  [[nodiscard]] std::vector<std::int64_t> integers(const NetcdfValues& values) const;
  [[nodiscard]] std::vector<double> reals(const NetcdfValues& values) const;
  /// Rows of characters, each up to its first zero byte.
  [[nodiscard]] std::vector<std::string> texts(const NetcdfValues& values) const;

 private:
  /// The numbers of a variable of one of two types, of 32 and of 64 bits.
  template <class Narrow, class Number>
  [[nodiscard]] std::vector<Number> numbers(const NetcdfValues& values, std::uint32_t narrow,
                                            std::uint32_t wide, const char* what) const;

  std::string_view bytes_;
  std::unique_ptr<HdfReader> hdf_;  ///< NetCDF-4 files only; null: classic layout in bytes_
  const std::string& fileName_;
  std::vector<NetcdfValues> variables_;  ///< sorted by name
};

}  // namespace hexhex::io
