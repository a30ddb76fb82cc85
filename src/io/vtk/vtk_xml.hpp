// VTK XML files of any kind of elements, with raw binary data appended.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtu_content.hpp>

namespace hexhex {

/// The arrays of a file, in the order in which they are written.
class VtkXmlFile {
 public:
  /// Bytes of an array, written when its turn has come.
  using Write = std::function<void(OutputFile&)>;

  /// @param section  "FieldData", "PointData", "CellData", "Points", "Cells", "Lines" or "Polys"
  void add(std::string section, std::string name, std::string_view type, std::size_t components,
           std::uint64_t count, std::size_t bytesEach, Write write);

  /// An array as it lies in memory. The memory must live until write().
  template <class T>
  void add(std::string section, std::string name, std::span<const T> values) {
    const auto bytes = values.size_bytes();
    add(std::move(section), std::move(name), typeName<T>(), 1, values.size(), sizeof(T),
        [data = values.data(), bytes](OutputFile& output) { output.writeBytes(data, bytes); });
  }
  /// Vectors.
  template <class T, std::size_t n>
  void add(std::string section, std::string name, std::span<const std::array<T, n>> values) {
    const auto bytes = values.size_bytes();
    add(std::move(section), std::move(name), typeName<T>(), n, values.size(), n * sizeof(T),
        [data = values.data(), bytes](OutputFile& output) { output.writeBytes(data, bytes); });
  }
  /// valueOf(i) for every i in [0, count).
  template <class T, class F>
  void addComputed(std::string section, std::string name, std::uint64_t count, const F& valueOf) {
    add(std::move(section), std::move(name), typeName<T>(), 1, count, sizeof(T),
        [count, valueOf](OutputFile& output) { writeValues<T>(output, count, valueOf); });
  }

  /// Writes and commits the file.
  /// @param type      "UnstructuredGrid" or "PolyData"
  /// @param piece     attributes of the piece: its counts
  /// @param sections  of the piece, in the order of the file
  void write(OutputFile& output, std::string_view type, const std::string& piece,
             std::span<const std::string_view> sections, Stage& stage) const;

 private:
  struct Entry {
    std::string section;
    std::string tag;
    std::uint64_t bytes;
    Write write;
  };
  template <class T>
  static constexpr std::string_view typeName() {
    if constexpr (std::same_as<T, double>) return "Float64";
    if constexpr (std::same_as<T, std::uint8_t>) return "UInt8";
    if constexpr (std::same_as<T, std::int32_t>) return "Int32";
    if constexpr (std::same_as<T, std::uint32_t>) return "UInt32";
    if constexpr (std::same_as<T, std::int64_t>) return "Int64";
  }

  std::vector<Entry> entries_;
};

}  // namespace hexhex
