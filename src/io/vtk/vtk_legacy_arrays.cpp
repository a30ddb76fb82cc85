#include <charconv>
#include <cstdint>

#include <hexhex/error.hpp>

#include <io/core/text_scanner.hpp>
#include <io/vtk/vtk_legacy_arrays.hpp>

namespace hexhex {
namespace {

/// VTK writes characters of names that separate tokens as "%20".
std::string decodedVtkName(std::string_view token) {
  std::string name;
  for (std::size_t i = 0; i < token.size(); ++i) {
    unsigned code = 0;
    const char* const digits = token.data() + i + 1;
    const bool coded = token[i] == '%' && token.size() - i > 2 &&
                       std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    name += coded ? static_cast<char>(code) : token[i];
    if (coded) i += 2;
  }
  return name;
}

}  // namespace

std::optional<GridMap> VtkLegacyArrays::readMap(std::size_t points, std::size_t cells) {
  behindMesh_ = true;
  points_ = points;
  cells_ = cells;
  while (!mapArray_.empty() && !map_ && source_.scanner().skipSpace()) {
    readAttribute(source_.readKeyword());
  }
  return std::move(map_);
}

/// Reads one array, or the beginning of the arrays of points or cells.
void VtkLegacyArrays::readAttribute(const std::string& keyword) {
  if (keyword == "metadata") return source_.skipMetadata();
  if (keyword == "field") return readField();
  if (keyword == "point_data" || keyword == "cell_data") return beginArrays(keyword == "cell_data");
  TextScanner& scanner = source_.scanner();
  const std::string_view name = scanner.readToken();
  const auto array = [&](std::size_t components, const VtkNumberType& type) {
    readArray(name, components, elements(), type);
  };
  const VtkNumberType& colour = source_.binary() ? kVtkByte : kVtkFloat;
  if (keyword == "scalars") return readScalars(name);
  if (keyword == "vectors" || keyword == "normals") return array(3, source_.readType());
  if (keyword == "tensors") return array(9, source_.readType());
  if (keyword == "tensors6") return array(6, source_.readType());
  if (keyword == "global_ids" || keyword == "pedigree_ids") return array(1, source_.readType());
  if (keyword == "texture_coordinates") {
    const std::size_t components = scanner.readCount("components", 1);
    return array(components, source_.readType());
  }
  if (keyword == "color_scalars") return array(scanner.readCount("components", 1), colour);
  if (keyword == "lookup_table") {
    return source_.skipNumbers(4 * scanner.readCount("colours", 4), colour);
  }
  scanner.fail(ErrorCode::FileSyntax, "expected a keyword of point or cell data, found " +
                                          quoted(std::string_view(keyword)) + ".");
}

void VtkLegacyArrays::beginArrays(bool ofCells) {
  ofCells_ = ofCells;
  std::int64_t count = 0;
  TextScanner& scanner = source_.scanner();
  if (!scanner.readInteger(count)) scanner.failInteger("the number of values");
  if (count >= 0 && static_cast<std::uint64_t>(count) == elements()) return;
  scanner.fail(ErrorCode::FileSyntax, "the arrays are for " + std::to_string(count) +
                                          (ofCells ? " cells" : " points") + ", but the file has " +
                                          std::to_string(elements()) + ".");
}

/// "SCALARS name type components", where the last may be missing, and the name of a table of
/// colours.
void VtkLegacyArrays::readScalars(std::string_view name) {
  constexpr std::string_view kTable = "lookup_table";
  TextScanner& scanner = source_.scanner();
  const VtkNumberType& type = source_.readType();
  std::size_t components = 1;
  if (lowerCase(scanner.peekToken()) != kTable) components = scanner.readCount("components", 1);
  if (lowerCase(scanner.peekToken()) == kTable) {
    scanner.readToken();
    scanner.readToken();
  }
  readArray(name, components, elements(), type);
}

void VtkLegacyArrays::readField() {
  TextScanner& scanner = source_.scanner();
  scanner.readToken();
  const std::size_t arrays = scanner.readCount("arrays", 8);
  for (std::size_t i = 0; i < arrays && !map_; ++i) {
    if (lowerCase(scanner.peekToken()) == "metadata") {
      scanner.readToken();
      source_.skipMetadata();
    }
    const std::string_view name = scanner.readToken();
    const std::size_t components = scanner.readCount("components", 1);
    const std::size_t tuples = scanner.readCount("tuples", 1);
    readArray(name, components, tuples, source_.readType());
  }
}

/// Reads the numbers of an array if it is the map, and skips them otherwise.
void VtkLegacyArrays::readArray(std::string_view name, std::size_t components, std::size_t tuples,
                                const VtkNumberType& type) {
  if (components > 0 && tuples > source_.text().size() / components) {
    source_.scanner().fail(ErrorCode::FileSyntax,
                           "an array has more numbers than the file has bytes.");
  }
  seen_.push_back(describeArray(name, ofCells_, components));
  const std::size_t wanted = ofCells_ ? kCellMapComponents : kPointMapComponents;
  const std::size_t count = components * tuples;
  if (!behindMesh_ || decodedVtkName(name) != mapArray_ || components != wanted ||
      tuples != elements() || type.kind != VtkNumberType::Kind::Float) {
    return source_.skipNumbers(count, type);
  }
  map_ = GridMap{ofCells_, source_.readReals(count, type, "a parameter of the map")};
}

}  // namespace hexhex
