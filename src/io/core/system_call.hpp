// System calls on files: POSIX, or the equivalents of Windows. Functions that return a number
// return a negative one on failure and set errno.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace hexhex::io {

/// Repeats a system call that was interrupted by a signal.
/// @param call  returns a negative number on failure
template <class Call>
auto uninterrupted(const Call& call) {
  while (true) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

namespace system_call {

using Path = std::filesystem::path;

struct Status {
  bool isFolder = false;
  bool isRegular = false;
  std::uint64_t size = 0;
};

// These return a descriptor.
[[nodiscard]] int openToRead(const Path& file) noexcept;
[[nodiscard]] int openToWrite(const Path& file) noexcept;
/// Creates a file for writing and reading; fails with EEXIST if it exists.
[[nodiscard]] int create(const Path& file) noexcept;
/// Reopens a file made by create().
[[nodiscard]] int openAgain(const Path& file) noexcept;
/// Opens a folder for sync(). Fails with EACCES if this folder or system does not permit that.
[[nodiscard]] int openFolder(const Path& folder) noexcept;

int close(int descriptor) noexcept;
[[nodiscard]] int statusOf(int descriptor, Status& status) noexcept;
[[nodiscard]] int statusOf(const Path& file, Status& status) noexcept;

// These return the number of bytes transferred, possibly fewer than requested. Those with a
// position do not move the file pointer and are thread-safe.
[[nodiscard]] std::ptrdiff_t read(int descriptor, void* bytes, std::size_t size) noexcept;
[[nodiscard]] std::ptrdiff_t write(int descriptor, const void* bytes, std::size_t size) noexcept;
[[nodiscard]] std::ptrdiff_t readAt(int descriptor, void* bytes, std::size_t size,
                                    std::uint64_t position) noexcept;
[[nodiscard]] std::ptrdiff_t writeAt(int descriptor, const void* bytes, std::size_t size,
                                     std::uint64_t position) noexcept;
[[nodiscard]] int moveTo(int descriptor, std::uint64_t position) noexcept;
/// Flushes a file to disk, so that it survives a power failure.
[[nodiscard]] int sync(int descriptor) noexcept;

/// Renames a file, replacing an existing one.
[[nodiscard]] int rename(const Path& from, const Path& to) noexcept;
/// Swaps the names of two folders atomically. Fails with ENOSYS where this is not supported.
[[nodiscard]] int exchange(const Path& a, const Path& b) noexcept;
[[nodiscard]] int makeFolder(const Path& folder) noexcept;
int removeFolder(const Path& folder) noexcept;
int remove(const Path& file) noexcept;

[[nodiscard]] long processId() noexcept;

}  // namespace system_call

}  // namespace hexhex::io
