#include <system_error>

#include <hexhex/error.hpp>

#include <io/core/library_file.hpp>

namespace hexhex {
namespace {

/// Before anything is opened: opening a pipe waits for who reads it.
const std::filesystem::path& requireRegular(const std::filesystem::path& target) {
  std::error_code error;
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error)) {
    throw Error(ErrorCode::FileWrite,
                target.string() +
                    ": the file was not written because it is no regular file, which this format "
                    "needs.");
  }
  return target;
}

}  // namespace

std::mutex& libraryLock() {
  static std::mutex lock;
  return lock;
}

LibraryFile::LibraryFile(const std::filesystem::path& target)
    : file_(requireRegular(target)), name_(file_.temporary().string()) {}

}  // namespace hexhex
