// A data set of VTK as those who read one see it: points, cells and named arrays, wherever their
// numbers are and however they are stored. Formats fill it in; vtk_reader.hpp makes meshes of it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/number_source.hpp>
#include <io/core/text_scanner.hpp>
#include <io/vtk/vtk_data_set.hpp>

namespace hexhex::io {

/// The number types that are read: a zero of the type.
using VtkScalar =
    std::variant<double, float, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
                 std::int32_t, std::uint32_t, std::int64_t, std::uint64_t>;

template <class T>
[[nodiscard]] constexpr bool isOf(const VtkScalar& scalar) noexcept {
  return std::holds_alternative<T>(scalar);
}
[[nodiscard]] std::size_t bytesOf(const VtkScalar& scalar);

/// What numbers are needed as. Arrays of others, like strings, are never needed.
enum class VtkNumbers : std::uint8_t { Integers, Reals, Others };

/// Where the numbers of an array are, and how they are stored.
struct VtkColumn {
  VtkScalar scalar = {};
  bool bigEndian = false;  ///< the largest byte first; otherwise in this machine's order
  std::uint64_t count = 0;
  std::uint64_t position = 0;  ///< in the file, or in `decoded`
  Array<char> decoded = {};    ///< what the file does not hold as plain bytes
};

/// An array of a file.
struct VtkSourceArray {
  VtkSection section = VtkSection::FieldData;
  std::string name;
  VtkNumbers numbers = VtkNumbers::Others;
  std::size_t components = 1;
  bool appended = false;  ///< to the head of an XML file, as this library writes arrays
  /// Finds the numbers: of this kind, and so many if it is told.
  std::function<VtkColumn(VtkNumbers, std::optional<std::uint64_t> count)> load = {};
};

/// The bytes of a file: all of them in memory, or its head only.
struct VtkFileBytes {
  std::unique_ptr<InputFile> file;  ///< where the rest is; null: nowhere else
  Array<char> room;                 ///< for `text`, unless that was in memory before
  std::string_view text;            ///< what is in memory
};

/// An open file.
class VtkSource {
 public:
  VtkSource(VtkFileBytes content, std::string fileName)
      : content_(std::move(content)),
        fileName_(std::move(fileName)),
        bytes_(content_.file ? ByteFile(*content_.file, fileName_)
                             : ByteFile(content_.text, fileName_)) {}
  virtual ~VtkSource() = default;
  // Arrays refer to the file.
  VtkSource(const VtkSource&) = delete;
  VtkSource& operator=(const VtkSource&) = delete;

  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  VtkColumn coordinates;
  VtkColumn types;
  /// Where cells end in `connectivity`; or one number more: where they begin and the last one ends.
  VtkColumn offsets;
  /// How many numbers of `connectivity` each cell has, if all have as many and no offsets say it.
  std::size_t stride = 0;
  VtkColumn connectivity;
  std::size_t gap = 0;  ///< how many numbers stand in `connectivity` in front of a cell's corners

  std::shared_ptr<CellCounts> counts;  ///< of the input

  std::vector<VtkSourceArray> arrays;
  /// Arrays of points and cells, for messages: the first of them, and how many more there are.
  std::vector<std::string> seen;
  std::size_t unnamed = 0;

  /// Goes on to more arrays; false if all are known.
  virtual bool readOn() { return false; }
  /// Throws TooLarge if points or cells are more than an Index can count.
  virtual void requireIndexable() const {}

  /// The first array of a section with this name and form; null if there is none.
  /// @param begin  how many arrays are passed over
  [[nodiscard]] const VtkSourceArray* find(VtkSection section, std::string_view name,
                                           std::size_t components, VtkNumbers numbers,
                                           std::size_t begin = 0) const;
  /// Its numbers: a tuple for each point or cell, if it belongs to them.
  [[nodiscard]] VtkColumn load(const VtkSourceArray& array) const;

  /// Copies numbers [begin, begin + count) of a column. T is double, std::int64_t, or the very type
  /// of the column. Thread-safe.
  template <class T>
  void copy(const VtkColumn& column, std::uint64_t begin, std::size_t count, T* to) const;

  /// Throws an error about the file.
  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place = {}) const {
    throw Error(code, fileName_ + ": " + sentence, place);
  }

 protected:
  /// Notes an array of points or cells for messages.
  void see(std::string_view name, bool ofCells, std::size_t components);

  [[nodiscard]] std::string_view text() const noexcept { return content_.text; }
  [[nodiscard]] std::uint64_t fileSize() const noexcept { return bytes_.size(); }

 private:
  VtkFileBytes content_;
  std::string fileName_;
  ByteFile bytes_;
};

/// Opens a `.vtu` file, without the whole of it in memory if its arrays are appended as plain
/// bytes. Every size and offset is checked against the file.
/// @param input, stage  outlive the source
/// @throws Error FileSyntax, FileUnsupported, NotFinite
[[nodiscard]] std::unique_ptr<VtkSource> openVtuFile(const Input& input, Stage& stage);

/// Opens a legacy `.vtk` file, and reads as far as the first array behind the sections of a mesh.
/// Of arrays, those of numbers are offered that come behind the mesh, and the regions of cells.
/// @param withRegions  reads the regions of cells if they follow as this library writes them
/// @throws Error FileSyntax, FileUnsupported, NotFinite or TooLarge, with the line
[[nodiscard]] std::unique_ptr<VtkSource> openVtkLegacyFile(const Input& input, bool withRegions,
                                                           Stage& stage);

/// A column for `count` numbers of text, to be filled in by readVtkNumber().
[[nodiscard]] VtkColumn textColumn(VtkNumbers numbers, std::size_t count);

/// Reads a number that is text, as number i of a column.
void readVtkNumber(TextScanner& scanner, VtkNumbers numbers, VtkColumn& column, std::size_t i,
                   const NumberName& name);

}  // namespace hexhex::io
