// A `.vtu` file as its readers see it: what its tags say, and its arrays, a range at a time, no
// matter whether they are in memory or on the disk. Every size and offset is checked against the
// file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/vtk/xml_tags.hpp>

namespace hexhex {

/// The number types of VTK that are supported.
enum class VtuScalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

/// What the arrays of a file belong to.
enum class VtuSection : std::uint8_t { Field, Points, Cells };

/// Where the numbers of an array are, and how they are stored.
struct VtuColumn {
  VtuScalar scalar = VtuScalar::Float64;
  std::size_t bytesEach = 1;
  std::uint64_t count = 0;
  std::uint64_t position = 0;  ///< in the file, or in `decoded`
  bool inMemory = false;
  Array<char> decoded;  ///< the numbers of an array that the file does not hold as plain bytes
};

/// An open file. Functions throw Error FileSyntax, FileUnsupported or FileNotFound.
class VtuFile {
 public:
  /// @param text   the whole file; outlives this
  /// @param stage  for parallel decoding; outlives this
  VtuFile(std::string_view text, const std::string& fileName, Stage& stage);
  /// Whether a file's arrays are appended to its head as plain bytes, so that it can be read in
  /// pieces.
  [[nodiscard]] static bool hasPlainAppendedData(const InputFile& input);
  /// Reads the head of a file with plain appended data.
  /// @param input  outlives this; a regular file
  VtuFile(const InputFile& input, const std::string& fileName);

  [[nodiscard]] std::uint64_t pointCount() const noexcept { return pointCount_; }
  [[nodiscard]] std::uint64_t cellCount() const noexcept { return cellCount_; }
  /// Throws TooLarge if points or cells are more than an Index can count.
  void requireIndexable() const;

  [[nodiscard]] const VtuColumn& coordinates() const noexcept { return coordinates_; }
  [[nodiscard]] const VtuColumn& connectivity() const noexcept { return connectivity_; }
  [[nodiscard]] const VtuColumn& ends() const noexcept { return ends_; }
  [[nodiscard]] const VtuColumn& types() const noexcept { return types_; }
  /// As this library writes them, else nothing.
  [[nodiscard]] const std::optional<VtuColumn>& generatorTets() const noexcept {
    return generatorTets_;
  }
  [[nodiscard]] const std::optional<VtuColumn>& generatorCorners() const noexcept {
    return generatorCorners_;
  }

  /// The first array of cells or points with this name, this many components per tuple and
  /// floating-point numbers, which must have a tuple for each cell or point.
  [[nodiscard]] std::optional<VtuColumn> findReals(std::string_view name, bool ofCells,
                                                   std::size_t components) const;
  /// The first array of a section with this name, this many components per tuple and integers. One
  /// of points or cells must have a tuple for each.
  [[nodiscard]] std::optional<VtuColumn> findIntegers(std::string_view name, VtuSection section,
                                                      std::size_t components) const;
  /// All arrays of points and cells, each with its name and number of components.
  [[nodiscard]] std::vector<std::string> describeArrays() const;

  /// Copies numbers [begin, begin + count) of a column. T is double, std::int64_t, or the very type
  /// of the column. Thread-safe.
  template <class T>
  void copy(const VtuColumn& column, std::uint64_t begin, std::size_t count, T* to) const;

  /// Throws an error about the file.
  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place = {}) const {
    throw Error(code, fileName_ + ": " + sentence, place);
  }

 private:
  /// A DataArray element: its tag, and the text up to the next tag.
  struct ArrayTag {
    XmlTag tag;
    std::string_view content;
  };
  /// An array of the data set, points or cells.
  struct DataArray {
    ArrayTag array;
    VtuSection section = VtuSection::Field;
  };
  enum class Kind { Integers, Reals };

  void readHead();
  void readFileTag(const XmlTag& tag);
  void readPieceTag(const XmlTag& tag);
  void readArrayTag(const XmlTag& tag, std::string_view section);
  void readAppendedTag(const XmlTag& tag);
  [[nodiscard]] std::uint64_t readCount(const XmlTag& tag, std::string_view attribute) const;
  void findColumns();
  [[nodiscard]] VtuColumn column(const std::optional<ArrayTag>& array, const char* what, Kind kind,
                                 std::optional<std::uint64_t> count) const;
  [[nodiscard]] VtuColumn typedColumn(const ArrayTag& array, Kind kind) const;
  [[nodiscard]] VtuColumn appendedColumn(const ArrayTag& array, Kind kind) const;
  [[nodiscard]] VtuColumn decodedColumn(const ArrayTag& array, Kind kind) const;
  [[nodiscard]] static std::size_t componentsOf(const ArrayTag& array);
  [[nodiscard]] const DataArray* findArray(std::string_view name, VtuSection section,
                                           std::size_t components, Kind kind) const;
  [[nodiscard]] VtuColumn parsedColumn(const ArrayTag& array, Kind kind,
                                       std::optional<std::uint64_t> count) const;
  [[nodiscard]] std::optional<VtuColumn> generatorColumn(const std::optional<ArrayTag>& array,
                                                         VtuScalar scalar) const;
  void readBytes(std::uint64_t position, std::size_t size, char* to) const;

  const InputFile* input_ = nullptr;
  Stage* stage_ = nullptr;
  Array<char> headBytes_;   ///< of a file that is not in memory
  std::string_view text_;   ///< the file, or its head
  std::uint64_t fileSize_;  ///< of the whole file
  std::string fileName_;
  XmlTags tags_;

  std::uint64_t pointCount_ = 0;
  std::uint64_t cellCount_ = 0;
  bool hasFileTag_ = false;
  std::optional<std::size_t> piece_;  ///< where its tag begins
  std::size_t lengthBytes_ = 4;       ///< of the numbers in front of encoded arrays
  bool compressed_ = false;
  bool appendedBase64_ = false;
  std::optional<std::uint64_t> appended_;  ///< position behind the '_' of AppendedData
  std::vector<DataArray> dataArrays_;
  std::optional<ArrayTag> coordinatesTag_;
  std::optional<ArrayTag> connectivityTag_;
  std::optional<ArrayTag> endsTag_;
  std::optional<ArrayTag> typesTag_;
  std::optional<ArrayTag> generatorTetsTag_;
  std::optional<ArrayTag> generatorCornersTag_;

  VtuColumn coordinates_;
  VtuColumn connectivity_;
  VtuColumn ends_;  ///< VTK's "offsets"
  VtuColumn types_;
  std::optional<VtuColumn> generatorTets_;
  std::optional<VtuColumn> generatorCorners_;
};

}  // namespace hexhex
