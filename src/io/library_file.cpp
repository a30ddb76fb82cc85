#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <hexhex/error.hpp>

#include <io/library_file.hpp>

namespace hexhex {
namespace {

constexpr mode_t kPermissions = 0666;  // less what the user's umask takes away

/// A name that no other file of this process uses; other processes are kept out by O_EXCL.
std::string temporaryName() {
  static std::atomic<unsigned> counter{0};
  return ".hexhex-" + std::to_string(::getpid()) + "-l" + std::to_string(counter++) + ".tmp";
}

}  // namespace

std::mutex& libraryLock() {
  static std::mutex lock;
  return lock;
}

LibraryFile::LibraryFile(std::filesystem::path target) : target_(std::move(target)) {
  std::error_code error;
  // Renaming onto a link would replace the link, not what it points to.
  if (std::filesystem::is_symlink(target_, error)) {
    const std::filesystem::path real = std::filesystem::canonical(target_, error);
    if (error) fail("its link leads nowhere: " + error.message());
    target_ = real;
  }
  if (std::filesystem::exists(target_, error) &&
      !std::filesystem::is_regular_file(target_, error)) {
    fail("it is no regular file, which this format needs");
  }
  const std::filesystem::path folder =
      target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
  int descriptor = -1;
  do {
    temporary_ = (folder / temporaryName()).string();
    descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kPermissions);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) {
    const std::string reason = std::generic_category().message(errno);
    temporary_.clear();
    fail("no file can be created in the folder " + folder.string() + ": " + reason);
  }
  ::close(descriptor);
}

LibraryFile::~LibraryFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void LibraryFile::commit() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail("the finished file cannot be renamed to it: " + std::generic_category().message(errno));
  }
  temporary_.clear();
}

void LibraryFile::fail(const std::string& reason) const {
  throw Error(ErrorCode::FileWrite,
              target_.string() + ": the file was not written because " + reason + ".");
}

}  // namespace hexhex
