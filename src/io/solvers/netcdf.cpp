#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include <io/solvers/netcdf.hpp>

namespace hexhex::io {
namespace {

constexpr std::uint64_t aligned(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

std::uint64_t bytesInFile(const NetcdfFile& file, const NetcdfVariable& variable) {
  std::uint64_t bytes = variable.type == NetcdfType::Char     ? 1
                        : variable.type == NetcdfType::Double ? 8
                                                              : 4;
  for (const std::uint32_t place : variable.dimensions) bytes *= file.dimensions[place].length;
  return bytes;
}

/// Makes the head of a file.
struct NetcdfHead {
  bool wide;  ///< counts take 8 bytes instead of 4
  std::string bytes;

  template <class T>
  void add(T number) {
    std::array<char, sizeof(T)> big{};
    bytes.append(big.data(), putBigBytes(big.data(), number));
  }
  void addCount(std::uint64_t count) { wide ? add(count) : add(static_cast<std::uint32_t>(count)); }
  void addText(std::string_view text) {
    addCount(text.size());
    bytes += text;
    bytes.resize(aligned(bytes.size()));
  }
  void beginList(std::uint32_t tag, std::size_t length) {
    add(length == 0 ? 0 : tag);
    addCount(length);
  }

  template <class T>
  void addValue(const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      add(NetcdfType::Char);
      return addText(value);
    } else {
      add(std::is_same_v<T, float> ? NetcdfType::Float : NetcdfType::Int);
      addCount(1);
      add(value);
    }
  }
  void addAttributes(const std::vector<NetcdfAttribute>& attributes) {
    beginList(12, attributes.size());
    for (const NetcdfAttribute& attribute : attributes) {
      addText(attribute.name);
      std::visit([this](const auto& value) { addValue(value); }, attribute.value);
    }
  }
};

/// @param begin  where the values begin
std::string headOf(const NetcdfFile& file, bool wide, std::uint64_t begin) {
  NetcdfHead head{wide, wide ? "CDF\5" : "CDF\2"};
  head.addCount(0);  // records
  head.beginList(10, file.dimensions.size());
  for (const NetcdfDimension& dimension : file.dimensions) {
    head.addText(dimension.name);
    head.addCount(dimension.length);
  }
  head.addAttributes(file.attributes);
  head.beginList(11, file.variables.size());
  // Records, of which there are none, begin behind all else: NetCDF refuses a file otherwise.
  std::uint64_t records = begin;
  for (const NetcdfVariable& variable : file.variables) {
    records += aligned(bytesInFile(file, variable));
  }
  for (const NetcdfVariable& variable : file.variables) {
    head.addText(variable.name);
    head.addCount(variable.dimensions.size());
    for (const std::uint32_t place : variable.dimensions) head.addCount(place);
    head.addAttributes(variable.attributes);
    head.add(variable.type);
    const std::uint64_t bytes = aligned(bytesInFile(file, variable));
    head.addCount(bytes);
    head.add(bytes == 0 ? records : begin);
    begin += bytes;
  }
  return std::move(head.bytes);
}

/// Whether the file takes the newer layout.
bool isWide(const NetcdfFile& file, std::uint64_t mostBytes) {
  return std::any_of(
      file.variables.begin(), file.variables.end(),
      [&](const NetcdfVariable& variable) { return bytesInFile(file, variable) > mostBytes; });
}

}  // namespace

std::uint64_t NetcdfFile::positionOf(std::string_view name, std::uint64_t mostBytes) const {
  std::uint64_t position = headOf(*this, isWide(*this, mostBytes), 0).size();
  for (const NetcdfVariable& variable : variables) {
    if (variable.name == name) break;
    position += aligned(bytesInFile(*this, variable));
  }
  return position;
}

void NetcdfFile::write(OutputFile& output, int threads, std::uint64_t mostBytes) const {
  const bool wide = isWide(*this, mostBytes);
  output.write(headOf(*this, wide, headOf(*this, wide, 0).size()));
  LineWriter values(output, threads);
  for (const NetcdfVariable& variable : variables) {
    if (variable.write != nullptr) variable.write(values);
    const std::uint64_t bytes = bytesInFile(*this, variable);
    output.write(std::string(aligned(bytes) - bytes, '\0'));
  }
}

}  // namespace hexhex::io
