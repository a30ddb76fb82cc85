// Files by the functions of the system: of POSIX, or what Windows has instead. Those that return a
// number return a negative one if they fail, and errno says why.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace hexhex::io {

/// Calls a function of the system again if a signal interrupted it.
/// @param call  returns a negative number if it fails
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
/// A new file, to write and read back; fails with EEXIST if there is one of the name.
[[nodiscard]] int create(const Path& file) noexcept;
/// A file that create() made.
[[nodiscard]] int openAgain(const Path& file) noexcept;
/// To sync() it. Fails with EACCES if that is possible, but not for this folder, or this system.
[[nodiscard]] int openFolder(const Path& folder) noexcept;

int close(int descriptor) noexcept;
[[nodiscard]] int statusOf(int descriptor, Status& status) noexcept;
[[nodiscard]] int statusOf(const Path& file, Status& status) noexcept;

// These return how many bytes: some, but not necessarily all. Those with a position leave alone
// where the others go on, and may run on several threads.
[[nodiscard]] std::ptrdiff_t read(int descriptor, void* bytes, std::size_t size) noexcept;
[[nodiscard]] std::ptrdiff_t write(int descriptor, const void* bytes, std::size_t size) noexcept;
[[nodiscard]] std::ptrdiff_t readAt(int descriptor, void* bytes, std::size_t size,
                                    std::uint64_t position) noexcept;
[[nodiscard]] std::ptrdiff_t writeAt(int descriptor, const void* bytes, std::size_t size,
                                     std::uint64_t position) noexcept;
[[nodiscard]] int moveTo(int descriptor, std::uint64_t position) noexcept;
/// Makes what was written survive a power failure.
[[nodiscard]] int sync(int descriptor) noexcept;

/// Replaces a file that has the new name.
[[nodiscard]] int rename(const Path& from, const Path& to) noexcept;
/// Gives each of two folders the other's name at once. Fails with ENOSYS where there is no way.
[[nodiscard]] int exchange(const Path& a, const Path& b) noexcept;
[[nodiscard]] int makeFolder(const Path& folder) noexcept;
int removeFolder(const Path& folder) noexcept;
int remove(const Path& file) noexcept;

[[nodiscard]] long processId() noexcept;

}  // namespace system_call

}  // namespace hexhex::io
