#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <hexhex/error.hpp>

#include <io/core/output_file.hpp>

namespace hexhex {
namespace {

constexpr mode_t kPermissions = 0666;  // less what the user's umask takes away

/// A name that no other file of this process uses; other processes are kept out by O_EXCL. It does
/// not contain the target's name, which may be as long as the file system allows.
std::string temporaryName() {
  static std::atomic<unsigned> counter{0};
  return ".hexhex-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
}

std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path target, Target kind)
    : target_(std::move(target)), buffer_(new char[kBufferSize]) {
  std::error_code error;
  if (kind == Target::Regular && std::filesystem::exists(target_, error) &&
      !std::filesystem::is_regular_file(target_, error)) {
    fail("it is no regular file, which this format needs");
  }
  // Renaming onto a link would replace the link, not what it points to.
  if (std::filesystem::is_symlink(target_, error)) {
    const std::filesystem::path real = std::filesystem::canonical(target_, error);
    if (error) fail("its link leads nowhere", error.value());
    target_ = real;
  }
  struct stat status {};
  const bool exists = ::stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail("it is a folder", EISDIR);
  if (!exists || S_ISREG(status.st_mode)) {
    openTemporary();
    return;
  }
  descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail("it cannot be opened", errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::openTemporary() {
  const std::filesystem::path folder = folderOf(target_);
  do {
    temporary_ = folder / temporaryName();
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kPermissions);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ >= 0) return;
  const int error = errno;
  temporary_.clear();
  fail("no file can be created in the folder " + folder.string(), error);
}

void OutputFile::writeBytes(const void* bytes, std::size_t size) {
  if (size > kBufferSize - used_) {
    flush();
    if (size >= kBufferSize) return writeThrough(bytes, size);
  }
  std::copy_n(static_cast<const char*>(bytes), size, buffer_.get() + used_);
  used_ += size;
}

void OutputFile::flush() {
  writeThrough(buffer_.get(), used_);
  used_ = 0;
}

/// @param write  write(bytes, size, done) writes some of so many bytes, after `done` others, and
///               returns how many, as the system does
template <class Write>
void OutputFile::writeAll(const void* bytes, std::size_t size, const Write& write) const {
  const char* const data = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const ssize_t written = write(data + done, size - done, done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("it cannot be written completely", errno);
    done += static_cast<std::size_t>(written);
  }
}

void OutputFile::writeThrough(const void* bytes, std::size_t size) {
  written_ += size;
  writeAll(bytes, size, [this](const char* data, std::size_t count, std::size_t /*done*/) {
    return ::write(descriptor_, data, count);
  });
}

void OutputFile::writeBytesAt(std::uint64_t position, const void* bytes, std::size_t size) const {
  writeAll(bytes, size, [&](const char* data, std::size_t count, std::size_t done) {
    return ::pwrite(descriptor_, data, count, static_cast<off_t>(position + done));
  });
}

void OutputFile::requirePositions(const std::string& why) const {
  if (!hasPositions()) fail("it is a device or a pipe, " + why + ". Name a file");
}

void OutputFile::commit() {
  flush();
  // Some file systems report a full disk only here.
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail("it cannot be written completely", errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail("the finished file cannot be renamed to it", errno);
  }
  temporary_.clear();
}

void OutputFile::fail(const std::string& what, int error) const {
  fail(what + ": " + std::generic_category().message(error));
}

void OutputFile::fail(const std::string& reason) const {
  throw Error(ErrorCode::FileWrite,
              target_.string() + ": the file was not written because " + reason + ".");
}

std::mutex& libraryLock() {
  static std::mutex lock;
  return lock;
}

}  // namespace hexhex
