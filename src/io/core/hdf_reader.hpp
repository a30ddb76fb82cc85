// The HDF5 library and a reader of its files, without headers of HDF5. The library is loaded when
// the first file needs it: it depends on some thirty other libraries (curl, OpenSSL, Kerberos ...),
// which take longer to load than most commands take to run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <io/core/input_file.hpp>

namespace hexhex::io {

/// Loads the library unless it is loaded already.
/// @param file  the file that needs it
/// @throws Error FileUnsupported if the library is missing, has another version, or this build has
///         no support for it; std::bad_alloc if there is not enough memory to load it
void requireHdf5(const std::filesystem::path& file);

/// The address of a symbol of the library. @pre  requireHdf5() succeeded
[[nodiscard]] void* hdf5Symbol(const char* name);

/// Signature of HDF5 files (unless a user block precedes it).
inline constexpr std::string_view kHdfMark = "\x89HDF\r\n\x1a\n";

/// The first bytes of an input; empty for a pipe, which can be read only once.
[[nodiscard]] std::string firstBytes(const Input& input, std::size_t count = kHdfMark.size());

/// An open file. For its lifetime, no other thread uses HDF5 through this library.
///
/// Paths are "group/group/dataset". A dataset that claims more values than the file can store is
/// refused.
class HdfReader {
 public:
  /// @throws Error FileUnsupported without the library; FileSyntax if HDF5 cannot read the file
  [[nodiscard]] static std::unique_ptr<HdfReader> open(const Input& input);
  /// The same for an input that may be a pipe.
  /// @throws Error FileSyntax also if the input does not begin with the signature
  [[nodiscard]] static std::unique_ptr<HdfReader> openAny(const Input& input, Stage& stage);
  virtual ~HdfReader() = default;
  HdfReader(const HdfReader&) = delete;
  HdfReader& operator=(const HdfReader&) = delete;

  /// The names in a group, in order of creation if the file stores it, by name otherwise.
  [[nodiscard]] virtual std::vector<std::string> members(const std::string& group) const = 0;
  /// Whether the path is a dataset.
  [[nodiscard]] virtual bool has(const std::string& path) const = 0;
  /// The dimensions; the last one varies fastest.
  [[nodiscard]] virtual std::vector<std::uint64_t> shape(const std::string& path) const = 0;
  /// Whether the dataset holds floating-point numbers.
  [[nodiscard]] virtual bool hasReals(const std::string& path) const = 0;
  /// @throws Error FileSyntax if the file cannot hold all values of the dataset
  virtual void requireStored(const std::string& path) const = 0;
  /// All values. @throws Error FileSyntax if they are of another kind, and as requireStored()
  [[nodiscard]] virtual std::vector<std::int64_t> integers(const std::string& path) const = 0;
  [[nodiscard]] virtual std::vector<double> reals(const std::string& path) const = 0;
  /// Fixed-size strings, or 8-bit integers used as characters, concatenated.
  [[nodiscard]] virtual std::string text(const std::string& path) const = 0;
  /// A string attribute, up to its first zero byte; empty if there is none.
  [[nodiscard]] virtual std::string attribute(const std::string& path, const char* name) const = 0;

 protected:
  HdfReader() = default;
};

}  // namespace hexhex::io
