#include <algorithm>
#include <array>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>
#include <io/vtk/vtk_legacy_source.hpp>

namespace hexhex {
namespace {

using VtkKind = VtkNumberType::Kind;

constexpr std::array<VtkNumberType, 16> kVtkTypes = {{{"double", VtkKind::Float, 8},
                                                      {"float", VtkKind::Float, 4},
                                                      {"int", VtkKind::Signed, 4},
                                                      {"vtktypeint64", VtkKind::Signed, 8},
                                                      {"vtkidtype", VtkKind::Signed, 4},
                                                      {"vtktypeint32", VtkKind::Signed, 4},
                                                      {"long", VtkKind::Signed, 8},
                                                      {"unsigned_int", VtkKind::Unsigned, 4},
                                                      {"unsigned_long", VtkKind::Unsigned, 8},
                                                      {"vtktypeuint64", VtkKind::Unsigned, 8},
                                                      {"short", VtkKind::Signed, 2},
                                                      {"unsigned_short", VtkKind::Unsigned, 2},
                                                      {"char", VtkKind::Signed, 1},
                                                      {"unsigned_char", VtkKind::Unsigned, 1},
                                                      {"bit", VtkKind::Bits, 0},
                                                      {"string", VtkKind::Text, 0}}};

/// Numbers of 8 bytes, or of 4 in their narrower type.
template <class Wide, class Narrow>
Array<Wide> loadNumbers(const char* bytes, std::size_t count, std::size_t bytesEach, Stage& stage) {
  Array<Wide> numbers(count);
  parallelFor(stage, count, kVtkLegacyGrain, [&](std::size_t i) {
    const char* const place = bytes + i * bytesEach;
    numbers[i] = bytesEach == 8 ? loadBig<Wide>(place) : Wide{loadBig<Narrow>(place)};
  });
  return numbers;
}

}  // namespace

std::string VtkLegacySource::readKeyword() { return lowerCase(scanner_.readToken()); }

void VtkLegacySource::skipMetadata() {
  static_cast<void>(scanner_.takeLine());
  while (scanner_.position() < text_.size()) {
    const std::string_view line = scanner_.takeLine();
    if (line.empty() || line == "\r") return;
  }
}

void VtkLegacySource::readHead() {
  constexpr std::string_view kMagic = "# vtk DataFile Version ";
  if (!scanner_.takeLine().starts_with(kMagic)) {
    scanner_.moveTo(0);
    scanner_.fail(
        ErrorCode::FileSyntax,
        "a .vtk file begins with \"# vtk DataFile Version\". If it is XML, name it .vtu.");
  }
  static_cast<void>(scanner_.takeLine());  // a title, which may be anything
  const std::string encoding = readKeyword();
  binary_ = encoding == "binary";
  if (!binary_ && encoding != "ascii") scanner_.failToken("\"ASCII\" or \"BINARY\"");
  if (readKeyword() != "dataset") scanner_.failToken("\"DATASET\"");
  if (readKeyword() != "unstructured_grid") {
    scanner_.fail(ErrorCode::FileUnsupported, "the data set must be an UNSTRUCTURED_GRID, found " +
                                                  quoted(scanner_.currentToken()) + ".");
  }
  if (!binary_) index_.emplace(text_, stage_);
}

const VtkNumberType& VtkLegacySource::readType() {
  const std::string name = readKeyword();
  const auto* const found =
      std::find_if(kVtkTypes.begin(), kVtkTypes.end(),
                   [&](const VtkNumberType& type) { return type.name == name; });
  if (found != kVtkTypes.end()) return *found;
  scanner_.failToken("a type of numbers, e.g. double");
}

const char* VtkLegacySource::takeBytes(std::size_t count, std::size_t bytesEach) {
  scanner_.skipLineBreak();
  const std::size_t left = text_.size() - scanner_.position();
  if (bytesEach > 0 && count > left / bytesEach) {
    scanner_.fail(ErrorCode::FileSyntax,
                  std::to_string(count) + " numbers of " + std::to_string(bytesEach) +
                      " bytes are announced, but only " + std::to_string(left) +
                      " bytes are left: the file is incomplete.");
  }
  const char* const bytes = text_.data() + scanner_.position();
  scanner_.moveTo(scanner_.position() + count * bytesEach);
  return bytes;
}

Array<std::int64_t> VtkLegacySource::readIntegers(std::size_t count, const VtkNumberType& type,
                                                  const char* what) {
  if (type.kind != VtkKind::Signed || type.bytes < 4) {
    scanner_.fail(ErrorCode::FileUnsupported, std::string(what) + " cannot be of type " +
                                                  std::string(type.name) +
                                                  ", only int or vtktypeint64.");
  }
  if (binary_) {
    return loadNumbers<std::int64_t, std::int32_t>(takeBytes(count, type.bytes), count, type.bytes,
                                                   stage_);
  }
  Array<std::int64_t> numbers(count);
  readAsText(count, 1, [&](TextScanner& scanner, std::size_t i) {
    if (!scanner.readInteger(numbers[i])) scanner.failInteger(what);
  });
  return numbers;
}

Array<double> VtkLegacySource::readReals(std::size_t count, const VtkNumberType& type,
                                         const char* what) {
  if (binary_) {
    return loadNumbers<double, float>(takeBytes(count, type.bytes), count, type.bytes, stage_);
  }
  Array<double> numbers(count);
  readAsText(count, 1, [&](TextScanner& scanner, std::size_t i) {
    if (!scanner.readNumber(numbers[i])) scanner.failNumber(what);
  });
  return numbers;
}

void VtkLegacySource::skipNumbers(std::size_t count, const VtkNumberType& type) {
  if (!binary_) {
    scanner_.moveTo(index_->find(index_->countBefore(scanner_.position()) + count));
    return;
  }
  if (type.kind == VtkKind::Text) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "an array of strings has no known length in bytes; save the file without it.");
  }
  const bool bits = type.kind == VtkKind::Bits;
  static_cast<void>(takeBytes(bits ? (count + 7) / 8 : count, bits ? 1 : type.bytes));
}

}  // namespace hexhex
