#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <io/core/output_file.hpp>
#include <io/core/system_call.hpp>

namespace hexhex::io {
namespace {

/// A name unique within this process; O_EXCL guards against other processes. It does not contain
/// the target's name, which may already have the maximum length.
std::string temporaryName() {
  static std::atomic<unsigned> counter{0};
  return concat(".hexhex-", system_call::processId(), "-", counter++, ".tmp");
}

std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// Flushes to disk (fsync), where the file system supports it.
bool synced(int descriptor) {
  return uninterrupted([descriptor] { return system_call::sync(descriptor); }) == 0 ||
         errno == EINVAL;
}

}  // namespace

void failToWrite(const std::filesystem::path& target, const std::string& reason, int error) {
  throw Error(ErrorCode::FileWrite,
              target.string() + ": the file was not written because " + reason +
                  (error == 0 ? "." : ": " + std::generic_category().message(error) + "."));
}

std::filesystem::path temporaryBeside(const std::filesystem::path& target) {
  // Built as one string: growing a libstdc++ path leaves it broken when memory runs out.
  return folderOf(target).string() + '/' + temporaryName();
}

std::filesystem::path realTarget(const std::filesystem::path& target) {
  std::error_code error;
  // The link of a pipe (as in /proc/self/fd) does not hold a path.
  if (!std::filesystem::is_symlink(target, error) || std::filesystem::is_other(target, error)) {
    return target;
  }
  std::filesystem::path real = std::filesystem::canonical(target, error);
  if (error) failToWrite(target, "its link leads nowhere", error.value());
  return real;
}

ChangedFolder::ChangedFolder(const std::filesystem::path& target)
    : target_(target),
      descriptor_(uninterrupted([&target] { return system_call::openFolder(folderOf(target)); })) {
  // The folder may be writable but not readable.
  if (descriptor_ < 0 && errno != EACCES) failToWrite(target, "its folder cannot be opened", errno);
}

ChangedFolder::~ChangedFolder() {
  if (descriptor_ >= 0) system_call::close(descriptor_);
}

void ChangedFolder::sync() const {
  if (descriptor_ < 0 || synced(descriptor_)) return;
  throw Error(ErrorCode::FileWrite,
              target_.string() + ": the file is complete, but its folder could not be written to " +
                  "the disk, so it may be lost with the power: " +
                  std::generic_category().message(errno) + ".");
}

OutputFile::OutputFile(std::filesystem::path target, Target kind)
    : target_(std::move(target)), buffer_(new char[kBufferSize]) {
  std::error_code error;
  if (kind == Target::Regular && std::filesystem::exists(target_, error) &&
      !std::filesystem::is_regular_file(target_, error)) {
    fail("it is no regular file, which this format needs");
  }
  target_ = realTarget(target_);
  system_call::Status status;
  const bool exists = system_call::statusOf(target_, status) == 0;
  if (status.isFolder) fail("it is a folder", EISDIR);
  if (!exists || status.isRegular) {
    openTemporary();
    return;
  }
  descriptor_ = uninterrupted([this] { return system_call::openToWrite(target_); });
  if (descriptor_ < 0) fail("it cannot be opened", errno);
}

OutputFile::OutputFile(std::filesystem::path target, std::filesystem::path temporary)
    : target_(std::move(target)), temporary_(std::move(temporary)) {
  resume();
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) system_call::close(descriptor_);
  if (!temporary_.empty()) system_call::remove(temporary_);
}

void OutputFile::openTemporary() {
  // open() may be interrupted by a signal, or find a file left by an earlier process.
  do {
    temporary_ = temporaryBeside(target_);
    descriptor_ = system_call::create(temporary_);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ >= 0) return;
  const int error = errno;
  temporary_.clear();
  const std::string folder = folderOf(target_).string();
  if (error == ENOENT) fail("its folder does not exist; make it with `mkdir -p " + folder + "`");
  fail("no file can be created in the folder " + folder, error);
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

/// @param write  write(bytes, size, done) writes some of `size` bytes after the first `done`, and
///               returns how many, as write(2) does
template <class Write>
void OutputFile::writeAll(const void* bytes, std::size_t size, const Write& write) const {
  const char* const data = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const std::ptrdiff_t written =
        uninterrupted([&] { return write(data + done, size - done, done); });
    if (written < 0) fail("it cannot be written completely", errno);
    done += static_cast<std::size_t>(written);
  }
}

void OutputFile::writeThrough(const void* bytes, std::size_t size) {
  written_ += size;
  writeAll(bytes, size, [this](const char* data, std::size_t count, std::size_t /*done*/) {
    return system_call::write(descriptor_, data, count);
  });
}

void OutputFile::writeBytesAt(std::uint64_t position, const void* bytes, std::size_t size) const {
  writeAll(bytes, size, [&](const char* data, std::size_t count, std::size_t done) {
    return system_call::writeAt(descriptor_, data, count, position + done);
  });
}

void OutputFile::readBytesAt(std::uint64_t position, void* bytes, std::size_t size) const {
  char* const data = static_cast<char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const std::ptrdiff_t count = uninterrupted([&] {
      return system_call::readAt(descriptor_, data + done, size - done, position + done);
    });
    if (count < 0) fail("it cannot be read back", errno);
    if (count == 0) fail("it became shorter while it was written");
    done += static_cast<std::size_t>(count);
  }
}

void OutputFile::requirePositions(const std::string& why) const {
  if (!hasPositions()) fail("it is a device or a pipe, " + why + ". Name a file");
}

void OutputFile::suspend() {
  flush();
  buffer_.reset();
  const int closed = system_call::close(std::exchange(descriptor_, -1));
  if (closed != 0 && errno != EINTR) fail("it cannot be written completely", errno);
}

void OutputFile::resume() {
  buffer_.reset(new char[kBufferSize]);
  descriptor_ = uninterrupted([this] { return system_call::openAgain(temporary_); });
  if (descriptor_ < 0) fail("it cannot be opened again", errno);
}

void OutputFile::finish(bool sync) {
  flush();
  // Some file systems report a full disk only on fsync or close.
  if (sync && !synced(descriptor_)) fail("it cannot be written completely", errno);
  const int closed = system_call::close(std::exchange(descriptor_, -1));
  if (closed != 0 && errno != EINTR) fail("it cannot be written completely", errno);
}

void OutputFile::commit() {
  const bool renamed = !temporary_.empty();
  finish(renamed);
  if (!renamed) return;
  const ChangedFolder folder(target_);
  if (system_call::rename(temporary_, target_) != 0) {
    fail("the finished file cannot be renamed to it", errno);
  }
  temporary_.clear();
  folder.sync();
}

void OutputFile::handOver() {
  finish(true);
  temporary_.clear();
}

void OutputFile::fail(const std::string& reason, int error) const {
  failToWrite(target_, reason, error);
}

}  // namespace hexhex::io
