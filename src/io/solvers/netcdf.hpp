// Files in NetCDF's classic format: a head with dimensions, attributes and variables, then the
// values of one variable after the other, the largest byte of each first.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

}  // namespace hexhex::io
