// Runs other programs until they end, or until this one ends or is cancelled.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hexhex/context.hpp>

namespace hexhex::fill {

struct ProgramEnd {
  static constexpr int kNotFound = 127;  ///< as reported by shells
  /// The exit code; for a program ended by a signal, 128 plus the signal's number.
  int code = 0;
  std::string said;  ///< on standard output and standard error
};

/// Runs a program, and waits for it.
/// @param words   its name or path, and its arguments
/// @param folder  the working folder, which also receives a file with the output
/// @throws Error Cancelled, after the program has been ended; FileUnsupported where programs cannot
///         be run
[[nodiscard]] ProgramEnd runProgram(const std::vector<std::string>& words,
                                    const std::filesystem::path& folder, Context& context);

/// A folder for temporary files.
class TemporaryFolder {
 public:
  /// @throws Error FileWrite
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace hexhex::fill
