// Words and numbers of legacy VTK files, for readers that need not know whether numbers are text or
// bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex {

// Numbers, points or cells that one thread takes in a go.
inline constexpr std::size_t kVtkLegacyGrain = std::size_t{1} << 14;

/// A type of numbers.
struct VtkNumberType {
  enum class Kind : std::uint8_t { Float, Signed, Unsigned, Bits, Text };

  std::string_view name;
  Kind kind;
  std::size_t bytes;  ///< of a number; 0 if it has no bytes of its own
};

// Types that a file need not tell.
inline constexpr VtkNumberType kVtkInt = {"int", VtkNumberType::Kind::Signed, 4};
inline constexpr VtkNumberType kVtkFloat = {"float", VtkNumberType::Kind::Float, 4};
inline constexpr VtkNumberType kVtkByte = {"unsigned_char", VtkNumberType::Kind::Unsigned, 1};

/// Numbers of legacy files are stored with the largest byte first.
template <class T>
[[nodiscard]] T loadBig(const char* place) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(T) == sizeof(Bits));
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {  // compilers make one instruction of it
    bits = bits << 8U | static_cast<unsigned char>(place[i]);
  }
  return std::bit_cast<T>(bits);
}

/// Reads a file from front to back. Errors name the line of what is read.
class VtkLegacySource {
 public:
  /// @param text  must outlive the source, and so must the stage
  VtkLegacySource(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text), scanner_(text, fileName), stage_(stage) {}

  /// Stands where the source stands, and moves with it.
  [[nodiscard]] TextScanner& scanner() noexcept { return scanner_; }
  [[nodiscard]] std::string_view text() const noexcept { return text_; }
  [[nodiscard]] Stage& stage() const noexcept { return stage_; }

  /// Reads a word that may come in any letter case, in lower case.
  [[nodiscard]] std::string readKeyword();
  /// Skips lines up to an empty one.
  void skipMetadata();

  /// Reads everything in front of the first section. Numbers come after it.
  void readHead();
  /// Whether numbers are bytes.
  [[nodiscard]] bool binary() const noexcept { return binary_; }
  /// Reads the name of a type.
  [[nodiscard]] const VtkNumberType& readType();

  /// The bytes of so many numbers, which begin on the next line.
  [[nodiscard]] const char* takeBytes(std::size_t count, std::size_t bytesEach);
  /// Calls read(scanner, i) for n elements of so many numbers, as readElements() does it. Text
  /// only.
  template <class Read>
  void readAsText(std::size_t n, std::size_t numbersEach, const Read& read) {
    readElements(scanner_, &*index_, stage_, n, numbersEach, read);
  }

  /// @param what  for messages: one of the numbers
  [[nodiscard]] Array<std::int64_t> readIntegers(std::size_t count, const VtkNumberType& type,
                                                 const char* what);
  /// @param type  of floating-point numbers
  [[nodiscard]] Array<double> readReals(std::size_t count, const VtkNumberType& type,
                                        const char* what);
  void skipNumbers(std::size_t count, const VtkNumberType& type);

 private:
  std::string_view text_;
  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only of text
  Stage& stage_;
  bool binary_ = false;
};

}  // namespace hexhex
