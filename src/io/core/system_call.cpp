#include <io/core/system_call.hpp>

#if !defined(_WIN32)

#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hexhex::io::system_call {
namespace {

// Restricted by the user's umask.
constexpr mode_t kFilePermissions = 0666;
constexpr mode_t kFolderPermissions = 0777;

Status statusFrom(const struct stat& status) noexcept {
  return {.isFolder = S_ISDIR(status.st_mode),
          .isRegular = S_ISREG(status.st_mode),
          .size = static_cast<std::uint64_t>(status.st_size)};
}

}  // namespace

int openToRead(const Path& file) noexcept { return ::open(file.c_str(), O_RDONLY | O_CLOEXEC); }
int openToWrite(const Path& file) noexcept { return ::open(file.c_str(), O_WRONLY | O_CLOEXEC); }
int create(const Path& file) noexcept {
  return ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kFilePermissions);
}
int openAgain(const Path& file) noexcept { return ::open(file.c_str(), O_RDWR | O_CLOEXEC); }
int openFolder(const Path& folder) noexcept {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

int close(int descriptor) noexcept { return ::close(descriptor); }

int statusOf(int descriptor, Status& status) noexcept {
  struct stat found {};
  const int result = ::fstat(descriptor, &found);
  if (result == 0) status = statusFrom(found);
  return result;
}
int statusOf(const Path& file, Status& status) noexcept {
  struct stat found {};
  const int result = ::stat(file.c_str(), &found);
  if (result == 0) status = statusFrom(found);
  return result;
}

std::ptrdiff_t read(int descriptor, void* bytes, std::size_t size) noexcept {
  return ::read(descriptor, bytes, size);
}
std::ptrdiff_t write(int descriptor, const void* bytes, std::size_t size) noexcept {
  return ::write(descriptor, bytes, size);
}
std::ptrdiff_t readAt(int descriptor, void* bytes, std::size_t size,
                      std::uint64_t position) noexcept {
  return ::pread(descriptor, bytes, size, static_cast<off_t>(position));
}
std::ptrdiff_t writeAt(int descriptor, const void* bytes, std::size_t size,
                       std::uint64_t position) noexcept {
  return ::pwrite(descriptor, bytes, size, static_cast<off_t>(position));
}
int moveTo(int descriptor, std::uint64_t position) noexcept {
  return ::lseek(descriptor, static_cast<off_t>(position), SEEK_SET) < 0 ? -1 : 0;
}
int sync(int descriptor) noexcept { return ::fsync(descriptor); }

int rename(const Path& from, const Path& to) noexcept { return ::rename(from.c_str(), to.c_str()); }
int exchange([[maybe_unused]] const Path& a, [[maybe_unused]] const Path& b) noexcept {
#if defined(RENAME_EXCHANGE)
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE);
#else
  errno = ENOSYS;
  return -1;
#endif
}
int makeFolder(const Path& folder) noexcept { return ::mkdir(folder.c_str(), kFolderPermissions); }
int removeFolder(const Path& folder) noexcept { return ::rmdir(folder.c_str()); }
int remove(const Path& file) noexcept { return ::unlink(file.c_str()); }

long processId() noexcept { return ::getpid(); }

}  // namespace hexhex::io::system_call

#else

#include <algorithm>
#include <fcntl.h>
#include <io.h>
#include <mutex>
#include <process.h>
#include <share.h>
#include <sys/stat.h>
#include <sys/types.h>

#define WIN32_LEAN_AND_MEAN
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <windows.h>

namespace hexhex::io::system_call {
namespace {

constexpr int kFlags = _O_BINARY | _O_NOINHERIT;
constexpr std::size_t kMost = std::size_t{1} << 30;  ///< bytes per system call

int open(const Path& file, int flags) noexcept {
  int descriptor = -1;
  // Share the file, so that other programs can open it meanwhile.
  const int error =
      ::_wsopen_s(&descriptor, file.c_str(), flags | kFlags, _SH_DENYNO, _S_IREAD | _S_IWRITE);
  if (error == 0) return descriptor;
  errno = error;
  return -1;
}

Status statusFrom(const struct _stat64& status) noexcept {
  return {.isFolder = (status.st_mode & _S_IFMT) == _S_IFDIR,
          .isRegular = (status.st_mode & _S_IFMT) == _S_IFREG,
          .size = static_cast<std::uint64_t>(status.st_size)};
}

/// Sets errno from GetLastError().
void noteError() noexcept {
  switch (::GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
      errno = ENOENT;
      break;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
      errno = EACCES;
      break;
    case ERROR_ALREADY_EXISTS:
    case ERROR_FILE_EXISTS:
      errno = EEXIST;
      break;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL:
      errno = ENOSPC;
      break;
    default:
      errno = EIO;
      break;
  }
}

HANDLE handleOf(int descriptor) noexcept {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

/// Runs call(size, count, place) to read or write at a position. Unlike pread() and pwrite(), it
/// also moves the file pointer, which is restored before another thread may do the same.
template <class Call>
std::ptrdiff_t atPosition(int descriptor, std::size_t size, std::uint64_t position,
                          const Call& call) noexcept {
  static std::mutex oneAtATime;
  OVERLAPPED place{};
  place.Offset = static_cast<DWORD>(position);
  place.OffsetHigh = static_cast<DWORD>(position >> 32U);
  DWORD count = 0;
  const std::lock_guard lock(oneAtATime);
  const __int64 before = ::_lseeki64(descriptor, 0, SEEK_CUR);
  const bool good = call(static_cast<DWORD>(std::min(size, kMost)), count, place);
  if (!good) noteError();
  if (::_lseeki64(descriptor, before, SEEK_SET) < 0 || !good) return -1;
  return static_cast<std::ptrdiff_t>(count);
}

}  // namespace

int openToRead(const Path& file) noexcept {
  Status status;  // open() does not report folders
  if (statusOf(file, status) == 0 && status.isFolder) {
    errno = EISDIR;
    return -1;
  }
  return open(file, _O_RDONLY);
}
int openToWrite(const Path& file) noexcept { return open(file, _O_WRONLY); }
int create(const Path& file) noexcept { return open(file, _O_RDWR | _O_CREAT | _O_EXCL); }
int openAgain(const Path& file) noexcept { return open(file, _O_RDWR); }
int openFolder(const Path& folder) noexcept {
  Status status;
  if (statusOf(folder, status) == 0) errno = status.isFolder ? EACCES : ENOTDIR;
  return -1;
}

int close(int descriptor) noexcept { return ::_close(descriptor); }

int statusOf(int descriptor, Status& status) noexcept {
  struct _stat64 found {};
  const int result = ::_fstat64(descriptor, &found);
  if (result == 0) status = statusFrom(found);
  return result;
}
int statusOf(const Path& file, Status& status) noexcept {
  struct _stat64 found {};
  const int result = ::_wstat64(file.c_str(), &found);
  if (result == 0) status = statusFrom(found);
  return result;
}

std::ptrdiff_t read(int descriptor, void* bytes, std::size_t size) noexcept {
  return ::_read(descriptor, bytes, static_cast<unsigned>(std::min(size, kMost)));
}
std::ptrdiff_t write(int descriptor, const void* bytes, std::size_t size) noexcept {
  return ::_write(descriptor, bytes, static_cast<unsigned>(std::min(size, kMost)));
}
std::ptrdiff_t readAt(int descriptor, void* bytes, std::size_t size,
                      std::uint64_t position) noexcept {
  return atPosition(descriptor, size, position, [&](DWORD most, DWORD& count, OVERLAPPED& place) {
    return ::ReadFile(handleOf(descriptor), bytes, most, &count, &place) != 0 ||
           ::GetLastError() == ERROR_HANDLE_EOF;
  });
}
std::ptrdiff_t writeAt(int descriptor, const void* bytes, std::size_t size,
                       std::uint64_t position) noexcept {
  return atPosition(descriptor, size, position, [&](DWORD most, DWORD& count, OVERLAPPED& place) {
    return ::WriteFile(handleOf(descriptor), bytes, most, &count, &place) != 0;
  });
}
int moveTo(int descriptor, std::uint64_t position) noexcept {
  return ::_lseeki64(descriptor, static_cast<__int64>(position), SEEK_SET) < 0 ? -1 : 0;
}
int sync(int descriptor) noexcept { return ::_commit(descriptor); }

int rename(const Path& from, const Path& to) noexcept {
  if (::MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING) != 0) return 0;
  noteError();
  return -1;
}
int exchange(const Path& /*a*/, const Path& /*b*/) noexcept {
  errno = ENOSYS;
  return -1;
}
int makeFolder(const Path& folder) noexcept { return ::_wmkdir(folder.c_str()); }
int removeFolder(const Path& folder) noexcept { return ::_wrmdir(folder.c_str()); }
int remove(const Path& file) noexcept { return ::_wunlink(file.c_str()); }

long processId() noexcept { return ::_getpid(); }

}  // namespace hexhex::io::system_call

#endif
