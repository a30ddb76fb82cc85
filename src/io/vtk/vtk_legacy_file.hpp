// Legacy `.vtk` files: their sections, in any order, and where the numbers are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/core/text_scanner.hpp>
#include <io/vtk/vtk_source.hpp>

namespace hexhex {

/// An open file. Of arrays, only floating-point numbers are offered, and the regions of cells.
/// Functions throw Error FileSyntax, FileUnsupported, NotFinite or TooLarge, with the line.
class VtkLegacyFile final : public VtkSource {
 public:
  /// Reads as far as the first array behind the sections of a mesh.
  /// @param text   the whole file; outlives this, and so does the stage
  VtkLegacyFile(std::string_view text, const std::string& fileName, Stage& stage);

  /// Reads the next section, array, or beginning of several arrays.
  bool readOn() override;
  /// Reads the regions of cells if they follow as this library writes them.
  void readRegions();

 private:
  struct NumberType {
    std::string_view name;
    VtkScalar scalar;
  };
  static const std::array<NumberType, 16> kTypes;

  void readHead();
  /// Whether only arrays follow.
  [[nodiscard]] bool isBehindMesh() const { return hasPoints_ && hasCells_ && hasTypes_; }
  void readSection(const std::string& keyword);
  void beginSection(bool& present, std::string_view keyword);
  void require(bool present, std::string_view keyword) const;
  void readPoints();
  void readCells();
  void readOldCells(std::size_t numbers);

  void readAttribute(const std::string& keyword);
  void beginArrays(bool ofCells);
  void beginField();
  void readFieldArray();
  void readScalars(std::string_view name);
  void readArray(std::string_view name, std::size_t components, std::size_t tuples,
                 const NumberType& type);
  /// Number of points or cells, whichever arrays belong to.
  [[nodiscard]] std::size_t elements() const { return ofCells_ ? cells : points; }

  [[nodiscard]] std::string readKeyword();
  [[nodiscard]] const NumberType& readType();
  void skipMetadata();
  [[nodiscard]] std::size_t takeBytes(std::size_t count, std::size_t bytesEach);
  template <class What>
  [[nodiscard]] VtkColumn readNumbers(std::size_t count, const NumberType& type, VtkNumbers numbers,
                                      const What& what);
  [[nodiscard]] VtkColumn readIntegers(std::size_t count, const NumberType& type, const char* what);
  void skipNumbers(std::size_t count, const NumberType& type);

  std::string_view text_;
  Stage& stage_;
  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only of text
  bool binary_ = false;
  bool hasPoints_ = false;
  bool hasCells_ = false;
  bool hasTypes_ = false;
  bool ofCells_ = false;         ///< whether arrays belong to cells or to points
  std::size_t fieldArrays_ = 0;  ///< that follow in the field that was begun
};

}  // namespace hexhex
