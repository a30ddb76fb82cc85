#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/concat.hpp>
#include <base/loaded_library.hpp>
#include <base/missing_library.hpp>
#include <io/core/hdf_reader.hpp>
#if defined(HEXHEX_HAS_HDF5)
#include <io/core/hdf_file.hpp>
#endif

namespace hexhex::io {

#if defined(HEXHEX_HDF5_NAME)
namespace {

LoadedLibrary load(const std::filesystem::path& file) {
  // The second is the path found at build time, which may lie outside the system's folders.
  LoadedLibrary library({HEXHEX_HDF5_NAME, HEXHEX_HDF5_FILE}, "HEXHEX_HDF5");
  const auto query = library.find<decltype(&H5get_libversion)>("H5get_libversion");
  std::array<unsigned, 3> version{};
  if (query != nullptr) query(&version[0], &version[1], &version[2]);
  if (version[0] == H5_VERS_MAJOR && version[1] == H5_VERS_MINOR) return library;
  throw Error(ErrorCode::FileUnsupported,
              concat(file.string(), ": such files take the library HDF5, version ", H5_VERS_MAJOR,
                     ".", H5_VERS_MINOR, ", which cannot be loaded (",
                     (query == nullptr ? library.problem()
                                       : concat("its version is ", version[0], ".", version[1])),
                     "). Install " HEXHEX_HDF5_PACKAGE ", or choose another format."));
}

LoadedLibrary& library(const std::filesystem::path& file) {
  static LoadedLibrary loaded = load(file);
  return loaded;
}

}  // namespace

void requireHdf5(const std::filesystem::path& file) { static_cast<void>(library(file)); }
void* hdf5Symbol(const char* name) { return library({}).find<void*>(name); }
#elif defined(HEXHEX_HAS_HDF5)
void requireHdf5(const std::filesystem::path& /*file*/) {}
#else
void requireHdf5(const std::filesystem::path& file) {
  failWithoutLibrary("read or write such files", "HDF5 (libhdf5-dev)", "choose another format",
                     file);
}
std::unique_ptr<HdfReader> HdfReader::open(const Input& input) {
  requireHdf5(input.name());
  return nullptr;
}
#endif

std::string firstBytes(const Input& input, std::size_t count) {
  if (input.bytes()) return std::string(input.bytes()->substr(0, count));
  std::error_code unknown;
  if (std::filesystem::exists(input.path(), unknown) &&
      !std::filesystem::is_regular_file(input.path(), unknown)) {
    return {};  // a pipe can be opened only once
  }
  const InputFile file(input.path());
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), count)), '\0');
  file.readAt(0, head.data(), head.size());
  return head;
}

std::unique_ptr<HdfReader> HdfReader::openAny(const Input& input, Stage& stage) {
  const std::string head = firstBytes(input);
  if (head == kHdfMark) return open(input);
  if (head.empty()) {  // a pipe
    Array<char> room;
    const std::string_view bytes = input.text(room, stage, "");
    if (bytes.starts_with(kHdfMark)) return open({bytes, input.name()});
  }
  input.fail(ErrorCode::FileSyntax,
             "the file does not begin as HDF5 files do. Is its extension right?");
}

}  // namespace hexhex::io
