// Files that another library writes by name: complete or absent like those of OutputFile.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

namespace hexhex {

/// HDF5, and what is built on it, keeps its state in global variables: whoever uses one of these
/// libraries holds this lock.
[[nodiscard]] std::mutex& libraryLock();

/// A temporary beside its target, to be written by name and renamed by commit(). Without commit()
/// it vanishes, and the target stays as it was.
///
/// Functions throw Error FileWrite, with the target and the reason, if they fail. A target that is
/// no regular file is refused: these libraries write at any position.
class LibraryFile {
 public:
  /// Creates the temporary, empty.
  explicit LibraryFile(std::filesystem::path target);
  ~LibraryFile();
  LibraryFile(const LibraryFile&) = delete;
  LibraryFile& operator=(const LibraryFile&) = delete;

  /// What the library is to write; it is closed before commit().
  [[nodiscard]] const std::string& name() const noexcept { return temporary_; }
  void commit();
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::filesystem::path target_;
  std::string temporary_;
};

}  // namespace hexhex
