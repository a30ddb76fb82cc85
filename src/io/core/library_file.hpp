// Files that another library writes by name: complete or absent like those of OutputFile.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include <io/core/output_file.hpp>

namespace hexhex {

/// HDF5, and what is built on it, keeps its state in global variables: whoever uses one of these
/// libraries holds this lock.
[[nodiscard]] std::mutex& libraryLock();

/// An OutputFile whose temporary is written by name.
///
/// Functions throw Error FileWrite, with the target and the reason, if they fail. A target that is
/// no regular file is refused: these libraries write at any position.
class LibraryFile {
 public:
  /// Creates the temporary, empty.
  explicit LibraryFile(const std::filesystem::path& target);

  /// What the library is to write; it is closed before commit().
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  void commit() { file_.commit(); }
  [[noreturn]] void fail(const std::string& reason) const { file_.fail(reason); }

 private:
  OutputFile file_;
  std::string name_;
};

}  // namespace hexhex
