// HDF5 files that are read: datasets by their paths. Needs no header of HDF5.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <io/core/input_file.hpp>

namespace hexhex::io {

/// What HDF5 files begin with, but those with a block of a user's in front.
inline constexpr std::string_view kHdfMark = "\x89HDF\r\n\x1a\n";

/// The first eight bytes of an input; empty for a pipe, which can be opened but once.
[[nodiscard]] std::string firstBytes(const Input& input);

/// An open file. While it lives, no other thread uses HDF5 through this library.
///
/// Paths are "group/group/dataset". A dataset that says it holds more values than it can have
/// bytes in the file is not read.
class HdfReader {
 public:
  /// @throws Error FileUnsupported without the library; FileSyntax if HDF5 cannot read the file
  [[nodiscard]] static std::unique_ptr<HdfReader> open(const Input& input);
  /// The same of an input that may be a pipe.
  /// @throws Error FileSyntax also for what does not begin as HDF5 files do
  [[nodiscard]] static std::unique_ptr<HdfReader> openAny(const Input& input, Stage& stage);
  virtual ~HdfReader() = default;
  HdfReader(const HdfReader&) = delete;
  HdfReader& operator=(const HdfReader&) = delete;

  /// The names in a group, as they were created if the file knows that, and by name otherwise.
  [[nodiscard]] virtual std::vector<std::string> members(const std::string& group) const = 0;
  /// Whether there is a dataset.
  [[nodiscard]] virtual bool has(const std::string& path) const = 0;
  /// The lengths of its dimensions, the last of which runs fastest.
  [[nodiscard]] virtual std::vector<std::uint64_t> shape(const std::string& path) const = 0;
  /// Whether it has floating-point numbers.
  [[nodiscard]] virtual bool hasReals(const std::string& path) const = 0;
  /// @throws Error FileSyntax if there are not the bytes for all its values
  virtual void requireStored(const std::string& path) const = 0;
  /// All values. @throws Error FileSyntax for those of another kind; as requireStored()
  [[nodiscard]] virtual std::vector<std::int64_t> integers(const std::string& path) const = 0;
  [[nodiscard]] virtual std::vector<double> reals(const std::string& path) const = 0;
  /// Letters, or integers of 8 bits that are meant as such, one after the other.
  [[nodiscard]] virtual std::string text(const std::string& path) const = 0;
  /// A text, up to its first zero; empty if there is none.
  [[nodiscard]] virtual std::string attribute(const std::string& path, const char* name) const = 0;

 protected:
  HdfReader() = default;
};

}  // namespace hexhex::io
